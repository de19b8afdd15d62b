"""The causes of one engine's failures on one case: model, equation, inverse dynamics, runs."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from omegadot.diagnosis.equations.evidence import ALONG, FORWARD, INVERSE, INVERTED
from omegadot.diagnosis.equations.siblings import AFTER_ANOTHER
from omegadot.diagnosis.equations.wrong_equation import (
    RELOADED,
    equation_causes,
    inverse_causes,
    is_of_a_load,
    scene_of,
)
from omegadot.diagnosis.integrator import IntegratorCauses
from omegadot.diagnosis.kept_case import opposite_steps, source_of
from omegadot.diagnosis.models.wrong_model import lever_causes, model_causes
from omegadot.diagnosis.over_scenarios import EngineOverScenarios
from omegadot.diagnosis.reported.requests import batch_cause, kept_causes
from omegadot.gates.bounds.scales import eps_of
from omegadot.gates.case import Case
from omegadot.gates.rows import Row
from omegadot.gates.states.equation import (
    EvaluationStates,
)
from omegadot.gates.truth import Truth
from omegadot.harness.drive import CaseResult
from omegadot.harness.judging.judged_run import JudgedRun
from omegadot.harness.requests import siblings

OF_RATES = ((FORWARD, "residual"), (ALONG, "residual_on_path"))


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
        self._failing = {run.integrator.name for run in runs if run.fails}
        self._shared_rows = [row for row in shared if row.verdict == "fail"]
        # Inverse dynamics are no part of a run, which then has causes of its own.
        self._explains_runs = any(row.channel != "torque" for row in self._shared_rows)
        scene = scene_of(case, evaluation_states, result)
        for name, integrator in self._integrators.items():
            if integrator.steps is not None:
                scene.evidence[source_of(name)] = integrator.steps.evidence
                scene.opposites[source_of(name)] = [*opposite_steps(case, result, name)]
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

    def fails(self, integrator: str | None) -> bool:
        """Whether a run of the integrator fails, or what all runs share."""
        return bool(self._shared_rows) if integrator is None else integrator in self._failing

    def _shared(self) -> list[str]:
        """Of the model, then of forward dynamics, then of inverse dynamics."""
        answers, states, across = self._answers, self._states, self._across
        failed = {(row.gate, row.metric) for row in self._shared_rows}
        model = (self._case, states, answers)
        if any(gate == "model" for gate, _ in failed):
            found = model_causes(across, *model) or kept_causes(states, answers)
            # Of a place that is off by a few digits, the equation states by how much, and of what.
            equation = {("equation", metric) for _, metric in OF_RATES}
            found = found or lever_causes(across, *model, numbers=not equation & failed)
            if found:
                return found
        alone = batch_cause(failed)
        if alone:
            return [alone]
        torques = any(row.channel == "torque" for row in self._shared_rows)
        for source, metric in OF_RATES:
            rates = [r for r in self._shared_rows if r.metric == metric and r.channel != "torque"]
            if rates:
                found = equation_causes(across, self._case.name, source)
                if not found or found[0].startswith("none is known"):
                    return lever_causes(across, *model) or found
                steps = [one.steps for one in self._integrators.values()]
                right = bool(steps) and all(one is not None and one.sound for one in steps)
                failing = (one.fails.values() for one in self._over.values())
                right = right and not any(map(any, failing))  # on any scenario of the run
                return [f"{one}{ALONE * right}" for one in found]
        if ("equation", "residual_reloaded") in failed:
            kept = across.left_over(self._case.name, RELOADED)
            if kept:
                return [kept]
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
            found = inverse_causes(*known, torque, eps) or ([formula] if formula else [])
            term = "" if found else across.cause(self._case.name, INVERTED)
            return [f"in inverse dynamics, {term}"] if term else found
        return lever_causes(across, *model)

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
