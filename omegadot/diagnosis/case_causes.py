"""The causes of one engine's failures on one case: model, equation, inverse dynamics, runs."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from omegadot.adapters.protocol import Integrator
from omegadot.diagnosis.defect import kept_apart
from omegadot.diagnosis.equations.evidence import ALONG, FORWARD, INVERSE, INVERTED
from omegadot.diagnosis.equations.siblings import AFTER_ANOTHER
from omegadot.diagnosis.equations.wrong_equation import (
    RELOADED,
    equation_causes,
    is_of_a_load,
    scene_of,
)
from omegadot.diagnosis.experiments.conditioned import UNKNOWN, condition_in
from omegadot.diagnosis.experiments.subject import Subject
from omegadot.diagnosis.integrator import IntegratorCauses
from omegadot.diagnosis.kept_case import opposite_steps, source_of
from omegadot.diagnosis.models.attitudes_read import IN_BOTH, IN_RUNS, in_both
from omegadot.diagnosis.models.misread_state import SET_OR_READ, known_state, misreading_in
from omegadot.diagnosis.models.wrong_lever import lever_causes
from omegadot.diagnosis.models.wrong_model import model_causes
from omegadot.diagnosis.over_scenarios import EngineOverScenarios
from omegadot.diagnosis.reported.requests import batch_cause, kept_causes
from omegadot.diagnosis.run_rules import READ
from omegadot.diagnosis.stepping.vanishing.kinematics import kinematic_causes, moves_by_cause
from omegadot.diagnosis.stepping.vanishing.vanishing_steps import VanishingSteps
from omegadot.diagnosis.wording.kinds import is_named
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

OF_BODY = {("model", metric) for metric in ("mass", "center_of_mass", "inertia")}
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
        self._siblings = engine.siblings
        engine.siblings.add(scene, case, result)

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
            found = found or (self._shared() if self._shared_rows else [])
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
        failed = {(row.gate, row.metric) for row in self._shared_rows}
        one = self._across.chosen(name, FORWARD) if self._has(name, FORWARD) else None
        alone = failed == {("equation", siblings.METRIC)}
        return alone and one is not None and self._siblings.follow(self._case, one)

    def outgrown(self, integrator: str, name: str) -> bool:
        """Whether the cause on another scenario makes the runs here, and outgrows their steps."""
        return not self._explains_runs and self._integrators[integrator].outgrown(name)

    def _has(self, name: str, source: str) -> bool:
        return source in self._across.scenes[name].evidence

    def _shared(self) -> list[str]:
        """Of the model, then of forward dynamics, then of inverse dynamics."""
        failed = {(row.gate, row.metric) for row in self._shared_rows}
        found = self._of_model(failed) if any(gate == "model" for gate, _ in failed) else []
        found = found or self._of_answers(failed)
        if not found and failed == {("model", "state")} and self._attitude_alone:
            found = self._of_attitudes_read()
        if not found and ("model", "state") in failed:
            eps = eps_of(self._answers.precision)
            found = [text for text in (known_state(self._across, self._case, eps),) if text]
        return found

    def _of_attitudes_read(self) -> list[str]:
        """The convention by which attitudes are read back, and whether samples of runs have it."""
        text = self._across.attitudes_read()
        known = ((self._over[name], one.integrator) for name, one in self._integrators.items())
        rules = [over.runs.rule(READ, how) for over, how in known]
        shown = any(one is not None and one.statement == f"{IN_RUNS}{text}" for one in rules)
        return [f"{IN_BOTH}{text}" if shown else f"{text}, {SET_OR_READ}"] if text else []

    @property
    def _attitude_alone(self) -> bool:
        """Whether of the state nothing but the attitude, and a pivoted body's place, is off."""
        follow = {"position", "linear_momentum"} if self._case.system.load.pivot is not None else {}
        channels = {row.channel for row in self._shared_rows}
        return "attitude" in channels and channels <= {"attitude", *follow}

    def _of_answers(self, failed: set[tuple[str, str]]) -> list[str]:
        """Of forward dynamics, then of inverse dynamics. failed: gates and metrics."""
        alone = batch_cause(failed)
        if alone:
            return [alone]
        for source, metric in OF_RATES:
            rates = [r for r in self._shared_rows if r.metric == metric and r.channel != "torque"]
            if rates:
                return self._of_rates(source)
        if ("equation", "residual_reloaded") in failed:
            return self._of_reloaded()
        if ("equation", siblings.METRIC) in failed:
            # Where a first system is wrong elsewhere, the sibling may be so by itself.
            first = (scene.evidence.get(FORWARD) for scene in self._across.scenes.values())
            wrong = any(one is not None and one.clear for one in first)
            if wrong:
                kept = self._siblings.left_over(self._case)
                return [kept] if kept else []
            return self._siblings.causes(self._case)
        if self._answers.inverse.ok and any(row.channel == "torque" for row in self._shared_rows):
            return self._of_torques()
        return self._of_lever()

    def _of_model(self, failed: set[tuple[str, str]]) -> list[str]:
        """Of what reads back. failed: gates and metrics."""
        rates = {("equation", metric) for _, metric in OF_RATES} & failed
        kept = self._kept() if rates else ""
        if kept:
            return [kept]
        lever = self._of_lever(numbers=False) if rates and not failed & OF_BODY else []
        if lever:  # a place from another point is a place alone
            return lever
        found = model_causes(self._across, self._case, self._states, self._answers)
        found = found or kept_causes(self._states, self._answers)
        # Of a place that is off by a few digits, the equation states by how much, and of what.
        return found or self._of_lever(numbers=not rates)

    def _kept(self) -> str:
        """What of a system that was loaded before makes the answers of this one; "" without any."""
        name = self._case.name
        return self._across.left_over(name, FORWARD) if self._has(name, FORWARD) else ""

    def _of_lever(self, numbers: bool = True) -> list[str]:
        how = (self._across, self._case, self._states, self._answers)
        return lever_causes(*how, numbers=numbers)

    def _of_rates(self, source: str) -> list[str]:
        """Of forward dynamics; said to be of these alone where the steps of every scenario hold."""
        found = equation_causes(self._across, self._case.name, source)
        if not found or found[0].startswith("none is known"):
            return self._of_lever() or found
        steps = [one.steps for one in self._integrators.values()]
        right = bool(steps) and all(one is not None and one.sound for one in steps)
        failing = (one.fails.values() for one in self._over.values())
        right = right and not any(map(any, failing))
        return [one if any(x in one for x in AT_SOME) else f"{one}{ALONE * right}" for one in found]

    def _of_reloaded(self) -> list[str]:
        """Of a system that was loaded after another."""
        kept = self._across.left_over(self._case.name, RELOADED)
        if kept:
            return [kept]
        found = equation_causes(self._across, self._case.name, RELOADED)
        return [f"{AFTER_ANOTHER}: {one}" for one in found] or [AFTER_ANOTHER]

    def _of_torques(self) -> list[str]:
        """Of inverse dynamics: by themselves, as in the steps, or as a wrong term would make it."""
        name, torque = self._case.name, self._answers.inverse.result["torque"]
        if INVERSE not in self._across.scenes[name].evidence:
            lost = int(np.count_nonzero(~np.isfinite(torque).all(-1)))
            return [
                f"the torque of inverse dynamics is not finite at {lost} of {len(torque)} states"
            ]
        same = self._of_steps_as_well()
        if same:
            return [same]
        found = self._across.of_torque(name)
        formula = "" if found else self._across.formula_of_torque(name)
        term = "" if found or formula else self._across.cause(name, INVERTED)
        return found or [f"in inverse dynamics, {term}" if term else formula] * bool(
            term or formula
        )

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
# Of states that the steps may not have come to.
AT_SOME = ("but only where", "but not always", "wrong only where")
