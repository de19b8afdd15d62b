"""Units that stand in the names of columns: ``gyro_x (deg/s)``, ``time [ms]``."""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import Any

from omegadot.commands.score.table import Table, TraceError, unit_text
from omegadot.commands.units import SPELLINGS, UNITS
from omegadot.harness.usage import UsageError

_KINDS = {"t": "time", "w": "rate", "e": "angle", "p": "length", "v": "length", "a": "rate"}
"""By a role's first letter, the quantity whose unit the column is in, or in over s: v and a."""
_OVER_TIME = {"v", "a"}
_WHAT = {"t": "a time", "w": "an angular velocity", "e": "an angle", "p": "a length"}
_WHAT |= {"v": "a velocity", "a": "an angular acceleration"}
WORDS = {"dps": "deg/s", "rad/sec": "rad/s", "rev/min": "rpm", "r/min": "rpm", "1/min": "rpm"}
"""How headers write units that options know by one name."""
_PARTS = {
    **dict.fromkeys(("sec", "secs", "second", "seconds"), "s"),
    **dict.fromkeys(("msec", "millisecond", "milliseconds"), "ms"),
    **dict.fromkeys(("degree", "degrees"), "deg"),
    **dict.fromkeys(("radian", "radians"), "rad"),
    **dict.fromkeys(("meter", "meters", "metre", "metres"), "m"),
}
_PER_SECOND = re.compile(r"\s*[·*. ]?\s*s(?:ec)?(?:\^?-1|⁻¹)$")
_SQUARED = re.compile(r"/s(?:\^?2|²|\*\*2)$")
_SINGLE = {unit for kind in ("time", "angle", "rate", "length") for unit in UNITS[kind]}


def _plain(text: str) -> str:
    """A unit as UNITS would spell it: ``deg/s`` of ``Degrees/sec``, ``°/s`` or ``deg s^-1``."""
    for other, ours in SPELLINGS.items():
        text = text.replace(other, ours)
    text = _PER_SECOND.sub("/s", text.strip().casefold())
    text = _SQUARED.sub("/s/s", text)
    parts = [part.strip() for part in text.split("/")]
    text = "/".join(_PARTS.get(part, part) for part in parts)
    return WORDS.get(text, text)


def unit_in(name: str, role: str) -> str | None:
    """The unit in a column's name as the option has it; None where it has none.

    Of a velocity it is that of length, of omega-dot that of omega.  Raises UsageError where the
    name has a unit of another quantity, or one that no option knows.
    """
    kind, written = _KINDS.get(role[0]), unit_text(name)
    if kind is None or not written:
        return None
    unit = _plain(written)
    own = unit.removesuffix("/s") if role[0] in _OVER_TIME else unit
    if own in UNITS[kind] and (own != unit or role[0] not in _OVER_TIME):
        return own
    # Anything else in brackets is a remark, such as (filtered).
    if unit in _SINGLE or all(part in _SINGLE for part in unit.split("/")):
        raise UsageError(f"column {name!r} is read as {_WHAT[role[0]]}, and {written} is none")
    return None


def named_units(
    table: Table, columns: Mapping[str, str], declared: Mapping[str, Any]
) -> dict[str, tuple[str, str]]:
    """By option, such as ``rate-unit``, the unit in the columns' names, and the column it is of.

    columns: names by role.  declared: settings by option, units as UNITS spells them.
    Raises TraceError where two names, or a name and an option, have different units.
    """
    found: dict[str, tuple[str, str]] = {}
    for role, name in columns.items():
        option = f"{_KINDS.get(role[0], '')}-unit"
        try:
            unit = unit_in(name, role)
        except UsageError as error:
            if option in declared:  # it says what the name does not
                continue
            raise TraceError(f"{table.file}: {error}; give --{option}, or rename it.") from None
        if unit is None:
            continue
        if declared.get(option, unit) != unit:
            raise TraceError(
                f"{table.file}: the name of column {name!r} has the unit {unit}, and --{option} "
                f"is {declared[option]}; leave out the option, or correct the name."
            )
        other, first = found.setdefault(option, (unit, name))
        if other != unit:
            raise TraceError(
                f"{table.file}: the names of columns {first!r} and {name!r} have different units; "
                "convert one to the unit of the other."
            )
    return found
