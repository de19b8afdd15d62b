"""A run measured in each channel: its distance from the exact solution and from its scheme."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from omegadot.gates.bounds.measures import INVARIANT_CHANNELS, TRAJECTORY_UNITS
from omegadot.gates.bounds.opened import opened_by_scheme
from omegadot.gates.bounds.scales import EPS
from omegadot.gates.case import Sweep
from omegadot.gates.errors.verdicts import OF_EITHER
from omegadot.gates.truth import Companion, Truth
from omegadot.reference_impl.energy import total_energy
from omegadot.reference_impl.system import Array, State

CHANNELS = (*TRAJECTORY_UNITS, *INVARIANT_CHANNELS)
ROTATION = ("omega", "attitude")
SATURATING = (*ROTATION, "linear_momentum")
# The state; energy and angular momentum follow from it, and their errors cancel now and then.
STATE = (*ROTATION, "position", "linear_momentum")


@dataclass(frozen=True)
class MeasuredRun:
    """One engine's run, measured. All arrays are (n,) at the sample times, by channel.

    gained: whether the energy is larger (1) than the exact one or smaller (-1), where it is known.
    opened: see `opened_by_scheme`; empty where it leaves nothing open.
    single: whether the engine works in single precision.  of_momentum: what rounding may grow to
    where the scheme is not known, and may step the angular momentum.  stiffness: see `Evidence`.
    """

    sweep: Sweep
    error: dict[str, Array]
    round_off: dict[str, Array]
    against_scheme: dict[str, Array] = field(default_factory=dict)
    floor: dict[str, Array] = field(default_factory=dict)
    gained: Array | None = field(default=None, kw_only=True)
    single: bool = field(default=False, kw_only=True)
    of_momentum: dict[str, Array] = field(default_factory=dict, kw_only=True)
    stiffness: float = field(default=0.0, kw_only=True)
    opened: dict[str, Array] = field(default_factory=dict, kw_only=True)

    @property
    def beside_scheme(self) -> dict[str, Array]:
        """How far rounding may take it from its scheme's run: each of the two may be off."""
        bounds = self.round_off.items()
        return {c: OF_EITHER * bound + self.opened.get(c, 0.0) for c, bound in bounds}

    def equals_by_rounding(self, channel: str) -> bool:
        """Whether rounding alone tells it from its scheme's run in a channel."""
        bound = OF_EITHER * self.round_off[channel]
        return bool(np.all(self.against_scheme[channel] <= bound))

    def may_be_rounding(self, channel: str) -> bool:
        """Whether an unknown scheme may have made all of the error by rounding the momentum."""
        rounding = self.of_momentum.get(channel)
        if self.against_scheme or rounding is None:
            return False
        return bool(np.all(self.error[channel] <= rounding))

    @property
    def saturating_error(self) -> Array:
        """(n,), the largest error of those that saturate where they are as large as the motion."""
        worst: Array = np.maximum.reduce([self.error[channel] for channel in SATURATING])
        return worst


def measure(truth: Truth, sweep: Sweep, state: State, own: Companion | None) -> MeasuredRun:
    """Distances of `state` from the exact trajectory and, where there is one, the scheme's own.

    What is not a number is infinitely far off, and where the scheme's own state is none there is
    no bound.
    """
    yardstick, rows, exact = truth.yardstick, truth.rows(sweep), truth.at(sweep)

    with np.errstate(over="ignore", invalid="ignore"):  # an engine may be where squares overflow
        mine, right = (total_energy(yardstick.system, one) for one in (state, exact))
        gained = np.sign(mine - right)

    def apart(other: State) -> dict[str, Array]:
        return {c: _sizes(yardstick.distance(c, state, other)) for c in CHANNELS}

    growth = own.growth if own else truth.growth[rows]
    faster = yardstick.faster(own.state, sweep.timestep) if own else 1.0
    how = (sweep.timestep, sweep.sample_steps, growth, faster)
    bounds = yardstick.round_off(*how)
    opened = opened_by_scheme(yardstick, sweep, own, bounds["omega"]) if own else {}
    momentum = yardstick.of_momentum().round_off(*how) if own is None else bounds
    return MeasuredRun(
        sweep=sweep,
        error=apart(exact),
        round_off={channel: _sizes(bound) for channel, bound in bounds.items()},
        against_scheme=apart(own.state) if own else {},
        floor={channel: values[rows] for channel, values in truth.floor.items()},
        gained=gained,
        single=yardstick.eps > EPS,
        of_momentum={channel: _sizes(bound) for channel, bound in momentum.items()},
        stiffness=sweep.timestep * yardstick.thin_rate,
        opened=opened,
    )


def _sizes(values: Array) -> Array:
    return np.where(np.isnan(values), np.inf, values)
