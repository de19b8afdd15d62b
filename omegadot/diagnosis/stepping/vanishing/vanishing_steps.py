"""What an engine's steps do as they vanish: its own equation, without any forward dynamics."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from omegadot.diagnosis.equations.evidence import Evidence
from omegadot.diagnosis.reported.singles import fields_in_single, named_single
from omegadot.gates.bounds.scales import EPS, ROUNDINGS_PER_EVALUATION, norm
from omegadot.gates.runs.trajectory import grain_of
from omegadot.gates.steps.limits import Limit, Tolerated, extrapolated
from omegadot.gates.steps.limits import limits as rates_at_no_step
from omegadot.gates.steps.probe import Probe
from omegadot.reference_impl.cross_product import cross
from omegadot.reference_impl.inertia import lever
from omegadot.reference_impl.rotations import attitude_angle, rotate
from omegadot.reference_impl.system import Acceleration, Array, State, System
from omegadot.written import written

EXACT = Tolerated()
AMPLIFIED = 8.0  # what the extrapolation from five halved steps makes of a rounding
STILL = 1e-9  # a factor that is none but for rounding
RANGE = 5  # steps
MOST_DECIMALS = 11
QUANTITIES = {
    "angular_velocity": "omega",
    "orientation": "the attitude",
    "position": "the position",
    "linear_velocity": "the linear velocity",
}
PART = 1e-3  # of what a step is to change: less is nothing
LEFT = 1e-5  # relative: what is left of a state extrapolated to no step from two short ones


@dataclass(frozen=True)
class VanishingSteps:
    """The rates at no step, by channel, and where a step of no length leads.

    start and moved: from the two shortest steps.  limit: from the shortest five, which knows it to
    rounding where the steps are smooth.  longer: from the five before, in double precision.
    rounded: which quantity comes back in a few decimals, and in how many.  single: ``omega is``, of
    what comes back in single precision.
    late_velocity: by which omega and attitude a pivoted body's velocity is that of no place now; ""
    where it is the right one.  stays_below: s, the longest step up to which none changes anything,
    and the shortest that does; zero and infinity where there is none.
    """

    system: System
    states: State
    rates: dict[str, Limit]
    start: State
    moved: State
    limit: State
    eps: float = EPS
    longer: State | None = None
    late_velocity: str = ""
    rounded: str = ""
    stays_below: tuple[float, float] = (0.0, np.inf)
    single: str = ""

    @property
    def evidence(self) -> Evidence:
        """omega-dot and the linear acceleration that the steps follow."""
        angular, angular_bound = within_range(self.rates["omega"])
        linear, linear_bound = within_range(self.rates["linear_momentum"])
        if self.system.load.pivot is not None and not np.all(stays_in_place(self, self.start)):
            linear_bound = np.full_like(linear_bound, np.inf)  # placed by another pivot
        # A wrong rate rounds as well; the bound of the right one, which may be zero, leaves it out.
        own = AMPLIFIED * ROUNDINGS_PER_EVALUATION * self.eps
        angular_bound = angular_bound + own * norm(angular)
        angular_bound = np.where(self.jumps, np.inf, angular_bound)
        linear_bound = linear_bound + own * norm(linear)
        found = Acceleration(angular, linear)
        bounds = (angular_bound, linear_bound)
        return Evidence("steps", self.system, self.states, found, *bounds, self.eps)

    @property
    def jumps(self) -> NDArray[np.bool_]:
        """(m,): whether omega changes by steps that vanish, so that it has no rate."""
        jump = self.rates["omega"].jump
        none = np.zeros(len(self.rates["omega"].expected), dtype=bool)
        return none if jump is None else jump > 0.0

    @property
    def sound(self) -> bool:
        """Whether every rate is the equation's."""
        return all(bool(np.all(one.shares() <= 1.0)) for one in self.rates.values())

    @property
    def still(self) -> bool:
        """Whether no step moves anything."""
        k = None if self.sound else common_factor(self.rates)
        return k is not None and abs(k) < STILL

    @property
    def turns(self) -> bool:
        """Whether the attitude follows omega, by which a pivoted body's place moves as well."""
        if self.system.load.pivot is None:
            return True
        return bool(np.all(self.rates["attitude"].shares() <= 1.0))

    def common_cause(self) -> str:
        """Steps that are too long or too short by a part: every rate is off by one factor."""
        k = None if self.sound else common_factor(self.rates)
        if k is None or abs(k) < STILL:
            return ""
        return f"steps are {written(100 * abs(k - 1.0), 4)} % too {'long' if k > 1.0 else 'short'}"


