"""DART behind the protocol: its forward and inverse dynamics and its own stepper.

`dart_joint` holds the world, the body and its joint. The stepper is semi-implicit Euler:
accelerations, then velocities, then positions with the new velocities.
"""

from __future__ import annotations

import numpy as np

from omegadot.adapters.dart_joint import SWITCHED_OFF, DartJoint
from omegadot.adapters.protocol import Description, Integrator, Setup, Trajectory, UnsupportedError
from omegadot.reference_impl.schemes import SCHEMES
from omegadot.reference_impl.stepping import kept_steps, stack
from omegadot.reference_impl.system import Acceleration, Array, Body, State, System

NAME = "semi-implicit"
SCHEME = "semi-implicit-euler"
NOTE = "World.step"
CONVENTIONS = (
    "FreeJoint velocities are in body axes up to 6.16 and in world axes from 6.17; BallJoint "
    "velocities are in body axes: the adapter asks for named frames or goes through the Jacobian",
    "orientation is kept as the rotation vector from the joint's frame",
    "spatial vectors are (angular, linear), at the body origin",
    "DART's joint damping is implicit in the step: here -damping * omega is an external torque at "
    "the start of each step, as the applied torques are",
    "rotations of less than 1e-3 rad, those of a step included, are expanded to second order: they "
    "turn by angle**3 / 6 too far",
    "from 6.17 a non-finite transform is replaced by the identity and a non-finite acceleration by "
    "zero: where DART's own coordinates are not finite, the adapter gives NaN",
)
FEATURES = frozenset(
    "free pivot gravity damping torque full_inertia offset_com forward_dynamics inverse_dynamics".split()
)
LINKS = ("https://github.com/dartsim/dart", "https://docs.dartsim.org/")


def _integrator(system: System | None) -> Integrator:
    """The stepper; of a loaded system with the orders that its scheme has on it.

    Channels without truncation error are left out. A free body with its centre of mass off the
    origin has none of these: its momentum drifts.
    """
    scheme = SCHEMES[SCHEME]
    orders: dict[str, int | None] = dict(scheme.orders)
    if system is not None and not _steps_off_center(system):
        orders = {channel: scheme.order(channel, system) for channel in orders}
    declared = {channel: order for channel, order in orders.items() if order is not None}
    return Integrator(NAME, SCHEME, declared, note=NOTE, steps_origin=True)


def _steps_off_center(system: System) -> bool:
    return system.load.pivot is None and bool(np.any(system.body.center_of_mass))


class DartAdapter:
    """dartpy 6.16.2 and later."""

    def __init__(self, setup: Setup = "physics") -> None:
        import dartpy

        self._engine = dartpy
        self._setup = setup
        self._joint: DartJoint | None = None
        self._system: System | None = None

    @property
    def description(self) -> Description:
        """DART as it is installed; once a system is loaded, its orders are those on that system."""
        return Description(
            name="dart",
            version=str(self._engine.__version__),
            integrators=(_integrator(self._system),),
            conventions=CONVENTIONS,
            switched_off=SWITCHED_OFF if self._setup == "physics" else (),
            features=FEATURES,
            licence="BSD-2-Clause",
            links=LINKS,
        )

    def load(self, system: System) -> None:
        """Build a world with one body. Raises UnsupportedError for several bodies."""
        if len(system.bodies) != 1:
            raise UnsupportedError(f"dart takes one body here, not {len(system.bodies)}.")
        self._system = system
        self._joint = DartJoint(self._engine, system, physics=self._setup == "physics")

    def model(self) -> tuple[Body, ...]:
        """The body node's inertia, read back."""
        return (self._loaded().body(),)

    def set_state(self, state: State) -> None:
        """Put the joint in the state."""
        self._loaded().set_state(state)

    def get_state(self) -> State:
        """The body node's state in the project's frames."""
        return State(*self._loaded().get_state())

    def forward_dynamics(self, states: State) -> Acceleration:
        """`Skeleton.computeForwardDynamics` at n states."""
        joint = self._loaded()
        angular = np.empty_like(states.angular_velocity, dtype=float)
        linear = np.empty_like(angular)
        for n in range(len(angular)):
            joint.set_state(_row(states, n))
            angular[n], linear[n] = joint.forward()
        return Acceleration(angular, linear)

    def inverse_dynamics(self, states: State, acceleration: Acceleration) -> Array:
        """`Skeleton.computeInverseDynamics` at n states."""
        joint = self._loaded()
        torque = np.empty_like(states.angular_velocity, dtype=float)
        for n in range(len(torque)):
            state = _row(states, n)
            joint.set_state(state)
            torque[n] = joint.inverse(state, acceleration.angular[n], acceleration.linear[n])
        return torque

    def run(
        self, initial: State, integrator: str, timestep: float, steps: int, every: int
    ) -> Trajectory:
        """`World.step`, the state read at samples alone. Raises UnsupportedError for other names.

        A run that is no longer finite is not stepped on: its later samples are NaN.
        """
        if integrator != NAME:
            raise UnsupportedError(f"dart has no integrator {integrator!r}.")
        joint, kept = self._loaded(), kept_steps(steps, every)
        joint.start(initial, timestep)
        rows = [joint.get_state()]
        for count in np.diff(kept).tolist():
            if joint.is_finite():
                joint.step(count)
            rows.append(joint.get_state())
        return Trajectory(np.multiply(kept, timestep), stack([State(*row) for row in rows]))

    def _loaded(self) -> DartJoint:
        if self._joint is None:
            raise RuntimeError("no system is loaded: call load() first")
        return self._joint


def _row(states: State, n: int) -> State:
    return State(
        states.orientation[n],
        states.angular_velocity[n],
        states.position[n],
        states.linear_velocity[n],
    )
