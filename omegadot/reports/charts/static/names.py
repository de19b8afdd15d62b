"""File names that are safe on every system, whatever a scenario is called."""

from __future__ import annotations

import re
from collections.abc import Iterable

_LONGEST = 60
# Devices, on systems where no file may be called so.
_DEVICES = re.compile(r"^(con|prn|aux|nul|com\d|lpt\d)$")


def file_stems(names: Iterable[str]) -> dict[str, str]:
    """The start of the file names of each scenario: plain letters, digits and hyphens, unique."""
    stems: dict[str, str] = {}
    taken: set[str] = set()
    for place, name in enumerate(names, 1):
        stem = re.sub(r"[^a-z0-9]+", "-", name.lower())[:_LONGEST].strip("-")
        if not stem or _DEVICES.match(stem) or stem in taken:
            stem = f"{stem}-{place}".lstrip("-") if stem else f"scenario-{place}"
        while stem in taken:
            stem += "-x"
        taken.add(stem)
        stems[name] = stem
    return stems
