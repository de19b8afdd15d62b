"""The likeliest cause of what the gates found, as text.

``diagnose(case, truth, evaluation_states, result, runs) -> list[str]`` is a function of what the
harness has after judging one engine on one case: the `Case`, its `Truth` (with companions of the
schemes in question), the `EvaluationStates`, the `CaseResult` with the engine's own answers, and
the `JudgedRun` list of `judge_case`. Each sentence names a cause that was tried on those answers
and explains them within the gates' own bounds. `Causes` does so over all scenarios of a run: what
fits one scenario and is contradicted by another is not named.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from omegadot.diagnosis.equations.across import Across
from omegadot.diagnosis.equations.wrong_equation import (
    ALONG,
    FORWARD,
    RELOADED,
    equation_causes,
    inverse_causes,
    known_difference,
    scene_of,
)
from omegadot.diagnosis.models.wrong_model import lever_causes, model_causes
from omegadot.diagnosis.reported.requests import again_cause, batch_cause, kept_causes
from omegadot.diagnosis.runs import run_causes
from omegadot.diagnosis.stepping.follows import SAMPLES, Beginning, follows
from omegadot.diagnosis.stepping.vanishing_steps import (
    VanishingSteps,
    jump_cause,
    jumps,
    kinematic_cause,
    moves_by_cause,
    omega_share_cause,
    omega_still_cause,
    vanishing_steps,
)
from omegadot.diagnosis.wording.kinds import agreed, is_of_one_run
from omegadot.gates.bounds.scales import eps_of
from omegadot.gates.case import Case
from omegadot.gates.rows import Row
from omegadot.gates.states.equation import (
    EvaluationStates,
    evaluation_states_of,
)
from omegadot.gates.steps.accuracy import tolerated_by
from omegadot.gates.truth import Truth
from omegadot.harness import siblings
from omegadot.harness.drive import CaseResult
from omegadot.harness.judge import JudgedRun
from omegadot.harness.judge_engine import shared_rows
from omegadot.harness.outcome import Cause, CausesOf, EngineCase, JudgedCase
from omegadot.reference_impl.schemes import SCHEMES
from omegadot.reference_impl.system import State


class CaseCauses:
    """The causes of one engine's failures on one case, worked out when they are needed."""

    def __init__(
        self,
        across: Across,
        case: Case,
        truth: Truth,
        evaluation_states: EvaluationStates,
        result: CaseResult,
        shared: Sequence[Row],
        runs: Sequence[JudgedRun],
    ) -> None:
        self._across, self._case, self._states = across, case, evaluation_states
        self._result: CaseResult | None = result
        self._truth, self._runs = truth, list(runs)
        self._answers = replace(result, runs={}, first_steps={}, restarts={})
        self._steps = _steps_of(case, result)
        self._of_runs: dict[str, list[str]] = {}
        self._again = {one.integrator.name: "" for one in runs}
        for one in runs:
            self._again[one.integrator.name] = self._again[one.integrator.name] or again_cause(
                one.rows
            )
        self._followed: dict[tuple[str, tuple[str, ...]], bool | None] = {}
        self._beginnings = _beginnings_of(truth, result, runs)
        self._shared_rows = [row for row in shared if row.verdict == "fail"]
        scene = scene_of(case, evaluation_states, result)
        for name, steps in self._steps.items():
            scene.evidence[_source(name)] = steps.evidence
        across.add(scene)

    def release(self) -> None:
        """Work out what needs the trajectories, and let go of them."""
        failed = {r.integrator.name for r in self._runs if _fails(r)}
        for name in failed if not self._shared_rows else ():
            self._of_run(name)
        self._result, self._runs = None, []

    def sentences(self, integrator: str | None) -> list[str]:
        """The causes, the most basic first; of one integrator, or of what all runs share.

        A wrong model or equation is looked for first, and explains the runs after it: these are
        looked at by themselves only where neither gate failed.
        """
        with np.errstate(all="ignore"):  # a wrong engine may answer with any numbers
            if self._shared_rows:
                return self._shared()
            return [] if integrator is None else self._of_run(integrator)

    def text(self, run: JudgedRun | None) -> str:
        """The causes of one run, or of what all runs share, as one text."""
        return "; ".join(self.sentences(None if run is None else run.integrator.name))

    def _shared(self) -> list[str]:
        """Of the model, then of forward dynamics, then of inverse dynamics."""
        answers, states, across = self._answers, self._states, self._across
        failed = {(row.gate, row.metric) for row in self._shared_rows}
        model = (self._case, states, answers)
        if any(gate == "model" for gate, _ in failed):
            found = model_causes(across, *model) or kept_causes(states, answers)
            if found:
                return found
        alone = batch_cause(failed)
        if alone:
            return [alone]
        torques = any(row.channel == "torque" for row in self._shared_rows)
        for source, metric in ((FORWARD, "residual"), (ALONG, "residual_on_path")):
            rates = [r for r in self._shared_rows if r.metric == metric and r.channel != "torque"]
            if rates:
                found = equation_causes(across, self._case.name, source)
                named = found and not found[0].startswith("none is known")
                return found if named else lever_causes(*model) or found
        if ("equation", "residual_reloaded") in failed:
            found = equation_causes(across, self._case.name, RELOADED)
            return [f"{AFTER_ANOTHER}: {one}" for one in found] or [AFTER_ANOTHER]
        if ("equation", siblings.METRIC) in failed:
            return [AFTER_ANOTHER]
        if torques and answers.inverse.ok:
            torque = answers.inverse.result["torque"]
            eps = eps_of(answers.precision)
            known = (self._case.system, states.random, states.acceleration)
            return inverse_causes(*known, torque, eps)
        return lever_causes(*model)

    def _of_run(self, name: str) -> list[str]:
        """Of the steps as they vanish and of the run itself.

        What a declared scheme makes of a wrong state is known better by stepping again than by
        the steps as they vanish; a wrong equation is known better by these.
        """
        steps, declared = self._steps.get(name), self._declares(name)
        if self._again[name]:
            seen = self._of_trajectories(name)
            return [one for one in seen if is_of_one_run(one)] or [self._again[name]]
        found: list[str] = []
        if steps is not None and not steps.sound:
            common = steps.common_cause() or omega_share_cause(steps)
            found = [common] if common else []
            if not found and not declared and jumps(steps):
                found = _of_states(steps)
            if not found and not jumps(steps) and not steps.still:
                moved = moves_by_cause(steps)
                if moved.startswith("either"):  # which of two, a whole run may show
                    return self._of_trajectories(name) or [moved]
                found = [moved] if moved else self._of_equation(name, steps)
        if not found:
            found = self._of_trajectories(name)
            over = self._across.of_runs.get(name, {})
            found = [one for one in found if agreed(one, over)]
        if found or steps is None or steps.sound:
            return found
        return _of_states(steps) or ([] if steps.still else self._known(name))

    def _of_equation(self, name: str, steps: VanishingSteps) -> list[str]:
        """By which equation the limit of vanishing steps is another; nothing where it is right."""
        if np.all(steps.evidence.sound) or not steps.turns:
            return []
        where = (self._case.name, _source(name))
        text, one = self._across.cause(*where), self._across.chosen(*where)
        if not text:
            still = omega_still_cause(steps)
            return (self._of_trajectories(name) or [still]) if still else []
        begun = self._beginnings.get(name)
        if one is not None and begun is not None:
            key = (name, one.key)
            if key not in self._followed:
                self._followed[key] = follows(self._case.system, begun, one, steps.eps)
            followed = self._followed[key]
            if followed is False:
                return [f"in the first step of a run alone, {text}"]
        return [f"in the steps, {text}"]

    def _known(self, name: str) -> list[str]:
        """What is known of the steps' equation where nothing fits."""
        if np.all(self._steps[name].evidence.sound):
            return []
        known = known_difference(self._across, self._case.name, _source(name))
        return [f"in the steps, {one}" for one in known]

    def _declares(self, name: str) -> bool:
        return any(i.name == name and i.scheme in SCHEMES for i in self._answers.integrators)

    def _of_trajectories(self, name: str) -> list[str]:
        # In single precision much fits a run within its rounding, and little is told apart.
        if self._answers.precision == "float32":
            return []
        if name not in self._of_runs and self._result is not None:
            runs = [run for run in self._runs if run.integrator.name == name]
            self._of_runs[name] = run_causes(self._case, self._truth, self._result, runs)
            here = "; ".join(self._of_runs[name])
            self._across.of_runs.setdefault(name, {})[self._case.name] = here
        return self._of_runs.get(name, [])


