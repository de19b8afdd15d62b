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


class Guesses:
    """Of the runs of one case that declare no scheme: by which they may be stepped.

    Which schemes are nearest is seen in the first samples, before a fault has spoiled the rest;
    these alone are stepped through the whole run.
    """

    def __init__(self, case: Case, truth: Truth, result: CaseResult) -> None:
        self.case, self.truth, self.result = case, truth, result
        self._ranked: dict[float, list[tuple[Distance, SchemeKey]]] = {}
        self._nearest: dict[float, list[ReportedRun]] = {}

    def nearest(self, run: JudgedRun) -> list[ReportedRun]:
        """The run next to each of the nearest schemes; none where it declares one."""
        knob, whole = run.sweep.knob, self._whole(run)
        if whole is None:
            return []
        if knob not in self._nearest:
            keys = [key for _, key in self._by_distance(run, whole)[:MOST_GUESSES]]
            found = [_beside_scheme(whole, key) for key in keys]
            sampled = len(whole.time) == len(whole.sweep.times)
            self._nearest[knob] = list(map(until_it_shows, found)) if sampled else found[:1]
        return self._nearest[knob]

    def equal(self, run: JudgedRun) -> set[str]:
        """The schemes that the run equals: none of those that do not begin as it does is."""
        whole = self._whole(run)
        if whole is None:
            return set()
        begin = [k for (_, off, _), k in self._by_distance(run, whole)[:MOST_GUESSES] if off == 0]
        known = self._nearest.get(run.sweep.knob)  # those that do not begin as it does are no use
        tried = [_beside_scheme(whole, key) for key in begin] if known is None else known
        return {one.integrator.scheme or "" for one in tried if begin and one.is_own}

    def _whole(self, run: JudgedRun) -> ReportedRun | None:
        """The run next to itself; None where there is none or its scheme is declared."""
        integrator, sweep = run.integrator, run.sweep
        answer = self.result.runs.get((integrator.name, sweep.timestep))
        if answer is None or not answer.ok or integrator.scheme in SCHEMES:
            return None
        time, state = answer.result["time"], State(**answer.result["state"])
        growth = self.truth.growth[self.truth.rows(sweep)]
        known = (self.case, self.truth, integrator, sweep)
        return ReportedRun(*known, time, state, state, growth, False)

    def _by_distance(self, run: JudgedRun, whole: ReportedRun) -> list[tuple[Distance, SchemeKey]]:
        """Every scheme, the nearest in the first samples first."""
        knob = run.sweep.knob
        if knob in self._ranked:
            return self._ranked[knob]
        beginnings = self.truth.beginnings(run.sweep.until(LEAST_SAMPLES))
        if len(whole.time) != len(run.sweep.times):
            return [((True, 0, 0.0), key) for key in beginnings]
        first = whole.until(LEAST_SAMPLES)
        ranked = [(_beside(first, k, own).distance_at_first, k) for k, own in beginnings.items()]
        ranked.sort(key=_distance_of)
        if ranked:
            least, nearest = ranked[0]
            by_nearest = _beside(first, nearest, beginnings[nearest])
            ranked += _explicit(by_nearest, least, run.sweep.steps)
        ranked.sort(key=_distance_of)
        self._ranked[knob] = ranked
        return ranked


def _distance_of(pair: tuple[Distance, SchemeKey]) -> Distance:
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
