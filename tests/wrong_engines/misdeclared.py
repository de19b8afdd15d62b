"""Engines that step another scheme than they declare, or an unknown one."""

from __future__ import annotations

import numpy as np

from omegadot.adapters.protocol import Description, Integrator, Trajectory, UnsupportedError
from omegadot.adapters.reference.adapter import FEATURES, ReferenceAdapter
from omegadot.reference_impl.schemes import SCHEMES, Motion, Scheme
from omegadot.reference_impl.schemes.scheme import every_channel
from omegadot.reference_impl.stepping import step_body
from omegadot.reference_impl.system import Array, State, System


class Misdeclared(ReferenceAdapter):
    """The reference with one integrator that declares `declared` and steps `stepped`."""

    declared: str | None = "lie-rk4"
    stepped: Scheme = SCHEMES["lie-rk4"]

    @property
    def description(self) -> Description:
        integrator = Integrator("step", self.declared, every_channel(4))
        return Description(type(self).__name__.lower(), "1.0", (integrator,), features=FEATURES)

    def run(
        self, initial: State, integrator: str, timestep: float, steps: int, every: int
    ) -> Trajectory:
        how = (self.stepped, self.system, initial)
        return Trajectory(*step_body(*how, timestep, steps, every))


class EulerAsRungeKutta(Misdeclared):
    stepped = SCHEMES["semi-implicit-euler"]


class NaiveAsRungeKutta(Misdeclared):
    """Right in omega, and of order 2 instead of 4 in attitude."""

    stepped = SCHEMES["lie-rk4-naive"]


def _explicit_midpoint(motion: Motion, q: Array, v: Array, h: float | Array) -> tuple[Array, Array]:
    middle = v + 0.5 * h * motion.acceleration(q, v)
    halfway = motion.retract(q, 0.5 * h * v)
    return motion.retract(q, h * middle), v + h * motion.acceleration(halfway, middle)


class Unheard(Misdeclared):
    """An explicit midpoint rule of order 2, which the reference does not have; free bodies only."""

    declared = None
    stepped = Scheme("explicit-midpoint", "", _explicit_midpoint, every_channel(2))

    def load(self, system: System) -> None:
        if system.load.pivot is not None:
            raise UnsupportedError("there are no joints here.")
        super().load(system)


class AlmostEuler(Misdeclared):
    """Semi-implicit Euler that turns by 1e-9 too much: no scheme that is known."""

    declared = "semi-implicit-euler"

    def run(
        self, initial: State, integrator: str, timestep: float, steps: int, every: int
    ) -> Trajectory:
        def step(motion: Motion, q: Array, v: Array, h: float | Array) -> tuple[Array, Array]:
            q, v = SCHEMES["semi-implicit-euler"].step(motion, q, v, h)
            more = np.zeros_like(v)
            more[..., -3:] = 1e-9 * v[..., -3:]
            return motion.retract(q, h * more), v

        how = (Scheme("almost", "", step, every_channel(1)), self.system, initial)
        return Trajectory(*step_body(*how, timestep, steps, every))
