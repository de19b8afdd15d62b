"""An engine in any language: an adapter that passes every call to a program, as frames.

docs/worker-protocol.md specifies the frames and operations. The program does only what its engine
does: answers are checked, runs timed and memory limited by the Python worker that starts it, as for
any adapter. The program ends with this worker, and this worker ends as the program did.
"""

from __future__ import annotations

import ctypes
import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from typing import Any, NoReturn

from omegadot.adapters.body_files import mjcf_of, origin_at_pivot, urdf_of
from omegadot.adapters.command_line import program_of
from omegadot.adapters.protocol import Description, Setup, Trajectory, UnsupportedError
from omegadot.adapters.registry import AdapterError
from omegadot.reference_impl.system import Acceleration, Array, Body, State, System
from omegadot.workers.engine_end.byte_order import check_byte_order
from omegadot.workers.engine_end.checked import AnswerError, checked_seconds
from omegadot.workers.engine_end.program_answers import (
    arrays_in,
    description_in,
    native_in,
    torque_in,
    trajectory_in,
)
from omegadot.workers.engine_end.program_output import SECONDS_TO_GO_ON, ProgramOutput
from omegadot.workers.frame_reader import NoFrameError, read_frame
from omegadot.workers.wire import encode_frame, one_line
from omegadot.written import written

PR_SET_PDEATHSIG = 1  # linux/prctl.h
NOT_FLUSHED = (
    "no byte of an answer to describe had come; is standard output flushed after each answer?"
)


class ProgramError(Exception):
    """What the program itself reports as an error."""


class ProgramLostError(Exception):
    """The program has written what is no answer: where the next one begins is not known."""


def end_with_parent() -> bool:
    """Have the system kill this process when its parent ends; whether the system can."""
    if sys.platform == "linux":
        ctypes.CDLL(None).prctl(PR_SET_PDEATHSIG, signal.SIGKILL)
    return sys.platform == "linux"


