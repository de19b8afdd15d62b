"""``omegadot.faults``: which faults a plain `check` catches, and how often."""

from __future__ import annotations

import os
import sys
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass

from omegadot.adapters.registry import BUILT_IN
from omegadot.commands.faults.catalogue import ORDERED
from omegadot.commands.faults.detection import DEFAULT
from omegadot.commands.faults.matrix import EngineMatrix, engine_matrix
from omegadot.commands.faults.prepared import Pool
from omegadot.commands.progress import Count, Reporting, reporting
from omegadot.commands.typed import typed
from omegadot.harness.arguments import several
from omegadot.harness.usage import UsageError, check_count, nearest
from omegadot.scenarios.random_systems import LARGEST_SEED, MOST_SYSTEMS

ENGINES = tuple(name for name in BUILT_IN if name != "exact")  # the truth cannot be wrong


@dataclass(frozen=True)
class FaultsResult:
    """The detection matrix, an engine after another, for so many random systems of a seed."""

    random: int
    seed: int
    matrices: tuple[EngineMatrix, ...]

    @property
    def unseen(self) -> tuple[str, ...]:
        """The faults that a plain check does not catch, as ``engine: fault``."""
        return tuple(f"{m.engine}: {name}" for m in self.matrices for name in m.missed)

    @property
    def passed(self) -> bool:
        """Whether every fault is caught and no sound engine is accused."""
        accused = any(m.accused or m.accused_nameless for m in self.matrices)
        return not self.unseen and not accused

    @property
    def minutes(self) -> float:
        """Of processor time."""
        return sum(matrix.minutes for matrix in self.matrices)


@typed
def faults(
    engines: str | Sequence[str] | None = None,
    *,
    random: int = DEFAULT,
    seed: int = 0,
    progress: Reporting = False,
) -> FaultsResult:
    """Break sound engines in known ways, and find what a plain check catches, and how often.

    engines: built-in ones, imported into this process; default: the reference.  The published
    checks are tried over the first.
    random: systems for each fault, those of `check`.  seed: theirs.
    Raises UsageError for an engine that is unknown or not installed.
    """
    check_count("--random", random, 1, MOST_SYSTEMS)
    check_count("--seed", seed, 0, LARGEST_SEED)
    given: list[str] = several(engines, "engines")
    names = list(dict.fromkeys(given)) or ["reference"]
    for name in names:
        if name not in ENGINES:
            raise UsageError(f"--engine {name}: no such engine; {nearest(name, ENGINES)}.")
    pool, matrices = Pool(seed), []
    with reporting(progress) as report, quiet_engines():
        count = Count(report, "judging faulty engines", len(names) * len(ORDERED))
        for name in names:
            first = name == names[0]
            try:
                matrices.append(engine_matrix(name, pool, random, first, count.advance))
            except ImportError as error:
                raise UsageError(
                    f"--engine {name}: not installed ({error}); install it."
                ) from error
    return FaultsResult(random, seed, tuple(matrices))


@contextmanager
def quiet_engines() -> Iterator[None]:
    """What engines print from native code would stand among the results: it is dropped.

    A wrong one may print a warning at every step. What Python prints to stderr is kept.
    """
    for stream in (sys.stdout, sys.stderr):
        stream.flush()
    kept, nowhere, own = [os.dup(1), os.dup(2)], os.open(os.devnull, os.O_WRONLY), sys.stderr
    try:
        sys.stderr = os.fdopen(kept[1], "w", buffering=1, closefd=False)
        for descriptor in (1, 2):
            os.dup2(nowhere, descriptor)
        yield
    finally:
        sys.stderr.flush()
        sys.stderr = own
        for descriptor, copy in zip((1, 2), kept, strict=True):
            os.dup2(copy, descriptor)
            os.close(copy)
        os.close(nowhere)
