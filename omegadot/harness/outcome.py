"""What is measured of a run, what is on its way, and what comes of it."""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from concurrent.futures import Future
from dataclasses import dataclass, field

from omegadot.gates.case import Case
from omegadot.gates.rows import Row
from omegadot.gates.truth import Companion, SchemeKey, Truth
from omegadot.harness.drive import CaseResult
from omegadot.harness.judging.judged_run import JudgedRun
from omegadot.harness.plan import Engine, EngineChoice
from omegadot.harness.usage import check_count, check_number, check_setup
from omegadot.workers.harness_end.process import Answer


@dataclass(frozen=True)
class RunRequest:
    """What to run.

    timeout: s, for one request to a worker.  jobs: requests at the same time.  memory: GiB that a
    worker may hold; None for half of the machine's.
    """

    cases: Sequence[Case]
    choices: Sequence[EngineChoice]
    setup: str = "physics"
    seed: int = 0
    timeout: float = 60.0
    jobs: int = field(default_factory=lambda: os.cpu_count() or 1)
    memory: float | None = None

    def __post_init__(self) -> None:
        """Raise UsageError for what the command line would refuse."""
        check_setup(self.setup)
        check_count("--seed", self.seed, 0)
        check_number("--timeout", self.timeout, 0.0)
        check_count("--jobs", self.jobs, 1)
        if self.memory is not None:
            check_number("--memory", self.memory, 0.1)


@dataclass(frozen=True)
class EngineCase:
    """One engine on one case, judged. shared: rows that belong to every task of it."""

    engine: Engine
    result: CaseResult
    shared: list[Row]
    runs: list[JudgedRun]


@dataclass(frozen=True)
class JudgedCase:
    """One case with its truth (None where there is none, and then why) and all engines."""

    case: Case
    truth: Truth | None
    reason: str
    engines: list[EngineCase]


# Names the likeliest cause of a failure: in one run, or (None) in what all runs share.
Cause = Callable[[JudgedRun | None], str]
# From an engine's judged case to its causes.
CausesOf = Callable[[JudgedCase, EngineCase], Cause]


@dataclass(frozen=True)
class Outcome:
    """Everything that came of a run.

    missing: engines that did not start, with the answer.  deaths: workers that died, and how.
    """

    engines: list[Engine]
    missing: list[tuple[EngineChoice, Answer]]
    cases: list[JudgedCase]
    interrupted: bool
    deaths: list[tuple[str, str]]


@dataclass(frozen=True)
class PendingCase:
    """The futures of one case. The truth is a string where there is none: the reason."""

    case: Case
    truth: Future[Truth | str]
    companions: Future[dict[tuple[SchemeKey, float], Companion]]
    results: dict[str, Future[CaseResult]] = field(default_factory=dict)


def tasks_of(engine: Engine, case: Case) -> int:
    """How many tasks an engine has in a case; the exact solution has one."""
    return 1 if engine.name == "exact" else sum(len(case.sweeps_of(i)) for i in engine.integrators)