def vanishing_steps(
    system: System,
    probe: Probe,
    stepped: State,
    eps: float = EPS,
    tolerated: Tolerated = EXACT,
) -> VanishingSteps:
    """From the answers to the gate's own requests: states (m, k, ...) after one step each.

    k is 9 in double and 5 in single precision, whose eps this then is.
    """
    with np.errstate(all="ignore"):
        rates = rates_at_no_step(system, probe, stepped, eps, tolerated)
    ends = [2.0 * f[:, -1] - f[:, -2] for f in vars(stepped).values()]
    moved = [f[:, -1] - f[:, -2] for f in vars(stepped).values()]
    limit = [extrapolated(f[:, -RANGE:]) for f in vars(stepped).values()]
    states = (State(*ends), State(*moved), State(*limit))
    before = [f[:, -RANGE - 1 : -1] for f in vars(stepped).values()]
    longer = State(*map(extrapolated, before)) if before[0].shape[1] == RANGE else None
    late, still = _late_velocity(system, probe, stepped, eps), _stays_below(probe, stepped, rates)
    set_ = State(*(values[:, None] for values in vars(probe.states).values()))
    single = named_single(fields_in_single(stepped, set_)) if eps == EPS else ""
    of_numbers = _rounded(probe, stepped)
    known = (system, probe.states, rates, *states, eps, longer)
    return VanishingSteps(*known, late, of_numbers, still, single)


def _rounded(probe: Probe, stepped: State) -> str:
    """A quantity of which every number after a step, but not before, is of a coarse grid."""
    for name, what in QUANTITIES.items():
        came, set_ = (getattr(states, name) for states in (stepped, probe.states))
        if not np.all(np.isfinite(came)) or not np.any(np.ptp(came, axis=(0, 1))):
            continue
        grain = grain_of(np.unique(came))
        if grain is not None and grain_of(np.unique(set_)) != grain:
            return f"{what} is rounded to multiples of 2^{grain} in each step"
        digits = next((d for d in range(1, MOST_DECIMALS) if _has_decimals(came, d)), None)
        if digits is None or _has_decimals(set_, digits):
            continue
        # of so many digits large numbers have fewer decimals than small ones
        large = came[np.abs(came) >= 0.5 * np.max(np.abs(came))]
        if not _has_decimals(large, digits - 1):
            return f"{what} is rounded to {digits} decimals in each step"
    return ""


def _has_decimals(values: Array, digits: int) -> bool:
    """However the last digit of the double was rounded."""
    return bool(np.all(np.abs(values - np.round(values, digits)) <= 2.0 * EPS * np.abs(values)))


def _late_velocity(system: System, probe: Probe, stepped: State, eps: float) -> str:
    """What stands for omega, or for the attitude, in ``v = R (omega x r)`` after a step."""
    if system.load.pivot is None:
        return ""
    arm = np.asarray(lever(system), dtype=float)
    before = State(*(values[:, None] for values in vars(probe.states).values()))
    w, q, v = stepped.angular_velocity, stepped.orientation, stepped.linear_velocity
    bound = ROUNDINGS_PER_EVALUATION * eps * norm(w) * float(norm(arm))

    def is_of(attitude: Array, omega: Array) -> bool:
        made = rotate(attitude, cross(omega, arm))
        return bool(np.all(norm(v - made) <= bound))

    if is_of(q, w):
        return ""
    old, was = before.angular_velocity + 0.0 * w, before.orientation + 0.0 * q
    ways = {"omega": (q, old), "attitude": (was, w), "omega and attitude": (was, old)}
    return next((what for what, way in ways.items() if is_of(*way)), "")


