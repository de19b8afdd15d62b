"""An engine in any language: an adapter that passes every call to a program, as frames.

docs/worker-protocol.md specifies the frames and operations. The program does only what its engine
does: answers are checked, runs timed and memory limited by the Python worker that starts it, as for
any adapter.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import Any

from omegadot.adapters.body_files import mjcf_of, origin_at_pivot, urdf_of
from omegadot.adapters.protocol import Description, Setup, Trajectory
from omegadot.reference_impl.system import Acceleration, Array, Body, State, System
from omegadot.workers.engine_end.byte_order import is_big_endian
from omegadot.workers.engine_end.checked import AnswerError, checked_seconds
from omegadot.workers.engine_end.program import Program
from omegadot.workers.engine_end.program_answers import (
    arrays_in,
    description_in,
    native_in,
    torque_in,
    trajectory_in,
)


class CommandAdapter:
    """The engine that a program serves. command, waiting: see `Program`."""

    def __init__(
        self, command: str, setup: Setup = "physics", waiting: Callable[[str], object] = str
    ) -> None:
        self._program = Program(command, waiting)
        self._given: State | None = None
        self._big_endian = False
        self._description = description_in("describe", self._program.ask("describe", setup=setup))

    @property
    def description(self) -> Description:
        """As the program gave it when it started, or for the system that was loaded last."""
        return self._description

    def load(self, system: System) -> None:
        """Have the engine's own model of the system built."""
        self._load("load", system)

    def load_file(self, system: System, way: str) -> None:
        """Have the engine read the body from the text of a file of this format."""
        text = mjcf_of(system) if way == "mjcf" else urdf_of(system, origin_at_pivot(system))
        self._load("load_file", system, format=way, text=text)

    def _load(self, operation: str, system: System, **request: Any) -> None:
        found = self._program.ask(operation, body=system.body, load=system.load, **request)
        self._system = system
        if found is not None:
            self._description = description_in(operation, found)

    def _check_order(self, operation: str, found: Body | State, given: Body | State) -> None:
        """Raise AnswerError where arrays are big-endian, in this answer or in one before it."""
        self._big_endian = self._big_endian or is_big_endian(found, given)
        self._refuse_big_endian(operation)

    def _refuse_big_endian(self, operation: str) -> None:
        if self._big_endian:
            raise AnswerError(
                f"the arrays of the answer to {operation} are big-endian; read and write them "
                "little-endian"
            )

    def model(self) -> tuple[Body, ...]:
        """Mass, centre of mass and inertia as the engine holds them."""
        found = arrays_in("the answer to model", self._program.ask("model"), Body)
        self._check_order("model", found, self._system.body)
        return (found,)

    def set_state(self, state: State) -> None:
        """Put the engine in a state."""
        self._program.ask("set_state", state=state)
        self._given = state

    def get_state(self) -> State:
        """The engine's present state."""
        given, found = self._given, self._program.ask("get_state")
        lead = given.angular_velocity.shape[:-1] if given else ()
        state = arrays_in("the answer to get_state", found, State, lead)
        if given:
            self._check_order("get_state", state, given)
        return state

    def forward_dynamics(self, states: State) -> Acceleration:
        """Omega-dot and the centre of mass's acceleration at n states."""
        found = self._program.ask("forward", states=states)
        self._refuse_big_endian("forward")
        lead = states.angular_velocity.shape[:-1]
        return arrays_in("the answer to forward", found, Acceleration, lead)

    def inverse_dynamics(self, states: State, acceleration: Acceleration) -> Array:
        """The torque (n, 3) that gives n states this acceleration."""
        found = self._program.ask("inverse", states=states, acceleration=acceleration)
        self._refuse_big_endian("inverse")
        return torque_in(found, states.angular_velocity.shape[:-1])

    def run(
        self,
        initial: State,
        integrator: str,
        timestep: float,
        steps: int,
        every: int,
        accuracy: float | None = None,
    ) -> Trajectory:
        """Step from `initial`, logging as `Adapter.run` specifies."""
        how = {"integrator": integrator, "timestep": timestep, "steps": steps, "every": every}
        started = time.perf_counter()
        found = trajectory_in(self._program.ask("run", initial=initial, **how, accuracy=accuracy))
        whole = time.perf_counter() - started
        checked_seconds(found.seconds, whole, "the answer to run: seconds")
        self._check_order("run", found.state[0], initial)
        return found

    def native(self) -> Any:
        """The engine's own conventions and defaults."""
        return native_in(self._program.ask("native"))
