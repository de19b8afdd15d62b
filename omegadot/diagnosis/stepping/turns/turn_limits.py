"""At which turns of a step a series is taken: below a limit, above one, or at all.

Intervals that either the series or the right exponential makes alone bound the limit. One that
crosses it is made by neither; it is stepped with limits between these bounds, turn by turn.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from omegadot.diagnosis.stepping.kept_run import CHANNELS, SLACK, KeptRun, SchemeOf
from omegadot.diagnosis.stepping.turns.turn_series import Series
from omegadot.diagnosis.wording.digits import limits
from omegadot.gates.bounds.scales import norm
from omegadot.reference_impl.coordinates import canonical
from omegadot.reference_impl.one_body.body_motion import body_motion
from omegadot.reference_impl.rotations import quaternion_product
from omegadot.reference_impl.schemes import Motion
from omegadot.reference_impl.system import Array

LEAST = 3  # intervals that show it, and scenarios
MOST_LIMITS = 128  # that are tried in one run
SAME = 1e-5  # relative: turns of iterations that end at one
SIDES = ("below", "above")


@dataclass(frozen=True)
class Turned:
    """Of m intervals. apart: (m, 3) per channel.  sound: (m,).  turns: (k, m) rad, of each step."""

    apart: dict[str, Array]
    sound: NDArray[np.bool_]
    turns: Array


def by_turns(
    run: KeptRun,
    by: SchemeOf,
    series: Series | None = None,
    c: float = 0.0,
    limit: float = np.inf,
    side: str = "below",
) -> Turned:
    """A run's intervals by a scheme whose turns are by a series on one side of a limit in rad."""
    own = SchemeOf(by.scheme, canonical(run.system, by.coordinates))
    exact, turns = body_motion(run.system, own.coordinates), list[Array]()

    def retract(q: Array, u: Array) -> Array:
        place, turn = exact.retract(q, u), u[..., -3:]
        turns.append(norm(turn))
        if series is None:
            return place
        turned = quaternion_product(q[..., -4:], series.unit(turn, c))
        acts = (turns[-1] < limit) if side == "below" else (turns[-1] > limit)
        turned = np.where(acts[..., None], turned, place[..., -4:])
        return np.concatenate((place[..., :-4], turned), axis=-1)

    motion: Motion = replace(exact, retract=retract)
    apart = run.apart(run.ends(own, motion))
    sound = np.all([norm(apart[x]) <= SLACK * run.bounds[x] for x in CHANNELS], axis=0)
    every = np.stack(turns) if turns else np.zeros((1, len(sound)))
    return Turned(apart, np.asarray(sound), every)


def limit_of(
    by: SchemeOf, plain: Sequence[tuple[KeptRun, NDArray[np.bool_]]], series: Series, c: float
) -> str | None:
    """Up to which turn a series is taken, or from which on.

    plain: runs, and which of their intervals the scheme makes as it is.  None where an interval is
    by neither, or where no turn sorts those that show which it is by.
    """
    wrong, exact, crossing = list[Array](), list[Array](), list[tuple[KeptRun, Array]]()
    for run, right in sorted(plain, key=lambda one: not one[0].fails):
        found = by_turns(run, by, series, c)
        made, largest = found.sound, np.max(found.turns, axis=0)
        # a step of several turns may be by both, on either side of a limit that lies between them
        mixed = np.ptp(found.turns, axis=0) > 0.0
        if run.sweep.every == 1 and not np.all(made | right | mixed):
            return None
        wrong.append(largest[made & ~right])
        exact.append(largest[right & ~made])
        crossing.append((run, found.turns))
        if not any(low < high for low, high in _bounds(wrong, exact)):
            return None
    if sum(map(len, wrong)) < LEAST:
        return None
    if not sum(map(len, exact)):  # a series that is too short at every turn is a scheme of its own
        every = all(np.all(by_turns(run, by, series, c).sound) for run, _ in plain if run.fails)
        return "" if series.wrong is not None and every else None
    for side, (low, high) in zip(SIDES, _bounds(wrong, exact), strict=True):
        between = _sorting(by, crossing, series, c, side, low, high) if low < high else None
        if between is not None:
            return f", where the turn is {side} a limit between {limits(*between, 'rad')}"
    return None


def _bounds(wrong: Sequence[Array], exact: Sequence[Array]) -> list[tuple[float, float]]:
    """rad: from where to where a limit is, of a series below it and of one above it.

    Smaller turns of an interval show less: it is the largest by which it is made.
    """
    one, other = np.concatenate(wrong), np.concatenate(exact)
    return [
        (float(np.max(low, initial=-np.inf)), float(np.min(high, initial=np.inf)))
        for low, high in ((one, other), (other, one))
    ]


def _sorting(
    by: SchemeOf,
    runs: Sequence[tuple[KeptRun, Array]],
    series: Series,
    c: float,
    side: str,
    low: float,
    high: float,
) -> tuple[float, float] | None:
    """The bounds, in rad, of limits with which every interval of all runs is made."""

    def inside(turns: Array) -> Array:
        found = np.unique(turns[(turns > low) & (turns < high)])
        return found[np.append(True, np.diff(found) > SAME * found[1:])] if len(found) else found

    def made(run: KeptRun, limit: float) -> bool:
        return bool(np.all(by_turns(run, by, series, c, limit, side).sound))

    for run, turns in sorted(runs, key=lambda one: len(inside(one[1]))):
        between = inside(turns)  # of fewer the more that others have shown
        if not len(between):
            continue
        if len(between) > MOST_LIMITS:
            return None
        gaps = [*pairwise([low, *between, high])]
        left = [gap for gap in gaps if made(run, 0.5 * sum(gap))]
        if not left:
            return None
        low, high = float(left[0][0]), float(left[-1][1])
    limit = 0.5 * (low + high)
    across = [r for r, t in runs if np.any((t.min(axis=0) < high) & (t.max(axis=0) > low))]
    return (low, high) if all(made(run, limit) for run in across) else None
