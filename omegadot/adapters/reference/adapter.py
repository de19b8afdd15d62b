"""The reference as an engine like any other: equation (8), stepped by every common scheme."""

from __future__ import annotations

from omegadot import __version__
from omegadot.adapters.protocol import (
    ONE_BODY,
    Description,
    Integrator,
    Setup,
    Trajectory,
    UnsupportedError,
)
from omegadot.reference_impl.coordinates import from_coordinates, to_coordinates
from omegadot.reference_impl.kinematics import place_on_pivot
from omegadot.reference_impl.motion import forward_dynamics, inverse_dynamics
from omegadot.reference_impl.one_body.body_motion import body_motion
from omegadot.reference_impl.schemes import COMMON, SCHEMES
from omegadot.reference_impl.stepping import step_through
from omegadot.reference_impl.system import Acceleration, Array, Body, State, System

FEATURES = ONE_BODY | {"batch"}


class ReferenceAdapter:
    """The Newton-Euler equations of the paper; ``setup`` makes no difference to them."""

    def __init__(self, setup: Setup = "physics") -> None:
        self._system: System | None = None
        self._state: State | None = None

    @property
    def description(self) -> Description:
        """The reference and its common schemes; `run` takes the others by name as well."""
        integrators = tuple(Integrator(s.name, s.name, s.orders) for s in COMMON.values())
        return Description(
            name="reference",
            version=__version__,
            integrators=integrators,
            conventions=("the project's own: equation (8), body axes, about the centre of mass",),
            features=FEATURES,
            licence="Apache-2.0",
        )

    @property
    def system(self) -> System:
        """The loaded system. Raises RuntimeError before `load`."""
        if self._system is None:
            raise RuntimeError("no system is loaded; call load first")
        return self._system

    def load(self, system: System) -> None:
        """Keep the system, no model being built. Raises UnsupportedError for several bodies."""
        if len(system.bodies) != 1:
            raise UnsupportedError(f"the equations are of one body, not of {len(system.bodies)}.")
        self._system, self._state = system, None

    def model(self) -> tuple[Body, ...]:
        """The bodies as they were given."""
        return self.system.bodies

    def set_state(self, state: State) -> None:
        """Keep the state; a pivoted body is placed where its pivot holds it."""
        self._state = place_on_pivot(self.system, state)

    def get_state(self) -> State:
        """The state that was set. Raises RuntimeError before that."""
        if self._state is None:
            raise RuntimeError("no state is set; call set_state first")
        return self._state

    def forward_dynamics(self, states: State) -> Acceleration:
        """Equation (8), and (7), at n states."""
        return forward_dynamics(self.system, states)

    def inverse_dynamics(self, states: State, acceleration: Acceleration) -> Array:
        """Equation (8) as it is printed, gravity apart, at n states."""
        return inverse_dynamics(self.system, states, acceleration)

    def run(
        self, initial: State, integrator: str, timestep: float, steps: int, every: int
    ) -> Trajectory:
        """Step the scheme named `integrator`. Raises UnsupportedError where there is none."""
        if integrator not in SCHEMES:
            raise UnsupportedError(f"the reference has no scheme {integrator!r}.")
        start = to_coordinates(self.system, initial, "com-world")
        motion = body_motion(self.system)
        found = step_through(SCHEMES[integrator], motion, *start, timestep, steps, every)
        states = from_coordinates(self.system, found.q, found.v, "com-world")
        return Trajectory(found.time, states, found.seconds)
