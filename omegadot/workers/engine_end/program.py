"""The program that serves an engine: it is started, asked, and its end is this worker's.

It ends with this worker, and this worker ends as the program did.
"""

from __future__ import annotations

import ctypes
import os
import signal
import subprocess
import sys
from collections.abc import Callable
from typing import Any, NoReturn

from omegadot.adapters.command_line import program_of
from omegadot.adapters.protocol import UnsupportedError
from omegadot.adapters.registry import AdapterError
from omegadot.workers.engine_end.checked import AnswerError
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


class Program:
    """A program that answers one request after another.

    command: as it is typed, ``node worker.js``.  waiting: takes what is wrong if the first
    request is never answered, once it has been written.
    """

    def __init__(self, command: str, waiting: Callable[[str], object]) -> None:
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
        self._last = ""
        self._known: set[str] = set()

    def ask(self, operation: str, **request: Any) -> Any:
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
            if isinstance(error, NoFrameError) and self._last:
                before = (
                    f"; or the answer before it, to {self._last}, wrote more than its shapes say"
                )
            raise ProgramLostError(
                f"the answer to {operation} is no frame: {error}{before}"
            ) from error
        self._last = operation
        self._check_surplus()
        return self._result(operation, answer)

    def _exchange(self, request: dict[str, Any]) -> Any:
        requests = self._process.stdin
        assert requests is not None
        requests.write(encode_frame(request))
        requests.flush()
        if not self._last:
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
        surplus = self._output.surplus() if self._last else b""
        if surplus:
            self._process.kill()
            raise ProgramLostError(
                f"the answer to {self._last} goes on with {surplus[:16]!r} after its end: "
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
