"""When a body that spins about its intermediate axis turns over, and whether it does so in time."""

from __future__ import annotations

from itertools import pairwise
from typing import Literal

import numpy as np

from omegadot.reference_impl.system import Array

Flipping = Literal["yes", "late", "early", "no"]
CLEAR = 0.5  # of |omega|: within 60 degrees of the axis, on one side of it


def flip_times(time: Array, omega: Array, inertia: Array) -> tuple[float, ...]:
    """The times at which omega turns over in the body, s.

    ``u = (omega . e) / |omega|``, with e (3,) the principal axis of the intermediate moment of the
    inertia (3, 3). A flip leads from ``u >= 1/2`` to ``u <= -1/2`` or back; its time is that of
    the first zero of u after the last sample of the old side, linear between samples. The shares
    of |omega| hold for a body that is braked as well.
    time: (n,) s.  omega: (n, 3), body axes; samples that are not finite are left out.
    """
    axis = np.linalg.eigh(inertia)[1][:, 1]
    finite = np.isfinite(omega).all(-1)
    with np.errstate(over="ignore"):
        speed = np.linalg.norm(omega, axis=-1)
    turning = finite & (speed > 0.0) & np.isfinite(speed)
    times, share = time[turning], omega[turning] @ axis / speed[turning]
    clear = np.flatnonzero(np.abs(share) >= CLEAR)
    found = []
    for one, other in pairwise(clear):
        if share[one] * share[other] < 0.0:
            inside = np.flatnonzero(share[one] * share[one + 1 : other + 1] <= 0.0)
            after = one + 1 + int(inside[0])
            before, left, right = after - 1, share[after - 1], share[after]
            part = left / (left - right)
            found.append(float(times[before] + part * (times[after] - times[before])))
    return tuple(found)


def in_time(flips: tuple[float, ...], exact: tuple[float, ...]) -> Flipping:
    """Whether a body flips as the exact motion does, which flips at least once.

    The middles between the exact flips cut the run into parts. ``yes``: one flip in each part.
    ``no``: none in the run. Else, by the first middle, or the end of the run, up to which it has
    not flipped as often as the exact motion: ``late`` for less, ``early`` for more.
    """
    if not flips:
        return "no"
    middles = [0.5 * (one + other) for one, other in pairwise(exact)]
    for due, end in enumerate([*middles, np.inf], 1):
        done = sum(flip < end for flip in flips)
        if done != due:
            return "late" if done < due else "early"
    return "yes"
