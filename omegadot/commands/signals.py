"""SIGTERM and SIGHUP taken as Ctrl-C is. Imports next to nothing: it comes before all that does."""

from __future__ import annotations

import signal

# Windows has no SIGHUP.
_ENDING = [getattr(signal, name) for name in ("SIGTERM", "SIGHUP") if hasattr(signal, name)]


def end_like_ctrl_c() -> list[int]:
    """Take SIGTERM and SIGHUP as Ctrl-C is taken, so that what there is gets written.

    The list receives the signal's number; after the first, what there is gets written without
    another interruption. One that is ignored, as under nohup, stays so.
    """
    received: list[int] = []

    def interrupt(number: int, _: object) -> None:
        if not received:
            received.append(number)
            raise KeyboardInterrupt

    for number in _ENDING:
        if signal.getsignal(number) is signal.SIG_DFL:
            signal.signal(number, interrupt)
    return received


def code_of(received: list[int]) -> int:
    """The exit code of an interruption: 128 and the signal's number, as shells count."""
    return 128 + (received[0] if received else signal.SIGINT)


def as_before(received: list[int]) -> None:
    """As the command is done: a signal that comes while Python leaves raises nothing there."""
    received.append(0)
    for number in _ENDING:
        if signal.getsignal(number) is not signal.SIG_IGN:
            signal.signal(number, signal.SIG_DFL)