def _stays_below(probe: Probe, stepped: State, rates: dict[str, Limit]) -> tuple[float, float]:
    """Of states that turn: the longest step that changes nothing, and the shortest that does.

    What an engine makes of a state as it is set and read is not a part of what a step changes.
    """
    start = State(*(values[:, None] for values in vars(probe.states).values()))
    changes = {
        "attitude": attitude_angle(start.orientation, stepped.orientation),
        "omega": norm(stepped.angular_velocity - start.angular_velocity),
        "position": norm(stepped.position - start.position),
        "linear_momentum": norm(stepped.linear_velocity - start.linear_velocity),
    }
    moved = np.zeros(probe.timesteps.shape, dtype=bool)
    for channel, change in changes.items():
        due = norm(rates[channel].expected)[:, None] * probe.timesteps
        moved |= (change > PART * due) & (due > 0.0)
    turning = np.any(probe.states.angular_velocity, axis=-1)
    moved, lengths = moved[turning], probe.timesteps[turning]
    shortest = float(np.min(lengths[moved], initial=np.inf))
    still = lengths[~moved]
    return float(np.max(still[still < shortest], initial=0.0)), shortest


def better(limit: Limit) -> tuple[Array, Array]:
    """Of the two ranges of steps the one with the smaller bound, at every state."""
    bound = np.where(np.isfinite(limit.bound), limit.bound, np.inf)
    best = np.argmin(bound, axis=0)
    places = np.arange(bound.shape[1])
    return limit.found[best, places], limit.bound[best, places]


def within_range(limit: Limit) -> tuple[Array, Array]:
    """The same, where a size can be formed of it; else nothing is known, and the due rate stands.

    Where a wrong term outgrows what steps are short for, its powers leave the range of numbers.
    """
    found, bound = better(limit)
    beyond = np.isfinite(found).all(-1) & ~np.isfinite(norm(found))
    return np.where(beyond[:, None], limit.expected, found), np.where(beyond, np.inf, bound)


def common_factor(rates: dict[str, Limit]) -> float | None:
    """The factor by which all rates are off; None where there is none."""
    with np.errstate(all="ignore"):
        return _common_factor(rates)


def _common_factor(rates: dict[str, Limit]) -> float | None:
    found = np.concatenate([np.ravel(better(one)[0]) for one in rates.values()])
    true = np.concatenate([np.ravel(one.expected) for one in rates.values()])
    weight = np.concatenate([np.repeat(1.0 / better(one)[1], 3) for one in rates.values()])
    used = np.isfinite(weight) & np.isfinite(found)
    found, true = found[used] * weight[used], true[used] * weight[used]
    size = float(true @ true)
    factor = float(found @ true) / size if size > 0.0 else 1.0
    fits = all(np.all(one.shares(factor) <= 1.0) for one in rates.values())
    return factor if fits and factor != 1.0 else None


def stays(steps: VanishingSteps, after: State) -> NDArray[np.bool_]:
    """(m,): whether a state is the one before, but for what is left of the extrapolation.

    A smooth step moves a state less from its limit than it moves between two short steps. A
    pivoted body's place follows from its attitude.
    """
    before, moved = steps.states, steps.moved
    turned = attitude_angle(before.orientation, after.orientation)
    length = np.abs(norm(after.orientation) - 1.0)
    same = np.asarray(np.maximum(turned, length) <= LEFT + 2.0 * norm(moved.orientation))
    w = norm(before.angular_velocity)
    change = norm(after.angular_velocity - before.angular_velocity)
    same &= change <= LEFT * w + norm(moved.angular_velocity)
    return same if steps.system.load.pivot is not None else same & stays_in_place(steps, after)


def stays_in_place(steps: VanishingSteps, after: State) -> NDArray[np.bool_]:
    """(m,): whether place and velocity are those before, but for what the extrapolation leaves."""
    before, moved = steps.states, steps.moved
    lever = float(norm(steps.system.body.center_of_mass))
    speed = norm(before.linear_velocity) + lever * norm(before.angular_velocity)
    push = norm(after.linear_velocity - before.linear_velocity)
    way = norm(after.position - before.position)
    same = push <= LEFT * speed + norm(moved.linear_velocity)
    same &= way <= LEFT * (norm(before.position) + lever) + norm(moved.position)
    return np.asarray(same)
