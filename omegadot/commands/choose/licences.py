"""The names of licences that may be required: SPDX's, and those of the engines themselves."""

from __future__ import annotations

from collections.abc import Iterable

from packaging.licenses import InvalidLicenseExpression, canonicalize_license_expression

from omegadot.commands.engines.engines import entry_of
from omegadot.harness.plan import EngineChoice
from omegadot.harness.usage import UsageError, nearest
from omegadot.reports.text.numbers import listed


def check_licences(wanted: Iterable[str], engines: Iterable[EngineChoice]) -> None:
    """Raise UsageError where a name is neither SPDX's nor an engine's, in whatever letters.

    engines: those that are installed. They are started only where a name is not SPDX's. A licence
    that no engine has may be allowed too: lists of what is allowed are longer than what is used.
    """
    unknown = [name for name in wanted if not _is_spdx(name)]
    if not unknown:
        return
    entries = [entry.description for entry in map(entry_of, engines)]
    own = sorted({found.licence for found in entries if found and found.licence})
    known = {name.casefold() for name in own}
    for name in unknown:
        if name.casefold() not in known:
            have = f"the installed engines have {listed(own)}" if own else "no engine states one"
            advice = nearest(name, own)
            advice = advice if advice.startswith("write ") else "give one by its SPDX name"
            raise UsageError(f"--licence {name}: there is no such licence; {advice} ({have}).")


def _is_spdx(name: str) -> bool:
    """Whether it is a licence of SPDX's list; an expression of several is none."""
    try:
        canonicalize_license_expression(name)
    except InvalidLicenseExpression:
        return False
    return len(name.split()) == 1 and not name.casefold().startswith("licenseref-")