AFTER_ANOTHER = "something of a system that was loaded before is left over"


def _source(integrator: str) -> str:
    return f"steps of {integrator}"


def _fails(run: JudgedRun) -> bool:
    return any(row.verdict == "fail" for row in run.rows)


def _steps_of(case: Case, result: CaseResult) -> dict[str, VanishingSteps]:
    tolerated = {one.name: tolerated_by(one) for one in result.integrators}
    return {
        name: vanishing_steps(
            case.system, probe, State(**answer.result), eps_of(result.precision), tolerated[name]
        )
        for name, (probe, answer) in result.first_steps.items()
        if answer.ok
    }


def _of_states(steps: VanishingSteps) -> list[str]:
    """What steps do to states, however short they are."""
    found = jump_cause(steps) or kinematic_cause(steps)
    return [found] if found else []


def _beginnings_of(
    truth: Truth, result: CaseResult, runs: Sequence[JudgedRun]
) -> dict[str, Beginning]:
    """The first samples of every failed integrator's run with the shortest steps."""
    found = dict[str, Beginning]()
    for run in sorted(runs, key=lambda run: -run.sweep.timestep):
        answer = result.runs.get((run.integrator.name, run.sweep.knob))
        if not _fails(run) or answer is None or not answer.ok:
            continue
        times, state = run.sweep.times, State(**answer.result["state"])
        if len(state.position) == len(times):
            first = slice(0, SAMPLES + 1)
            parts = (times[first], state[first], truth.at(run.sweep)[first])
            found[run.integrator.name] = Beginning(*parts)
    return found


