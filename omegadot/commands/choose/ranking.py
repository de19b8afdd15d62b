"""What a step costs, measured in rounds; ranks, ties within the spread, and the Pareto front."""

from __future__ import annotations

import operator
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from omegadot.commands.choose.candidate import Candidate
from omegadot.commands.choose.search import EDGE
from omegadot.commands.choose.trial import Row, Trial
from omegadot.gates.case import Sweep

FEWEST_ROUNDS, MOST_ROUNDS = 7, 15
SECONDS_A_RUN = 0.15  # so short that a round sees every engine in the same weather
SECONDS_IN_ALL = 8.0
Key = tuple[str, str]  # names of case and candidate


@dataclass(frozen=True)
class Spread:
    """rounds: the values, one a round; in each round everything was measured in turn."""

    rounds: tuple[float, ...]

    @property
    def median(self) -> float:
        """The middle value."""
        return self._quantile(0.5)

    @property
    def quartiles(self) -> tuple[float, float]:
        """A quarter of the values lies below the first, a quarter above the second."""
        return self._quantile(0.25), self._quantile(0.75)

    def _quantile(self, share: float) -> float:
        return float(np.quantile(np.asarray(self.rounds), share))

    def row(self) -> Row:
        """Median, quartiles, and every round."""
        quartiles, rounds = [*self.quartiles], [*self.rounds]
        return {"median": self.median, "quartiles": quartiles, "rounds": rounds}

    def scaled(self, factor: float) -> Spread:
        """Every value multiplied."""
        return Spread(tuple(value * factor for value in self.rounds))

    def under(self, numerator: float) -> Spread:
        """The numerator over every value."""
        return Spread(tuple(numerator / value for value in self.rounds))

    def over(self, other: Spread) -> Spread:
        """Round by round, this over the other: what slowed a whole round cancels."""
        return Spread(tuple(a / b for a, b in zip(self.rounds, other.rounds, strict=True)))


def _moment(trial: Trial) -> Sweep:
    """The horizon, or as much of it as takes a moment; the ends alone are kept."""
    steps = min(trial.steps, max(1, round(SECONDS_A_RUN / max(trial.seconds_per_step, 1e-9))))
    if trial.accuracy is None:
        return Sweep(trial.timestep, steps, steps)
    intervals = trial.samples - 1  # as close together as they were when it was judged
    part = max(1, round(intervals * steps / trial.steps))
    return Sweep(trial.timestep * trial.steps / intervals, part, part, trial.accuracy)


def time_all(wanted: Mapping[Key, tuple[Candidate, Trial]]) -> dict[Key, Spread]:
    """Seconds per step of each, from interleaved repeats after a round that is not counted.

    wanted: candidates, each at the step of one of its runs.  One that fails to answer in any round
    is left out.
    """
    found: dict[Key, list[float]] = {key: [] for key in wanted}
    one = sum(_moment(t).times[-1] / t.timestep * t.seconds_per_step for _, t in wanted.values())
    rounds = int(min(max(SECONDS_IN_ALL / max(one, 1e-9), FEWEST_ROUNDS), MOST_ROUNDS))
    for number in range(rounds + 1):
        for key, (own, trial) in wanted.items():
            moment = _moment(trial)
            answer = own.driver.run(own.ruler.case, own.integrator.name, moment)
            if answer.ok and number:
                part = trial.timestep / moment.timestep  # of one of the run's steps
                found[key].append(float(answer.result["seconds_per_step"]) * part)
    return {key: Spread(tuple(found[key])) for key in found if len(found[key]) == rounds}


def total(spreads: Sequence[Spread]) -> Spread:
    """The sum, round by round."""
    return Spread(tuple(map(sum, zip(*(spread.rounds for spread in spreads), strict=True))))


@dataclass(frozen=True)
class Place:
    """rank: 1 for the cheapest; those that cannot be distinguished from a rank's first share it."""

    candidate: str
    rank: int
    tied: bool


def ranked(costs: Mapping[str, Spread]) -> list[Place]:
    """Places by median cost. Two of which neither is dearer are a tie, not a win and a loss.

    One is dearer that took longer by more than EDGE in three quarters of the rounds at least: a
    step is known no better than that, so neither is its cost.
    A place's ties are with its first: of three where each ties with its neighbour alone, the third
    is not dragged up to the first.
    """
    order = sorted(costs, key=lambda key: costs[key].median)
    groups: list[list[str]] = []
    for key in order:
        if groups and costs[key].over(costs[groups[-1][0]]).quartiles[0] <= EDGE:
            groups[-1].append(key)
        else:
            groups.append([key])
    places, rank = [], 1
    for group in groups:
        places += [Place(key, rank, len(group) > 1) for key in group]
        rank += len(group)
    return places


@dataclass(frozen=True)
class Point:
    """A run that meets the limits. figures: cost, error, memory and so on: less is better."""

    key: str
    figures: tuple[float, ...]


def front(points: Sequence[Point]) -> list[Point]:
    """The points that no other one equals or betters in everything: the Pareto front."""
    found = {p.figures for p in points}
    beaten = {f for f in found for o in found if o != f and all(map(operator.le, o, f))}
    return [p for p in points if p.figures not in beaten]