class CommandAdapter:
    """The engine that a program serves.

    command: as it is typed, ``node worker.js``.  waiting: is told what is wrong if `describe` is
    never answered, once it has been requested.
    """

    def __init__(
        self, command: str, setup: Setup = "physics", waiting: Callable[[str], object] = str
    ) -> None:
        try:
            self._process = subprocess.Popen(
                program_of(command),
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                preexec_fn=end_with_parent if os.name == "posix" else None,
            )
        except OSError as error:
            raise AdapterError(f"{command}: it cannot be started, {error.strerror}.") from None
        assert self._process.stdout is not None
        self._output, self._waiting = ProgramOutput(self._process.stdout), waiting
        self._answered: list[str] = []
        self._known: set[str] = set()
        self._given: State | None = None
        self._description = description_in("describe", self._ask("describe", setup=setup))

    def _ask(self, operation: str, **request: Any) -> Any:
        """What the program answers.

        Raises UnsupportedError and ProgramError where it reports one, ProgramLostError where it
        writes what is no answer or leaves as if all was well; where it ends otherwise, this
        process ends as well.
        """
        self._check_surplus()
        try:
            answer = self._exchange({"operation": operation, **request})
        except (EOFError, OSError) as error:
            self._leave(operation, str(error) if isinstance(error, EOFError) else "")
        except Exception as error:  # what is no frame can fail to be read in many ways
            self._process.kill()
            before = ""
            if isinstance(error, NoFrameError) and self._answered:
                before = (
                    f"; or the answer before it, to {self._answered[-1]}, wrote more than its "
                    "shapes say"
                )
            raise ProgramLostError(
                f"the answer to {operation} is no frame: {error}{before}"
            ) from error
        self._answered = [operation]
        self._check_surplus()
        return self._result(operation, answer)

    def _exchange(self, request: dict[str, Any]) -> Any:
        requests = self._process.stdin
        assert requests is not None
        requests.write(encode_frame(request))
        requests.flush()
        if not self._answered:
            self._waiting(NOT_FLUSHED)
        self._output.expect_answer()
        return read_frame(self._output)

    def _result(self, operation: str, answer: Any) -> Any:
        """What an answer holds. Raises UnsupportedError, ProgramError and AnswerError."""
        if not isinstance(answer, dict):
            raise AnswerError(f"{operation}: the answer has no outcome; give an object with one")
        outcome, reason = answer.get("outcome"), one_line(str(answer.get("reason") or ""))
        if outcome == "ok":
            self._known.add(operation)
            return answer.get("result")
        if outcome == "unsupported":
            lacking = "reason" not in answer and operation not in self._known
            refuses = f"the program refuses {operation} and gives no reason"
            no_reason = f"the program has no operation {operation}" if lacking else refuses
            raise UnsupportedError(reason or no_reason)
        if outcome == "raised":
            raise ProgramError(reason or f"{operation} raised an error, with no reason given")
        raise AnswerError(
            f"{operation}: the outcome is {outcome!r}; give ok, unsupported or raised"
        )

    def _check_surplus(self) -> None:
        """Raise ProgramLostError where more has come than the last answer was to have."""
        surplus = self._output.surplus() if self._answered else b""
        if surplus:
            self._process.kill()
            raise ProgramLostError(
                f"the answer to {self._answered[-1]} goes on with {surplus[:16]!r} after its end: "
                "it has more bytes than its shapes say, or text, which belongs on standard error"
            )

    def _leave(self, operation: str, part: str) -> NoReturn:
        """End as the program has, by the same signal or exit code.

        part: of an answer that has begun, what came of it. Raises ProgramLostError where the
        program lives, which is killed, and where it has left with the exit code 0.
        """
        when = (
            f"in its answer to {operation}: {part}" if part else f"before it answered {operation}"
        )
        if self._output.stalled:
            self._process.kill()
            raise ProgramLostError(
                f"the answer to {operation} broke off: {part}, and no more in "
                f"{written(SECONDS_TO_GO_ON)} s"
            )
        try:
            code = self._process.wait(1.0)
        except subprocess.TimeoutExpired:
            self._process.kill()
            raise ProgramLostError(
                f"the program closed its standard input or output {when}"
            ) from None
        if code == 0:
            raise ProgramLostError(f"the program left (exit code 0) {when}")
        if code < 0:
            signal.signal(-code, signal.SIG_DFL) if -code != signal.SIGKILL else None
            os.kill(os.getpid(), -code)
        os._exit(code)

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
        found = self._ask(operation, body=system.body, load=system.load, **request)
        self._system = system
        if found is not None:
            self._description = description_in(operation, found)

    def model(self) -> tuple[Body, ...]:
        """Mass, centre of mass and inertia as the engine holds them."""
        found = arrays_in("the answer to model", self._ask("model"), Body)
        check_byte_order("model", found, self._system.body)
        return (found,)

    def set_state(self, state: State) -> None:
        """Put the engine in a state."""
        self._ask("set_state", state=state)
        self._given = state

    def get_state(self) -> State:
        """The engine's present state."""
        given, found = self._given, self._ask("get_state")
        lead = given.angular_velocity.shape[:-1] if given else ()
        state = arrays_in("the answer to get_state", found, State, lead)
        if given:
            check_byte_order("get_state", state, given)
        return state

    def forward_dynamics(self, states: State) -> Acceleration:
        """Omega-dot and the centre of mass's acceleration at n states."""
        found = self._ask("forward", states=states)
        lead = states.angular_velocity.shape[:-1]
        return arrays_in("the answer to forward", found, Acceleration, lead)

    def inverse_dynamics(self, states: State, acceleration: Acceleration) -> Array:
        """The torque (n, 3) that gives n states this acceleration."""
        found = self._ask("inverse", states=states, acceleration=acceleration)
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
        found = trajectory_in(self._ask("run", initial=initial, **how, accuracy=accuracy))
        whole = time.perf_counter() - started
        checked_seconds(found.seconds, whole, "the answer to run: seconds")
        check_byte_order("run", found.state[0], initial)
        return found

    def native(self) -> Any:
        """The engine's own conventions and defaults."""
        return native_in(self._ask("native"))
