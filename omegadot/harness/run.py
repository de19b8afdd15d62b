"""A run: every engine over every case, judged case by case as the answers come in."""

from __future__ import annotations

import os
import threading
from collections.abc import Callable, Sequence
from concurrent.futures import Future, ThreadPoolExecutor
from dataclasses import dataclass, field
from functools import partial
from typing import TypeVar

from omegadot.adapters.protocol import Description, Integrator
from omegadot.adapters.registry import BUILT_IN
from omegadot.adapters.wire import description_of
from omegadot.harness.ask_truth import case_companions, case_truth, reference_runs
from omegadot.harness.drive import INTERRUPTED, CaseResult, Driver, Questions
from omegadot.harness.gates.course import Companion, SchemeKey, scheme_key
from omegadot.harness.gates.equation import random_acceleration, random_states
from omegadot.harness.judge_case import JudgedRun, judge_case, shared_rows
from omegadot.harness.plan import Case, Engine, EngineChoice, Sweep
from omegadot.harness.refine import MOST_HALVINGS, Refinements, refine, refined_sweeps
from omegadot.harness.rows import Row
from omegadot.harness.truth import Truth, path_states
from omegadot.harness.usage import check_integrators
from omegadot.harness.worker_process import Answer, WorkerProcess

RANDOM_STATES = 200
PATH_STATES = 200
Result = TypeVar("Result")


@dataclass(frozen=True)
class RunRequest:
    """What to run. timeout: s, for one request to a worker. jobs: requests at the same time."""

    cases: Sequence[Case]
    choices: Sequence[EngineChoice]
    setup: str = "physics"
    seed: int = 0
    timeout: float = 60.0
    jobs: int = field(default_factory=lambda: os.cpu_count() or 1)


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


def integrators_chosen(choice: EngineChoice, description: Description) -> tuple[Integrator, ...]:
    """The integrators asked for, in the engine's order; all of them when none was named."""
    if not choice.integrators:
        return description.integrators
    return tuple(i for i in description.integrators if i.name in choice.integrators)


