"""The causes of one integrator's failures on one case: in its steps as they vanish, in its runs."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from omegadot.diagnosis.equations.known import scenarios_in_common
from omegadot.diagnosis.equations.wrong_equation import known_difference
from omegadot.diagnosis.over_scenarios import EngineOverScenarios
from omegadot.diagnosis.reported.known_run import known_of_runs
from omegadot.diagnosis.reported.requests import again_cause
from omegadot.diagnosis.runs import NOTHING, RunCauses, run_causes
from omegadot.diagnosis.stepping.follows import SAMPLES, Beginning, begins_turned, keeps_pace
from omegadot.diagnosis.stepping.jumps import first_turn, jump_cause, jumps, slight_jump_cause
from omegadot.diagnosis.stepping.kept_run import KeptRun, kept_run
from omegadot.diagnosis.stepping.kinematics import (
    kinematic_causes,
    moves_by_cause,
    omega_share_cause,
    omega_still_cause,
    still_cause,
    velocity_share_cause,
)
from omegadot.diagnosis.stepping.order_lost import OrderLost, order_lost
from omegadot.diagnosis.stepping.vanishing_steps import VanishingSteps, vanishing_steps
from omegadot.diagnosis.stepping.wrong_steps import LEAST_SAMPLES
from omegadot.diagnosis.wording.kinds import (
    agreed,
    either,
    is_fact,
    is_of_one_run,
    kind_of,
    over_run,
)
from omegadot.gates.bounds.scales import eps_of
from omegadot.gates.case import Case
from omegadot.gates.errors.measured_run import orders_for
from omegadot.gates.steps import restart
from omegadot.gates.steps.accuracy import tolerated_by
from omegadot.gates.truth import Truth
from omegadot.harness.drive import CaseResult
from omegadot.harness.judging.judged_run import JudgedRun
from omegadot.reference_impl.schemes import SCHEMES
from omegadot.reference_impl.system import State, System

# Scenarios on which the runs of an integrator are looked at in vain, before the rest is left alone:
# stepping again by all that may be wrong takes long. The order that steps have lost explains them.
VAIN, VAIN_BESIDE_ORDER = 8, 3
IN_THE_FIRST = "at the start of a run alone"
FIRST_ALONE = "only the first steps are wrong"  # which states less than what is wrong in them
OBSERVED = "observed_order"
OF_ONE_FIELD = "alone is wrong in the run"  # which the order that it has lost may explain


def source_of(integrator: str) -> str:
    """The name of the evidence in an integrator's steps."""
    return f"steps of {integrator}"


def fails(run: JudgedRun) -> bool:
    """Whether a gate of a run fails."""
    return any(row.verdict == "fail" for row in run.rows)


