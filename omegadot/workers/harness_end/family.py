"""A worker and whatever it started: all of it is ended with it, even what left its process group.

A child that has made itself a session of its own is out of the group's reach; it is found by a
mark in the environment that it has inherited.
"""

from __future__ import annotations

import contextlib
import os
import signal
import subprocess

import psutil

VARIABLE = "OMEGADOT_WORKER_MARKS"
# A family that starts new members while it is ended is searched again, so many times.
MOST_SEARCHES = 8


def marked(environment: dict[str, str], mark: str) -> dict[str, str]:
    """The environment with one more mark; a worker's own workers bear both."""
    return {**environment, VARIABLE: f"{environment.get(VARIABLE, '')}:{mark}"}


def end_family(process: subprocess.Popen[bytes], mark: str) -> None:
    """Kill the process, its group, and every process of this user that bears the mark."""
    with contextlib.suppress(OSError):
        if psutil.POSIX:
            os.killpg(process.pid, signal.SIGKILL)
        else:
            process.kill()
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
