"""What an engine's steps do as they vanish: its own equation, without any forward dynamics."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from omegadot.diagnosis.equations.evidence import SLACK, Evidence
from omegadot.diagnosis.models.misreadings import fitted_misreadings, misreadings
from omegadot.diagnosis.wording.conditions import only_where
from omegadot.diagnosis.wording.digits import factor, limits
from omegadot.gates.bounds.scales import EPS, ROUNDINGS_PER_EVALUATION, norm
from omegadot.gates.steps.vanishing_step import Limit, Probe, Tolerated
from omegadot.gates.steps.vanishing_step import limits as rates_at_no_step
from omegadot.reference_impl.cross_product import cross
from omegadot.reference_impl.rotations import (
    attitude_angle,
    quaternion_product,
    rotate,
    rotate_inverse,
)
from omegadot.reference_impl.system import Acceleration, Array, State, System

EXACT = Tolerated()
AMPLIFIED = 8.0  # what the extrapolation from five halved steps makes of a rounding
STILL = 1e-9  # a factor that is none but for rounding
LEFT = 1e-5  # relative: what is left of a state extrapolated to no step from two short ones


@dataclass(frozen=True)
class VanishingSteps:
    """The rates at no step, by channel, and where a step of no length leads."""

    system: System
    states: State
    rates: dict[str, Limit]
    start: State
    moved: State
    eps: float = EPS

    @property
    def evidence(self) -> Evidence:
        """omega-dot and the linear acceleration that the steps follow."""
        angular, angular_bound = _better(self.rates["omega"])
        linear, linear_bound = _better(self.rates["linear_momentum"])
        if self.system.load.pivot is not None and not np.all(_stays_in_place(self, self.start)):
            linear_bound = np.full_like(linear_bound, np.inf)  # placed by another pivot
        # A wrong rate rounds as well; the bound of the right one, which may be zero, leaves it out.
        own = AMPLIFIED * ROUNDINGS_PER_EVALUATION * self.eps
        angular_bound = angular_bound + own * norm(angular)
        linear_bound = linear_bound + own * norm(linear)
        found = Acceleration(angular, linear)
        bounds = (angular_bound, linear_bound)
        return Evidence("steps", self.system, self.states, found, *bounds, self.eps)

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
        return f"steps are {100 * abs(k - 1.0):.4g} % too {'long' if k > 1.0 else 'short'}"


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
    return VanishingSteps(system, probe.states, rates, State(*ends), State(*moved), eps)


def _better(limit: Limit) -> tuple[Array, Array]:
    """Of the two ranges of steps the one with the smaller bound, at every state."""
    bound = np.where(np.isfinite(limit.bound), limit.bound, np.inf)
    best = np.argmin(bound, axis=0)
    places = np.arange(bound.shape[1])
    return limit.found[best, places], limit.bound[best, places]


def common_factor(rates: dict[str, Limit]) -> float | None:
    """The factor by which all rates are off; None where there is none."""
    with np.errstate(all="ignore"):
        return _common_factor(rates)


def _common_factor(rates: dict[str, Limit]) -> float | None:
    found = np.concatenate([np.ravel(_better(one)[0]) for one in rates.values()])
    true = np.concatenate([np.ravel(one.expected) for one in rates.values()])
    weight = np.concatenate([np.repeat(1.0 / _better(one)[1], 3) for one in rates.values()])
    used = np.isfinite(weight) & np.isfinite(found)
    found, true = found[used] * weight[used], true[used] * weight[used]
    size = float(true @ true)
    factor = float(found @ true) / size if size > 0.0 else 1.0
    fits = all(np.all(one.shares(factor) <= 1.0) for one in rates.values())
    return factor if fits and factor != 1.0 else None


def kinematic_cause(steps: VanishingSteps) -> str:
    """What attitude and position follow in place of omega and the velocity; "" where they do."""
    system, states = steps.system, steps.states
    q, w, v = states.orientation, states.angular_velocity, states.linear_velocity
    lever = rotate(q, cross(w, system.body.center_of_mass))
    candidates: dict[str, dict[str, Array]] = {
        "attitude": {
            "the attitude does not move, or not in the first step of a run": 0 * w,
            "the attitude turns by omega taken in world axes": rotate_inverse(q, w),
            "the attitude turns by R omega taken in body axes": rotate(q, w),
            "the attitude turns the wrong way": -w,
        },
        "position": {
            "the position does not move, or not in the first step of a run": 0 * v,
            "the position moves by the velocity taken in body axes": rotate(q, v),
            "the position moves by R^T v": rotate_inverse(q, v),
            "the position moves with the velocity of the body's origin": v - lever,
            "the position moves with the velocity of a point on the centre of mass's other side": (
                v + lever
            ),
            "the position moves the wrong way": -v,
        },
    }
    if system.load.pivot is not None:
        del candidates["position"]
    if steps.still:
        return "a run of one step does not move"
    for channel, named in candidates.items():
        limit = steps.rates[channel]
        found, bound = _better(limit)
        if np.all(limit.shares() <= 1.0):
            continue
        for text, rate in named.items():
            if np.all(norm(found - rate) <= SLACK * bound):
                return f"in the steps, {text}"
    return ""


def moves_by_cause(steps: VanishingSteps) -> str:
    """The attitude or the position moves by a factor of what it should; "" where it does not.

    By half or by one and a half it is as well of another time than the rest.
    """
    for channel, what in (("attitude", "omega"), ("position", "the velocity")):
        limit = steps.rates[channel]
        found, bound = _better(limit)
        if np.all(limit.shares() <= 1.0) or (
            channel == "position" and steps.system.load.pivot is not None
        ):
            continue
        weight = np.where(np.isfinite(bound) & (bound > 0.0), 1.0 / bound, 0.0)[:, None]
        size = float(np.sum((limit.expected * weight) ** 2))
        k = float(np.sum(found * limit.expected * weight**2)) / size if size > 0.0 else 1.0
        if not np.all(norm(found - k * limit.expected) <= SLACK * bound) or abs(k) < STILL:
            continue
        text = f"in the steps, the {channel} moves by {factor(k)} times {what}"
        for half, when in ((0.5, "before"), (1.5, "after")):
            if abs(k - half) < 1e-6:
                return f"either the {channel} is reported as of half a step {when}, or, {text}"
        return text
    return ""


def omega_still_cause(steps: VanishingSteps) -> str:
    """Omega does not change in the first step of a run, which has two explanations."""
    limit = steps.rates["omega"]
    found, bound = _better(limit)
    still = bool(np.all(norm(found) <= SLACK * bound)) and not np.all(limit.shares() <= 1.0)
    text = "either omega is reported late, or it does not change in the first step of a run"
    return text if still else ""


def omega_share_cause(steps: VanishingSteps) -> str:
    """Omega alone moves by a part of omega-dot, as where it is of another time than the rest."""
    if not all(np.all(one.shares() <= 1.0) for c, one in steps.rates.items() if c == "attitude"):
        return ""
    found, bound = _better(steps.rates["omega"])
    true = steps.rates["omega"].expected
    for k, when in ((0.5, "before"), (1.5, "after")):
        if np.all(norm(found - k * true) <= SLACK * bound) and np.any(true):
            return (
                f"omega is reported as of half a step {when}: in one step it moves by {k:g} of it"
            )
    return ""


def jumps(steps: VanishingSteps) -> bool:
    """Whether a step of no length changes omega, the velocity, the attitude or the place."""
    return not np.all(_stays(steps, steps.start))


def _stays(steps: VanishingSteps, after: State) -> NDArray[np.bool_]:
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
    return same if steps.system.load.pivot is not None else same & _stays_in_place(steps, after)


def _stays_in_place(steps: VanishingSteps, after: State) -> NDArray[np.bool_]:
    before, moved = steps.states, steps.moved
    lever = float(norm(steps.system.body.center_of_mass))
    speed = norm(before.linear_velocity) + lever * norm(before.angular_velocity)
    push = norm(after.linear_velocity - before.linear_velocity)
    way = norm(after.position - before.position)
    same = push <= LEFT * speed + norm(moved.linear_velocity)
    same &= way <= LEFT * (norm(before.position) + lever) + norm(moved.position)
    return np.asarray(same)


def jump_cause(steps: VanishingSteps) -> str:
    """What a step does to a state however short it is: limits, sleep, rounding; "" without any."""
    before, after = steps.states, steps.start
    if not jumps(steps):
        return ""
    finite = np.all([np.isfinite(values).all(-1) for values in vars(after).values()], axis=0)
    if not finite.all():
        count = int(np.count_nonzero(~finite))
        where = only_where([(steps.system, before, finite)])
        text = f"a step leads to numbers that are not finite from {count} of {len(finite)} states"
        return f"{text}: only where {where}" if where else text
    for one in (*misreadings(steps.system), *fitted_misreadings(after, before)):
        if np.all(_stays(steps, one.right(after))):
            return f"in the run, {one.statement}"
    relative = replace(after, orientation=quaternion_product(before.orientation, after.orientation))
    if np.all(_stays(steps, relative)):
        return "the attitude of a run is relative to its start, or starts from the identity"
    w, new = before.angular_velocity, after.angular_velocity
    v, moved = before.linear_velocity, after.linear_velocity
    between = steps.moved
    for what, unit, was, now, step in (
        ("omega", "rad/s", w, new, between.angular_velocity),
        ("the linear velocity", "m/s", v, moved, between.linear_velocity),
    ):
        allowed = LEFT * norm(was) + norm(step)
        jumped = norm(now - was) > allowed
        if jumped.any() and np.all(np.isfinite(now)):
            text = _limit(what, unit, was, now, allowed, jumped)
            if text:
                return text
    where = only_where([(steps.system, before, _stays(steps, after))])
    return f"a step changes the state, however short it is, only where {where}" if where else ""


def _limit(
    what: str, unit: str, was: Array, now: Array, allowed: Array, jumped: NDArray[np.bool_]
) -> str:
    size, held = norm(was), norm(now)
    if np.all(held[jumped] <= allowed[jumped]):
        least, more = float(np.max(size[jumped])), size[~jumped]
        sleeps = "the body is put to sleep: " if what == "omega" else ""
        if not len(more):
            return f"{sleeps}{what} is set to zero"
        if np.min(more) < least:
            return ""
        return f"{sleeps}{what} is set to zero below {limits(least, float(np.min(more)), unit)}"
    limit = float(np.median(held[jumped]))
    scaled = was * np.minimum(1.0, limit / np.where(size > 0.0, size, 1.0))[:, None]
    if np.all(norm(now - scaled) <= 10 * allowed):
        return f"{what} is held below {limit:.6g} {unit}"
    largest = float(np.max(np.abs(now[jumped])))
    if np.all(norm(now - np.clip(was, -largest, largest)) <= 10 * allowed):
        return f"each component of {what} is held within {largest:.6g} {unit}"
    return ""
