"""What a step does to a state however short it is: limits, sleep, rounding, misread states."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from omegadot.diagnosis.equations.evidence import BEYOND_ROUNDING
from omegadot.diagnosis.models.fitted_misreadings import fitted_misreadings
from omegadot.diagnosis.models.misreadings import Misreading, misreadings
from omegadot.diagnosis.stepping.vanishing.follows import Beginning
from omegadot.diagnosis.stepping.vanishing.rests import SLEEPS
from omegadot.diagnosis.stepping.vanishing.vanishing_steps import (
    AMPLIFIED,
    LEFT,
    VanishingSteps,
    stays,
)
from omegadot.diagnosis.wording.conditions import only_where
from omegadot.diagnosis.wording.digits import factor
from omegadot.gates.bounds.scales import ROUNDINGS_PER_EVALUATION, norm
from omegadot.reference_impl.rotations import attitude_angle, quaternion_product
from omegadot.reference_impl.system import Array
from omegadot.written import written

SLIGHT = BEYOND_ROUNDING * AMPLIFIED * ROUNDINGS_PER_EVALUATION  # times the rounding of a number
SMALL = 1e-3  # of what is beyond a limit: one as near to zero as this is zero
CLOSE = 1e-2  # relative: a change that is in proportion
QUANTITIES = (
    ("angular_velocity", "omega", "rad/s"),
    ("linear_velocity", "the linear velocity", "m/s"),
    ("orientation", "the quaternion", ""),
    ("position", "the position", "m"),
)
STOPPED = "omega is set to zero"
UNSIGNED = "the quaternion's scalar part is reported without its sign"
BEGINS_UNSIGNED = "a run begins with the quaternion's scalar part without its sign"
NEARER = 0.5  # of what a misread run is off by: a coarse scheme leaves something too


def jumps(steps: VanishingSteps) -> bool:
    """Whether a step of no length changes omega, the velocity, the attitude or the place."""
    return not np.all(stays(steps, steps.start))


def jump_cause(steps: VanishingSteps, beginning: Beginning | None = None) -> str:
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
        if np.all(stays(steps, one.right(after))):
            text = _along(one, beginning)
            return f"in the run, {text}" if text else ""
    relative = replace(after, orientation=quaternion_product(before.orientation, after.orientation))
    if np.all(stays(steps, relative)):
        return "the attitude of a run is relative to its start, or starts from the identity"
    placed = replace(after, position=before.position + after.position)
    if steps.system.load.pivot is None and np.all(stays(steps, placed)):
        return "the position of a run is reported from where it began"
    unsigned = before.orientation * np.sign(before.orientation * [1.0, 0, 0, 0] + [0, 1, 1, 1])
    signed = np.any(after.orientation[:, 0] < 0.0)
    if (
        not signed
        and np.any(before.orientation[:, 0] < 0.0)
        and np.all(stays(replace(steps, states=replace(before, orientation=unsigned)), after))
    ):
        return UNSIGNED
    w, new = before.angular_velocity, after.angular_velocity
    v, moved = before.linear_velocity, after.linear_velocity
    between = steps.moved
    for what, unit, was, now, step in (
        ("omega", "rad/s", w, new, between.angular_velocity),
        ("the linear velocity", "m/s", v, moved, between.linear_velocity),
        ("the position", "m", before.position, after.position, between.position),
    ):
        allowed = LEFT * norm(was) + norm(step)
        jumped = norm(now - was) > allowed
        if jumped.any() and np.all(np.isfinite(now)):
            damped = bool(np.any(steps.system.load.damping))
            text = _limit(what, unit, was, now, allowed, jumped, damped)
            if text:
                return text
    sound = stays(steps, after)
    where = only_where([(steps.system, before, sound)])
    for one in misreadings(steps.system) if where else ():
        if np.all(sound | stays(steps, one.right(after))):
            return f"in the run, {one.statement}, but only where {where}"
    return f"a step changes the state, however short it is, only where {where}" if where else ""


def slight_jump_cause(steps: VanishingSteps) -> str:
    """What a first step adds to a state however short it is, if that is little; "" without any."""
    for name, what, unit in QUANTITIES:
        off, allowed = _slightly_off(steps, name)
        if off is None:
            continue
        was, size = getattr(steps.states, name), norm(getattr(steps.states, name))
        k = float(np.sum(off * was) / np.sum(was * was))
        if np.all(norm(off - k * was) <= CLOSE * abs(k) * size + allowed):
            times = factor(1.0 + k)
            return f"{what} is multiplied by {times} in the first step, however short it is"
        some = f"{written(float(np.median(norm(off))), 1)} {unit}".strip()
        return f"the first step changes {what} by some {some}, however short it is"
    return ""


def first_turn(steps: VanishingSteps) -> float | None:
    """The slight angle in rad by which a run's first step turns the body however short it is.

    None where there is none, or where another quantity jumps as well.
    """
    off, _ = _slightly_off(steps, "orientation")
    free = steps.system.load.pivot is None
    others = ("angular_velocity", *(("linear_velocity", "position") if free else ()))
    if off is None or any(_slightly_off(steps, name)[0] is not None for name in others):
        return None
    turned = attitude_angle(steps.states.orientation, steps.limit.orientation)
    return float(np.median(turned)) if np.median(turned) > np.median(norm(off)) else None


def _slightly_off(steps: VanishingSteps, name: str) -> tuple[Array | None, Array]:
    """How far the limit of a quantity is off, None where it is not clearly; and the rounding."""
    was, now = getattr(steps.states, name), getattr(steps.limit, name)
    rate = norm(steps.states.angular_velocity)
    off, size = now - was, norm(was)
    allowed = SLIGHT * steps.eps * (size + rate + norm(steps.states.linear_velocity))
    seen = norm(off) > allowed
    if np.count_nonzero(seen) < len(seen) // 2 or not np.all(np.isfinite(off)):
        return None, allowed
    # longer steps must show it as well, or the two shortest alone, to second order: where steps are
    # not smooth, the limit of five is another
    if steps.longer is not None:
        shown = norm(getattr(steps.longer, name) - now) <= CLOSE * norm(off) + allowed
    else:
        short, moved = getattr(steps.start, name), norm(getattr(steps.moved, name))
        left = moved**2 / np.where(size > 0.0, size, np.inf) + allowed
        shown = norm(short - now) <= CLOSE * norm(off) + left
    return (off if np.all(shown) else None), allowed


def _along(one: Misreading, beginning: Beginning | None) -> str:
    """A misreading as text, if it holds along a run as well; "" if it does not.

    Undone, it is nearer to the exact motion. A step of no length has the attitude of the run's
    start, with which any sample of a run may be turned.
    """
    if beginning is None or len(beginning.times) < 3:
        return one.statement
    came, exact = beginning.reported[1:], beginning.exact[1:]
    first = 0.0 * came.orientation + beginning.reported.orientation[:1]
    at_start = one.right(replace(came, orientation=first))
    undone, text = one.right(came), one.statement
    for name, due in vars(exact).items():
        far, near, other = (_apart(name, getattr(x, name), due) for x in (came, undone, at_start))
        if np.array_equal(getattr(came, name), getattr(undone, name)):
            continue
        if name != "orientation" and other < NEARER * near:
            near, text = other, f"{one.statement} of the run's start"
        if near > NEARER * far:
            return ""
    return text


def _apart(name: str, one: Array, other: Array) -> float:
    with np.errstate(all="ignore"):
        apart = attitude_angle(one, other) if name == "orientation" else norm(one - other)
    return float(np.max(apart))


def _limit(
    what: str,
    unit: str,
    was: Array,
    now: Array,
    allowed: Array,
    jumped: NDArray[np.bool_],
    damped: bool,
) -> str:
    size, held = norm(was), norm(now)
    if np.all(held[jumped] <= allowed[jumped]):
        least, more = float(np.max(size[jumped])), size[~jumped & (size > 0.0)]
        sleeps = f"{SLEEPS}: " if what == "omega" else ""
        if not len(more):
            # a damping that is taken wrongly stops it as well
            return f"{what} is set to zero" if damped else f"{sleeps}{what} is set to zero"
        # a limit that holds here, of whatever quantity, may be another elsewhere
        return "" if np.min(more) < least else f"{sleeps}{what} is set to zero at some states"
    wrong = np.any(np.abs(now - was) > allowed[:, None], axis=0)
    if np.count_nonzero(wrong) == 1:
        k = int(np.argmax(wrong))
        ends, near = now[jumped, k], 10.0 * float(np.max(allowed))
        beyond = np.abs(was[jumped, k] - np.median(ends))  # from where it is brought to the limit
        if np.ptp(ends) <= near < np.min(beyond) and len(ends) > 1:
            end = float(np.median(ends)) if abs(np.median(ends)) > near else 0.0
            side = "above" if np.all(was[jumped, k] < end) else "below"
            known = bool(end) or near <= SMALL * float(np.min(beyond))
            limit = (
                f"{written(end)} {unit}"
                if known
                else f"a limit within {written(near, 1)} {unit} of 0"
            )
            return f"{what} along {'xyz'[k]} is held {side} {limit}"
    if np.mean(norm(now - was)[jumped] <= 10 * allowed[jumped]) >= 0.5:
        return ""  # any limit next to the largest of them would do
    most = float(np.median(held[jumped]))
    scaled = was * np.minimum(1.0, most / np.where(size > 0.0, size, 1.0))[:, None]
    if np.all(norm(now - scaled) <= 10 * allowed):
        return f"{what} is held below {written(most)} {unit}"
    largest = float(np.max(np.abs(now[jumped])))
    if np.all(norm(now - np.clip(was, -largest, largest)) <= 10 * allowed):
        return f"each component of {what} is held within {written(largest)} {unit}"
    return ""
