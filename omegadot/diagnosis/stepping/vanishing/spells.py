"""Runs that are sound until a step after which the body rests, and between which limits it fell.

With N steps in a row below a limit L of a quantity Q, a body falls asleep in the first step n of
which ``max(Q_{n-N+1}, ..., Q_n) < L``. So for each Q and N a run that falls asleep in step n leaves
L between two numbers, the least such maximum up to n and the least before; one that does not fall
asleep leaves it below the second.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from omegadot.diagnosis.stepping.kept_run import SLACK, KeptRun, SchemeOf
from omegadot.diagnosis.stepping.vanishing.rests import UNITS, quantities, stands
from omegadot.gates.bounds.scales import EPS, norm
from omegadot.reference_impl.one_body.body_motion import body_motion
from omegadot.reference_impl.rotations import normalize, rotation_between
from omegadot.reference_impl.stepping import step_body
from omegadot.reference_impl.system import Array, State, System

MOST_IN_A_ROW = 256  # steps
ROUNDINGS = 8  # of a state at rest that is given in other coordinates than it is stepped in
NEAR = 1e-9  # relative: a time that is a whole number of steps but for rounding
WAYS = 2  # the steps alone are counted, or the state that is given as well


@dataclass(frozen=True, eq=False)
class Spell:
    """Of a run of this scenario: low and high (WAYS, Q, N), what its limit is not below or above.

    Q: the quantities of `UNITS`.  N: from 1 on, how many steps in a row.  timestep: s.  fell: the
    step by which it falls asleep; 0 where it does not, and low is zero.  values: (Q, fell + 1) of
    the given state and after each step.  early: in how many fewer steps
    it may have fallen asleep.
    """

    name: str
    timestep: float
    low: Array
    high: Array
    fell: int
    values: Array
    early: int = 0

    def below_for(self, times: Array) -> tuple[Array, Array]:
        """Low and high (WAYS, Q, T) where the steps in a row last these times in s, or just longer.

        A time that is a whole number of steps takes one more where rounding has it so. Of more
        steps than are counted nothing is known, but that the run has taken them.
        """
        ratio, numbers = times / self.timestep, self.numbers_of(times)
        more = numbers + (np.abs(ratio - numbers) <= NEAR * ratio)
        (low, high), (lower, higher) = self._ends(numbers), self._ends(more)
        return np.minimum(low, lower), np.maximum(high, higher)

    def steps_of(self, time: float) -> int:
        """In a row, that last so many s or just longer, of those that are counted."""
        return min(int(self.numbers_of(np.array(time))), MOST_IN_A_ROW)

    def numbers_of(self, times: Array) -> NDArray[np.intp]:
        """How many steps last these times in s, or just longer."""
        return np.asarray(np.maximum(np.ceil(times / self.timestep * (1.0 - NEAR)), 1), dtype=int)

    def _ends(self, numbers: NDArray[np.intp]) -> tuple[Array, Array]:
        """Of so many steps in a row."""
        places = np.minimum(numbers, MOST_IN_A_ROW) - 1
        unknown = numbers > MOST_IN_A_ROW
        given = np.arange(WAYS)[:, None, None]
        least = np.where(self.fell and numbers > self.fell + given, np.inf, 0.0)
        low = np.where(unknown, least, self.low[:, :, places])
        return low, np.where(unknown, np.inf, self.high[:, :, places])

    def steps_between(self, quantity: int, number: int, way: int, low: float, high: float) -> int:
        """In how many of its steps it would fall asleep by a limit between these two."""
        row = self.values[quantity : quantity + 1, 1 - way :]
        if row.shape[1] < number:
            return 0
        most = np.max(np.lib.stride_tricks.sliding_window_view(row[0], number), axis=-1)
        reached = np.minimum.accumulate(most)
        before = np.append(np.inf, reached[:-1])
        return int(np.count_nonzero((reached < high) & (before > low) & (reached < before)))


def rests_from(run: KeptRun) -> int:
    """The first sample from which on the body rests to the end, though it began moving; 0 if none.

    Its velocities are zero there, and neither its attitude nor its place changes any more.
    """
    still = _is_still(run.system, run.state)
    first = int(np.argmax(still))
    after = run.state[first:]
    names = ["orientation", *(["position"] if run.system.load.pivot is None else [])]
    for name in names:
        values = getattr(after, name)
        still[first:] &= norm(values - values[:1]) <= ROUNDINGS * EPS * norm(values[:1])
    return first if first > 0 and bool(np.all(still[first:])) else 0


def _is_still(system: System, states: State) -> NDArray[np.bool_]:
    """(n,): whether the velocities are zero; a pivoted body's follows from omega."""
    moves = np.any(states.linear_velocity, axis=-1)
    return stands(states) if system.load.pivot is not None else stands(states) & ~moves