class IntegratorCauses:
    """The causes of one integrator's failures on one case, worked out when they are needed."""

    def __init__(
        self,
        engine: EngineOverScenarios,
        case: Case,
        truth: Truth,
        result: CaseResult,
        runs: Sequence[JudgedRun],
    ) -> None:
        self._across, self._case, self._truth = engine.across, case, truth
        self._result: CaseResult | None = result
        self._runs = list(runs)
        integrator = runs[0].integrator
        self._integrator = integrator
        self._name, self._declares = integrator.name, integrator.scheme in SCHEMES
        self._again = next(filter(None, (again_cause(run.rows) for run in runs)), "")
        over = self._over = engine.integrators[self._name]
        over.again = over.again or self._again
        self._beginning = _beginning_of(case.system, truth, result, runs)
        if self._beginning is not None:
            over.beginnings[case.name] = self._beginning
        failed = [run for run in runs if fails(run)]
        over.fails[case.name] = bool(failed)
        over.kept += _kept_runs(case.name, truth, result, runs)
        self._turned_wrong = any(
            row.channel == "attitude" and row.verdict == "fail"
            for run in failed
            for row in run.rows
        )
        self._brief = all(len(run.sweep.times) < LEAST_SAMPLES for run in runs)
        self._of_runs: RunCauses | None = None
        self.steps: VanishingSteps | None = None
        probe, answer = result.first_steps.get(self._name, (None, None))
        if probe is not None and answer is not None and answer.ok:
            tolerated, eps = tolerated_by(integrator), eps_of(result.precision)
            stepped = State(**answer.result)
            self.steps = vanishing_steps(case.system, probe, stepped, eps, tolerated)
            angle = None if self.steps.sound else first_turn(self.steps)
            if angle is not None:
                first = self._beginning
                alone = first is not None and begins_turned(first, angle)
                over.turned[case.name] = angle, alone
            if any(map(fails, runs)) and self.steps.sound:
                due = orders_for(integrator, case.system)
                found = order_lost(case.system, probe, stepped, eps, due)
                if found is not None:
                    found = found.over(_observed(runs), due)
                    over.lost[case.name] = found.of_first if _has_past(runs) else found

    def release(self, wanted: bool) -> None:
        """Work out what needs the trajectories, where it is wanted, and let go of them."""
        if wanted and any(map(fails, self._runs)) and self._result is not None:
            failed = [run for run in self._runs if fails(run)]
            steps = [r.sweep.timestep for r in self._runs if r.sweep.accuracy is None]
            shortest = min(steps, default=0.0)
            seen = known_of_runs(self._truth, self._result, failed, shortest)
            if seen is not None:
                self._over.seen[self._case.name] = seen
            if self._again or not self._over.likely(self._integrator):
                self._of_case()
        self._result, self._runs = None, []

    def sentences(self) -> list[str]:
        """What makes the runs of all scenarios together, or else what this one shows."""
        failing = self._over.fails[self._case.name] and not self._again
        return (self._over.together(self._integrator) if failing else []) or self._of_case()

    def _of_case(self) -> list[str]:
        """Of the steps as they vanish and of the run itself.

        What a declared scheme makes of a wrong state is known better by stepping again than by
        the steps as they vanish; a wrong equation is known better by these.
        """
        steps = self.steps
        if self._again:
            seen = self._of_trajectories()
            return [one for one in seen if is_of_one_run(one)] or [self._again]
        if steps is None or steps.sound:
            found = self._of_trajectories()
            own = self._over.lost.get(self._case.name)
            lost = own.with_others(self._over.lost.values()) if own and own.orders else None
            if not found or any(OF_ONE_FIELD in text for text in found) or self._beyond(lost):
                found = [lost.text] if lost is not None else found
            return found or self._known_of_runs()
        if self._over.again:  # what is left over from a run spoils the short ones that follow
            return [self._over.again]
        found = self._of_steps(steps) or self._of_trajectories()
        if self._case.name in self._over.turned and all(map(is_fact, found)):
            begins = self._over.begins
            found = [begins] if begins else found
        jumped = either([jump_cause(steps, self._beginning)])
        if any(OF_ONE_FIELD in text for text in found):
            found = jumped or found
        last = found or jumped or either(kinematic_causes(steps))
        last = last or either([still_cause(steps)])
        if last or steps.still:
            return last
        slight = either([slight_jump_cause(steps)])
        return slight or self._known(steps) or self._known_of_runs()

    def _beyond(self, lost: OrderLost | None) -> bool:
        """Whether what makes single steps lose their order explains scenarios that no run does."""
        if lost is None or not lost.by:
            return False
        here = set(map(kind_of, self._of_runs.texts)) if self._of_runs is not None else set()
        shown = dict[str, bool]()  # by scenario: whether its runs are made by what makes these
        for name, (texts, _) in self._over.causes.items():
            shown[name] = bool(here & set(map(kind_of, texts)))
        losing = {name for name, one in self._over.lost.items() if one.orders}
        return all(name in losing for name, same in shown.items() if same) and any(
            name in losing for name, same in shown.items() if not same
        )

    def _of_steps(self, steps: VanishingSteps) -> list[str]:
        """Where every state is off by the steps alone, the more basic first."""
        common = steps.common_cause()
        if common:
            first = self._beginning is not None and not keeps_pace(self._beginning, steps)
            if not first:
                return [common]
            seen = [one for one in self._of_trajectories() if not one.startswith(FIRST_ALONE)]
            return seen or [f"{IN_THE_FIRST}: {common}"]
        if jumps(steps):
            return [] if self._declares else either([jump_cause(steps, self._beginning)])
        if steps.still:
            return []
        moved = moves_by_cause(steps)
        if moved:  # where it is either of two, a whole run may show which
            return (self._of_trajectories() if moved.startswith("either") else []) or [moved]
        return either(kinematic_causes(steps)) or self._of_omega(steps)

    def _of_omega(self, steps: VanishingSteps) -> list[str]:
        """Omega is of another time than the rest, or the equation that it follows is another."""
        if not steps.evidence.clear:
            return []
        share = omega_share_cause(steps)
        if share and not self._turned_wrong and not self._brief:
            return [share]
        found = self._of_equation(steps)
        if any(one.startswith(IN_THE_FIRST) or f"or {IN_THE_FIRST}" in one for one in found):
            seen = [one for one in self._of_trajectories() if not one.startswith(FIRST_ALONE)]
            found = seen or found
        if share and not self._turned_wrong:
            return either([share, *found])
        return found

    def _of_equation(self, steps: VanishingSteps) -> list[str]:
        """By which equation the limit of vanishing steps is another; nothing where it is right."""
        if np.all(steps.evidence.sound) or not steps.turns:
            return []
        where = (self._case.name, source_of(self._name))
        still = omega_still_cause(steps)
        if still:
            return self._of_trajectories() or [still]
        text, one = self._across.cause(*where), self._across.chosen(*where)
        if not text:
            return []
        alike = self._across.explained(*where)
        scenes = self._across.scenes
        evidence = {
            n: scenes[n].evidence[where[1]] for n in alike if where[1] in scenes[n].evidence
        }
        followed = self._over.followed(one, evidence, steps.eps) if one is not None else set()
        if "between" in followed or {"right", "wrong"} <= followed:
            later = "later steps come nearer to the right equation"
            return [f"at the start of a run, {text}; {later}"]
        if "right" in followed:
            first = f"{IN_THE_FIRST}, {text}"
            return either([velocity_share_cause(steps), first])
        return [f"in the steps, {text}"]

    def _known(self, steps: VanishingSteps) -> list[str]:
        """What is known of the steps' equation where nothing fits."""
        if np.all(steps.evidence.sound):
            return []
        known = known_difference(self._across, self._case.name, source_of(self._name))
        return [f"in the steps, {one}" for one in known]

    def _known_of_runs(self) -> list[str]:
        """What is seen of the runs where nothing fits, and in which scenarios alone."""
        fails_in = self._over.fails
        scenes = self._across.scenes
        failing, passing = (
            [s.features for name, s in scenes.items() if fails_in.get(name) is wrong]
            for wrong in (True, False)
        )
        own = self._over.seen.get(self._case.name)
        seen = own.with_others(self._over.seen.values()).text if own else ""
        texts = [text for text in (seen, scenarios_in_common(failing, passing)) if text]
        return [f"none is known; {'; '.join(texts)}"] if texts else []

    def _of_trajectories(self) -> list[str]:
        """What makes the runs, and most of those of the other cases."""
        over = self._over.causes
        if self._of_runs is None:
            self._of_runs = NOTHING
            vain = sum(not texts for texts, _ in over.values())
            lost = self._over.lost.get(self._case.name)
            most = VAIN_BESIDE_ORDER if lost is not None and lost.orders else VAIN
            looked = any(texts for texts, _ in over.values()) or vain < most
            if self._result is not None and looked:
                # a wrong equation shows in steps that vanish, and from more states
                wrong = self.steps is None or not np.all(self.steps.evidence.sound)
                how = (self._case, self._truth, self._result, self._runs)
                self._of_runs = run_causes(*how, equations=wrong)
                over[self._case.name] = (self._of_runs.texts, self._of_runs.decisive)
        known = {name: texts for name, (texts, _) in over.items()}
        return either([over_run(text, known) for text in agreed(self._of_runs.texts, over)])


