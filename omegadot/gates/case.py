"""A case: a scenario prepared for running, and the samples that each of its steps keeps."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TypedDict

import numpy as np

from omegadot.adapters.protocol import Integrator
from omegadot.reference_impl.solutions.companion import Steps
from omegadot.reference_impl.system import Array, State, System
from omegadot.scenarios import Scenario

# Each is a hundredth of the one before; where these show too little, two finer ones follow.
ACCURACIES = (1e-3, 1e-5, 1e-7, 1e-9)


@dataclass(frozen=True)
class Sweep(Steps):
    """One step size of a scenario, or one accuracy.

    accuracy: of an error-controlled integrator, whose steps are its own. The timestep is then the
    spacing of the samples.
    """

    accuracy: float | None = None

    @property
    def knob(self) -> float:
        """The accuracy, or else the step: what names it among the sweeps of one integrator."""
        return self.timestep if self.accuracy is None else self.accuracy

    def until(self, samples: int) -> Sweep:
        """The first samples, or all where there are no more."""
        numbers = self.sample_steps
        return replace(self, steps=int(numbers[min(samples, len(numbers)) - 1]))

    def refined(self, factor: int) -> Sweep:
        """The same samples at a step `factor` times smaller."""
        parts = (self.timestep / factor, self.steps * factor, self.every * factor)
        return Sweep(*parts, self.accuracy)


@dataclass(frozen=True)
class Case:
    """A scenario made ready: its system, its initial state, its sweep over steps.

    accuracies: the sweep of error-controlled integrators.
    """

    scenario: Scenario
    system: System
    initial: State
    sweeps: tuple[Sweep, ...]
    accuracies: tuple[float, ...] = ACCURACIES

    @property
    def name(self) -> str:
        """The scenario's name."""
        return self.scenario.name

    @property
    def sample_times(self) -> Array:
        """Every sample time of every sweep, sorted, each once."""
        return np.unique(np.concatenate([sweep.times for sweep in self.sweeps]))

    @property
    def sampled(self) -> Sweep:
        """The evenly spaced samples of the finest step, each a step of its own."""
        finest = min(self.sweeps, key=lambda sweep: sweep.timestep)
        every = min(finest.every, finest.steps)
        return Sweep(finest.timestep * every, finest.steps // every, 1)

    def sweeps_of(self, integrator: Integrator) -> tuple[Sweep, ...]:
        """What an integrator is swept over: steps, or accuracies where it takes them."""
        if integrator.knob != "accuracy":
            return self.sweeps
        return self.swept_by_accuracy(integrator.finest_accuracy)

    def swept_by_accuracy(self, finest: float) -> tuple[Sweep, ...]:
        """The samples at every accuracy, from the coarsest on, and none finer than `finest`."""
        values = sorted({max(value, finest) for value in self.accuracies}, reverse=True)
        return tuple(replace(self.sampled, accuracy=value) for value in values)


class Knobs(TypedDict):
    """The columns that name a run among those of its integrator; one of them is None at least."""

    timestep: float | None
    accuracy: float | None


def knobs_of(sweep: Sweep | None) -> Knobs:
    """The step or the accuracy of a run; neither for what has none."""
    accuracy = sweep.accuracy if sweep else None
    timestep = sweep.timestep if sweep and accuracy is None else None
    return {"timestep": timestep, "accuracy": accuracy}


def sweep_of(duration: float, timestep: float, sample: float) -> Sweep:
    """Whole steps within the duration, and k = max(1, round(sample / step)) between samples."""
    ratio = duration / timestep
    nearest = round(ratio)
    # A duration that is a whole multiple on paper is one here, whatever the division rounded to.
    whole = nearest if abs(ratio - nearest) <= 4 * np.finfo(float).eps * ratio else int(ratio)
    return Sweep(timestep, max(1, whole), max(1, round(sample / timestep)))