def slept(run: KeptRun, by: SchemeOf) -> Spell | None:
    """Of a run that rests from some sample on; None if it is not sound before, or is sound then."""
    first = rests_from(run)
    if not first:
        return None
    stepped = _steps_within(run, by, first)
    ends = State(*(f[-1] for f in vars(stepped).values()))
    good = run.reached(ends, first)
    if not np.all(good[:-1]) or good[-1] or np.any(_is_still(run.system, ends)):
        return None
    last = State(*(f[:, -1] for f in vars(stepped).values()))
    near = np.flatnonzero(_rests_at(run, last, first))
    if not len(near):
        return None
    before = (first - 1) * run.sweep.every
    return _spell(run, stepped, (int(near[0]) + before, int(near[-1]) + before))


def awake(run: KeptRun, by: SchemeOf) -> Spell | None:
    """Of a run that is sound up to some sample, until which it has not fallen asleep."""
    stepped = _steps_within(run, by, len(run.times) - 1)
    good = run.reached(State(*(f[-1] for f in vars(stepped).values())))
    count = len(good) if good.all() else int(np.argmin(good))
    if not count:
        return None
    return _spell(run, State(*(f[:, :count] for f in vars(stepped).values())), None)


def sizes(run: KeptRun) -> Array:
    """(Q, n - 1): the quantities of the samples after the start."""
    return np.stack([*quantities(run.system, run.state[1:]).values()])


def _steps_within(run: KeptRun, by: SchemeOf, count: int) -> State:
    """(every + 1, count, ...): all steps from each of the first samples to the next."""
    start, every = run.state[:count], run.sweep.every
    unit = State(**{**vars(start), "orientation": normalize(start.orientation)})
    plan = (run.sweep.timestep, every, 1, by.coordinates)
    with np.errstate(all="ignore"):
        own = body_motion(run.system, by.coordinates)
        return step_body(by.scheme, run.system, unit, *plan, own)[1]


def _rests_at(run: KeptRun, stepped: State, first: int) -> NDArray[np.bool_]:
    """(every + 1,): whether the attitude and the place of these steps are those of the rest."""
    bounds, rest = run.bounds, run.state[first]
    turned = norm(
        rotation_between(stepped.orientation, 0.0 * stepped.orientation + rest.orientation)
    )
    moved = norm(stepped.position - rest.position)
    near = turned <= SLACK * bounds["attitude"][first - 1]
    return np.asarray(near & (moved <= SLACK * bounds["position"][first - 1]))


def _spell(run: KeptRun, stepped: State, asleep: tuple[int, int] | None) -> Spell:
    """asleep: between which steps, both included, the body falls asleep."""
    parts = [np.moveaxis(f[1:], 0, 1).reshape(-1, f.shape[-1]) for f in vars(stepped).values()]
    first = [f[:1] for f in vars(run.state).values()]
    states = State(*(np.concatenate(pair) for pair in zip(first, parts, strict=True)))
    values = np.stack([*quantities(run.system, states).values()])
    begin, end = asleep or (values.shape[1], values.shape[1])
    low = np.full((WAYS, len(UNITS), MOST_IN_A_ROW), np.inf)
    high = low.copy()
    for way in range(WAYS):
        for n, (number, most) in enumerate(_in_a_row(values[:, 1 - way :])):
            steps = number - way  # by which step so many are in a row
            high[way, :, n] = np.min(most[:, : max(0, begin - steps)], axis=-1, initial=np.inf)
            low[way, :, n] = np.min(most[:, : max(0, end - steps + 1)], axis=-1, initial=np.inf)
    if asleep is None:
        return Spell(run.name, run.timestep, np.zeros_like(low), high, 0, values)
    return Spell(run.name, run.timestep, low, high, end, values[:, : end + 1], end - begin)


def _in_a_row(values: Array) -> Iterator[tuple[int, Array]]:
    """N, and the largest of each N values in a row: (Q, n - N + 1)."""
    most = values
    for number in range(1, min(MOST_IN_A_ROW, values.shape[1]) + 1):
        yield number, most
        most = np.maximum(most[:, :-1], values[:, number:])
