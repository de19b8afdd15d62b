"""``omegadot.faults``: which gate catches which fault, how often, and what published checks do."""

from __future__ import annotations

import os
import sys
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass

from omegadot.adapters.registry import BUILT_IN
from omegadot.commands.faults.matrix import EngineMatrix, engine_matrix
from omegadot.commands.faults.prepared import Pool
from omegadot.commands.progress import Count, Reporting, reporting
from omegadot.harness.arguments import several
from omegadot.harness.usage import UsageError, check_count, nearest

ENGINES = tuple(name for name in BUILT_IN if name != "exact")  # the truth cannot be wrong


@dataclass(frozen=True)
class FaultsResult:
    """The detection matrix, an engine after another, for so many bodies of a seed."""

    bodies: int
    seed: int
    matrices: tuple[EngineMatrix, ...]

    @property
    def unseen(self) -> tuple[str, ...]:
        """The faults that no gate catches on some body, as ``engine: fault``."""
        return tuple(f"{m.engine}: {name}" for m in self.matrices for name in m.missed)

    @property
    def passed(self) -> bool:
        """Whether every fault is caught on every body and no sound engine is accused on one."""
        return not self.unseen and not any(matrix.accused for matrix in self.matrices)


def faults(
    engines: str | Sequence[str] = (),
    *,
    bodies: int = 5,
    seed: int = 0,
    progress: Reporting = False,
) -> FaultsResult:
    """Break sound engines in known ways, and find which gate catches what, and how often.

    engines: built-in ones, imported into this process; default: the reference.
    bodies: random ones for each fault.  seed: theirs.
    Raises UsageError for an engine that is unknown or not installed.
    """
    check_count("--bodies", bodies, 1)
    check_count("--seed", seed, 0)
    given: list[str] = several(engines)
    names = list(dict.fromkeys(given)) or ["reference"]
    for name in names:
        if name not in ENGINES:
            raise UsageError(f"--engine {name}: no such engine; {nearest(name, ENGINES)}.")
    pool, matrices = Pool(seed), []
    with reporting(progress) as report, quiet_engines():
        count = Count(report, "judging faulty engines", len(names))
        for name in names:
            try:
                matrices.append(engine_matrix(name, pool, bodies))
            except ImportError as error:
                raise UsageError(
                    f"--engine {name}: not installed ({error}); install it."
                ) from error
            count.advance()
    return FaultsResult(bodies, seed, tuple(matrices))


@contextmanager
def quiet_engines() -> Iterator[None]:
    """What engines print from native code would stand among the results: it is dropped."""
    sys.stdout.flush()
    kept, nowhere = os.dup(1), os.open(os.devnull, os.O_WRONLY)
    try:
        os.dup2(nowhere, 1)
        yield
    finally:
        os.dup2(kept, 1)
        os.close(kept)
        os.close(nowhere)
