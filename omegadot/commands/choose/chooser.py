"""Seek every integrator's largest step on its engine's worker, then time those that qualify."""

from __future__ import annotations

import contextlib
import threading
from collections.abc import Callable, Sequence
from concurrent.futures import Future
from dataclasses import dataclass, field
from functools import partial

from omegadot.commands.choose.candidate import BrokenError, Candidate, Prober
from omegadot.commands.choose.eligible import unmet
from omegadot.commands.choose.requirements import Requirements
from omegadot.commands.choose.ruler import NoTruthError, Ruler
from omegadot.commands.choose.spread import Spread
from omegadot.commands.choose.timing import Timed, time_all
from omegadot.gates.case import Case
from omegadot.harness.engines import Engines, outcome_of
from omegadot.harness.outcome import RunRequest
from omegadot.harness.plan import Engine, EngineChoice
from omegadot.reference_impl.system import Array
from omegadot.workers.harness_end.process import Answer

FACTORS = (0.5, 2.0)
TimedKey = tuple[str, str]


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
    """Everything that was found out.

    refused: by engine, what it misses before it steps.  costs: seconds per step, by case and
    candidate.  memory: bytes, by engine.
    """

    cases: list[CaseChoice]
    engines: list[Engine] = field(default_factory=list)
    missing: list[tuple[EngineChoice, Answer]] = field(default_factory=list)
    refused: dict[str, list[str]] = field(default_factory=dict)
    costs: dict[TimedKey, Spread] = field(default_factory=dict)
    memory: dict[str, int | None] = field(default_factory=dict)
    deaths: list[tuple[str, str]] = field(default_factory=list)


@dataclass
class Chooser:
    """One choice. budget: s that one run of the search may take.

    on_start and on_advance report to a progress bar what is planned and done.
    """

    request: RunRequest
    requirements: Requirements
    budget: float
    on_start: Callable[[int], object] = lambda total: None
    on_advance: Callable[[], object] = lambda: None
    on_timing: Callable[[], object] = lambda: None
    _one_at_a_time: threading.Lock = field(default_factory=threading.Lock)

    def execute(self) -> Choice:
        """Seek, then time. Ctrl-C ends the workers at once and is passed on."""
        self.engines = Engines(self.request)
        choice = Choice([CaseChoice(case) for case in self.request.cases])
        try:
            self.engines.start()
            choice.engines, choice.missing = self.engines.started, self.engines.missing
            self._seek_all(choice)
            self._time(choice)
        except BaseException:
            self.engines.stop()
            raise
        finally:
            self.engines.finish()
        choice.deaths = self.engines.deaths()
        return choice

    def _seek_all(self, choice: Choice) -> None:
        for engine in choice.engines:
            choice.refused[engine.name] = unmet(engine.description, self.requirements)
        fit = [e for e in choice.engines if not choice.refused[e.name]]
        self.on_start(sum(len(e.integrators) for e in fit) * len(choice.cases))
        rulers = [self._exactly(partial(self._ruler, found)) for found in choice.cases]
        for ruler in rulers:
            outcome_of(ruler)
        seeking: list[tuple[CaseChoice, Future[list[Candidate]]]] = []
        for found in choice.cases:
            if found.ruler is None or found.unverifiable:
                continue
            for engine in fit:
                call = partial(self._examine, engine, found.case, found.ruler)
                seeking.append((found, self.engines.submit(engine.name, call)))
        for found, future in seeking:
            candidates = outcome_of(future)
            found.candidates.extend(candidates)

    def _exactly(self, call: Callable[[], None]) -> Future[None]:
        return self.engines.submit("exact", call)

    def _ruler(self, found: CaseChoice) -> None:
        """Have the case's ruler made, on the exact solution's own thread."""
        case, limits = found.case, self.requirements.limits
        driver = self.engines.drivers.get("exact")
        if driver is None:
            found.reason = "the exact solution could not be started"
            return

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
            candidate = Candidate(engine, declared.get(integrator.name, integrator))
            found.append(candidate)
            if not loaded.ok:
                candidate.outcome, candidate.reason = loaded.outcome, loaded.reason
            else:
                prober = Prober(driver, ruler, candidate, self.budget)
                self._seek(candidate, prober)
            self.on_advance()
        return found

    def _seek(self, candidate: Candidate, prober: Prober) -> None:
        limits = self.requirements.limits
        try:
            candidate.edge = prober.seek(limits)
            for key in limits:
                for factor in FACTORS:
                    changed = self.requirements.scaled(key, factor).limits
                    candidate.variants[key, factor] = prober.vary(changed)
        except (BrokenError, NoTruthError) as error:
            candidate.outcome = getattr(error, "outcome", "raised")
            candidate.reason = str(error)

    def _time(self, choice: Choice) -> None:
        """Time every candidate that qualifies, or would if one limit were another."""
        wanted: dict[TimedKey, Timed] = {}
        for found in choice.cases:
            for candidate in found.candidates:
                edges = [candidate.edge, *candidate.variants.values()]
                trial = next((e.passing for e in edges if e.passing is not None), None)
                if trial is not None and candidate.outcome == "ok":
                    wanted[found.case.name, candidate.name] = Timed(
                        found.case, candidate, trial.timestep, trial.steps, trial.seconds_per_step
                    )
        self.on_timing()
        choice.costs = time_all(wanted, self.engines.drivers)
        for name in {candidate.engine.name for f in choice.cases for candidate in f.candidates}:
            with contextlib.suppress(KeyError):
                choice.memory[name] = self.engines.drivers[name].worker.peak_memory()


def choices_to_make(choices: Sequence[EngineChoice]) -> list[EngineChoice]:
    """The engines to choose among: not the truth itself, nor the reference unless it is named."""
    return [c for c in choices if c.name != "exact" and (c.required or c.name != "reference")]
