"""Seek every integrator's largest step on its engine's worker, then time those that qualify."""

from __future__ import annotations

import contextlib
import threading
from concurrent.futures import Future
from dataclasses import dataclass, field
from functools import partial

from omegadot.commands.choose.candidate import Candidate
from omegadot.commands.choose.eligible import unmet, untestable
from omegadot.commands.choose.ranking import Key, Spread, time_all
from omegadot.commands.choose.requirements import Requirements
from omegadot.commands.choose.ruler import NoTruthError, Ruler
from omegadot.commands.choose.trial import Trial
from omegadot.commands.progress import Count, Progress, Reporter
from omegadot.gates.case import Case
from omegadot.harness.engines import Engines, outcome_of
from omegadot.harness.outcome import RunRequest
from omegadot.harness.plan import Engine
from omegadot.reference_impl.system import Array
from omegadot.workers.harness_end.process import Answer

FACTORS = (0.5, 2.0)


@dataclass
class CaseChoice:
    """One case: its ruler, or the reason why there is none, and every candidate.

    unverifiable: requirements that lie below what doubles can resolve here.
    """

    case: Case
    ruler: Ruler | None = None
    reason: str = ""
    unverifiable: tuple[str, ...] = ()
    candidates: list[Candidate] = field(default_factory=list)


@dataclass
class Choice:
    """One choice, and everything that is found out for it.

    budget: s that one run of the search may take.  report: how far it is.  refused: by engine, what
    it misses before it steps.  costs: seconds per step, by case and candidate.  memory: bytes, by
    engine.
    """

    request: RunRequest
    requirements: Requirements
    budget: float
    report: Reporter
    refused: dict[str, list[str]] = field(default_factory=dict)
    costs: dict[Key, Spread] = field(default_factory=dict)
    memory: dict[str, int | None] = field(default_factory=dict)

    def __post_init__(self) -> None:
        """Nothing has started yet."""
        self.engines = Engines(self.request)
        self.cases = [CaseChoice(case) for case in self.request.cases]
        self._one_at_a_time = threading.Lock()

    def execute(self) -> None:
        """Seek, then time. Ctrl-C ends the workers at once and is passed on."""
        self.report(Progress("starting the engines"))
        try:
            self.engines.start()
            self._seek_all()
            self._time()
        except BaseException:
            self.engines.stop()
            raise
        finally:
            self.engines.finish()

    def _seek_all(self) -> None:
        for engine in self.engines.started:
            own = engine.description
            self.refused[engine.name] = untestable(own) + unmet(own, self.requirements)
        fit = [e for e in self.engines.started if not self.refused[e.name]]
        total = sum(len(e.integrators) for e in fit) * len(self.cases)
        self._count = Count(self.report, "seeking the largest steps", total)
        rulers = [self.engines.submit("exact", partial(self._ruler, c)) for c in self.cases]
        for ruler in rulers:
            outcome_of(ruler)
        seeking: list[tuple[CaseChoice, Future[list[Candidate]]]] = []
        for found in self.cases:
            if found.ruler is None or found.unverifiable:
                continue
            for engine in fit:
                call = partial(self._examine, engine, found.case, found.ruler)
                seeking.append((found, self.engines.submit(engine.name, call)))
        for found, future in seeking:
            candidates = outcome_of(future)
            found.candidates += candidates

    def _ruler(self, found: CaseChoice) -> None:
        """Have the case's ruler made, on the exact solution's own thread."""
        case, limits = found.case, self.requirements.limits
        driver = self.engines.drivers["exact"]

        def solve(times: Array) -> Answer:
            fields = {"system": case.system, "initial": case.initial, "times": times}
            with self._one_at_a_time:  # every engine's thread sends requests to the same worker
                return driver.request(case, "solve", **fields)

        try:
            found.ruler = Ruler(case, case.scenario.run.duration, list(limits), solve)
        except NoTruthError as error:
            found.reason = str(error)
            return
        floor = found.ruler.floor
        found.unverifiable = tuple(k for k in limits if floor.get(k, 0.0) >= limits[k])

    def _examine(self, engine: Engine, case: Case, ruler: Ruler) -> list[Candidate]:
        driver = self.engines.drivers[engine.name]
        loaded = driver.request(case, "model", state=case.initial)
        declared = {i.name: i for i in driver.integrators()}
        found = []
        for integrator in engine.integrators:
            own = declared.get(integrator.name, integrator)
            candidate = Candidate(engine, own, driver, ruler, self.budget)
            found.append(candidate)
            if loaded.ok:
                candidate.seek(self.requirements.limits, FACTORS)
            else:
                candidate.outcome, candidate.reason = loaded.outcome, loaded.reason
            self._count.advance()
        return found

    def _time(self) -> None:
        """Time every candidate that qualifies, or would if one limit were another."""
        wanted: dict[Key, tuple[Candidate, Trial]] = {}
        for found in self.cases:
            for candidate in found.candidates:
                edges = [candidate.edge, *candidate.variants.values()]
                trial = next((e.passing for e in edges if e.passing is not None), None)
                if trial is not None and candidate.outcome == "ok":
                    wanted[found.case.name, candidate.name] = (candidate, trial)
        self._count.advance(0, "timing, engine by engine")
        self.costs = time_all(wanted)
        for name in {candidate.engine.name for f in self.cases for candidate in f.candidates}:
            with contextlib.suppress(KeyError):
                self.memory[name] = self.engines.drivers[name].worker.peak_memory()
