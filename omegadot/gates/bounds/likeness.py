"""How alike two motions are, in parts of what rounding may make of the difference."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from omegadot.gates.bounds.opened import opened_by_scheme
from omegadot.gates.case import Sweep
from omegadot.gates.errors.measured_run import CHANNELS, ROTATION
from omegadot.gates.truth import SchemeKey, Truth
from omegadot.reference_impl.system import Array, State


@dataclass(frozen=True)
class Likeness:
    """Two motions compared. share: the largest distance over its bound; at most one if they agree.

    channel: where that is.  distance: the largest distance in omega (relative) and attitude (rad).
    NaN where there was no bounded sample to compare.
    """

    share: float
    channel: str
    distance: float

    @property
    def agree(self) -> bool:
        """Whether rounding alone accounts for the difference."""
        return self.share <= 1.0


def share_of(distance: Array, bound: Array) -> float:
    """The largest distance over its bound, at the samples that have one; the start has nothing.

    NaN where no other sample is bounded: there the motion has blown up.
    """
    bounded = np.isfinite(bound)
    if not bounded[1:].any():
        return float("nan")
    with np.errstate(divide="ignore", invalid="ignore"):
        shares = np.where(distance == 0.0, 0.0, distance / bound)[bounded]
    return float("inf") if np.any(np.isnan(shares)) else float(np.max(shares))


def likeness(distances: Mapping[str, Array], bounds: Mapping[str, Array]) -> Likeness:
    """From the distances by channel, (n,) each, and what rounding may have made of each."""
    shares = {channel: share_of(distances[channel], bounds[channel]) for channel in distances}
    worst = max(shares, key=lambda channel: (np.isnan(shares[channel]), shares[channel]))
    turning = [
        float(np.max(distances[c], where=np.isfinite(bounds[c]), initial=0.0)) for c in ROTATION
    ]
    return Likeness(shares[worst], worst, max(turning))


def like_schemes(truth: Truth, sweep: Sweep, state: State) -> dict[SchemeKey, Likeness]:
    """A run against every scheme that the reference stepped with the same step."""
    found, yardstick = {}, truth.yardstick
    for (key, timestep), own in truth.companions.items():
        if timestep == sweep.timestep:
            faster = yardstick.faster(own.state, timestep)
            bounds = yardstick.round_off(timestep, sweep.sample_steps, own.growth, faster)
            distances = {c: yardstick.distance(c, state, own.state) for c in CHANNELS}
            opened = opened_by_scheme(yardstick, sweep, own, bounds["omega"])
            beside = {c: 2.0 * bounds[c] + opened.get(c, 0.0) for c in CHANNELS}
            found[key] = likeness(distances, beside)
    return found
