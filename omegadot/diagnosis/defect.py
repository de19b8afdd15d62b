"""A search for a cause that ends in an exception: a verdict stands without its explanation."""

from __future__ import annotations

import traceback
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from omegadot.diagnosis.experiments.conditioned import UNKNOWN


@contextmanager
def kept_apart(defects: list[str]) -> Iterator[None]:
    """Add what ends the search to `defects`, in a sentence, and go on."""
    try:
        yield
    except Exception as error:  # a search may fail in any way on the numbers of a wrong engine
        frame = traceback.extract_tb(error.__traceback__)[-1]
        where = f"{type(error).__name__} in {Path(frame.filename).name}:{frame.lineno}"
        defects.append(f"{UNKNOWN}; its search ended in {where}: a defect of omegadot, report it")
