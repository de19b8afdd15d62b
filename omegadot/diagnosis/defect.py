"""A search for a cause that ends in an exception: a verdict stands without its explanation."""

from __future__ import annotations

import traceback
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from pathlib import Path

from omegadot.diagnosis.experiments.conditioned import UNKNOWN

PACKAGE = Path(__file__).resolve().parents[1]


def first_found(searches: Iterable[Callable[[], list[str]]]) -> list[str]:
    """What the first search finds that finds anything.

    One that raises an exception costs its own answer alone: it is raised where no other finds any.
    """
    raised: Exception | None = None
    for search in searches:
        try:
            found = search()
        except Exception as error:  # on the numbers of a wrong engine, in any way
            raised = raised or error
            continue
        if found:
            return found
    if raised is not None:
        raise raised
    return []


@contextmanager
def kept_apart(defects: list[str]) -> Iterator[None]:
    """Add what ends the search to `defects`, in a sentence, and go on."""
    try:
        yield
    except Exception as error:  # a search may fail in any way on the numbers of a wrong engine
        frames = traceback.extract_tb(error.__traceback__)
        own = [one for one in frames if PACKAGE in Path(one.filename).parents]
        frame = (own or frames)[-1]  # a library's own is the same for many defects
        where = f"{type(error).__name__} in {Path(frame.filename).name}:{frame.lineno}"
        defects.append(f"{UNKNOWN}; its search ended in {where}: a defect of omegadot, report it")
