"""Causes in the runs of one integrator: in what is reported, in the stepping, in the past."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from omegadot.diagnosis.equations.evidence import BEYOND_ROUNDING
from omegadot.diagnosis.models.fitted_misreadings import ADDED
from omegadot.diagnosis.reported.clock import clock_of_runs
from omegadot.diagnosis.reported.field_causes import field_causes
from omegadot.diagnosis.reported.guesses import Guesses
from omegadot.diagnosis.reported.late import late
from omegadot.diagnosis.reported.one_of_all import one_of_all
from omegadot.diagnosis.reported.onsets import Onset, onset_of
from omegadot.diagnosis.reported.precision import precision_reported
from omegadot.diagnosis.reported.run import SLACK, ReportedRun, reported_run
from omegadot.diagnosis.reported.run_causes import (
    CAUSES_REPORTED,
    SEEN,
    another_start,
    begin_apart,
    misread,
    not_finite,
)
from omegadot.diagnosis.reported.sample_causes import (
    intervals,
    last_sample,
    not_unit,
    omega_dot_late,
    one_field,
)
from omegadot.diagnosis.stepping.ends.restarts import restart_cause
from omegadot.diagnosis.stepping.explicit_schemes import scheme_named
from omegadot.diagnosis.stepping.slips.other_schemes import slips_of
from omegadot.diagnosis.stepping.slips.slips import OF_SCHEME
from omegadot.diagnosis.stepping.wrong_steps import is_decisive, is_steppable, stepping_causes
from omegadot.diagnosis.wording.kinds import is_fact, kind_of
from omegadot.gates.bounds.scales import EPS
from omegadot.gates.case import Case
from omegadot.gates.truth import Truth
from omegadot.harness.drive import CaseResult
from omegadot.harness.judging.judged_run import JudgedRun, is_finite
from omegadot.written import written

ALIKE = ("steps are", "a damping of")  # causes that act in every step alike
LIMIT = "is held"
# In single precision what fits within SLACK bounds must be off by far more without it.
CLEAR_OF_SINGLE = SLACK * BEYOND_ROUNDING
MOST_TRIED = 1000  # steps of a second run, in which a cause is looked for again


@dataclass(frozen=True)
class RunCauses:
    """Causes of which each alone makes the runs of one integrator on a scenario.

    decisive: whether the motion has enough in it that what else it could be is ruled out.
    tried: whether they are off by enough to distinguish them from steps by other hypotheses.
    """

    texts: tuple[str, ...] = ()
    decisive: bool = True
    tried: bool = True


NOTHING = RunCauses()
HARDLY_OFF = RunCauses(tried=False)


def run_causes(
    case: Case,
    truth: Truth,
    result: CaseResult,
    runs: Sequence[JudgedRun],
    equations: bool = True,
    deep: bool = True,
) -> RunCauses:
    """Of the failed run of the fewest steps in which one is found: hypotheses are stepped again.

    equations: whether the equation that is stepped may be another than the right one.  deep:
    whether hypotheses are stepped; else no more is sought than what is seen of a run.
    """
    guesses = Guesses(case, truth.in_precision(result.precision), result)
    failed = [run for run in runs if run.fails]
    clock = _of_clock(result, runs, guesses.truth.yardstick.eps)
    if clock:
        return RunCauses(clock)
    several = _of_several_schemes(guesses, runs) if failed and deep else ""
    if several:
        return RunCauses((several,))
    tried = False
    for run in sorted(failed, key=lambda run: run.sweep.steps):
        found = _of_run(guesses, run, equations, deep)
        tried |= found.tried
        if found.texts:
            kept = _of_others(guesses, found, run, failed, equations) if deep else found
            return _at_long_steps(kept, runs)
    return NOTHING if tried or not failed else HARDLY_OFF


def onsets_of(
    case: Case, truth: Truth, result: CaseResult, runs: Sequence[JudgedRun]
) -> list[Onset]:
    """Of runs that are sound up to a sample, or throughout: where they begin to be wrong."""
    guesses = Guesses(case, truth.in_precision(result.precision), result)
    found = list[Onset]()
    for run in runs:
        reported = reported_run(case, truth, result, run)
        tried = guesses.nearest(run) if reported is None else [reported]
        found += [one for one in (onset_of(beside) for beside in tried) if one is not None][:1]
    return found


def _of_clock(result: CaseResult, runs: Sequence[JudgedRun], eps: float) -> tuple[str, ...]:
    answers = [(result.runs.get((run.integrator.name, run.sweep.knob)), run) for run in runs]
    answered = [(a.result["time"], run) for a, run in answers if a is not None and a.ok]
    failed = [place for place, (_, run) in enumerate(answered) if run.fails]
    return clock_of_runs([(time, run.sweep) for time, run in answered], failed, eps)


def _of_others(
    guesses: Guesses,
    found: RunCauses,
    run: JudgedRun,
    failed: Sequence[JudgedRun],
    equations: bool,
) -> RunCauses:
    """Those that make the next failed run as well, if it is short, by other numbers maybe."""
    longer = [one for one in failed if run.sweep.steps < one.sweep.steps <= MOST_TRIED]
    if not longer or all(map(is_fact, found.texts)):
        return found
    second = min(longer, key=lambda one: one.sweep.steps)
    other = _of_run(guesses, second, equations)
    if other.texts and all(map(is_fact, other.texts)):
        return found
    kinds = set(map(kind_of, other.texts))
    both = tuple(text for text in found.texts if kind_of(text) in kinds)
    return RunCauses(both, found.decisive or other.decisive)


def _of_several_schemes(guesses: Guesses, runs: Sequence[JudgedRun]) -> str:
    """Runs of one integrator that are different schemes' at different steps, none declared."""
    equal = {run.sweep.timestep: guesses.equal(run) for run in runs}
    named = {timestep: schemes for timestep, schemes in equal.items() if schemes}
    if len(named) < 2 or set.intersection(*named.values()):
        return ""
    parts = [f"{' or '.join(sorted(n))} at {written(h)} s" for h, n in sorted(named.items())]
    return f"runs with different steps are of different schemes: {', '.join(parts)}"


