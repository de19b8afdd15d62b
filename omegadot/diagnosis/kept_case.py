"""What is kept of one integrator on one case: how its runs begin, and its steps as they vanish."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from omegadot.adapters.protocol import Integrator
from omegadot.diagnosis.equations.evidence import Evidence
from omegadot.diagnosis.over_scenarios import OverScenarios
from omegadot.diagnosis.reported.requests import again_cause
from omegadot.diagnosis.run_rules import KeptRuns
from omegadot.diagnosis.stepping.ends.last_samples import run_end
from omegadot.diagnosis.stepping.kept_run import KeptRun, kept_run
from omegadot.diagnosis.stepping.step_orders import order_lost
from omegadot.diagnosis.stepping.vanishing.follows import (
    SAMPLES,
    Beginning,
    begins_turned,
    keeps_pace,
)
from omegadot.diagnosis.stepping.vanishing.freezes import freezes_of
from omegadot.diagnosis.stepping.vanishing.jumps import first_turn
from omegadot.diagnosis.stepping.vanishing.rests import RunWithRests, rests_of
from omegadot.diagnosis.stepping.vanishing.vanishing_steps import VanishingSteps, vanishing_steps
from omegadot.diagnosis.stepping.wrong_steps import LEAST_SAMPLES
from omegadot.diagnosis.wording.features import Features, features_of
from omegadot.gates.bounds.scales import eps_of
from omegadot.gates.case import Case
from omegadot.gates.errors.findings import orders_for
from omegadot.gates.steps import restart
from omegadot.gates.steps.accuracy import tolerated_by
from omegadot.gates.truth import Truth
from omegadot.harness.drive import CaseResult
from omegadot.harness.judging.judged_run import JudgedRun
from omegadot.harness.requests.repeats import short_sweep
from omegadot.reference_impl.schemes import SCHEMES
from omegadot.reference_impl.system import Array, State, System

OBSERVED = "observed_order"
WholeRun = tuple[State, Array, JudgedRun]  # with how far rounding may grow


def source_of(integrator: str) -> str:
    """The name of the evidence in an integrator's steps."""
    return f"steps of {integrator}"


@dataclass(frozen=True)
class KeptCase:
    """Of one integrator on the case of this name.

    again: what shows where two answers to one request differ.  beginning: of a failed run.
    turned_wrong: whether a run fails in attitude.  brief: whether every run has too few samples to
    be stepped again.  steps: None where there is no answer to the probe.
    """

    name: str
    integrator: Integrator
    again: str
    beginning: Beginning | None
    turned_wrong: bool
    brief: bool
    steps: VanishingSteps | None

    @property
    def declares(self) -> bool:
        """Whether its scheme is one of the reference."""
        return self.integrator.scheme in SCHEMES

    @property
    def source(self) -> str:
        """The name of the evidence in its steps."""
        return source_of(self.integrator.name)


def kept_case(
    over: OverScenarios, case: Case, truth: Truth, result: CaseResult, runs: Sequence[JudgedRun]
) -> KeptCase:
    """What is kept of the case, which is added to what is kept over the scenarios."""
    again = next(filter(None, (again_cause(run.rows) for run in runs)), "")
    over.again = over.again or again
    beginning = _beginning_of(case.system, truth, result, runs)
    if beginning is not None:
        over.beginnings[case.name] = beginning
    over.fails[case.name] = any(run.fails for run in runs)
    whole = [*_whole_runs(truth, result, runs)]
    over.runs.integrator = runs[0].integrator
    _keep(over.runs, case, truth, result, whole)
    failed = (row for run in runs for row in run.rows if row.verdict == "fail")
    turned_wrong = any(row.channel == "attitude" for row in failed)
    brief = all(len(run.sweep.times) < LEAST_SAMPLES for run in runs)
    steps = _steps(over, case, result, runs, beginning)
    probe, answer = result.first_steps.get(runs[0].integrator.name, (None, None))
    stepped = State(**answer.result) if answer is not None and answer.ok else None
    over.asleep.frozen[case.name] = freezes_of(
        case.system, probe, stepped, [one for one, _, _ in whole]
    )
    over.asleep.rests[case.name] = rests_of(
        case.system, probe, stepped, [*_with_rests(truth, result, runs)]
    )
    return KeptCase(case.name, runs[0].integrator, again, beginning, turned_wrong, brief, steps)


