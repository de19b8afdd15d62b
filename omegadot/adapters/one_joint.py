"""What adapters share whose engine holds its one body on one joint: calls that go to the joint."""

from __future__ import annotations

from importlib import import_module
from types import ModuleType
from typing import Any, Literal

import numpy as np

from omegadot.adapters.protocol import Format, UnsupportedError
from omegadot.reference_impl.system import Acceleration, Array, Body, State, System


class OneJointAdapter:
    """The part of an adapter that its joint answers.

    A joint has body, set_state and get_state, forward: omega-dot and the centre of mass's
    acceleration (3,) at a state, and inverse: the torque (3,) there.
    """

    name: str
    _engine: ModuleType
    _joint: Any = None

    def load(self, system: System) -> None:
        """Build the engine's own model. Raises UnsupportedError for several bodies."""
        self._take(system, "")

    def load_file(self, system: System, via: Format) -> None:
        """The same with a model that the engine reads from a file of this format."""
        self._take(system, via)

    def _take(self, system: System, via: Format | Literal[""]) -> None:
        if len(system.bodies) != 1:
            raise UnsupportedError(f"{self.name} takes one body here, not {len(system.bodies)}.")
        self._joint = self._built(system, via)

    def _built(self, system: System, via: Format | Literal[""]) -> Any:
        """The joint of a model. via: the format of the file by which the body goes in, if any."""
        raise NotImplementedError

    def _loaded(self) -> Any:
        if self._joint is None:
            raise RuntimeError("no system is loaded: call load() first")
        return self._joint

    def model(self) -> tuple[Body, ...]:
        """The body's inertia, read back."""
        return (self._loaded().body(),)

    def set_state(self, state: State) -> None:
        """Put the joint in the state."""
        self._loaded().set_state(state)

    def get_state(self) -> State:
        """The state by the engine's own kinematics, in the project's frames."""
        found: State = self._loaded().get_state()
        return found

    def native(self) -> dict[str, dict[str, str]]:
        """Conventions as measured of the engine itself, and its defaults."""
        native = import_module(f"omegadot.adapters.{self.name}.native")
        conventions, defaults = native.conventions(self._engine), native.defaults(self._engine)
        return {"conventions": conventions, "defaults": defaults}

    def forward_dynamics(self, states: State) -> Acceleration:
        """The engine's own forward dynamics at n states."""
        joint, count = self._loaded(), len(states.angular_velocity)
        answers = np.array([joint.forward(states[n]) for n in range(count)])
        return Acceleration(answers[:, 0], answers[:, 1])

    def inverse_dynamics(self, states: State, acceleration: Acceleration) -> Array:
        """The engine's own inverse dynamics at n states."""
        joint = self._loaded()
        torque = np.empty(states.angular_velocity.shape)
        for n in range(len(torque)):
            state = states[n]
            wanted = Acceleration(acceleration.angular[n], acceleration.linear[n])
            torque[n] = joint.inverse(state, wanted)
        return torque
