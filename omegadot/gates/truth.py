"""The exact trajectory of a case at its sample times, and the reference's companions."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from omegadot.gates.case import Case, Sweep
from omegadot.gates.measured_run import Companion, ExactSamples, SchemeKey
from omegadot.gates.measures import Yardstick
from omegadot.reference_impl.system import Array, State


@dataclass(frozen=True)
class Truth:
    """The exact solution of one case.

    source: "closed-form" or "series".  growth: (n,), of rounding along the exact trajectory.
    floor: (n,) per channel, how far a perfect answer in double may be off: omega relative to the
    yardstick's rate, attitude in rad.
    """

    source: str
    times: Array
    state: State
    omega_dot: Array
    growth: Array
    floor: dict[str, Array]
    yardstick: Yardstick
    companions: dict[tuple[SchemeKey, float], Companion] = field(default_factory=dict)

    def at(self, sweep: Sweep) -> State:
        """The exact states at the samples of one sweep."""
        rows = self._rows(sweep)
        return State(*(values[rows] for values in vars(self.state).values()))

    def samples(self, sweep: Sweep) -> ExactSamples:
        """What there is to measure one sweep's runs by."""
        rows = self._rows(sweep)
        floor = {channel: values[rows] for channel, values in self.floor.items()}
        return ExactSamples(self.at(sweep), self.growth[rows], floor)

    def _rows(self, sweep: Sweep) -> NDArray[np.intp]:
        return np.searchsorted(self.times, sweep.times)


def path_states(case: Case, truth: Truth, most: int) -> State:
    """At most `most` states spread evenly along the exact trajectory, both ends among them."""
    rows = np.unique(np.linspace(0, len(truth.times) - 1, most).round().astype(int))
    return State(*(values[rows] for values in vars(truth.state).values()))