def _keep(
    kept: KeptRuns, case: Case, truth: Truth, result: CaseResult, whole: Sequence[WholeRun]
) -> None:
    """Keep of the case's runs their first samples, from q and from -q, and their last two."""
    for state, growth, run in whole:
        how = (case.name, truth, run.sweep, state, growth, run.fails)
        kept.kept += filter(None, (kept_run(*how),))
        kept.ends += filter(None, (run_end(*how),))
        kept.negated += filter(None, (_negated(case.name, truth, result, growth, run),))
    stepping = {one.name for one in result.integrators if one.knob == "timestep"}
    kept.given[case.name] = case.initial
    kept.requested[case.name] = [knob for name, knob in result.runs if name in stepping]


def _steps(
    over: OverScenarios,
    case: Case,
    result: CaseResult,
    runs: Sequence[JudgedRun],
    beginning: Beginning | None,
) -> VanishingSteps | None:
    """Steps as they vanish; with the turn of a first step, or else the order that steps lose."""
    integrator = runs[0].integrator
    probe, answer = result.first_steps.get(integrator.name, (None, None))
    if probe is None or answer is None or not answer.ok:
        return None
    tolerated, eps = tolerated_by(integrator), eps_of(result.precision)
    stepped = State(**answer.result)
    steps = vanishing_steps(case.system, probe, stepped, eps, tolerated)
    over.runs.steps[case.name] = steps
    over.stays_below[case.name] = steps.stays_below
    if beginning is not None and not steps.sound:
        over.keeps_pace[case.name] = keeps_pace(beginning, steps)
    angle = None if steps.sound else first_turn(steps)
    if angle is not None:
        alone = beginning is not None and begins_turned(beginning, angle)
        over.turned[case.name] = angle, alone
    if any(run.fails for run in runs) and steps.sound:
        due = orders_for(integrator, case.system)
        found = order_lost(case.system, probe, stepped, eps, due)
        if found is not None:
            found = found.over(_observed(runs), due)
            over.lost[case.name] = found.of_first if _has_past(runs) else found
    return steps


def opposite_steps(
    case: Case, result: CaseResult, integrator: str
) -> Iterator[tuple[Features, Evidence]]:
    """What steps follow as they vanish, of systems in which one thing is the other way."""
    tolerated = {one.name: tolerated_by(one) for one in result.integrators}
    for (name, _), (system, probe, answer) in result.opposite_steps.items():
        if name == integrator and answer.ok:
            how = (eps_of(result.precision), tolerated[name])
            steps = vanishing_steps(system, probe, State(**answer.result), *how)
            yield features_of(system, case.initial), steps.evidence


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


def _whole_runs(truth: Truth, result: CaseResult, runs: Sequence[JudgedRun]) -> Iterator[WholeRun]:
    """The runs that were answered in full, in double precision, with how far rounding may grow."""
    for run in runs if truth.in_precision(result.precision) is truth else ():
        answer = result.runs.get((run.integrator.name, run.sweep.knob))
        if answer is not None and answer.ok and len(answer.result["time"]) == len(run.sweep.times):
            yield State(**answer.result["state"]), truth.growth[truth.rows(run.sweep)], run


def _negated(
    name: str, truth: Truth, result: CaseResult, growth: Array, run: JudgedRun
) -> KeptRun | None:
    """The first samples of a run that was requested again from -q."""
    answer = result.again.get((run.integrator.name, run.sweep.knob, "negated"))
    sweep = short_sweep(run.sweep)
    if answer is None or not answer.ok or len(answer.result["time"]) != len(sweep.times):
        return None
    state, first = State(**answer.result["state"]), growth[: len(sweep.times)]
    return kept_run(name, truth, sweep, state, first, fails=True, least=2)


def _with_rests(
    truth: Truth, result: CaseResult, runs: Sequence[JudgedRun]
) -> Iterator[RunWithRests]:
    """The runs that were answered in full."""
    for run in runs:
        answer = result.runs.get((run.integrator.name, run.sweep.knob))
        if answer is not None and answer.ok and len(answer.result["time"]) == len(run.sweep.times):
            yield RunWithRests(State(**answer.result["state"]), truth.at(run.sweep))


def _beginning_of(
    system: System, truth: Truth, result: CaseResult, runs: Sequence[JudgedRun]
) -> Beginning | None:
    """The first samples of the failed run with the shortest steps."""
    for run in sorted(runs, key=lambda run: run.sweep.timestep):
        answer = result.runs.get((run.integrator.name, run.sweep.knob))
        if not run.fails or answer is None or not answer.ok:
            continue
        times, state = run.sweep.times, State(**answer.result["state"])
        if len(state.position) == len(times):
            first = slice(0, SAMPLES + 1)
            steps = int(run.sweep.sample_steps[first][-1])
            exact = truth.at(run.sweep)[first]
            return Beginning(system, times[first], state[first], exact, steps)
    return None
