"""What adapters share whose engine has dynamics and no stepper: the reference's schemes step it."""

from __future__ import annotations

import numpy as np

from omegadot.adapters.one_joint import OneJointAdapter
from omegadot.adapters.protocol import Integrator, Trajectory, UnsupportedError
from omegadot.reference_impl.schemes import SCHEMES
from omegadot.reference_impl.stepping import step_through
from omegadot.reference_impl.system import Acceleration, State

# The reference's other schemes are those of other engines' steppers; no user loops them here.
LOOPED = (
    "semi-implicit-euler",
    "linearly-implicit-euler",
    "rk4-quaternion",
    "lie-rk4",
    "lie-rk4-naive",
    "implicit-midpoint",
)


def looped_integrators(prefix: str, note: str) -> tuple[Integrator, ...]:
    """An integrator for each scheme, named ``prefix + scheme``, in spatial coordinates."""
    return tuple(
        Integrator(
            prefix + name, name, dict(SCHEMES[name].orders), note=note, coordinates="body-spatial"
        )
        for name in LOOPED
    )


class LoopedAdapter(OneJointAdapter):
    """The part of an adapter that steps the motion of its joint.

    Beyond what `OneJointAdapter` requires, a joint has motion: its `Motion`; coordinates: q and v
    of states; states: the inverse; and forward takes q and v.
    """

    prefix: str

    def forward_dynamics(self, states: State) -> Acceleration:
        """The engine's own forward dynamics at n states."""
        joint = self._loaded()
        rows = zip(*joint.coordinates(states), strict=True)
        answers = np.array([joint.forward(q, v) for q, v in rows])
        return Acceleration(answers[:, 0], answers[:, 1])

    def run(
        self, initial: State, integrator: str, timestep: float, steps: int, every: int
    ) -> Trajectory:
        """Step a scheme of the reference. Raises UnsupportedError for other names."""
        name = integrator.removeprefix(self.prefix)
        if name not in LOOPED or not integrator.startswith(self.prefix):
            raise UnsupportedError(f"{self.name} has no integrator {integrator!r}.")
        joint = self._loaded()
        q, v = joint.coordinates(initial)
        found = step_through(SCHEMES[name], joint.motion, q, v, timestep, steps, every)
        return Trajectory(found.time, joint.states(found.q, found.v), found.seconds)
