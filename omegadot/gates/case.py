"""A case: a scenario prepared for running, and the samples that each of its steps keeps."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from omegadot.reference_impl.companion import Steps
from omegadot.reference_impl.system import Array, State, System
from omegadot.scenarios import Scenario


@dataclass(frozen=True)
class Sweep(Steps):
    """One step size of a scenario."""

    def refined(self, factor: int) -> Sweep:
        """The same samples at a step `factor` times smaller."""
        return Sweep(self.timestep / factor, self.steps * factor, self.every * factor)


@dataclass(frozen=True)
class Case:
    """A scenario made ready: its system, its initial state, its sweep."""

    scenario: Scenario
    system: System
    initial: State
    sweeps: tuple[Sweep, ...]

    @property
    def name(self) -> str:
        """The scenario's name."""
        return self.scenario.name

    @property
    def sample_times(self) -> Array:
        """Every sample time of every sweep, sorted, each once."""
        return np.unique(np.concatenate([sweep.times for sweep in self.sweeps]))


def sweep_of(duration: float, timestep: float, sample: float) -> Sweep:
    """Whole steps within the duration, and k = max(1, round(sample / step)) between samples."""
    ratio = duration / timestep
    nearest = round(ratio)
    # A duration that is a whole multiple on paper is one here, whatever the division rounded to.
    whole = nearest if abs(ratio - nearest) <= 4 * np.finfo(float).eps * ratio else int(ratio)
    return Sweep(timestep, max(1, whole), max(1, round(sample / timestep)))
