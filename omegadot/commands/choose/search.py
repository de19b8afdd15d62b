"""The largest step that meets the limits, sought over whole numbers of steps a horizon.

Observed orders predict where to look next; only runs decide. With `steps` counting the steps of the
horizon, more of them are a smaller step. An error need not rise with the step, so what is found is
the largest step of which this holds: it passes, every smaller one that was tried passes, and the
next larger one that was tried fails.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass

from omegadot.commands.choose.trial import Trial

EDGE = 1.05  # how far apart a passing step and a failing larger one may be left
ASIDE = 1.015  # how far next to the edge that the order predicts to look
LEAP = 32.0  # the order of two coarse runs is not trusted any further
BLIND = 4.0  # the leap where no order shows
WORTH = 1.25  # how much finer a last run must be that shows the nearest an integrator comes
SATURATED = 0.5  # an error of lower order than this has nothing to do with the step
STEEPEST = 8.0
MOST_RUNS = 32
CONFIRMED = (1 / 1.1, 1.1, 1.5)  # steps a horizon, over those found, that are tried in addition


@dataclass(frozen=True)
class Edge:
    """passing: the run found, None where there is none.  failing: the next larger step tried.

    again: a still larger step that passes, though `failing` does not.
    """

    passing: Trial | None
    failing: Trial | None
    again: Trial | None = None


Trials = dict[int, Trial]
Evaluate = Callable[[int], Trial]


def edge_of(trials: Mapping[int, Trial], limits: Mapping[str, float]) -> Edge:
    """What the runs that were made so far show."""
    failing = [n for n, trial in trials.items() if not trial.passes(limits)]
    finest = max(failing, default=0)
    passing = [n for n in trials if n > finest]
    beyond = [n for n in trials if n < finest and trials[n].passes(limits)]
    return Edge(
        trials[min(passing)] if passing else None,
        trials[finest] if failing else None,
        trials[min(beyond)] if beyond else None,
    )


def order_between(one: Trial, other: Trial, limits: Mapping[str, float]) -> float | None:
    """The order of the ratio between a coarser run and a finer; None where it shows none."""
    coarse, fine = one.ratio(limits), other.ratio(limits)
    if not (math.isfinite(coarse) and math.isfinite(fine) and coarse > 0.0 and fine > 0.0):
        return None
    order = math.log(coarse / fine) / math.log(other.steps / one.steps)
    return None if order < SATURATED else min(order, STEEPEST)


def _inward(edge: tuple[Trial, Trial], limits: Mapping[str, float], blindly: bool) -> int:
    """Steps between a failing and a passing run: next to the predicted edge, or in the middle."""
    failing, passing = edge
    order = order_between(failing, passing, limits)
    if blindly or order is None:
        return round(math.sqrt(failing.steps * passing.steps))
    predicted = float(failing.steps * failing.ratio(limits) ** (1.0 / order))
    if passing.steps / predicted > EDGE / ASIDE:
        return math.ceil(predicted * ASIDE)
    return math.floor(predicted / ASIDE)


@dataclass(frozen=True)
class Search:
    """The search for one edge, from the runs in `trials`, of which there is one at least.

    Every new run goes there.  fewest, most: steps a horizon that may be tried; the most may depend
    on the last run.  declared: the order to begin with.
    """

    trials: Trials
    evaluate: Evaluate
    limits: Mapping[str, float]
    fewest: int
    most: Callable[[], int]
    declared: float

    def largest_step(self) -> Edge:
        """Seek, until the edge is known well enough or out of reach."""
        for count in range(MOST_RUNS):
            wanted = self._next(blindly=count > MOST_RUNS // 4)
            if wanted is None:
                break
            self.trials[wanted] = self.evaluate(wanted)
        return edge_of(self.trials, self.limits)

    def confirmed(self) -> Edge:
        """As `largest_step`, and then runs next to the edge, until none proves it wrong.

        A step of a tenth more is tried, and steps of a tenth and a third less.
        """
        edge = self.largest_step()
        for _ in range(MOST_RUNS):
            found = edge.passing
            if found is None:
                break
            counts = [math.floor(found.steps * f) if f < 1 else math.ceil(found.steps * f)
                      for f in CONFIRMED]  # fmt: skip
            most = max(self.most(), found.steps)
            for steps in [n for n in counts if self.fewest <= n <= most]:
                if steps not in self.trials:
                    self.trials[steps] = self.evaluate(steps)
            edge = self.largest_step()
            if edge.passing is not None and edge.passing.steps == found.steps:
                break
        return edge

    def _next(self, blindly: bool) -> int | None:
        """Where to run next; None where the edge is known well enough or out of reach."""
        edge = edge_of(self.trials, self.limits)
        failing, passing = edge.failing, edge.passing
        if failing is not None and passing is not None:
            if passing.steps <= max(EDGE * failing.steps, failing.steps + 1):
                return None
            wanted = _inward((failing, passing), self.limits, blindly)
            return min(max(wanted, failing.steps + 1), passing.steps - 1)
        if failing is not None:
            wanted, most = max(self._outward(failing), failing.steps + 1), self.most()
            if wanted <= most:
                return wanted
            return most if most > WORTH * failing.steps else None
        assert passing is not None  # the first run has been made
        if passing.steps <= self.fewest:
            return None
        return max(min(self._outward(passing), passing.steps - 1), self.fewest)

    def _outward(self, known: Trial) -> int:
        """Steps a horizon at which the limits are predicted to be just met, from one side only."""
        others = sorted((t for t in self.trials.values() if t is not known), key=lambda t: t.steps)
        near = min(others, key=lambda t: abs(math.log(t.steps / known.steps)), default=None)
        ratio = known.ratio(self.limits)
        order: float | None = self.declared
        if near is not None:
            coarse, fine = sorted((near, known), key=lambda t: t.steps)
            order = order_between(coarse, fine, self.limits)
        if order is None or not 0.0 < ratio < math.inf:
            leap = BLIND if ratio > 1.0 else 1.0 / BLIND
        else:
            leap = min(max(ratio ** (1.0 / order), 1.0 / LEAP), LEAP)
        aside = ASIDE if ratio > 1.0 else 1.0 / ASIDE
        return round(known.steps * leap * aside)
