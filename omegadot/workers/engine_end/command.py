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
from collections.abc import Callable
from dataclasses import fields, replace
from typing import Any, BinaryIO, NoReturn, TypeVar, cast

import numpy as np

from omegadot.adapters.body_files import mjcf_of, origin_at_pivot, urdf_of
from omegadot.adapters.protocol import (
    Description,
    Integrator,
    Setup,
    Trajectory,
    UnsupportedError,
)
from omegadot.adapters.registry import AdapterError, program_of
from omegadot.reference_impl.system import Acceleration, Array, Body, State, System
from omegadot.workers.engine_end.checked import SHAPES, AnswerError
from omegadot.workers.wire import encode_frame, one_line, read_frame

PR_SET_PDEATHSIG = 1  # linux/prctl.h
T = TypeVar("T")


class ProgramError(Exception):
    """What the program itself reports as an error."""


class ProgramLostError(Exception):
    """The program has written what is no answer: where the next one begins is not known."""


def _fields_of(what: str, kind: Callable[..., T], found: Any) -> T:
    """A dataclass of an answer's keys. Raises AnswerError where one is missing or unknown."""
    if not isinstance(found, dict):
        raise AnswerError(f"{what} is no table of keys; answer with one")
    known = [field.name for field in fields(kind)]  # type: ignore[arg-type]
    for key in found:
        if key not in known:
            raise AnswerError(f"{what} has no key {key!r}; give {', '.join(known)}")
    if kind in SHAPES or kind is Trajectory:
        found = {key: _numbers(f"{what}: {key}", value) for key, value in found.items()}
    try:
        return kind(**found)
    except TypeError:
        missing = [key for key in known if key not in found]
        raise AnswerError(f"{what} lacks a key; it needs more of {', '.join(missing)}") from None


def _numbers(what: str, value: Any) -> Any:
    """Lists of numbers as an array; null in one stands for what is not finite."""
    if not isinstance(value, list):
        return value
    try:
        return np.array(value, dtype=float)
    except (TypeError, ValueError):
        raise AnswerError(f"{what} is no array of numbers; give rows of one length") from None


def _described(found: Any) -> Description:
    """The description of an answer, its lists as the protocol has them."""
    if isinstance(found, dict):
        given = found.get("integrators")
        if not isinstance(given, list):
            raise AnswerError("describe: integrators is no list; give one")
        found = {k: tuple(v) if isinstance(v, list) else v for k, v in found.items()}
        found["features"] = frozenset(found.get("features", ()))
        what = "an integrator of describe"
        found["integrators"] = tuple(_fields_of(what, Integrator, one) for one in given)
    return _fields_of("describe", Description, found)


def end_with_parent() -> bool:
    """Have the system kill this process when its parent ends; whether the system can."""
    if sys.platform == "linux":
        ctypes.CDLL(None).prctl(PR_SET_PDEATHSIG, signal.SIGKILL)
    return sys.platform == "linux"


class CommandAdapter:
    """The engine that a program serves. command: as it is typed, ``node worker.js``."""

    def __init__(self, command: str, setup: Setup = "physics") -> None:
        try:
            self._process = subprocess.Popen(
                program_of(command),
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                preexec_fn=end_with_parent if os.name == "posix" else None,
            )
        except OSError as error:
            raise AdapterError(f"{command}: it cannot be started, {error.strerror}.") from None
        self._description = _described(self._ask("describe", setup=setup))

    def _ask(self, operation: str, **request: Any) -> Any:
        """What the program answers.

        Raises UnsupportedError and ProgramError where it reports one, ProgramLostError where it
        writes what is no answer; where it ends, this process ends as well.
        """
        requests, answers = self._process.stdin, self._process.stdout
        assert requests is not None
        assert answers is not None
        try:
            requests.write(encode_frame({"operation": operation, **request}))
            requests.flush()
            answer = read_frame(cast(BinaryIO, answers))
        except (EOFError, OSError):
            self._leave()
        except Exception as error:  # what is no frame can fail to be read in many ways
            self._process.kill()
            raise ProgramLostError(f"the answer to {operation} is no frame: {error}") from error
        outcome, reason = answer.get("outcome"), one_line(str(answer.get("reason", "")))
        if outcome == "ok":
            return answer.get("result")
        if outcome == "unsupported":
            raise UnsupportedError(reason or f"the program has no operation {operation}")
        if outcome == "raised":
            raise ProgramError(reason)
        raise AnswerError(
            f"{operation}: the outcome is {outcome!r}; give ok, unsupported or raised"
        )

    def _leave(self) -> NoReturn:
        """End as the program has, by the same signal or exit code; one that lives is killed."""
        try:
            code = self._process.wait(1.0)
        except subprocess.TimeoutExpired:
            self._process.kill()
            code = 1
        if code < 0:
            signal.signal(-code, signal.SIG_DFL) if -code != signal.SIGKILL else None
            os.kill(os.getpid(), -code)
        os._exit(code or 1)

    @property
    def description(self) -> Description:
        """As the program gave it when it started, or for the system that was loaded last."""
        return self._description

    def _loaded(self, found: Any) -> None:
        self._description = _described(found) if found else self._description

    def load(self, system: System) -> None:
        """Have the engine's own model of the system built."""
        self._loaded(self._ask("load", body=system.body, load=system.load))

    def load_file(self, system: System, way: str) -> None:
        """Have the engine read the body from the text of a file of this format."""
        text = mjcf_of(system) if way == "mjcf" else urdf_of(system, origin_at_pivot(system))
        loads = {"body": system.body, "load": system.load}
        self._loaded(self._ask("load_file", format=way, text=text, **loads))

    def model(self) -> tuple[Body, ...]:
        """Mass, centre of mass and inertia as the engine holds them."""
        return (_fields_of("model", Body, self._ask("model")),)

    def set_state(self, state: State) -> None:
        """Put the engine in a state."""
        self._ask("set_state", state=state)

    def get_state(self) -> State:
        """The engine's present state."""
        return _fields_of("get_state", State, self._ask("get_state"))

    def forward_dynamics(self, states: State) -> Acceleration:
        """Omega-dot and the centre of mass's acceleration at n states."""
        return _fields_of("forward", Acceleration, self._ask("forward", states=states))

    def inverse_dynamics(self, states: State, acceleration: Acceleration) -> Array:
        """The torque (n, 3) that gives n states this acceleration."""
        found = self._ask("inverse", states=states, acceleration=acceleration)
        if not isinstance(found, dict) or "torque" not in found:
            raise AnswerError("inverse has no key 'torque'; give one")
        torque: Array = _numbers("inverse: torque", found["torque"])
        return torque

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
        found = self._ask("run", initial=initial, **how, accuracy=accuracy)
        trajectory = _fields_of("run", Trajectory, found)
        return replace(trajectory, state=_fields_of("run().state", State, trajectory.state))

    def native(self) -> Any:
        """The engine's own conventions and defaults."""
        return self._ask("native")