def _observed(runs: Sequence[JudgedRun]) -> dict[str, float]:
    """The lowest order that whole runs show of each channel, where it is settled."""
    found = dict[str, float]()
    for row in (row for run in runs for row in run.rows if row.metric == OBSERVED):
        if row.verdict in ("pass", "fail"):
            found[row.channel] = min(row.value, found.get(row.channel, row.value))
    return found


def _has_past(runs: Sequence[JudgedRun]) -> bool:
    """Whether a run that is restarted at one of its samples is another: what first steps do is."""
    rows = (row for run in runs for row in run.rows if row.metric == restart.METRIC)
    return any(not row.value <= 1.0 for row in rows)


def _kept_runs(
    name: str, truth: Truth, result: CaseResult, runs: Sequence[JudgedRun]
) -> Iterator[KeptRun]:
    """The first samples of the runs that were answered in full, in double precision."""
    for run in runs if truth.in_precision(result.precision) is truth else ():
        answer = result.runs.get((run.integrator.name, run.sweep.knob))
        if answer is not None and answer.ok and len(answer.result["time"]) == len(run.sweep.times):
            growth = truth.growth[truth.rows(run.sweep)]
            state = State(**answer.result["state"])
            one = kept_run(name, truth, run.sweep, state, growth, fails(run))
            yield from () if one is None else (one,)


def _beginning_of(
    system: System, truth: Truth, result: CaseResult, runs: Sequence[JudgedRun]
) -> Beginning | None:
    """The first samples of the failed run with the shortest steps."""
    for run in sorted(runs, key=lambda run: run.sweep.timestep):
        answer = result.runs.get((run.integrator.name, run.sweep.knob))
        if not fails(run) or answer is None or not answer.ok:
            continue
        times, state = run.sweep.times, State(**answer.result["state"])
        if len(state.position) == len(times):
            first = slice(0, SAMPLES + 1)
            steps = int(run.sweep.sample_steps[first][-1])
            exact = truth.at(run.sweep)[first]
            return Beginning(system, times[first], state[first], exact, steps)
    return None
