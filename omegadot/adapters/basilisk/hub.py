"""States of a Basilisk spacecraft in the project's frames, and its dynamics."""

from __future__ import annotations

from typing import Any

import numpy as np

from omegadot.adapters.basilisk.attitude import of_quaternion, quaternion_of
from omegadot.adapters.basilisk.model import BasiliskModel
from omegadot.reference_impl.cross_product import cross
from omegadot.reference_impl.kinematics import at_point
from omegadot.reference_impl.rotations import rotate
from omegadot.reference_impl.system import Array, Body, State

STATES = ("hubSigma", "hubOmega", "hubPosition", "hubVelocity")


def place(model: BasiliskModel, state: State) -> None:
    """Let the model begin in the state."""
    model.begin(
        of_quaternion(state.orientation),
        np.array(state.angular_velocity, float),
        np.array(state.position, float),
        np.array(state.linear_velocity, float),
    )


def row_of(model: BasiliskModel, state: State) -> Array:
    """sigma, omega, position and velocity of the origin, (12,)."""
    origin = at_point(state, -model.center)
    sigma, omega = of_quaternion(state.orientation), state.angular_velocity
    return np.concatenate((sigma, omega, origin.position, origin.linear_velocity))


def states(model: BasiliskModel, rows: Array) -> State:
    """The states of such rows, (n, 12)."""
    sigma, omega, position, velocity = np.split(rows, 4, axis=-1)
    return at_point(State(quaternion_of(sigma), omega, position, velocity), model.center)


class BasiliskHub:
    """The hub of a model: Basilisk's own kinematics and equations of motion."""

    def __init__(self, model: BasiliskModel) -> None:
        self.model, self._craft = model, model.craft
        model.reset()
        manager = self._craft.dynManager
        _, self._omega, _, self._velocity = (manager.getStateObject(name) for name in STATES)

    def body(self) -> Body:
        """Mass, centre of mass and inertia, read back."""
        return self.model.read_back()

    def set_state(self, state: State) -> None:
        """Put the hub in the state."""
        place(self.model, state)
        self.model.reset()

    def get_state(self) -> State:
        """The state of the spacecraft's message, with its centre of mass."""
        self._craft.writeOutputStateMessages(0)
        found: Any = self._craft.scStateOutMsg.read()
        return State(
            quaternion_of(np.array(found.sigma_BN)),
            np.array(found.omega_BN_B),
            np.array(found.r_CN_N),
            np.array(found.v_CN_N),
        )

    def forward(self, state: State) -> tuple[Array, Array]:
        """omega-dot (3,), body, and the acceleration of the centre of mass (3,), world.

        By `Spacecraft.equationsOfMotion`, of which an integrator takes the derivatives of the hub's
        states. That of the velocity is the origin's: ``a + R (omega-dot x c + omega x (omega x
        c))`` is the centre of mass's.
        """
        self.set_state(state)
        self._craft.equationsOfMotion(0.0, 1.0)
        angular = np.array(self._omega.getStateDeriv())[:, 0]
        linear = np.array(self._velocity.getStateDeriv())[:, 0]
        c, w = self.model.center, state.angular_velocity
        lifted = cross(angular, c) + cross(w, cross(w, c))
        return angular, linear + rotate(state.orientation, lifted)
