"""The causes of one engine's failures on one case: model, equation, inverse dynamics, runs."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from omegadot.adapters.protocol import Integrator
from omegadot.diagnosis.defect import kept_apart
from omegadot.diagnosis.equations.evidence import FORWARD
from omegadot.diagnosis.equations.wrong_equation import scene_of
from omegadot.diagnosis.experiments.conditioned import UNKNOWN, condition_in
from omegadot.diagnosis.experiments.subject import Subject
from omegadot.diagnosis.integrator import IntegratorCauses
from omegadot.diagnosis.kept_case import opposite_steps, source_of
from omegadot.diagnosis.models.attitudes_read import IN_RUNS, in_both
from omegadot.diagnosis.models.misread_state import misreading_in
from omegadot.diagnosis.over_scenarios import EngineOverScenarios
from omegadot.diagnosis.shared_causes import SharedCauses
from omegadot.diagnosis.stepping.vanishing.kinematics import kinematic_causes, moves_by_cause
from omegadot.diagnosis.stepping.vanishing.vanishing_steps import VanishingSteps
from omegadot.diagnosis.wording.kinds import is_named
from omegadot.gates.bounds.scales import eps_of
from omegadot.gates.case import Case
from omegadot.gates.rows import Row
from omegadot.gates.states.equation import EvaluationStates
from omegadot.gates.truth import Truth
from omegadot.harness.drive import CaseResult
from omegadot.harness.judging.judged_run import JudgedRun


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
        self._answers = replace(result, runs={}, first_steps={}, restarts={})
        by_name: dict[str, list[JudgedRun]] = {}
        for run in runs:
            by_name.setdefault(run.integrator.name, []).append(run)
        self._integrators = {
            name: IntegratorCauses(engine, case, truth, result, own)
            for name, own in by_name.items()
        }
        self._defects: list[str] = []  # of the search, which costs no verdict
        self._failing = {run.integrator.name for run in runs if run.fails}
        self._shared_rows = [row for row in shared if row.verdict == "fail"]
        # Inverse dynamics are no part of a run, which then has causes of its own.
        self._explains_runs = any(row.channel != "torque" for row in self._shared_rows)
        scene = scene_of(case, evaluation_states, result)
        for name, integrator in self._integrators.items():
            if integrator.steps is not None:
                scene.evidence[source_of(name)] = integrator.steps.evidence
                scene.limits.append((integrator.steps.states, integrator.steps.limit))
                scene.opposites[source_of(name)] = [*opposite_steps(case, result, name)]
        engine.across.add(scene)
        engine.siblings.add(scene, case, result)
        about = (engine, case, evaluation_states, self._answers, self._shared_rows)
        self._shared = SharedCauses(*about, self._integrators)

    def release(self) -> None:
        """Work out what needs the trajectories, and let go of them."""
        for one in self._integrators.values():
            with np.errstate(all="ignore"), kept_apart(self._defects):
                one.release(wanted=not self._explains_runs)
            one.let_go()

    def sentences(self, integrator: str | None) -> list[str]:
        """The causes, the most basic first; of one integrator, or of what all runs share.

        A wrong model or equation is looked for first, and explains the runs after it: these are
        looked at by themselves only where neither gate failed.
        """
        defects, found = list(self._defects), list[str]()
        with np.errstate(all="ignore"), kept_apart(defects):
            own = None if integrator is None else self._integrators[integrator]
            found = own.sentences() if own is not None and not self._explains_runs else []
            found = found or self._shared.sentences()
            if any(text.startswith(IN_RUNS) for text in found):
                found = [in_both(text, self._across.attitudes_read()) for text in found]
        return found or defects[-1:]

    def subject(self, integrator: str | None, text: str) -> Subject | None:
        """What the cause that `sentences` names is about; None where no condition is looked for."""
        own = None if integrator is None else self._integrators[integrator]
        if own is not None and not self._explains_runs:
            return self._of_steps(own, text)
        failed = {(row.gate, row.metric) for row in self._shared_rows}
        if {gate for gate, _ in failed} == {"model"}:
            unknown = text.startswith(UNKNOWN) or bool(condition_in(text))
            if failed != {("model", "state")} or not unknown:
                return None
            misread = misreading_in(text, self._case.system)
            return Subject(of_states=True, misreading=misread)
        if ("equation", "residual") not in failed or any(gate == "model" for gate, _ in failed):
            return None
        if FORWARD not in self._across.scenes[self._case.name].evidence:
            return None  # the residual is of inverse dynamics
        one = self._across.acting(self._case.name, FORWARD)
        return Subject(one) if one is not None or text.startswith(UNKNOWN) else None

    def _of_steps(self, own: IntegratorCauses, text: str) -> Subject | None:
        """Of the steps as they vanish, or of longer ones where these are right, or all wrong."""
        steps, unknown = own.steps, text.startswith(UNKNOWN)
        if steps is None:
            return None
        if steps.sound:
            return (
                Subject(integrator=own.integrator, by_length=True) if not is_named(text) else None
            )
        where = (self._case.name, source_of(own.integrator.name))
        one = self._across.acting(*where)
        if one is not None and self._across.cause(*where) in text:
            return Subject(one, own.integrator)
        moves = text in (moves_by_cause(steps), *kinematic_causes(steps))
        return Subject(None, own.integrator, text=text * moves) if moves or unknown else None

    @property
    def of_forward_dynamics(self) -> bool:
        """Whether answers of forward dynamics fail, and the body and states are right."""
        failed = {row.gate for row in self._shared_rows}
        known = FORWARD in self._across.scenes[self._case.name].evidence
        channels = {row.channel for row in self._shared_rows}
        return failed == {"equation"} and known and channels != {"torque"}

    def of_answers(self, integrator: str | None) -> bool:
        """Whether answers at states fail, which explain the runs, and body and states are right."""
        failed = {row.gate for row in self._shared_rows} == {"equation"}
        return failed and (integrator is None or self._explains_runs)

    @property
    def of_torques(self) -> bool:
        """Whether those of inverse dynamics alone do."""
        return {row.channel for row in self._shared_rows} == {"torque"}

    @property
    def case(self) -> Case:
        """The case."""
        return self._case

    @property
    def states(self) -> EvaluationStates:
        """The states that were evaluated."""
        return self._states

    @property
    def integrators(self) -> list[Integrator]:
        """Those that have run."""
        return [one.integrator for one in self._integrators.values()]

    @property
    def eps(self) -> float:
        """Of the engine's precision."""
        return eps_of(self._answers.precision)

    def steps_of(self, integrator: str) -> VanishingSteps | None:
        """The steps of an integrator as they vanish; None without any."""
        own = self._integrators.get(integrator)
        return None if own is None else own.steps

    def fails(self, integrator: str | None) -> bool:
        """Whether a run of the integrator fails, or what all runs share."""
        return bool(self._shared_rows) if integrator is None else integrator in self._failing

    def steps_follow(self, integrator: str, text: str) -> bool:
        """Whether the cause of an integrator's runs on another scenario makes those here."""
        own = self._integrators.get(integrator)
        return own is not None and not self._explains_runs and own.follows(text)

    def siblings_follow(self, name: str) -> bool:
        """Whether the cause on another scenario makes what fails here, of siblings alone."""
        return self._shared.siblings_follow(name)

    def outgrown(self, integrator: str, name: str) -> bool:
        """Whether the cause on another scenario makes the runs here, and outgrows their steps."""
        return not self._explains_runs and self._integrators[integrator].outgrown(name)
