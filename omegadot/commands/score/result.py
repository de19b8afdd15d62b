"""What comes of a scored trace, for a script: channel by channel, in SI units."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from omegadot.commands.run.result import RunResult
from omegadot.commands.score.judged import Judged
from omegadot.commands.score.sentences import sentences
from omegadot.commands.score.shift import Shift
from omegadot.gates.rows import Row

UNITS = {"omega": "rad/s", "attitude": "rad", "position": "m"}


@dataclass(frozen=True)
class ChannelScore:
    """A channel's error against the exact solution, in `unit`; "1" is relative.

    max, end, rms, start: of the samples.  digits_open: the resolution of the data, by its digits.
    bound: that, rounding and the floor together.  verdict: pass, fail or info, with kind and note.
    """

    max: float
    end: float
    rms: float
    start: float
    digits_open: float
    bound: float
    unit: str
    verdict: str
    kind: str
    note: str


@dataclass(frozen=True, repr=False, kw_only=True)
class ScoreResult(RunResult):
    """A trace scored, and the record it stands in, with the engines that were run with it.

    name: the trace's, among the engines.  found: everything that was found.  rows: its measures.
    """

    name: str
    found: Judged
    rows: tuple[Row, ...]

    @cached_property
    def channels(self) -> Mapping[str, ChannelScore]:
        """The errors by channel, of those that the trace gives."""
        return {channel: _channel(self.found, channel) for channel in self.found.measured.error}

    @property
    def not_given(self) -> Mapping[str, str]:
        """The channels that the trace does not give, and why."""
        return self.found.measured.absent

    @property
    def shift(self) -> Shift | None:
        """How late or early the trace is, where that can be seen."""
        return self.found.shift

    @property
    def requirements(self) -> tuple[Row, ...]:
        """A row for every requirement: its value, bound and verdict."""
        return tuple(row for row in self.rows if row.metric == "requirement")

    @property
    def sentences(self) -> list[str]:
        """What else was found, one sentence each."""
        return sentences(self.found, list(self.rows))


def _channel(found: Judged, channel: str) -> ChannelScore:
    error, judgement = found.measured.error[channel], found.judgement[channel]
    factor = found.truth.yardstick.rate if channel == "omega" else 1.0
    return ChannelScore(
        max=factor * float(np.max(error)),
        end=factor * float(error[-1]),
        rms=factor * math.sqrt(float(np.mean(error**2))),
        start=factor * float(error[0]),
        digits_open=factor * float(np.max(found.digits[channel])),
        bound=factor * float(np.max(found.bound[channel])),
        unit=UNITS.get(channel, "1"),
        verdict=judgement.verdict,
        kind=judgement.kind,
        note=judgement.note,
    )
