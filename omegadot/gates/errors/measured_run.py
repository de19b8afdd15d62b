"""A run measured in each channel: its distance from the exact solution and from its scheme."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from omegadot.adapters.protocol import Integrator
from omegadot.gates.bounds.measures import INVARIANT_CHANNELS, TRAJECTORY_UNITS
from omegadot.gates.bounds.opened import opened_by_scheme
from omegadot.gates.bounds.scales import EPS
from omegadot.gates.case import Sweep
from omegadot.gates.errors.excess import excess_of
from omegadot.gates.errors.highest_order import highest_order
from omegadot.gates.errors.observed_order import ObservedOrder
from omegadot.gates.errors.orders import order_of
from omegadot.gates.errors.sweep_errors import FEWEST_STEPS, Errors
from omegadot.gates.errors.verdicts import BLOWN_UP_UNSEEN, OF_EITHER, Evidence, Finding, judge
from omegadot.gates.truth import Companion, Truth, scheme_key
from omegadot.reference_impl.energy import total_energy
from omegadot.reference_impl.schemes import SCHEMES
from omegadot.reference_impl.system import Array, State, System

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


def errors_of(run: MeasuredRun, channel: str, *, left: bool = False) -> Errors | None:
    """A run's errors in a channel, or what is left of them after the declared scheme."""
    if left and not run.against_scheme:
        return None
    size = run.against_scheme[channel] if left else run.error[channel]
    rounding = run.beside_scheme if left else run.round_off
    bound = np.maximum(rounding[channel], run.floor.get(channel, 0.0))
    largest, saturates = run.saturating_error, channel in SATURATING
    gained = run.gained if channel == "energy" and not left else None
    signed = None if gained is None else size * gained
    return Errors(run.sweep.timestep, run.sweep.times, size, bound, largest, saturates, signed)


def evidence_of(
    measured: MeasuredRun,
    measured_runs: list[MeasuredRun],
    channel: str,
    declared: int | None = None,
) -> Evidence:
    """What one run and the others of its sweep show in a channel. declared: its order."""
    left = measured.against_scheme.get(channel)
    orders: list[ObservedOrder | None] = []
    finer = sum(run.sweep.timestep < measured.sweep.timestep for run in measured_runs)
    highest, excess = np.inf, 0.0
    for part in (False,) if left is None else (False, True):
        errors = [errors_of(run, channel, left=part) for run in measured_runs]
        known = [one for one in errors if one is not None]
        orders.append(order_of(known))
        if measured.single:
            highest = min(highest, highest_order(known))
        if channel in STATE and declared is not None:
            own = next(one for one in known if one.timestep == measured.sweep.timestep)
            excess = max(excess, excess_of(own, known, declared + part))
    bound, floor = measured.round_off[channel], measured.floor.get(channel)
    stiffness = min(run.stiffness for run in measured_runs)
    of_momentum, opened = measured.of_momentum.get(channel), measured.opened.get(channel)
    more = (excess, finer >= FEWEST_STEPS, highest, of_momentum, stiffness, opened)
    return Evidence(measured.error[channel], bound, left, tuple(orders), floor, *more)


@dataclass(frozen=True)
class Declared:
    """What an integrator is judged by: its scheme, and its order per channel (None: conserved)."""

    scheme: str | None
    orders: dict[str, int | None]


def orders_for(integrator: Integrator, system: System) -> dict[str, int | None]:
    """The declared orders; those of a known scheme are higher where the system is simple."""
    key = scheme_key(integrator, system)
    if key is None or key.scheme not in SCHEMES:
        return {c: integrator.orders.get(c) for c in CHANNELS}
    scheme = SCHEMES[key.scheme]
    return {c: scheme.order(c, system, key.coordinates) for c in CHANNELS}


def findings_of(
    measured: MeasuredRun, declared: Declared, measured_runs: list[MeasuredRun]
) -> dict[str, Finding]:
    """Judge every channel of one run; the other runs of its sweep show the orders.

    Where the state blows up as a scheme may, so do energy and angular momentum: these may show no
    order until then, as their errors cancel now and then.
    """
    found = {
        c: judge(evidence_of(measured, measured_runs, c, order), declared.scheme, order)
        for c, order in declared.orders.items()
    }
    lost = [found[c] for c in STATE if c in found and not np.all(np.isfinite(measured.error[c]))]
    if lost and all(finding.kind == "beyond" for finding in lost):
        follow = {c for c, finding in found.items() if finding == BLOWN_UP_UNSEEN}
        found |= dict.fromkeys(follow - {*STATE}, lost[0])
    return found
