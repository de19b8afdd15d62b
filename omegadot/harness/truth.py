"""The exact course of a case at its sample times, and the reference's companions."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from omegadot.harness.gates.course import Companion, SchemeKey
from omegadot.harness.measures import Yardstick
from omegadot.harness.plan import Case, Sweep
from omegadot.reference_impl.system import Array, State


@dataclass(frozen=True)
class Truth:
    """The exact solution of one case. source: "closed-form" or "series"."""

    source: str
    times: Array
    state: State
    omega_dot: Array
    yardstick: Yardstick
    companions: dict[tuple[SchemeKey, float], Companion] = field(default_factory=dict)

    def at(self, sweep: Sweep) -> State:
        """The exact states at the samples of one sweep."""
        rows = np.searchsorted(self.times, sweep.times)
        return State(*(values[rows] for values in vars(self.state).values()))


def path_states(case: Case, truth: Truth, most: int) -> State:
    """At most `most` states spread evenly along the exact course, both ends among them."""
    rows = np.unique(np.linspace(0, len(truth.times) - 1, most).round().astype(int))
    return State(*(values[rows] for values in vars(truth.state).values()))
