"""What comes of a scored trace, for a script: channel by channel, in SI units."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property

from omegadot.commands.run.result import RunResult
from omegadot.commands.score.judged import ChannelScore, Judged
from omegadot.commands.score.sentences import sentences
from omegadot.commands.score.shift import Shift
from omegadot.gates.rows import Row


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
        return {channel: self.found.in_si(channel) for channel in self.found.error}

    @property
    def not_given(self) -> Mapping[str, str]:
        """The channels that the trace does not give, and why."""
        return self.found.absent

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
