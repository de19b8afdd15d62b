"""A worker and whatever it started: all of it is ended with it, even what left its process group.

The group is ended everywhere. A child that has made itself a session of its own is out of its
reach; on Linux it is found by a mark in the environment that it has inherited.
"""

from __future__ import annotations

import contextlib
import os
import signal
import subprocess
import sys
import uuid
from collections.abc import Iterator
from pathlib import Path

VARIABLE = "OMEGADOT_WORKER_MARKS"
# A family that starts new members while it is ended is searched again, so many times.
MOST_SEARCHES = 8


def new_mark() -> str:
    """A mark that no other worker has."""
    return uuid.uuid4().hex


def marked(environment: dict[str, str], mark: str) -> dict[str, str]:
    """The environment with one more mark; a worker's own workers bear both."""
    return {**environment, VARIABLE: f"{environment.get(VARIABLE, '')}:{mark}"}


def end_family(process: subprocess.Popen[bytes], mark: str) -> None:
    """Kill the process, its group, and on Linux every process that bears the mark."""
    with contextlib.suppress(ProcessLookupError, PermissionError):
        os.killpg(process.pid, signal.SIGKILL)
    if sys.platform == "linux":
        for _ in range(MOST_SEARCHES):
            if not _kill_marked(mark):
                return


def _kill_marked(mark: str) -> int:
    """How many were killed. A number is held while its owner is looked at, so none is mistaken."""
    killed = 0
    for number in _numbers():
        with contextlib.suppress(OSError):  # it may be gone by now, or another process's
            held = os.pidfd_open(number)
            try:
                if mark.encode() in Path(f"/proc/{number}/environ").read_bytes():
                    signal.pidfd_send_signal(held, signal.SIGKILL)
                    killed += 1
            finally:
                os.close(held)
    return killed


def _numbers() -> Iterator[int]:
    with contextlib.suppress(OSError), os.scandir("/proc") as entries:
        yield from (int(entry.name) for entry in entries if entry.name.isdecimal())
