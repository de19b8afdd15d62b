"""A wrong exponential of a step's turn: one number of its series, and at which turns it is taken.

Every turn u of a scheme is by the quaternion ``(C, S u)`` made unit, with ``C = cos(x/2)`` and
``S = sin(x/2)/x`` as series in ``x = |u|``. One number in these is fitted to the attitudes of all
steps that are wrong; then each interval of each run must be led on by it, or by the right one.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from omegadot.diagnosis.stepping.kept_run import KeptRun, SchemeOf
from omegadot.diagnosis.stepping.turns.turn_limits import LEAST, by_turns, limit_of
from omegadot.diagnosis.stepping.turns.turn_series import (
    COSINE,
    SINE,
    Series,
    series_named,
    series_to_try,
)
from omegadot.gates.bounds.scales import norm
from omegadot.reference_impl.system import Array

ALONG = 0.05  # of a defect, at most, that is not along the turn
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
        plain = [(run.short, by_turns(run.short, by).sound) for run in runs]
        wrong = [(run, sound) for run, sound in plain if run.fails and not sound.all()]
        if len({run.name for run, _ in wrong}) < LEAST:
            return []
        # along the turn of several steps no defect is whose turns differ
        if not _along(by, *min(wrong, key=lambda one: one[0].sweep.every)):
            return []
        # those of the largest turns show most of the series
        wrong.sort(key=lambda one: -float(np.max(_last_turns(one[0])[~one[1]])))
        for series in every:
            c = 0.0 if series.wrong is None else _fitted(by, wrong[:FITTED], series)
            limit = None if c is None else limit_of(by, plain, series, c)
            if c is not None and limit is not None and series_named(series, c):
                if not limit and _too_short(by, wrong, every):
                    return []  # a scheme of its own, however its numbers are read
                return [f"the turn of a step is by a series {series_named(series, c)}{limit}"]
    return []


def _too_short(
    by: SchemeOf, wrong: Sequence[tuple[KeptRun, NDArray[np.bool_]]], every: Sequence[Series]
) -> bool:
    """Whether a series of right numbers makes every interval of the runs that are wrong."""
    plain = (one for one in every if one.wrong is None)
    return any(all(np.all(by_turns(run, by, one).sound) for run, _ in wrong) for one in plain)


def _last_turns(run: KeptRun) -> Array:
    """(m,) rad, of a step of each interval, by omega at its end."""
    return norm(run.state.angular_velocity[1:]) * run.sweep.timestep


def _along(by: SchemeOf, run: KeptRun, sound: NDArray[np.bool_]) -> bool:
    """Whether the attitude is off along the turn, as by no other quantity of a step."""
    off = by_turns(run, by).apart["attitude"][~sound]
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
            (by_turns(run, by, series, c).apart["attitude"] / run.bounds["attitude"][:, None])[
                ~sound
            ]
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
