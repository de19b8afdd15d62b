"""The process above a worker on Linux: what an engine starts ends with it, wherever it has gone.

A worker forks before its engine is imported. Its parent, the keeper, adopts the orphans below it
(PR_SET_CHILD_SUBREAPER): a process that has left the worker's session, group and environment is
still a descendant. The keeper kills them all when the worker ends, however it ends, then ends as it
did. It does the same on SIGTERM, which is sent to it when the harness has ended.
"""

from __future__ import annotations

import contextlib
import ctypes
import os
import signal
import sys
import time
from collections.abc import Iterator
from pathlib import Path
from types import FrameType
from typing import NoReturn

# linux/prctl.h
PR_SET_PDEATHSIG, PR_SET_DUMPABLE, PR_SET_CHILD_SUBREAPER = 1, 4, 36
SECONDS_TO_END, SECONDS_ASLEEP = 1.0, 0.002


class _EndedError(BaseException):
    """The harness has ended, or is about to end this worker."""


def keep_family() -> None:
    """Go on in a child of this process, which then keeps it and never returns; on Linux alone."""
    if sys.platform != "linux":
        return
    control = ctypes.CDLL(None).prctl
    control(PR_SET_CHILD_SUBREAPER, 1, 0, 0, 0)
    signal.signal(signal.SIGTERM, _stop)
    control(PR_SET_PDEATHSIG, signal.SIGTERM)
    worker = os.fork()
    if worker == 0:
        signal.signal(signal.SIGTERM, signal.SIG_DFL)
        return
    try:
        _leave_channels()
        code = _code_of(worker)
    except _EndedError:
        code = -signal.SIGTERM
    signal.signal(signal.SIGTERM, signal.SIG_IGN)
    _end_children()
    control(PR_SET_DUMPABLE, 0, 0, 0, 0)  # one image of the memory is enough
    _end_with(code)


def _stop(_: int, __: FrameType | None) -> NoReturn:
    # The kernel and the guard both send it: a second one would end the keeper before its family.
    signal.signal(signal.SIGTERM, signal.SIG_IGN)
    raise _EndedError


def _leave_channels() -> None:
    """They are the worker's alone: that it closes one is seen at once."""
    nothing = os.open(os.devnull, os.O_RDWR)
    for number in range(3):
        os.dup2(nothing, number)


def _code_of(worker: int) -> int:
    """How the worker ended, as `subprocess` has it; orphans that end before it are laid to rest."""
    while True:
        ended, status = os.wait()
        if ended == worker:
            return os.waitstatus_to_exitcode(status)


def _end_children() -> None:
    """Kill and await all; those of each are this process's then, so none is left at the end."""
    end = time.monotonic() + SECONDS_TO_END
    while time.monotonic() < end:  # another user's cannot be killed
        for child in _children():
            with contextlib.suppress(OSError):
                os.kill(child, signal.SIGKILL)
        try:
            while os.waitpid(-1, os.WNOHANG)[0]:
                pass
        except ChildProcessError:
            return
        time.sleep(SECONDS_ASLEEP)


def _children() -> Iterator[int]:
    for folder in Path("/proc").iterdir():
        if folder.name.isdigit():
            with contextlib.suppress(OSError):
                # after the name, which may hold anything: state, parent
                parent = (folder / "stat").read_bytes().rpartition(b")")[2].split()[1]
                if int(parent) == os.getpid():
                    yield int(folder.name)


def _end_with(code: int) -> NoReturn:
    if code < 0:
        with contextlib.suppress(OSError):  # SIGKILL is as it is
            signal.signal(-code, signal.SIG_DFL)
        os.kill(os.getpid(), -code)
    os._exit(code if code >= 0 else 128 - code)
