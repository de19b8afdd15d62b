"""Which schemes a run may be stepped by that declares none: those nearest in its first samples."""

from __future__ import annotations

from dataclasses import replace

from omegadot.diagnosis.reported.run import LEAST_SAMPLES, ReportedRun, until_it_shows
from omegadot.diagnosis.stepping.explicit_schemes import EXPLICIT
from omegadot.gates.case import Case
from omegadot.gates.truth import Companion, SchemeKey, Truth
from omegadot.harness.drive import CaseResult
from omegadot.harness.judging.judged_run import JudgedRun
from omegadot.reference_impl.schemes import SCHEMES
from omegadot.reference_impl.system import State

MOST_GUESSES = 3
MOST_STEPS = 5000  # of a run that is stepped for a guess
Distance = tuple[bool, int, float]


def reported_run_guesses(
    case: Case, truth: Truth, result: CaseResult, run: JudgedRun
) -> list[ReportedRun]:
    """The run next to the nearest schemes of the reference, of an engine that declares none.

    Which are nearest is seen in the first samples, before a fault has spoiled the rest; these
    alone are stepped through the whole run.
    """
    integrator, sweep = run.integrator, run.sweep
    answer = result.runs.get((integrator.name, sweep.timestep))
    if answer is None or not answer.ok or integrator.scheme in SCHEMES:
        return []
    time, state = answer.result["time"], State(**answer.result["state"])
    growth = truth.growth[truth.rows(sweep)]
    whole = ReportedRun(case, truth, integrator, sweep, time, state, state, growth, False)
    beginnings = truth.beginnings(sweep.until(LEAST_SAMPLES))
    if len(time) != len(sweep.times):
        return [_beside_scheme(whole, key) for key in list(beginnings)[:1]]
    first = whole.until(LEAST_SAMPLES)
    ranked = [(_beside(first, key, own).distance_at_first, key) for key, own in beginnings.items()]
    ranked.sort(key=_by_distance)
    if ranked:
        least, nearest = ranked[0]
        ranked += _explicit(_beside(first, nearest, beginnings[nearest]), least, sweep.steps)
    ranked.sort(key=_by_distance)
    return [until_it_shows(_beside_scheme(whole, key)) for _, key in ranked[:MOST_GUESSES]]


def _by_distance(pair: tuple[Distance, SchemeKey]) -> Distance:
    return pair[0]


def _beside(run: ReportedRun, key: SchemeKey, own: Companion) -> ReportedRun:
    integrator = replace(run.integrator, scheme=key.scheme, coordinates=key.coordinates)
    return replace(run, integrator=integrator, own=own.state, growth=own.growth)


def _beside_scheme(run: ReportedRun, key: SchemeKey) -> ReportedRun:
    """The run next to a scheme's whole run. The reference's worker steps only its own."""
    own = None if key.scheme in EXPLICIT else run.truth.whole(run.sweep, key)
    if own is not None:
        return _beside(run, key, own)
    integrator = replace(run.integrator, scheme=key.scheme, coordinates=key.coordinates)
    guess = replace(run, integrator=integrator)
    return replace(guess, own=guess.stepped())


def _explicit(
    nearest: ReportedRun, least: Distance, steps: int
) -> list[tuple[Distance, SchemeKey]]:
    """The explicit scheme that is nearer than the reference's nearest, in the first samples."""
    found = list[tuple[Distance, SchemeKey]]()
    for name in EXPLICIT if steps <= MOST_STEPS else ():
        key = SchemeKey(name, "com-world")
        here = _beside_scheme(nearest, key).distance_at_first
        if here < least:
            least, found = here, [(here, key)]
    return found
