"""The harness's side of one worker: start it, send requests, and report how it ended."""

from __future__ import annotations

import contextlib
import os
import queue
import signal
import subprocess
import sys
import time
import uuid
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from typing import Any

import psutil

from omegadot.workers.engine_end.memory import MEMORY_VARIABLE
from omegadot.workers.harness_end.answers import FrameError, answer_in
from omegadot.workers.harness_end.family import GUARD, marked
from omegadot.workers.harness_end.pipes import Lost, Pipes
from omegadot.workers.machine import memory_of_machine
from omegadot.workers.wire import one_line
from omegadot.written import written

SECONDS_TO_LEAVE = 2.0
# Importing an engine takes its time, however short the limit of a request.
SECONDS_TO_START = 20.0
# On Linux a worker ends with the thread that started it: this one ends with the harness.
_starter = ThreadPoolExecutor(1, "start")


@dataclass(frozen=True)
class Answer:
    """What came back: an outcome of the contract, its reason, the result and the time it took."""

    outcome: str
    reason: str = ""
    result: Any = None
    seconds: float = 0.0

    @property
    def ok(self) -> bool:
        """Whether there is a result."""
        return self.outcome == "ok"


def _worker_environment(memory: int | None) -> dict[str, str]:
    # One thread an engine: the workers run side by side, and timings must not share cores.
    single = {"OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1", "MKL_NUM_THREADS": "1"}
    limit = {MEMORY_VARIABLE: str(memory)} if memory else {}
    # A json.py or mujoco.py of the current folder must not stand in for the real one.
    safe = {"PYTHONSAFEPATH": "1", "PYTHONUNBUFFERED": "1"}
    return {**os.environ, **single, **safe, **limit}


class WorkerProcess:
    """One engine's process. It is started when first requested and again after it dies.

    timeout: s, for one request; a start may take 20 s where that is longer.  memory: bytes of data
    that it may hold; half of the machine's where none is given, and no limit where that is not
    known.  via: the format of the files by which systems are loaded; "" for the engine's API.
    """

    def __init__(
        self,
        target: str,
        setup: str,
        timeout: float,
        command: Sequence[str] | None = None,
        memory: int | None = None,
        via: str = "",
    ) -> None:
        python = [sys.executable, "-m", "omegadot.workers.engine_end.worker"]
        self._command = [*(command or python), target, setup, via]
        self._timeout = timeout
        self._memory = memory or memory_of_machine() // 2
        self._pipes: Pipes | None = None
        self.deaths: list[str] = []

    @property
    def pid(self) -> int | None:
        """The process's number while it lives."""
        pipes = self._pipes
        return pipes.process.pid if pipes else None

    @property
    def started(self) -> bool:
        """Whether there is a process; one that died since then is found at the next request."""
        return self._pipes is not None

    def start(self) -> Answer:
        """Start the process; the result is the engine's description."""
        self.stop()
        mark = uuid.uuid4().hex
        try:
            process = _starter.submit(self._opened, mark).result()
        except OSError as error:
            return Answer("crashed", f"the worker could not be started: {error}")
        self._pipes = pipes = Pipes(process, mark)
        seconds = max(self._timeout, SECONDS_TO_START)
        late = f"not started within {written(seconds)} s"
        answer = self._wait(pipes, seconds, late, "start", {})
        if not answer.ok:
            self.stop()
        return answer

    def _opened(self, mark: str) -> subprocess.Popen[bytes]:
        GUARD.begin()
        process = subprocess.Popen(
            self._command,
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            env=marked(marked(_worker_environment(self._memory), GUARD.mark), mark),
            start_new_session=True,  # Ctrl-C is the harness's to handle
        )
        GUARD.watch(process.pid)
        return process

    def request(self, operation: str, **fields: Any) -> Answer:
        """Put one request and wait for its answer, a death, or the time limit."""
        pipes = self._pipes
        if pipes is None:
            return Answer("crashed", "the worker is not running")
        pipes.send({"operation": operation, **fields})
        late = f"no answer within {written(self._timeout)} s"
        return self._wait(pipes, self._timeout, late, operation, fields)

    def peak_memory(self) -> int | None:
        """Bytes that the living process has held in memory at most; None where it is not known."""
        answer = self.request("memory")
        if answer.ok and answer.result is None and self.pid is not None:
            # Windows keeps it for others to read.
            return getattr(psutil.Process(self.pid).memory_info(), "peak_wset", None)
        return answer.result if answer.ok else None

    def _wait(
        self, pipes: Pipes, seconds: float, late: str, operation: str, fields: dict[str, Any]
    ) -> Answer:
        end, note = time.monotonic() + seconds, ""
        try:
            answer = pipes.answers.get(timeout=seconds)
            if operation == "start" and (note := _waited_for(answer)):
                answer = pipes.answers.get(timeout=max(0.0, end - time.monotonic()))
        except queue.Empty:
            self.stop()
            return Answer("timeout", f"{late}; the worker was ended{note}")
        if isinstance(answer, Lost):
            return Answer("crashed", self._post_mortem(pipes, answer.how))
        try:
            answer = answer_in(answer, operation, fields)
        except FrameError as error:
            how = f"what it answers is no answer: {one_line(str(error), 100)}"
            return Answer("crashed", self._post_mortem(pipes, how))
        if answer.pop("leaves", False):
            self.stop()
            if answer["outcome"] == "crashed":
                answer["reason"] = _with_output(answer["reason"], pipes)
                self.deaths.append(answer["reason"])
        return Answer(**{**answer, "reason": one_line(answer.get("reason", ""))})

    def _post_mortem(self, pipes: Pipes, how: str) -> str:
        """State how a worker came to give no more answers. how: why it is ended, if it lives."""
        if how:
            pipes.end()
            how += "; the worker was ended"
        else:
            how = _ending(pipes.process.wait())
        self._pipes = None
        found = _with_output(how, pipes)
        if not pipes.ended_here:
            self.deaths.append(found)
        return found

    def finish(self) -> None:
        """Let an idle worker leave by itself, so that it may tidy up; end it if it does not."""
        pipes = self._pipes
        if pipes is None:
            return
        if pipes.process.poll() is not None:  # it died between requests
            self._post_mortem(pipes, "")
            return
        pipes.close_requests()
        with contextlib.suppress(subprocess.TimeoutExpired):
            pipes.process.wait(timeout=SECONDS_TO_LEAVE)
        self.stop()

    def stop(self) -> None:
        """End the process and everything it started, at once."""
        pipes, self._pipes = self._pipes, None
        if pipes is not None:
            pipes.ended_here = pipes.process.poll() is None
            pipes.end()


def _waited_for(frame: Any) -> str:
    """What a worker tells before its program has answered; "" of any other frame."""
    if isinstance(frame, dict) and frame.get("outcome") == "waiting":
        return f"; {one_line(str(frame.get('reason')))}"
    return ""


def _with_output(how: str, pipes: Pipes) -> str:
    """How a process ended, with what it wrote last."""
    text = pipes.last_output()
    return f"{how}; its last output: {text}" if text else how


def _ending(code: int) -> str:
    """A process's end as text, of its return code."""
    if code >= 0:
        return f"ended with exit code {code}"
    try:
        return f"ended by signal {-code} ({signal.Signals(-code).name})"
    except ValueError:  # the real-time signals have no names
        return f"ended by signal {-code}"