class Runner:
    """The workers of one run, one thread and one process an engine."""

    def __init__(self, request: RunRequest) -> None:
        self.request = request
        self.on_start: Callable[[], None] = lambda: None
        self.on_advance: Callable[[int], object] = lambda _: None
        self._stopping = threading.Event()
        self._slots = threading.Semaphore(request.jobs)
        self._workers: dict[str, WorkerProcess] = {}
        self._drivers: dict[str, Driver] = {}
        self._threads: dict[str, ThreadPoolExecutor] = {}
        self.engines: list[Engine] = []
        self.missing: list[tuple[EngineChoice, Answer]] = []

    def start(self) -> None:
        """Start every engine asked for, and the two that know the truth."""
        wanted = {choice.name: choice for choice in self.request.choices}
        helpers = [EngineChoice(n, BUILT_IN[n]) for n in ("exact", "reference") if n not in wanted]
        setup, timeout = self.request.setup, self.request.timeout
        for choice in (*wanted.values(), *helpers):
            self._workers[choice.name] = WorkerProcess(choice.target, setup, timeout)
            self._threads[choice.name] = ThreadPoolExecutor(1, choice.name)
        started = {n: self._threads[n].submit(worker.start) for n, worker in self._workers.items()}
        for choice in (*wanted.values(), *helpers):
            answer = started[choice.name].result()
            if not answer.ok:
                self.missing.append((choice, answer))
                continue
            description = description_of(answer.result)
            check_integrators(choice, description)
            engine = Engine(choice, description, integrators_chosen(choice, description))
            worker = self._workers[choice.name]
            self._drivers[choice.name] = Driver(engine, worker, self._slots, self._stopping)
            if choice.name in wanted:
                self.engines.append(engine)

    def stop(self) -> None:
        """End every worker at once; answers that were on their way become interruptions."""
        self._stopping.set()
        for worker in self._workers.values():
            worker.stop()

    def finish(self) -> None:
        """End the threads, then the workers, which are idle by then or stopped already."""
        for threads in self._threads.values():
            threads.shutdown(wait=True, cancel_futures=True)
        for worker in self._workers.values():
            worker.finish()

    def _submit(self, name: str, call: Callable[[], Result]) -> Future[Result]:
        return self._threads[name].submit(call)

    def _keys(self, case: Case) -> list[SchemeKey]:
        """The reference's runs that this case's engines will be held against."""
        named = {scheme_key(i, case.system) for engine in self.engines for i in engine.integrators}
        return sorted((key for key in named if key), key=str)

    def _add_companions(
        self, case: Case, truth: Truth, results: list[CaseResult], sweeps: list[Sweep]
    ) -> None:
        """Companions for schemes or steps that came up only when the engines had answered."""
        named = {scheme_key(i, case.system) for result in results for i in result.integrators}
        for sweep in sweeps:
            known = {key for key, step in truth.companions if step == sweep.timestep}
            missing = sorted((key for key in named if key and key not in known), key=str)
            if missing:
                driver = self._drivers["reference"]
                call = partial(case_companions, driver, case, truth, missing, [sweep])
                truth.companions.update(self._submit("reference", call).result())

    def _examine(self, engine: Engine, case: Case, pending: PendingTruth) -> CaseResult:
        truth, driver = pending.truth.result(), self._drivers[engine.name]
        if isinstance(truth, str):
            self.on_advance(tasks_of(engine, case))
            return CaseResult(engine.name, case.name)
        result = driver.ask_equations(case, questions_of(case, truth, self.request.seed))
        if engine.name == "exact":
            self.on_advance(1)
        elif engine.name == "reference":
            result.runs.update(reference_runs(driver, case, pending.companions.result()))
            self.on_advance(tasks_of(engine, case))
        else:
            result.runs.update(driver.run_all(case, lambda: self.on_advance(1)))
        return result

    def _submit_case(self, case: Case) -> PendingCase:
        exact, reference = self._drivers["exact"], self._drivers["reference"]
        truth = self._submit("exact", lambda: case_truth(exact, case))
        keys = self._keys(case)
        companions = self._submit(
            "reference", lambda: case_companions(reference, case, truth.result(), keys, case.sweeps)
        )
        known = PendingTruth(truth, companions)
        results = {
            engine.name: self._submit(engine.name, partial(self._examine, engine, case, known))
            for engine in self.engines
        }
        return PendingCase(case, known, results)

    def judge(self, pending: PendingCase, finer: dict[str, Refinements]) -> JudgedCase:
        """Wait for one case and send it through the gates. finer: refinements, by engine."""
        case, truth = pending.case, pending.known.truth.result()
        results = {name: future.result() for name, future in pending.results.items()}
        if isinstance(truth, str):
            unjudged = [EngineCase(e, results[e.name], [], []) for e in self.engines]
            return JudgedCase(case, None, truth, unjudged)
        truth.companions.update(pending.known.companions.result())
        refined = [sweep for known in finer.values() for sweep in refined_sweeps(known)]
        unique = {sweep.timestep: sweep for sweep in (*case.sweeps, *refined)}
        self._add_companions(case, truth, list(results.values()), list(unique.values()))
        questions, judged = questions_of(case, truth, self.request.seed), []
        for engine in self.engines:
            result = results[engine.name]
            shared = shared_rows(case, questions, result)
            runs: list[JudgedRun] = []
            if engine.name != "exact":
                runs = judge_case(truth, case, result, finer.get(engine.name, {}))
            judged.append(EngineCase(engine, result, shared, runs))
        return JudgedCase(case, truth, "", judged)

    def _resolve(self, pending: PendingCase, judged: JudgedCase) -> JudgedCase:
        """Judge a case again with finer steps, as long as these can still decide something."""
        finer: dict[str, Refinements] = {}
        for _ in range(MOST_HALVINGS):
            asked = []
            for found in judged.engines:
                name, driver = found.engine.name, self._drivers[found.engine.name]
                known = finer.setdefault(name, {})
                if any(run.unresolved for run in found.runs):
                    call = partial(refine, driver, judged.case, found.runs, known)
                    asked.append(self._submit(name, call))
            done = [future.result() for future in asked]
            if not any(done):
                break
            judged = self.judge(pending, finer)
        return judged

    def execute(self) -> Outcome:
        """Run everything; Ctrl-C ends the workers and keeps what has come in."""
        judged: list[JudgedCase] = []
        interrupted = False
        pending: list[PendingCase] = []
        try:
            self.start()
            self.on_start()
            pending = [self._submit_case(case) for case in self.request.cases]
            for case in pending:
                judged.append(self.judge(case, {}))
            for index, case in enumerate(pending):
                judged[index] = self._resolve(case, judged[index])
        except KeyboardInterrupt:
            interrupted = True
            self.stop()
            judged += [self._leftover(case) for case in pending[len(judged) :]]
        except BaseException:
            self.stop()
            raise
        finally:
            self.finish()
        deaths = [(n, how) for n, worker in self._workers.items() for how in worker.deaths]
        return Outcome(self.engines, self.missing, judged, interrupted, deaths)

    def _leftover(self, pending: PendingCase) -> JudgedCase:
        """A case that the interruption caught: none of it is judged, and it says so."""
        engines = [
            EngineCase(engine, CaseResult(engine.name, pending.case.name), [], [])
            for engine in self.engines
        ]
        return JudgedCase(pending.case, None, INTERRUPTED.reason, engines)


@dataclass(frozen=True)
class PendingTruth:
    """What a case is judged by. The truth is a string where there is none: the reason."""

    truth: Future[Truth | str]
    companions: Future[dict[tuple[SchemeKey, float], Companion]]


@dataclass(frozen=True)
class PendingCase:
    """The futures of one case."""

    case: Case
    known: PendingTruth
    results: dict[str, Future[CaseResult]]


def tasks_of(engine: Engine, case: Case) -> int:
    """How many tasks an engine has in a case; the exact solution has one."""
    return 1 if engine.name == "exact" else len(engine.integrators) * len(case.sweeps)


def questions_of(case: Case, truth: Truth, seed: int) -> Questions:
    """The states that every engine is asked about; the same for all, and for every run."""
    own = [seed, *case.name.encode()]
    states = random_states(case, RANDOM_STATES, own)
    path = path_states(case, truth, PATH_STATES)
    return Questions(states, path, random_acceleration(case.system, states, own))