def _at_long_steps(found: RunCauses, runs: Sequence[JudgedRun]) -> RunCauses:
    """Where the longer steps alone fail, between which steps it begins.

    What acts in every step alike is not the cause then, and a limit is one on any motion.
    """
    failed, sound = (
        [r.sweep.timestep for r in runs if r.fails is wrong] for wrong in (True, False)
    )
    if not failed or not sound or max(sound) >= min(failed):
        return found
    least, most = written(min(failed)), written(max(sound))
    where = f", at steps of {least} s and longer; steps of {most} s fail no gate"
    kept = [text for text in found.texts if not text.startswith(ALIKE)]
    limit = len(kept) == 1 and LIMIT in kept[0]
    return RunCauses(tuple(text + where for text in kept), found.decisive or limit)


def _of_run(guesses: Guesses, run: JudgedRun, equations: bool, deep: bool = True) -> RunCauses:
    """Causes in what one run reports, then in its stepping, then in where it is sound.

    Where nothing but the omega-dot reported along it failed, only that is looked at.
    """
    case, truth, result = guesses.case, guesses.truth, guesses.result
    reported = reported_run(case, truth, result, run)
    if {row.channel for row in run.rows if row.verdict == "fail"} == {"omega_dot"}:
        text = omega_dot_late(case, truth, result, run)
        return RunCauses((text,)) if text else NOTHING
    if reported is not None:
        return _of_reported(reported, result, equations, deep)
    # By the schemes of the reference that come nearest, where none is declared.
    nearest = guesses.nearest(run)
    own = [one for one in nearest if one.is_own]
    if own and not any(one.is_declared for one in own):
        return _lower_order(own, deep)
    facts = NOTHING
    for guess in nearest:
        found = _of_reported(guess, result, equations, deep)
        if found.texts and not all(map(is_fact, found.texts)):
            return found
        facts = facts if facts.texts else found
    found = _of_other_slips(nearest) if deep else NOTHING
    if found.texts or facts.texts:
        return found if found.texts else facts
    text = restart_cause(truth, result, run)
    return RunCauses((text,)) if text else NOTHING


