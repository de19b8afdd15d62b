"""A wrong exponential of a step's turn: one number of its series, and at which turns it is taken.

Every turn u of a scheme is by the quaternion ``(C, S u)`` made unit, with ``C = cos(x/2)`` and
``S = sin(x/2)/x`` as series in ``x = |u|``. One number in these is fitted to the attitudes of all
steps that are wrong; then each interval of each run must be led on by it, or by the right one.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from omegadot.diagnosis.stepping.kept_run import CHANNELS, SLACK, KeptRun, SchemeOf
from omegadot.diagnosis.stepping.turns.turn_series import (
    COSINE,
    SINE,
    Series,
    series_named,
    series_to_try,
)
from omegadot.diagnosis.wording.digits import limits
from omegadot.gates.bounds.scales import norm
from omegadot.reference_impl.coordinates import canonical
from omegadot.reference_impl.one_body.body_motion import body_motion
from omegadot.reference_impl.rotations import quaternion_product
from omegadot.reference_impl.schemes import Motion
from omegadot.reference_impl.system import Array

ALONG = 0.05  # of a defect, at most, that is not along the turn
LEAST = 3  # intervals that show it, and scenarios
FITTED, TRIES = 3, 4  # runs by which a number is found, and its corrections
SETTLED = 1e-9


def exponential_causes(by: SchemeOf, runs: Sequence[KeptRun]) -> list[str]:
    """The series by which small turns are taken; none where an interval is by neither."""
    single = [run for run in runs if run.sweep.every == 1]
    every = series_to_try()
    found = _causes_in(by, single, every)
    if found or len(single) == len(runs):
        return found
    # an interval of several steps may be by both: no number is fitted to it
    return _causes_in(by, runs, [one for one in every if one.wrong is None])


def _causes_in(by: SchemeOf, runs: Sequence[KeptRun], every: Sequence[Series]) -> list[str]:
    with np.errstate(all="ignore"):
        plain = [(run.short, _sound(run.short, by, None, 0.0)) for run in runs]
        wrong = [(run, sound) for run, sound in plain if run.fails and not sound.all()]
        if len({run.name for run, _ in wrong}) < LEAST or not _along(by, *wrong[0]):
            return []
        # those of the largest turns show most of the series
        wrong.sort(key=lambda one: -float(np.max(_turns(one[0])[~one[1]])))
        for series in every:
            c = 0.0 if series.wrong is None else _fitted(by, wrong[:FITTED], series)
            limit = None if c is None else _limit(by, plain, series, c)
            if c is not None and limit is not None and series_named(series, c):
                return [f"the turn of a step is by a series {series_named(series, c)}{limit}"]
    return []


def _motion(run: KeptRun, by: SchemeOf, series: Series | None, c: float) -> Motion:
    exact = body_motion(run.system, by.coordinates)
    if series is None:
        return exact

    def retract(q: Array, u: Array) -> Array:
        turned = quaternion_product(q[..., -4:], series.unit(u[..., -3:], c))
        return np.concatenate((exact.retract(q, u)[..., :-4], turned), axis=-1)

    return replace(exact, retract=retract)


def _apart(run: KeptRun, by: SchemeOf, series: Series | None, c: float) -> dict[str, Array]:
    own = SchemeOf(by.scheme, canonical(run.system, by.coordinates))
    return run.apart(run.ends(own, _motion(run, own, series, c)))


def _sound(run: KeptRun, by: SchemeOf, series: Series | None, c: float) -> NDArray[np.bool_]:
    apart = _apart(run, by, series, c)
    return np.asarray(np.all([norm(apart[x]) <= SLACK * run.bounds[x] for x in CHANNELS], axis=0))


def _turns(run: KeptRun) -> Array:
    """(m,) rad, of a step of each interval, by omega at its end."""
    return norm(run.state.angular_velocity[1:]) * run.sweep.timestep


def _along(by: SchemeOf, run: KeptRun, sound: NDArray[np.bool_]) -> bool:
    """Whether the attitude is off along the turn, as by no other quantity of a step."""
    off = _apart(run, by, None, 0.0)["attitude"][~sound]
    axis = run.state.angular_velocity[1:][~sound]
    across = norm(np.cross(off, axis)) / (norm(off) * norm(axis))
    return bool(np.median(across) < ALONG)


def _fitted(
    by: SchemeOf, wrong: Sequence[tuple[KeptRun, NDArray[np.bool_]]], series: Series
) -> float | None:
    """The number that leaves least of the attitudes, by Gauss-Newton."""
    right = [*(SINE if series.of_sine else COSINE).values()][series.wrong or 0][0]

    def off(c: float) -> Array:
        lines = [
            (_apart(run, by, series, c)["attitude"] / run.bounds["attitude"][:, None])[~sound]
            for run, sound in wrong
        ]
        return np.concatenate([np.ravel(line) for line in lines])

    c, delta = right, 1e-3 * right
    for _ in range(TRIES):
        here = off(c)
        slope = (off(c + delta) - here) / delta
        moved = -np.float64(slope @ here) / np.float64(slope @ slope)
        c = float(c + moved)
        if not np.isfinite(c):
            return None  # or the number makes no difference
        if abs(moved) < SETTLED * abs(right):
            break
    return c


def _limit(
    by: SchemeOf, plain: Sequence[tuple[KeptRun, NDArray[np.bool_]]], series: Series, c: float
) -> str | None:
    """Up to which turn it is taken, or from which on.

    None where an interval is by neither, or where no turn sorts those that show which it is by.
    """
    wrong, exact, both = list[Array](), list[Array](), list[Array]()
    for run, right in plain:
        made, turns = _sound(run, by, series, c), _turns(run)
        wrong.append(turns[made & ~right])
        exact.append(turns[right & ~made])
        if not np.all(made | right):
            if run.sweep.every == 1:
                return None
            both.append(_between_samples(run)[:, ~(made | right)])
    one, other = np.concatenate(wrong), np.concatenate(exact)
    mixed = np.concatenate(both, axis=1) if both else np.zeros((2, 0))
    if len(one) < LEAST:
        return None
    if not len(other):  # a series that is too short at every turn is a scheme of its own
        return "" if series.wrong is not None and not mixed.size else None
    for side, low, high in (("below", one, other), ("above", other, one)):
        least, most = float(np.max(low)), float(np.min(high))
        if least < most and np.all((mixed[0] < most) & (mixed[1] > least)):
            return f", where the turn is {side} a limit between {limits(least, most, 'rad')}"
    return None


def _between_samples(run: KeptRun) -> Array:
    """(2, m) rad: the least and the largest turn of a step in each interval, by its ends."""
    turns = norm(run.state.angular_velocity) * run.sweep.timestep
    return np.stack((np.minimum(turns[1:], turns[:-1]), np.maximum(turns[1:], turns[:-1])))
