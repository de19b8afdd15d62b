"""A run: every engine over every case, judged case by case as the answers come in."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from concurrent.futures import Future
from dataclasses import replace
from functools import partial

import numpy as np

from omegadot.adapters.protocol import Integrator
from omegadot.gates.case import Case, Sweep
from omegadot.gates.states.equation import evaluation_states_of
from omegadot.gates.steps.scheme import comparison_keys
from omegadot.gates.truth import Companion, SchemeKey, StepSchemes, Truth, scheme_key
from omegadot.harness.drive import INTERRUPTED, CaseResult, Driver
from omegadot.harness.engines import Engines, outcome_of
from omegadot.harness.judging.engine import shared_rows
from omegadot.harness.judging.judged_run import JudgedRun
from omegadot.harness.judging.refine import (
    MORE_OF_ONE,
    MOST_HALVINGS,
    Refinements,
    left_undecided,
    refine,
)
from omegadot.harness.judging.runs import judge_case
from omegadot.harness.outcome import (
    EngineCase,
    JudgedCase,
    Outcome,
    PendingCase,
    RunRequest,
    tasks_of,
)
from omegadot.harness.plan import Engine
from omegadot.harness.requests.nudged import request_nudged, rounding_may_decide
from omegadot.harness.requests.repeats import OTHERS, request_again
from omegadot.harness.requests.step_probes import probe_steps
from omegadot.harness.requests.truth_requests import (
    Companions,
    case_companions,
    case_truth,
    reference_runs,
)
from omegadot.harness.requests.turned import axes_may_decide, request_turned
from omegadot.harness.requests.until_raised import request_until_raised


class Runner:
    """One run. on_start and on_advance report to a progress bar what is planned and done."""

    def __init__(self, request: RunRequest) -> None:
        self.request = request
        self.engines = Engines(request)
        self.on_start: Callable[[], None] = lambda: None
        self.on_advance: Callable[[int], object] = lambda _: None

    def _declared(self, case: Case) -> list[SchemeKey]:
        """The schemes that this case's engines declare, which their runs are held against."""
        found = {scheme_key(integrator, case.system) for integrator in self._integrators()}
        return sorted((key for key in found if key is not None), key=str)

    def _compared(self, case: Case) -> list[SchemeKey]:
        """The same, and for integrators that declare none every scheme, to name what they equal."""
        found = {k for i in self._integrators() for k in comparison_keys(i, case.system)}
        return sorted(found, key=str)

    def _integrators(self) -> Iterator[Integrator]:
        for engine in self.engines.started:
            if engine.name != "exact":
                yield from engine.integrators

    def _submit_companions(
        self,
        case: Case,
        truth: Callable[[], Truth | str],
        keys: list[SchemeKey],
        sweeps: Sequence[Sweep],
    ) -> Future[Companions]:
        """The companions of these schemes, each from whichever of two processes is free.

        They take longer than any engine, and the exact solution's process is soon idle. What that
        gives no answer for is left to the reference's own.
        """
        left, given_back = iter(keys), []  # one iterator for both: each takes the next scheme

        def step(name: str, schemes: Iterable[SchemeKey]) -> Companions:
            return case_companions(self.engines.drivers[name], case, truth(), schemes, sweeps)

        def assist() -> Companions:
            found: Companions = {}
            for key in left:
                own = step("exact", [key])
                if not own:
                    given_back.append(key)
                    break
                found |= own
            return found

        def finish() -> Companions:
            own = step("reference", left)
            return own | half.result() | step("reference", given_back)

        half = self.engines.submit("exact", assist)
        return self.engines.submit("reference", finish)

    def _add_companions(
        self, case: Case, truth: Truth, results: list[CaseResult], sweeps: list[Sweep]
    ) -> None:
        """Companions for schemes or steps that came up only when the engines had answered."""
        named = {scheme_key(i, case.system) for result in results for i in result.integrators}
        pending = []
        for sweep in sweeps:
            known = {key for key, step in truth.companions if step == sweep.timestep}
            missing = sorted((key for key in named if key and key not in known), key=str)
            if missing:  # an empty request, too, would wait for all that was submitted before
                call = self._submit_companions(case, lambda: truth, missing, [sweep])
                pending.append(call)
        for companions in pending:
            found: Companions = outcome_of(companions)
            truth.companions.update(found)

    def _examine(self, engine: Engine, pending: PendingCase) -> CaseResult:
        case, truth = pending.case, pending.truth.result()
        driver = self.engines.drivers[engine.name]
        if isinstance(truth, str):
            self.on_advance(tasks_of(engine, case))
            return CaseResult()
        evaluation_states = evaluation_states_of(case, truth, self.request.seed)
        if engine.name not in ("exact", "reference"):
            driver.prime(OTHERS)
        result = driver.evaluate_equations(case, evaluation_states)
        if engine.name == "exact":
            self.on_advance(1)
        elif engine.name == "reference":
            result.runs.update(reference_runs(driver, case, pending.companions.result()))
            self.on_advance(tasks_of(engine, case))
        else:
            result.runs.update(driver.run_all(case, lambda: self.on_advance(1)))
            request_until_raised(driver, case, result)
            probe_steps(driver, case, evaluation_states, result)
        if engine.name != "exact":
            request_again(driver, case, evaluation_states, result)
        return result

    def _submit_case(self, case: Case, keys: list[SchemeKey]) -> PendingCase:
        exact = self.engines.drivers["exact"]
        truth = self.engines.submit("exact", lambda: case_truth(exact, case))
        companions = self._submit_companions(case, truth.result, keys, case.sweeps)
        pending = PendingCase(case, truth, companions)
        for engine in self.engines.started:
            call = partial(self._examine, engine, pending)
            pending.results[engine.name] = self.engines.submit(engine.name, call)
        return pending

    def judge(self, pending: PendingCase, finer: dict[str, Refinements]) -> JudgedCase:
        """Wait for one case and send it through the gates. finer: refinements, by engine."""
        case, truth = pending.case, outcome_of(pending.truth)
        results = {name: outcome_of(future) for name, future in pending.results.items()}
        if isinstance(truth, str):
            unjudged = [EngineCase(e, results[e.name], [], []) for e in self.engines.started]
            return JudgedCase(case, None, truth, unjudged)
        companions = outcome_of(pending.companions)
        truth.companions.update(companions)
        refined = [
            sweep
            for own in finer.values()
            for runs in own.values()
            for sweep in runs
            if sweep.accuracy is None  # an accuracy has no companion
        ]
        unique = {sweep.timestep: sweep for sweep in (*case.sweeps, *refined)}
        self._add_companions(case, truth, list(results.values()), list(unique.values()))
        judged = [
            self._judge_engine(case, truth, e, results[e.name], finer.get(e.name, {}))
            for e in self.engines.started
        ]
        return JudgedCase(case, truth, "", judged)

    def _judge_engine(
        self, case: Case, truth: Truth, engine: Engine, result: CaseResult, finer: Refinements
    ) -> EngineCase:
        runs: list[JudgedRun] = []
        # A run that blew up is measured like any other: what overflows is infinitely far off.
        with np.errstate(over="ignore", invalid="ignore"):
            shared = shared_rows(case, evaluation_states_of(case, truth, self.request.seed), result)
            if engine.name != "exact":
                runs = judge_case(truth, case, result, finer)
        return EngineCase(engine, result, shared, runs)

    def _resolve(self, pending: PendingCase, judged: JudgedCase) -> JudgedCase:
        """Judge a case again with finer steps, as long as these can still decide something.

        Then with the axes of the world turned, where these can, and at states that are a few
        roundings off.
        """
        finer: dict[str, Refinements] = {}
        for _ in range(MOST_HALVINGS + MORE_OF_ONE):
            futures = []
            for found in judged.engines:
                name, driver = found.engine.name, self.engines.drivers[found.engine.name]
                known = finer.setdefault(name, {})
                if any(run.unresolved for run in found.runs):
                    call = partial(refine, driver, judged.case, found.runs, known)
                    futures.append(self.engines.submit(name, call))
            done = [outcome_of(future) for future in futures]
            if not any(done):
                break
            judged = self.judge(pending, finer)
        return self._with_more_requests(pending, judged, finer)

    def _with_more_requests(
        self, pending: PendingCase, judged: JudgedCase, finer: dict[str, Refinements]
    ) -> JudgedCase:
        """Judge a case again where the axes of the world, then an engine's own rounding can decide.

        See `errors.coordinates` and `own_rounding`.
        """
        case, truth = judged.case, judged.truth
        if truth is None:
            return judged

        def nudged(driver: Driver, case: Case, found: EngineCase) -> None:
            states = evaluation_states_of(case, truth, self.request.seed)
            request_nudged(driver, case, found, states)

        decided = ((axes_may_decide, request_turned), (rounding_may_decide, nudged))
        for may_decide, request in decided:
            futures = []
            for found in judged.engines:
                name = found.engine.name
                if may_decide(case, found):
                    call = partial(request, self.engines.drivers[name], case, found)
                    futures.append(self.engines.submit(name, call))
            for future in futures:
                outcome_of(future)
            judged = self.judge(pending, finer) if futures else judged
        return judged

    def run_case(self, case: Case) -> JudgedCase:
        """One case by itself; the workers are started before and finished after by the caller.

        A run whose scheme is not declared is compared with none. Where it fails, its cause may be
        sought in the difference from the nearest scheme: they are stepped when that is requested.
        """
        pending = self._submit_case(case, self._declared(case))
        judged = self._resolve(pending, self.judge(pending, {}))
        truth = judged.truth
        if truth is None:
            return judged
        return replace(judged, truth=replace(truth, step_schemes=self._schemes_of(judged, truth)))

    def _schemes_of(self, judged: JudgedCase, truth: Truth) -> StepSchemes:
        """Steps the schemes that a case's failing runs may equal. No verdict depends on them."""
        case = judged.case
        failing = [run.integrator for engine in judged.engines for run in engine.runs if run.fails]
        every = {key for one in failing for key in comparison_keys(one, case.system)}

        def step(sweep: Sweep, keys: Sequence[SchemeKey] | None) -> dict[SchemeKey, Companion]:
            wanted = sorted(every - truth.of_step(sweep).keys(), key=str) if keys is None else keys
            call = self._submit_companions(case, lambda: truth, list(wanted), [sweep])
            return {key: own for (key, _), own in outcome_of(call).items()}

        return step

    def execute(self) -> Outcome:
        """Run everything; Ctrl-C ends the workers and keeps what has come in."""
        judged: list[JudgedCase] = []
        interrupted, decided = False, 0
        pending: list[PendingCase] = []
        try:
            self.engines.start()
            self.on_start()
            pending = [self._submit_case(c, self._compared(c)) for c in self.request.cases]
            for case in pending:
                judged.append(self.judge(case, {}))
            for index, case in enumerate(pending):
                judged[index] = self._resolve(case, judged[index])
                decided = index + 1
        except KeyboardInterrupt:
            interrupted = True
            self.engines.stop()
            judged[decided:] = [_with_undecided(case) for case in judged[decided:]]
            judged += [self._leftover(case) for case in pending[len(judged) :]]
        except BaseException:
            self.engines.stop()
            raise
        finally:
            self.engines.finish()
        engines = self.engines
        return Outcome(engines.started, engines.missing, judged, interrupted, engines.deaths())

    def _leftover(self, pending: PendingCase) -> JudgedCase:
        """A case that the interruption caught: none of it is judged, and it states so."""
        engines = [EngineCase(engine, CaseResult(), [], []) for engine in self.engines.started]
        return JudgedCase(pending.case, None, INTERRUPTED.reason, engines)


def _with_undecided(case: JudgedCase) -> JudgedCase:
    """A case whose finer steps the interruption caught."""
    engines = [replace(one, runs=left_undecided(one.runs)) for one in case.engines]
    return replace(case, engines=engines)
