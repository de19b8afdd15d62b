"""How far a command is: reported to a function of the caller's, or drawn as a bar."""

from __future__ import annotations

import sys
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass


@dataclass(frozen=True)
class Progress:
    """What a command is doing now. total: None where it is not known how much there is to do."""

    what: str
    done: int = 0
    total: int | None = None


Reporter = Callable[[Progress], object]
Reporting = bool | Reporter
"""Nothing (False), a bar or a line on standard error (True), or a function of Progress."""


@contextmanager
def reporting(progress: Reporting) -> Iterator[Reporter]:
    """What a command reports to. A function may be called from several threads, one at a time."""
    if progress is True:
        with _bar() if sys.stderr.isatty() else _line() as shown:
            yield shown
        return
    if progress is False:
        yield lambda now: None
        return
    lock = threading.Lock()

    def one_at_a_time(now: Progress) -> object:
        with lock:
            return progress(now)

    yield one_at_a_time


@contextmanager
def _bar() -> Iterator[Reporter]:
    from rich.console import Console
    from rich.progress import BarColumn, MofNCompleteColumn, TextColumn, TimeRemainingColumn
    from rich.progress import Progress as Bar

    ends = MofNCompleteColumn(), TimeRemainingColumn()
    columns = TextColumn("{task.description}"), BarColumn(), *ends
    with Bar(*columns, console=Console(stderr=True), transient=True) as bar:
        task = bar.add_task("", total=None)
        yield lambda now: bar.update(
            task, description=now.what, completed=now.done, total=now.total
        )


@contextmanager
def _line() -> Iterator[Reporter]:
    """One line that is written over, as notebooks show it."""

    def write(now: Progress) -> None:
        count = "" if now.total is None else f": {now.done} of {now.total}"
        sys.stderr.write(f"\r{now.what + count:<72}")
        sys.stderr.flush()

    yield write
    sys.stderr.write("\r" + " " * 72 + "\r")


class Count:
    """Counts what is done, from any thread, and reports it."""

    def __init__(self, report: Reporter, what: str, total: int | None = None) -> None:
        self._report, self._what, self._total = report, what, total
        self._done, self._lock = 0, threading.Lock()
        report(Progress(what, 0, total))

    def advance(self, by: int = 1, what: str = "") -> None:
        """Some more are done. what: what is done from here on, where that changes."""
        with self._lock:
            self._done += by
            self._what = what or self._what
            now = Progress(self._what, self._done, self._total)
        self._report(now)
