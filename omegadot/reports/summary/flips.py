"""How often a body has turned over in a stored trajectory, and whether when the exact one did."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from omegadot.reference_impl.inertia import lever, moving_inertia
from omegadot.reference_impl.system import Array, System

Flipping = Literal["yes", "never", "late", "early"]
# Nearer than this to the middle axis, H is nearer to it than to the plane of the other two.
NEAR = math.cos(math.pi / 4)
# Moments as close as this, relative to the largest, differ by the rounding of their eigenvalues.
_ALIKE = 64 * float(np.finfo(float).eps)


@dataclass(frozen=True)
class Flip:
    """One flip, s. start: the last sample with H within 45° of the middle axis, or its opposite.

    time: omega along that axis changes its sign.  end: the first sample with H within 45° of the
    other direction; infinite where the samples end before.
    """

    start: float
    time: float
    end: float


@dataclass(frozen=True)
class Flips:
    """The flips of a trajectory, in order. until: s, its last finite sample."""

    flips: tuple[Flip, ...]
    until: float

    @property
    def times(self) -> tuple[float, ...]:
        """s, one a flip."""
        return tuple(flip.time for flip in self.flips)


def flip_axis(system: System) -> Array | None:
    """(3,) unit vector of the middle moment of inertia, body axes, where flips are counted.

    None where two moments are equal, or where a torque acts: it may reverse omega by itself.
    """
    load, pulled = system.load, np.any(lever(system))  # gravity turns a pivoted body alone
    loads = (load.damping, load.torque_body, load.torque_world, load.gravity if pulled else 0.0)
    moments, axes = np.linalg.eigh(np.asarray(moving_inertia(system), dtype=float))
    if any(np.any(one) for one in loads) or np.min(np.diff(moments)) <= _ALIKE * moments[-1]:
        return None
    axis: Array = axes[:, 1]
    return axis


def flips_of(time: Array, omega: Array, system: System) -> Flips | None:
    """The flips of one trajectory; None where `flip_axis` has none.

    time: (n,) s, ascending.  omega: (n, 3) rad/s, body axes; samples from the first that is not
    finite on are left out.  With h = I omega / |I omega| and e the middle axis, a flip leads from
    h.e > cos 45° to h.e < -cos 45°, or the reverse; its time is the last sign change in between,
    interpolated linearly. A wobble about another axis changes the sign and turns nothing over. At
    the end a flip counts without its second half, if the sign has changed once.
    """
    axis = flip_axis(system)
    if axis is None:
        return None
    bad = np.flatnonzero(~np.isfinite(omega).all(axis=-1))
    stop = int(bad[0]) if len(bad) else len(time)
    if stop == 0:
        return Flips((), -math.inf)
    time, omega = time[:stop], omega[:stop] / (np.max(np.abs(omega[:stop])) or 1.0)
    along, rate = _along(omega, moving_inertia(system), axis), omega @ axis
    near = np.flatnonzero(np.abs(along) > NEAR)
    turned = np.flatnonzero(along[near[1:]] * along[near[:-1]] < 0.0)
    found = [_flip(time, along, rate, int(near[k]), int(near[k + 1])) for k in turned]
    last = len(time) - 1
    if len(near) and len(_changes(along[near[-1] :])) == 1:
        found.append(_flip(time, along, rate, int(near[-1]), last))
    return Flips(tuple(found), float(time[-1]))


def turned_over(times: Sequence[float], until: float, exact: Flips) -> Flipping | None:
    """Whether a run turns over as the exact motion does.

    times, until: s, of the run's flips and of its last finite sample.  The middles between the
    exact flips part the time, and ``yes`` is one flip in each part. ``never`` is none at all. Else
    the first flip that lies outside the part of its number decides, or is missing: ``late`` where
    it comes after that part or not at all, ``early`` before it or beyond the exact ones. Exact
    flips that end after the run's last sample may be missing; None where all do.
    """
    due = [flip.end <= until for flip in exact.flips]
    if not any(due):
        return None
    if not times:
        return "never"
    middles = [0.5 * (one + other) for one, other in pairwise(exact.times)]
    for place, (start, end) in enumerate(pairwise((-math.inf, *middles, math.inf))):
        if place >= len(times):
            return "late" if due[place] else "yes"
        if not start <= times[place] < end:
            return "late" if times[place] >= end else "early"
    return "early" if len(times) > len(exact.flips) else "yes"


def _along(omega: Array, inertia: Array, axis: Array) -> Array:
    """(n,) the middle axis' component of the direction of I omega; 0 where the body is at rest."""
    size = np.max(np.abs(omega), axis=-1, keepdims=True)
    momentum = np.divide(omega, size, out=np.zeros_like(omega), where=size > 0.0) @ inertia
    length = np.sqrt(np.sum(momentum**2, axis=-1))
    along: Array = np.divide(momentum @ axis, length, out=np.zeros_like(length), where=length > 0.0)
    return along


def _changes(along: Array) -> NDArray[np.intp]:
    """The places after which the sign is another than before; at rest it is the first one's."""
    turned = along * along[0] < 0.0
    return np.flatnonzero(turned[1:] != turned[:-1])


def _flip(time: Array, along: Array, rate: Array, first: int, last: int) -> Flip:
    """The one from the sample `first` to the sample `last`, which is on the other side."""
    before = first + int(_changes(along[first : last + 1])[-1])
    share = rate[before] / (rate[before] - rate[before + 1])
    middle = time[before] + share * (time[before + 1] - time[before])
    end = float(time[last]) if abs(along[last]) > NEAR else math.inf
    return Flip(float(time[first]), float(middle), end)
