"""A selection's checks: generated when the engines have started, judged scenario by scenario."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Mapping
from dataclasses import replace
from functools import partial
from pathlib import Path

from omegadot.commands.check.baseline import answered, figures_of, updated
from omegadot.commands.check.baseline_file import ScenarioFigures, read_baseline, write_baseline
from omegadot.commands.check.compare import GATE as BASELINE
from omegadot.commands.check.compare import baseline_checks, compare
from omegadot.commands.check.exceptions import matches_nothing, unmatched, with_exceptions
from omegadot.commands.check.judge import results_of
from omegadot.commands.check.result import (
    GATES_OF_A_RUN,
    GATES_OF_A_SCENARIO,
    Check,
    Registry,
    Result,
    checks_of,
    error,
    skipped,
    subject_of,
)
from omegadot.commands.check.select import Selection
from omegadot.diagnosis.diagnose import Causes
from omegadot.diagnosis.experiments.subject import Conditions
from omegadot.gates.case import Case
from omegadot.harness.drive import Driver
from omegadot.harness.engines import outcome_of
from omegadot.harness.outcome import RunRequest
from omegadot.harness.runner import Runner

START, EXCEPTIONS = "start", "exceptions"
SEED = 0


class Suite:
    """The checks of a selection and their results; each scenario is run once, when first requested.

    registry: what the engines reported when they started; given where another process has started
    them before, so that all who share the work have the same checks.
    """

    def __init__(self, selection: Selection, registry: Registry | None = None) -> None:
        self.selection = selection
        self._runner: Runner | None = None
        self.registry = registry or self._start()
        # By either name: an engine whose bodies go in by a file has another.
        given = selection.arguments.required
        own = {c.name for c in selection.choices if c.engine in given}
        self._required = {*given, *own}
        # Engines that did not start: outcome and reason.
        text = "no engine of this name is known; install the package that announces it"
        unknown = dict.fromkeys(selection.unknown, ("not-installed", text))
        self._absent = {**self.registry.missing, **unknown}
        subjects, folder, cases = self.registry.subjects, selection.baseline, selection.cases
        self._versions = {s.name: s.version for s in subjects}
        self._stored = {s.name: read_baseline(folder, s.name) if folder else None for s in subjects}
        self._unmatched = {
            s.name: unmatched(selection.exceptions, s, cases, self._stored[s.name])
            for s in subjects
        }
        self.checks: list[Check] = self._generate()
        self._results: dict[Check, Result] = {}
        self._causes = Causes()
        self.figures: dict[str, dict[str, ScenarioFigures]] = {}

    def _start(self) -> Registry:
        chosen = self.selection
        timeout, jobs = chosen.arguments.timeout, chosen.jobs
        request = RunRequest(chosen.cases, chosen.choices, seed=SEED, timeout=timeout, jobs=jobs)
        runner = Runner(request)
        try:
            runner.engines.start()
        except BaseException:
            runner.engines.stop()
            runner.engines.finish()
            raise
        self._runner = runner
        missing = {c.name: (a.outcome, a.reason) for c, a in runner.engines.missing}
        return Registry(tuple(map(subject_of, runner.engines.started)), missing)

    def store(self) -> list[Path]:
        """The files written, where baselines are to be updated: of every engine with figures."""
        folder, written = self.selection.baseline, list[Path]()
        if folder is None or not self.selection.arguments.update:
            return written
        for subject in self.registry.subjects:
            if subject.name in self.figures:
                stored = read_baseline(folder, subject.name)
                whole = updated(stored, self.figures[subject.name], subject)
                written.append(write_baseline(folder, subject.name, whole))
        return written

    def settled(self, results: Mapping[Check, Result]) -> dict[Check, Result]:
        """The results with causes that hold on all scenarios, on conditions found by experiment.

        Every scenario has been run. Requests are made of engines only where a check fails.
        """
        self._causes.ask = self._ask
        return {one: result.settled for one, result in results.items()}

    @property
    def lost(self) -> tuple[str, ...]:
        """A sentence for each engine that crashed or timed out as causes were looked for."""
        return tuple(
            f"{name} gave no answer in an experiment on a cause, the last that was made: {how}."
            for name, how in self._causes.lost.items()
        )

    def _ask(self, engine: str, call: Callable[[Driver], Conditions]) -> Conditions:
        """A call with an engine's driver, on the engine's own thread."""
        if self._runner is None:
            self._start()
        assert self._runner is not None
        engines = self._runner.engines
        try:
            return outcome_of(engines.submit(engine, partial(call, engines.drivers[engine])))
        except BaseException:
            engines.stop()  # no one waits for what it is busy with
            raise

    def finish(self) -> None:
        """End the workers; they are started again if another result is requested."""
        if self._runner is not None:
            self._runner.engines.finish()
            self._runner = None

    def _generate(self) -> list[Check]:
        names = [*(choice.name for choice in self.selection.choices), *self.selection.unknown]
        found = [Check(name, "", START) for name in names if name in self._absent]
        found += [Check(name, "", EXCEPTIONS) for name, left in self._unmatched.items() if left]
        comparing = self.selection.baseline and not self.selection.arguments.update
        for case in self.selection.cases:
            found += checks_of(self.registry.subjects, [case])
            compared = comparing and case.name not in self.selection.drawn
            for subject in self.registry.subjects if compared else ():
                found += baseline_checks(subject, [case], self._stored[subject.name])
        return found

    def result_of(self, check: Check) -> Result:
        """The result of one of the checks, from the one run of its scenario."""
        if check.gate == START:
            outcome, reason = self._absent[check.engine]
            required = check.engine in self._required
            if outcome in ("not-installed", "unsupported") and not required:
                return skipped(f"{outcome}: {reason}")
            return error(outcome, reason)
        if check.gate == EXCEPTIONS:
            return Result("fail", " ".join(map(matches_nothing, self._unmatched[check.engine])))
        if check not in self._results:
            self._run(next(c for c in self.selection.cases if c.name == check.scenario))
        return self._excused(check)

    def _excused(self, check: Check) -> Result:
        """The result of a scenario's check, with the exceptions that are declared."""
        case = next(c for c in self.selection.cases if c.name == check.scenario)
        known = self.selection.exceptions
        return with_exceptions(check, self._results[check], known, case.scenario)

    def _run(self, case: Case) -> None:
        """Run one scenario on every engine; keep its checks' results, not the trajectories."""
        if self._runner is None:
            self._start()
        assert self._runner is not None
        with warnings.catch_warnings():
            # An engine that diverges overflows on its way; the gates state so.
            warnings.simplefilter("ignore", RuntimeWarning)
            try:
                judged = self._runner.run_case(case)
            except BaseException:
                self._runner.engines.stop()  # no one waits for what they are busy with
                raise
            for found in judged.engines:
                if judged.truth is not None:
                    causes = self._causes.add(judged, found, SEED)
                    drawn = case.name in self.selection.drawn
                    cause = partial(self._causes.text, found.engine.name, case.name)
                    results = results_of(judged, found, cause, drawn=drawn)
                    self._results |= dict(results)
                    causes.release()
                kept = judged.truth is not None and case.name not in self.selection.drawn
                if kept and answered(found):
                    self.figures.setdefault(found.engine.name, {})[case.name] = figures_of(found)
        lost = error("raised", judged.reason or "the engine gave no answer")
        for check in self.checks:
            if check.scenario == case.name and check.gate == BASELINE:
                now = self.figures.get(check.engine, {}).get(check.scenario)
                stored, version = self._stored[check.engine], self._versions[check.engine]
                failing = self._failing_beside(check)
                self._results[check] = compare(check, stored, now, version, failing)
            elif check.scenario == case.name:
                self._results.setdefault(check, lost)

    def _failing_beside(self, check: Check) -> list[str]:
        """The gates that the run, or the scenario, of a baseline's check fails."""
        found = []
        for gate in (*GATES_OF_A_SCENARIO, *GATES_OF_A_RUN):
            own = replace(check, gate=gate)
            if own in self._results:
                found += [gate] if self._excused(own).verdict == "fail" else []
        return found