class Causes:
    """Causes over the scenarios of a run, of which each engine's are kept in small arrays."""

    def __init__(self) -> None:
        self._engines: dict[str, Across] = {}

    def of_case(self, judged: JudgedCase, found: EngineCase, seed: int) -> CaseCauses:
        """One more case of an engine. It must have an exact trajectory."""
        assert judged.truth is not None
        across = self._engines.setdefault(found.engine.name, Across())
        states = evaluation_states_of(judged.case, judged.truth, seed)
        with np.errstate(all="ignore"):
            return CaseCauses(
                across, judged.case, judged.truth, states, found.result, found.shared, found.runs
            )


def causes_over(cases: Sequence[JudgedCase], seed: int) -> CausesOf:
    """The causes of every engine on every case of a run, each held against all of its cases.

    An engine's cases are looked at when its first failure is.
    """
    kept: dict[str, dict[str, CaseCauses]] = {}

    def of_engine(name: str) -> dict[str, CaseCauses]:
        causes = Causes()
        return {
            judged.case.name: causes.of_case(judged, found, seed)
            for judged in cases
            for found in judged.engines
            if judged.truth is not None and found.engine.name == name
        }

    def causes_of_case(judged: JudgedCase, found: EngineCase) -> Cause:
        def cause(run: JudgedRun | None) -> str:
            name = found.engine.name
            if name not in kept:
                kept[name] = of_engine(name)
            return kept[name][judged.case.name].text(run)

        return cause

    return causes_of_case


def diagnose(
    case: Case,
    truth: Truth,
    evaluation_states: EvaluationStates,
    result: CaseResult,
    runs: Sequence[JudgedRun],
) -> list[str]:
    """Sentences that explain the failed gates of one case; none without failure."""
    shared = shared_rows(case, evaluation_states, result)
    causes = CaseCauses(Across(), case, truth, evaluation_states, result, shared, runs)
    found = causes.sentences(None)
    names = dict.fromkeys(run.integrator.name for run in _by_length(runs) if _fails(run))
    for name in names if not found else ():
        found = causes.sentences(name)
        if found:
            break
    return list(dict.fromkeys(found))


def _by_length(runs: Sequence[JudgedRun]) -> list[JudgedRun]:
    return sorted(runs, key=lambda run: run.sweep.steps)
