"""Pinocchio behind the protocol: its ABA and RNEA, and the reference's schemes stepping its ABA.

Pinocchio computes dynamics and has no stepper, so every integrator here is named
``aba+<scheme of the reference>``. `pinocchio_joint` holds the model and the joint coordinates.
"""

from __future__ import annotations

import numpy as np

from omegadot.adapters.pinocchio.joint import PinocchioJoint
from omegadot.adapters.protocol import (
    Description,
    Integrator,
    Setup,
    Trajectory,
    UnsupportedError,
)
from omegadot.reference_impl.schemes import SCHEMES, Scheme
from omegadot.reference_impl.stepping import step_through
from omegadot.reference_impl.system import Acceleration, Array, Body, State, System

PREFIX = "aba+"
NOTE = "the reference's scheme over Pinocchio's ABA, not a stepper of Pinocchio's own"

CONVENTIONS = (
    "quaternions are (x, y, z, w) in q",
    "a free body has a free-flyer joint at the body origin: its velocity is the spatial velocity "
    "(linear, angular) of that origin in body axes, its acceleration the spatial one",
    "a pivoted body has a spherical joint at the pivot: its velocity is omega in body axes",
    "no stepper: the reference's schemes step pinocchio.aba (convention LOCAL) and "
    "pinocchio.integrate in these coordinates",
    "no damping inside aba: -damping * omega and the applied torques are added to the joint torque "
    "at every evaluation",
)
FEATURES = frozenset(
    {
        *("free", "pivot", "gravity", "damping", "torque", "full_inertia", "offset_com"),
        *("forward_dynamics", "inverse_dynamics"),
    }
)
LINKS = (
    "https://github.com/stack-of-tasks/pinocchio",
    "https://gepettoweb.laas.fr/doc/stack-of-tasks/pinocchio/master/doxygen-html/",
)

# The reference's other schemes are those of other engines' steppers; no user loops them here.
LOOPED = (
    "semi-implicit-euler",
    "linearly-implicit-euler",
    "rk4-quaternion",
    "lie-rk4",
    "lie-rk4-naive",
    "implicit-midpoint",
)


def _integrator(scheme: Scheme) -> Integrator:
    return Integrator(
        PREFIX + scheme.name,
        scheme.name,
        dict(scheme.orders),
        note=NOTE,
        coordinates="body-spatial",
    )


def _rows(states: State) -> State:
    """The states as n rows with the same n in every array."""
    lead = np.broadcast_shapes(states.orientation.shape[:-1], states.angular_velocity.shape[:-1])

    def rows(array: Array, width: int) -> Array:
        return np.broadcast_to(array, (*lead, width)).reshape(-1, width)

    return State(
        rows(states.orientation, 4),
        rows(states.angular_velocity, 3),
        rows(states.position, 3),
        rows(states.linear_velocity, 3),
    )


class PinocchioAdapter:
    """Pinocchio 3.4 and later. Nothing in it spoils physics, so both setups are the same."""

    def __init__(self, setup: Setup = "physics") -> None:
        import pinocchio

        self._engine = pinocchio
        self._joint: PinocchioJoint | None = None

    @property
    def description(self) -> Description:
        """Pinocchio as it is installed."""
        return Description(
            name="pinocchio",
            version=str(self._engine.__version__),
            integrators=tuple(_integrator(SCHEMES[name]) for name in LOOPED),
            conventions=CONVENTIONS,
            features=FEATURES,
            licence="BSD-2-Clause",
            links=LINKS,
        )

    def load(self, system: System) -> None:
        """Build a `pinocchio.Model` of one joint. Raises UnsupportedError for several bodies."""
        if len(system.bodies) != 1:
            raise UnsupportedError(f"pinocchio takes one body here, not {len(system.bodies)}.")
        self._joint = PinocchioJoint(self._engine, system)

    def model(self) -> tuple[Body, ...]:
        """The inertia of the joint, read back."""
        return (self._loaded().body(),)

    def set_state(self, state: State) -> None:
        """Keep the state as joint position and velocity."""
        self._loaded().set_state(state)

    def get_state(self) -> State:
        """The state by Pinocchio's own forward kinematics of the joint coordinates."""
        return self._loaded().get_state()

    def forward_dynamics(self, states: State) -> Acceleration:
        """`pinocchio.aba` at each state; the leading axes of the answer are those of the states."""
        joint = self._loaded()
        q, v = joint.coordinates(states)
        lanes = np.broadcast_shapes(q.shape[:-1], v.shape[:-1])
        q, v = (np.broadcast_to(x, (*lanes, x.shape[-1])).reshape(-1, x.shape[-1]) for x in (q, v))
        answers = np.array([joint.forward(*row) for row in zip(q, v, strict=True)])
        return Acceleration(*(answers[:, k].reshape(*lanes, 3) for k in range(2)))

    def inverse_dynamics(self, states: State, acceleration: Acceleration) -> Array:
        """`pinocchio.rnea` at n states."""
        joint, rows = self._loaded(), _rows(states)
        torque = np.empty_like(rows.angular_velocity)
        for n in range(len(torque)):
            wanted = (acceleration.angular[n], acceleration.linear[n])
            torque[n] = joint.inverse(_row(rows, n), *wanted)
        return torque

    def run(
        self, initial: State, integrator: str, timestep: float, steps: int, every: int
    ) -> Trajectory:
        """Step a scheme of the reference over `aba`. Raises UnsupportedError for other names."""
        name = integrator.removeprefix(PREFIX)
        if name not in LOOPED or not integrator.startswith(PREFIX):
            raise UnsupportedError(f"pinocchio has no integrator {integrator!r}.")
        scheme = SCHEMES[name]
        joint = self._loaded()
        start = joint.coordinates(initial)
        found = step_through(scheme, joint.motion, *start, timestep, steps, every)
        return Trajectory(found.time, joint.states(found.q, found.v), found.seconds)

    def native(self) -> dict[str, dict[str, str]]:
        """Conventions as measured of the engine itself, and its defaults."""
        from omegadot.adapters.pinocchio.native import native

        return native(self._engine)

    def _loaded(self) -> PinocchioJoint:
        if self._joint is None:
            raise RuntimeError("no system is loaded: call load() first")
        return self._joint


def _row(rows: State, n: int) -> State:
    return State(
        rows.orientation[n], rows.angular_velocity[n], rows.position[n], rows.linear_velocity[n]
    )
