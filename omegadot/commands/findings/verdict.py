"""When a finding stands: the record and the script show the same, beyond what rounding may do."""

from __future__ import annotations

import math
from dataclasses import dataclass

from omegadot.commands.findings.entry import Entry
from omegadot.commands.findings.measured import Measured

# Parts of a figure: both ways are stated in two digits, and are then equal in them, or nearly so.
SAME = 0.005


@dataclass(frozen=True)
class Finding:
    """A finding with what was measured of it.  doubt: why it does not stand, "" where it does."""

    entry: Entry
    measured: Measured
    doubt: str

    @property
    def stands(self) -> bool:
        """Whether it was reproduced in both ways."""
        return not self.doubt

    @property
    def order(self) -> tuple[bool, bool, float]:
        """Among the others, what changes a motion most is smallest."""
        size = 0.0 if self.entry.expected is not None else abs(self.measured.value or 0.0)
        return self.entry.reach != "ordinary", self.entry.expected is not None, -size


def judged(entry: Entry, measured: Measured) -> Finding:
    """The finding, with the first reason that it does not stand, if there is one."""
    doubt = _of_record(entry, measured) or _of_script(entry, measured)
    return Finding(entry, measured, doubt)


def _of_record(entry: Entry, measured: Measured) -> str:
    value, bound = measured.value, measured.bound
    if value is None or not math.isfinite(value):
        return "no record has the run"
    if entry.expected is not None:
        return "the record has the expected order" if round(value) == entry.expected else ""
    if measured.verdict not in ("fail", "declared"):
        return f"no gate fails in the record's run, of which the verdict is {measured.verdict}"
    if bound is not None and not value > bound:
        return f"the record's figure, {value!r}, is within the round-off bound, {bound!r}"
    return ""


def _of_script(entry: Entry, measured: Measured) -> str:
    value, other, mended = measured.value, measured.script_value, measured.script_mended
    if measured.script_error:
        return f"the script failed: {measured.script_error}"
    if other is None or not math.isfinite(other):
        return "the script was not run"
    if measured.script_release != measured.release:
        return f"the script ran release {measured.script_release}, the record {measured.release}"
    assert value is not None
    orders = entry.expected is not None  # of several steps in two ways: whole numbers alone compare
    same = round(other) == round(value) if orders else abs(other - value) <= SAME * abs(value)
    if not same:
        return f"the script's figure is {other!r}, the record's {value!r}"
    if entry.mends and not _mended(value, measured.physics, mended):
        return f"with what is said to mend it the script has {mended!r}, and {value!r} without"
    return ""


def _mended(value: float, physics: float | None, mended: float | None) -> bool:
    """Whether the setting leaves what the setup physics does, to the same parts of the figure."""
    if physics is None or mended is None:
        return False
    return abs(physics) < abs(value) / 2 and abs(mended - physics) <= SAME * abs(value)
