"""The causes of what all runs of an engine share on one case: model, states, equations."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from omegadot.diagnosis.equations.evidence import ALONG, FORWARD, INVERSE, INVERTED
from omegadot.diagnosis.equations.siblings import AFTER_ANOTHER
from omegadot.diagnosis.equations.wrong_equation import RELOADED, equation_causes, is_of_a_load
from omegadot.diagnosis.integrator import IntegratorCauses
from omegadot.diagnosis.kept_case import source_of
from omegadot.diagnosis.models.attitudes_read import IN_BOTH, IN_RUNS
from omegadot.diagnosis.models.misread_state import SET_OR_READ, known_state
from omegadot.diagnosis.models.wrong_lever import lever_causes
from omegadot.diagnosis.models.wrong_model import model_causes
from omegadot.diagnosis.over_scenarios import EngineOverScenarios
from omegadot.diagnosis.reported.requests import batch_cause, kept_causes
from omegadot.diagnosis.run_rules import READ
from omegadot.gates.bounds.scales import eps_of
from omegadot.gates.case import Case
from omegadot.gates.rows import Row
from omegadot.gates.states.equation import EvaluationStates
from omegadot.harness.drive import CaseResult
from omegadot.harness.requests import siblings

OF_BODY = {("model", metric) for metric in ("mass", "center_of_mass", "inertia")}
OF_RATES = ((FORWARD, "residual"), (ALONG, "residual_on_path"))
ALONE = ", in forward dynamics alone: steps are right"
# Of states that the steps may not have come to.
AT_SOME = ("but only where", "but not always", "wrong only where")


class SharedCauses:
    """Of one case, of which these rows fail. answers: the engine's, without its runs."""

    def __init__(
        self,
        engine: EngineOverScenarios,
        case: Case,
        states: EvaluationStates,
        answers: CaseResult,
        rows: Sequence[Row],
        integrators: Mapping[str, IntegratorCauses],
    ) -> None:
        self._across, self._siblings = engine.across, engine.siblings
        self._over, self._integrators = engine.integrators, integrators
        self._case, self._states, self._answers, self._rows = case, states, answers, rows

    def siblings_follow(self, name: str) -> bool:
        """Whether the cause on another scenario makes what fails here, of siblings alone."""
        failed = {(row.gate, row.metric) for row in self._rows}
        one = self._across.chosen(name, FORWARD) if self._has(name, FORWARD) else None
        alone = failed == {("equation", siblings.METRIC)}
        return alone and one is not None and self._siblings.follow(self._case, one)

    def _has(self, name: str, source: str) -> bool:
        return source in self._across.scenes[name].evidence

    def sentences(self) -> list[str]:
        """Of the model, then of forward dynamics, then of inverse dynamics."""
        if not self._rows:
            return []
        failed = {(row.gate, row.metric) for row in self._rows}
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
        channels = {row.channel for row in self._rows}
        return "attitude" in channels and channels <= {"attitude", *follow}

    def _of_answers(self, failed: set[tuple[str, str]]) -> list[str]:
        """Of forward dynamics, then of inverse dynamics. failed: gates and metrics."""
        alone = batch_cause(failed)
        if alone:
            return [alone]
        for source, metric in OF_RATES:
            rates = [r for r in self._rows if r.metric == metric and r.channel != "torque"]
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
        if self._answers.inverse.ok and any(row.channel == "torque" for row in self._rows):
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