def _lower_order(guesses: Sequence[ReportedRun], deep: bool) -> RunCauses:
    """Of a run that is a known scheme's: that it is of a lower order than is declared."""
    texts = list[str]()
    for guess in guesses:
        integrator, system = guess.integrator, guess.case.system
        orders = [
            (own, due)
            for channel, due in integrator.orders.items()
            if (own := guess.declared.order(channel, system, integrator.coordinates)) is not None
            and due is not None
        ]
        order, due = min(orders, default=(0, 0))
        if order >= due:
            return NOTHING  # by one of those that it may be, all is as declared
        named = guess.declared.name
        texts.append(f"it is stepped by {named}, which is of order {order}, not {due}")
    if deep and is_steppable(guesses[0]):
        # By a slip in one of the declared order some motions are a known one's of lower order.
        due = max(filter(None, guesses[0].integrator.orders.values()), default=0)
        of_order = [one for one in OF_SCHEME if scheme_named(one).orders["omega"] >= due]
        texts += [text for one in of_order for text in slips_of(guesses[0], one)]
    return RunCauses(tuple(dict.fromkeys(texts)), is_decisive(guesses[0]))


def _of_other_slips(guesses: Sequence[ReportedRun]) -> RunCauses:
    """A slip in a scheme that is far from the run for it."""
    if not guesses or any(one.is_own for one in guesses) or not is_steppable(guesses[0]):
        return NOTHING
    tried = {one.integrator.scheme for one in guesses}
    texts = [t for name in OF_SCHEME if name not in tried for t in slips_of(guesses[0], name)]
    return RunCauses(tuple(texts), is_decisive(guesses[0])) if texts else NOTHING


def _of_reported(
    reported: ReportedRun, result: CaseResult, equations: bool, deep: bool = True
) -> RunCauses:
    if not reported.is_declared and reported.is_own:
        return NOTHING  # nothing in this run is wrong
    whole = len(reported.time) == len(reported.sweep.times)
    single = reported.truth.yardstick.eps > EPS
    slack = CLEAR_OF_SINGLE if single else BEYOND_ROUNDING
    clear = not (whole and reported.agrees(reported.state, reported.own, slack=slack))
    if single and not clear:
        return NOTHING  # in single precision much fits a run within its rounding
    finite = whole and is_finite(reported.state)
    seen = precision_reported(reported) if finite else not_finite(reported)
    seen = seen or one_of_all(reported, result)
    seen = seen or begin_apart(reported, result)
    seen = seen or next(filter(None, (cause(reported) for cause in SEEN)), "")
    if seen:
        return RunCauses((seen,))
    if whole and reported.is_own:
        return HARDLY_OFF  # which any cause fits that changes nothing on this motion
    found = [*misread(reported), *late(reported)]
    found += filter(None, (cause(reported) for cause in CAUSES_REPORTED))
    found = [text for text in found if ADDED not in text] or found
    if all(ADDED in text for text in found):  # which on other motions is no constant
        found = [*field_causes(reported), *found]
    found += stepping_causes(reported, equations) if clear and deep else ()
    if found:
        return RunCauses(tuple(dict.fromkeys(found)), is_decisive(reported))
    # Beside a guess it is its error that one quantity shows, where the motion is the same by many.
    alone = (one_field,) if reported.is_declared or is_decisive(reported) else ()
    seen_last = (last_sample, intervals, *alone) if whole and clear else ()
    last = (not_unit, another_start, *seen_last)
    text = next(filter(None, (cause(reported) for cause in last)), "")
    if text:
        return RunCauses((text,), is_decisive(reported))
    return NOTHING if clear or not whole else HARDLY_OFF
