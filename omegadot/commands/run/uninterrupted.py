"""What must not be interrupted: a record is written whole, and then it is said where it is."""

from __future__ import annotations

import signal
import threading
from collections.abc import Iterator
from contextlib import contextmanager

# Windows has no SIGHUP.
_ENDING = [getattr(signal, n) for n in ("SIGINT", "SIGTERM", "SIGHUP") if hasattr(signal, n)]


@contextmanager
def uninterrupted() -> Iterator[list[int]]:
    """Signals that end a program wait; the list receives the numbers of those that came.

    One that is ignored stays so. In another thread than the main one nothing changes: Python
    interrupts the main thread alone.
    """
    came: list[int] = []
    before = {}
    if threading.current_thread() is threading.main_thread():
        for number in _ENDING:
            if signal.getsignal(number) not in (signal.SIG_IGN, None):
                before[number] = signal.signal(number, lambda own, _: came.append(own))
    try:
        yield came
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)
