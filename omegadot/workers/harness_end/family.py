"""A worker's family, the process and all that it started: it is ended as one.

On Linux a worker has a keeper, which ends all that is below it (`engine_end.keeper`). Elsewhere,
and where somebody has ended the keeper, a child may have left the worker's group for a session of
its own. It is found by a mark in the environment that it has inherited. Each worker has a mark, and
its harness has one that all bear.

A worker dies with its harness by itself (`engine_end.worker`), its children do not. So this file is
also a program, the guard: one beside each harness. It waits until the harness is gone, however that
ended, SIGKILL included, and kills what its workers left.
"""

from __future__ import annotations

import atexit
import contextlib
import os
import signal
import subprocess
import sys
import uuid
from collections.abc import Iterable

import psutil

VARIABLE = "OMEGADOT_WORKER_MARKS"
# A family that starts new members while it is ended is searched again, so many times.
MOST_SEARCHES = 8
SECONDS_TO_END = 2.0


def marked(environment: dict[str, str], mark: str) -> dict[str, str]:
    """The environment with one more mark; a worker's own workers bear both."""
    return {**environment, VARIABLE: f"{environment.get(VARIABLE, '')}:{mark}"}


def ask_to_end(worker: subprocess.Popen[bytes]) -> None:
    """Have a keeper end all that is below it, and wait for that, a moment at most."""
    if sys.platform == "linux" and worker.poll() is None:
        with contextlib.suppress(OSError, subprocess.TimeoutExpired):
            worker.terminate()
            worker.wait(SECONDS_TO_END)


def end_family(leader: int, mark: str) -> None:
    """Kill the process group of a worker, and every process of this user that bears the mark."""
    _end_group(leader)
    _end_marked(mark)


def _end_group(leader: int) -> None:
    with contextlib.suppress(OSError):
        if psutil.POSIX:
            os.killpg(leader, signal.SIGKILL)
        else:
            os.kill(leader, signal.SIGTERM)  # Windows ends the process alone, at once


def _end_marked(mark: str) -> None:
    for _ in range(MOST_SEARCHES):
        if not _kill_marked(mark):
            return


def _kill_marked(mark: str) -> int:
    """How many were killed; psutil kills none that has taken over the number of another."""
    killed = 0
    for process in psutil.process_iter():
        with contextlib.suppress(psutil.Error, OSError):  # it has ended, or is another user's
            if mark in process.environ().get(VARIABLE, ""):
                process.kill()
                killed += 1
    return killed


class Guard:
    """The harness's side of its guard, which is started before the first worker."""

    def __init__(self) -> None:
        self.mark = uuid.uuid4().hex
        self._process: subprocess.Popen[bytes] | None = None

    def begin(self) -> None:
        """Start it, if that is still to be done. Raises OSError."""
        if self._process is None:
            self._process = subprocess.Popen(
                [sys.executable, __file__, self.mark],
                stdin=subprocess.PIPE,
                stdout=subprocess.DEVNULL,
                stderr=subprocess.DEVNULL,
                env={**os.environ, "PYTHONSAFEPATH": "1"},
                start_new_session=True,
            )
            atexit.register(self._dismiss, self._process)

    def watch(self, leader: int) -> None:
        """Have a worker's group ended with the harness."""
        self._write(leader)

    def forget(self, leader: int) -> None:
        """A worker has ended, and its number may be another's soon."""
        self._write(-leader)

    def _write(self, number: int) -> None:
        stream = self._process.stdin if self._process else None
        with contextlib.suppress(OSError, ValueError):  # somebody has ended the guard
            if stream is not None:
                stream.write(b"%d\n" % number)
                stream.flush()

    @staticmethod
    def _dismiss(process: subprocess.Popen[bytes]) -> None:
        """The harness ends as it should, and has ended its workers."""
        process.kill()
        process.wait()


GUARD = Guard()


def _ask_to_end(leaders: Iterable[int]) -> None:
    """The same of several, which are not this process's own."""
    ending = []
    for leader in leaders if sys.platform == "linux" else ():
        with contextlib.suppress(psutil.Error, OSError):
            keeper = psutil.Process(leader)
            keeper.terminate()
            ending.append(keeper)
    psutil.wait_procs(ending, SECONDS_TO_END)


def guard(mark: str) -> None:
    """Read the numbers of workers, negative once they are ended, until the harness is gone."""
    leaders = set()
    for line in sys.stdin:
        number = int(line)
        if number > 0:
            leaders.add(number)
        else:
            leaders.discard(-number)
    _ask_to_end(leaders)
    for leader in leaders:
        _end_group(leader)
    _end_marked(mark)


if __name__ == "__main__":
    guard(sys.argv[1])
