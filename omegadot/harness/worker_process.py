"""The harness's side of one worker: start it, ask it, and say how it died."""

from __future__ import annotations

import contextlib
import os
import queue
import signal
import subprocess
import sys
import threading
from collections import deque
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from omegadot.adapters.wire import read_frame, write_frame

STDERR_BYTES_KEPT = 4000
SECONDS_TO_LEAVE = 2.0
FAILED_TO_ANSWER = {"crashed", "timeout"}


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


def _worker_environment() -> dict[str, str]:
    # One thread an engine: the workers run side by side, and timings must not share cores.
    single = {"OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1", "MKL_NUM_THREADS": "1"}
    return {**os.environ, **single, "PYTHONUNBUFFERED": "1"}


class WorkerProcess:
    """One engine's process. It is started when first asked and again after it dies."""

    def __init__(
        self, target: str, setup: str, timeout: float, command: Sequence[str] | None = None
    ) -> None:
        python = [sys.executable, "-m", "omegadot.adapters.worker"]
        self._command = [*(command or python), target, setup]
        self._timeout = timeout
        self._process: subprocess.Popen[bytes] | None = None
        self._answers: queue.Queue[dict[str, Any] | None] = queue.Queue()
        self._stderr: deque[bytes] = deque()
        self._drain: threading.Thread | None = None
        self.deaths: list[str] = []

    @property
    def pid(self) -> int | None:
        """The process's number while it lives."""
        return self._process.pid if self._process else None

    @property
    def started(self) -> bool:
        """Whether there is a process to ask; one that died since then will be found out there."""
        return self._process is not None

    def start(self) -> Answer:
        """Start the process; the result is the engine's description."""
        self.stop()
        self._answers, self._stderr = queue.Queue(), deque()
        try:
            self._process = subprocess.Popen(
                self._command,
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                stderr=subprocess.PIPE,
                env=_worker_environment(),
                start_new_session=True,  # Ctrl-C is the harness's to handle
            )
        except OSError as error:
            return Answer("crashed", f"the worker could not be started: {error}")
        process, answers, stderr = self._process, self._answers, self._stderr
        threading.Thread(target=_collect, args=(process, answers), daemon=True).start()
        self._drain = threading.Thread(target=_keep_tail, args=(process, stderr), daemon=True)
        self._drain.start()
        answer = self._wait()
        if not answer.ok:
            self.stop()
        return answer

    def ask(self, operation: str, **fields: Any) -> Answer:
        """Put one request and wait for its answer, a death, or the time limit."""
        if self._process is None:
            return Answer("crashed", "the worker is not running")
        assert self._process.stdin is not None
        # A dead worker shows as a broken pipe here and as an end of answers in _wait.
        with contextlib.suppress(OSError):
            write_frame(self._process.stdin, {"operation": operation, **fields})  # type: ignore[arg-type]
        return self._wait()

    def _wait(self) -> Answer:
        try:
            answer = self._answers.get(timeout=self._timeout)
        except queue.Empty:
            self.stop()
            return Answer("timeout", f"no answer within {self._timeout:g} s; the worker was ended")
        if answer is None:
            return Answer("crashed", self._post_mortem())
        return Answer(
            answer["outcome"],
            answer.get("reason", ""),
            answer.get("result"),
            answer.get("seconds", 0.0),
        )

    def _post_mortem(self) -> str:
        assert self._process is not None
        code = self._process.wait()
        if self._drain is not None:
            self._drain.join(timeout=1.0)
        if code < 0:
            how = f"ended by signal {-code} ({signal.Signals(-code).name})"
        else:
            how = f"ended with exit code {code}"
        lines = b"".join(self._stderr).decode(errors="replace").strip().splitlines()[-3:]
        said = " | ".join(" ".join(line.split()) for line in lines)[:400]
        self._process = None
        found = f"{how}; its last words: {said}" if said else how
        self.deaths.append(found)
        return found

    def finish(self) -> None:
        """Let an idle worker leave by itself, so that it may tidy up; end it if it does not."""
        if self._process is None:
            return
        if self._process.poll() is not None:  # it died while nobody asked it anything
            self._post_mortem()
            return
        assert self._process.stdin is not None
        with contextlib.suppress(OSError, subprocess.TimeoutExpired):
            self._process.stdin.close()
            self._process.wait(timeout=SECONDS_TO_LEAVE)
        self.stop()

    def stop(self) -> None:
        """End the process and everything it started, at once."""
        if self._process is None:
            return
        with contextlib.suppress(ProcessLookupError, PermissionError):
            os.killpg(self._process.pid, signal.SIGKILL)
        self._process.wait()
        self._process = None


def _collect(process: subprocess.Popen[bytes], answers: queue.Queue[dict[str, Any] | None]) -> None:
    """Move answers from the pipe to the queue; None says that there will be no more."""
    assert process.stdout is not None
    while True:
        try:
            answers.put(read_frame(process.stdout))  # type: ignore[arg-type]
        except (EOFError, OSError, ValueError):
            answers.put(None)
            return


def _keep_tail(process: subprocess.Popen[bytes], tail: deque[bytes]) -> None:
    """Keep the last lines of standard error and drop the rest, however much comes."""
    assert process.stderr is not None
    kept = 0
    with contextlib.suppress(OSError, ValueError):
        while chunk := process.stderr.read1(STDERR_BYTES_KEPT):  # type: ignore[attr-defined]
            tail.append(chunk)
            kept += len(chunk)
            while len(tail) > 1 and kept - len(tail[0]) >= STDERR_BYTES_KEPT:
                kept -= len(tail.popleft())
