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

from omegadot.diagnosis.equations.evidence import INVERSE
from omegadot.diagnosis.equations.siblings import AFTER_ANOTHER
from omegadot.diagnosis.equations.wrong_equation import (
    ALONG,
    FORWARD,
    RELOADED,
    equation_causes,
    inverse_causes,
    is_of_a_load,
    scene_of,
)
from omegadot.diagnosis.integrator import IntegratorCauses
from omegadot.diagnosis.kept_case import source_of
from omegadot.diagnosis.models.wrong_model import lever_causes, model_causes
from omegadot.diagnosis.over_scenarios import EngineOverScenarios
from omegadot.diagnosis.reported.requests import batch_cause, kept_causes
from omegadot.gates.bounds.scales import eps_of
from omegadot.gates.case import Case
from omegadot.gates.rows import Row
from omegadot.gates.states.equation import (
    EvaluationStates,
    evaluation_states_of,
)
from omegadot.gates.truth import Truth
from omegadot.harness.drive import CaseResult
from omegadot.harness.judging.engine import shared_rows
from omegadot.harness.judging.judged_run import JudgedRun
from omegadot.harness.outcome import Cause, CausesOf, EngineCase, JudgedCase
from omegadot.harness.requests import siblings


class CaseCauses:
    """The causes of one engine's failures on one case, worked out when they are needed."""

    def __init__(
        self,
        engine: EngineOverScenarios,
        case: Case,
        truth: Truth,
        evaluation_states: EvaluationStates,
        result: CaseResult,
        shared: Sequence[Row],
        runs: Sequence[JudgedRun],
    ) -> None:
        self._across, self._case, self._states = engine.across, case, evaluation_states
        self._over = engine.integrators
        self._answers = replace(result, runs={}, first_steps={}, restarts={})
        by_name: dict[str, list[JudgedRun]] = {}
        for run in runs:
            by_name.setdefault(run.integrator.name, []).append(run)
        self._integrators = {
            name: IntegratorCauses(engine, case, truth, result, own)
            for name, own in by_name.items()
        }
        self._shared_rows = [row for row in shared if row.verdict == "fail"]
        # Inverse dynamics are no part of a run, which then has causes of its own.
        self._explains_runs = any(row.channel != "torque" for row in self._shared_rows)
        scene = scene_of(case, evaluation_states, result)
        for name, integrator in self._integrators.items():
            if integrator.steps is not None:
                scene.evidence[source_of(name)] = integrator.steps.evidence
        engine.across.add(scene)
        self._siblings = engine.siblings
        engine.siblings.add(scene, case, result)

    def release(self) -> None:
        """Work out what needs the trajectories, and let go of them."""
        with np.errstate(all="ignore"):
            for one in self._integrators.values():
                one.release(wanted=not self._explains_runs)

    def sentences(self, integrator: str | None) -> list[str]:
        """The causes, the most basic first; of one integrator, or of what all runs share.

        A wrong model or equation is looked for first, and explains the runs after it: these are
        looked at by themselves only where neither gate failed.
        """
        with np.errstate(all="ignore"):  # a wrong engine may answer with any numbers
            own = None if integrator is None else self._integrators[integrator]
            found = own.sentences() if own is not None and not self._explains_runs else []
            return found or (self._shared() if self._shared_rows else [])

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
                if not found or found[0].startswith("none is known"):
                    return lever_causes(*model) or found
                steps = [one.steps for one in self._integrators.values()]
                right = bool(steps) and all(one is not None and one.sound for one in steps)
                failing = (one.fails.values() for one in self._over.values())
                right = right and not any(map(any, failing))  # on any scenario of the run
                return [f"{one}{ALONE * right}" for one in found]
        if ("equation", "residual_reloaded") in failed:
            found = equation_causes(across, self._case.name, RELOADED)
            return [f"{AFTER_ANOTHER}: {one}" for one in found] or [AFTER_ANOTHER]
        if ("equation", siblings.METRIC) in failed:
            # Where a first system is wrong elsewhere, the sibling may be so by itself.
            first = (scene.evidence.get(FORWARD) for scene in across.scenes.values())
            wrong = any(one is not None and one.clear for one in first)
            return [] if wrong else self._siblings.causes(self._case)
        if torques and answers.inverse.ok:
            same = self._of_steps_as_well()
            if same:
                return [same]
            torque = answers.inverse.result["torque"]
            eps = eps_of(answers.precision)
            known = (self._case.system, states.random, states.acceleration)
            formula = across.of_inverse_dynamics(self._case.name)
            return inverse_causes(*known, torque, eps) or ([formula] if formula else [])
        return lever_causes(*model)

    def _of_steps_as_well(self) -> str:
        """A load that is wrong in the steps, and by as much in inverse dynamics; "" without any."""
        scene = self._across.scenes[self._case.name]
        for name, integrator in self._integrators.items():
            if integrator.steps is None or integrator.steps.sound:
                continue
            where = (scene.name, source_of(name))
            text, one = self._across.cause(*where), self._across.chosen(*where)
            if one is not None and is_of_a_load(one, scene.evidence[INVERSE]):
                return f"in the steps and in inverse dynamics, {text}"
        return ""


ALONE = ", in forward dynamics alone: steps are right"


class Causes:
    """Causes over the scenarios of a run, of which each engine's are kept in small arrays."""

    def __init__(self) -> None:
        self._engines: dict[str, EngineOverScenarios] = {}

    def of_case(self, judged: JudgedCase, found: EngineCase, seed: int) -> CaseCauses:
        """One more case of an engine. It must have an exact trajectory."""
        assert judged.truth is not None
        engine = self._engines.setdefault(found.engine.name, EngineOverScenarios())
        states = evaluation_states_of(judged.case, judged.truth, seed)
        with np.errstate(all="ignore"):
            return CaseCauses(
                engine, judged.case, judged.truth, states, found.result, found.shared, found.runs
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
    causes = CaseCauses(EngineOverScenarios(), case, truth, evaluation_states, result, shared, runs)
    found = causes.sentences(None)
    names = dict.fromkeys(run.integrator.name for run in _by_length(runs) if run.fails)
    for name in names if not found else ():
        found = causes.sentences(name)
        if found:
            break
    return list(dict.fromkeys(found))


def _by_length(runs: Sequence[JudgedRun]) -> list[JudgedRun]:
    return sorted(runs, key=lambda run: run.sweep.steps)
