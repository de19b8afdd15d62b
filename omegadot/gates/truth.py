"""The exact trajectory of a case at its sample times, and the reference's companions."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

from omegadot.adapters.protocol import Integrator
from omegadot.gates.bounds.measures import Yardstick
from omegadot.gates.bounds.roundings import PLAIN, Roundings
from omegadot.gates.bounds.scales import EPS, eps_of
from omegadot.gates.case import Sweep
from omegadot.reference_impl.coordinates import Coordinates, canonical
from omegadot.reference_impl.system import Array, State, System


@dataclass(frozen=True)
class SchemeKey:
    """Which of the reference's runs an integrator is compared with."""

    scheme: str
    coordinates: Coordinates = "com-world"


def scheme_key(integrator: Integrator, system: System) -> SchemeKey | None:
    """The run of the reference that this integrator should equal; None for an unknown scheme.

    An error-controlled integrator chooses its own steps: it equals none.
    """
    if integrator.scheme is None or integrator.knob != "timestep":
        return None
    return SchemeKey(integrator.scheme, canonical(system, integrator.coordinates))


@dataclass(frozen=True)
class Companion:
    """The reference stepping one scheme with one step: its states and the growth of rounding."""

    state: State
    growth: Array
    omega_dot: Array
    scheme: str = ""

    def until(self, count: int) -> Companion:
        """Its first samples."""
        first = (self.state[:count], self.growth[:count], self.omega_dot[:count])
        return Companion(*first, self.scheme)


# Companions by scheme over the steps of a sweep: of these schemes, or of all that may be stepped.
StepSchemes = Callable[[Sweep, Sequence[SchemeKey] | None], Mapping[SchemeKey, Companion]]


@dataclass(frozen=True)
class Truth:
    """The exact solution of one case.

    source: "closed-form" or "series".  growth: (n,), of rounding along the exact trajectory.
    floor: (n,) per channel, how far a perfect answer in the yardstick's precision may be off: omega
    relative to the yardstick's rate, attitude in rad.  step_schemes: steps further companions.
    """

    source: str
    times: Array
    state: State
    omega_dot: Array
    growth: Array
    floor: dict[str, Array]
    yardstick: Yardstick
    companions: dict[tuple[SchemeKey, float], Companion] = field(default_factory=dict)
    step_schemes: StepSchemes = lambda sweep, keys: {}

    def in_precision(self, precision: str) -> Truth:
        """What an engine is held against that computes in "float64" or "float32".

        The exact motion and the companions are in double all the same. Rounding and floor are in
        proportion to eps, to first order: the start is rounded to the engine's numbers, and so are
        mass, inertia, centre of mass, loads and the step.
        """
        eps = eps_of(precision)
        if eps == self.yardstick.eps:
            return self
        ratio = eps / self.yardstick.eps
        floor = {channel: ratio * values for channel, values in self.floor.items()}
        return replace(self, floor=floor, yardstick=self.yardstick.with_eps(eps))

    def of_kept(self, sweep: Sweep, state: State) -> Truth:
        """The same for a run that keeps energy and momentum, see `Yardstick.of_kept`."""
        yardstick = self.yardstick.of_kept(state.angular_velocity, sweep.sample_steps)
        return self if yardstick is self.yardstick else replace(self, yardstick=yardstick)

    def of_roundings(self, roundings: Roundings) -> Truth:
        """The same for steps that round otherwise than most."""
        if roundings == PLAIN:
            return self
        return replace(self, yardstick=self.yardstick.of_roundings(roundings))

    def rows(self, sweep: Sweep) -> NDArray[np.intp]:
        """Where the samples of one sweep are among the times, which may be rounded otherwise."""
        return np.searchsorted(self.times, sweep.times * (1.0 - 4.0 * EPS))

    def at(self, sweep: Sweep) -> State:
        """The exact states at the samples of one sweep."""
        return self.state[self.rows(sweep)]

    def of_step(self, sweep: Sweep) -> dict[SchemeKey, Companion]:
        """The companions that are known with a sweep's step."""
        step = sweep.timestep
        return {key: own for (key, timestep), own in self.companions.items() if timestep == step}

    def beginnings(self, sweep: Sweep) -> dict[SchemeKey, Companion]:
        """Of every scheme that an engine's run may equal, over these first steps of a sweep."""
        stepped, count = self.step_schemes(sweep, None), len(sweep.times)
        return {**stepped, **{key: own.until(count) for key, own in self.of_step(sweep).items()}}

    def whole(self, sweep: Sweep, key: SchemeKey) -> Companion | None:
        """Of one scheme over a whole sweep, stepped when it is first requested."""
        if (key, sweep.timestep) not in self.companions:
            for own, found in self.step_schemes(sweep, [key]).items():
                self.companions[own, sweep.timestep] = found
        return self.companions.get((key, sweep.timestep))

    def companion(self, integrator: Integrator, sweep: Sweep) -> Companion | None:
        """The run of the reference that an integrator's should equal, where there is one."""
        key = scheme_key(integrator, self.yardstick.system)
        return None if key is None else self.companions.get((key, sweep.timestep))
