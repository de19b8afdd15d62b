"""How good a trace must be, where a requirement is given."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from omegadot.commands.score.judged import GATES, Judged
from omegadot.commands.units import UNITS, quantity, unit_written
from omegadot.gates.rows import Row
from omegadot.harness.usage import UsageError
from omegadot.written import written

KINDS = {
    **{"attitude": "angle", "omega": "rate", "position": "length"},
    **{"energy": "ratio", "momentum": "ratio", "flip-time": "time"},
}
CHANNEL = {"momentum": "angular_momentum", "flip-time": "time"}


@dataclass(frozen=True)
class Requirement:
    """The largest error allowed. limit: SI, relative for energy and momentum."""

    name: str
    text: str
    limit: float

    @property
    def channel(self) -> str:
        """The channel that it is about."""
        return CHANNEL.get(self.name, self.name)

    def as_text(self, value: float) -> str:
        """A value in the unit that the requirement is written in."""
        kind = KINDS[self.name]
        unit = unit_written(self.text, kind, f"--{self.name}")
        return f"{written(value / UNITS[kind][unit], 4)}{'' if unit == '1' else unit}"


def requirements_of(texts: Mapping[str, str | None]) -> list[Requirement]:
    """By option name, without the dashes. Raises UsageError."""
    return [
        Requirement(name, text, quantity(text, KINDS[name], f"--{name}", needs_unit=True))
        for name, text in texts.items()
        if text is not None
    ]


def requirement_row(one: Requirement, found: Judged) -> Row:
    """Pass or fail. Raises UsageError where the trace cannot decide."""
    channel, flips = one.channel, found.flips
    if channel == "time" and not flips:
        raise UsageError(
            f"--flip-time {one.text}: the motion does not flip about its middle axis, or "
            "omega is not given; leave it out."
        )
    if channel in found.absent:
        raise UsageError(f"--{one.name} {one.text}: {found.absent[channel]}.")
    if channel == "time":
        value, unit, gate = flips[0].value, "s", "trajectory"
    else:
        score, gate = found.in_si(channel), GATES[channel]
        value, unit = score.max, score.unit
    verdict = "pass" if value <= one.limit else "fail"
    note = f"required: at most {one.text}, found {one.as_text(value)}"
    return Row(gate, channel, "requirement", value, unit, one.limit, verdict, note)
