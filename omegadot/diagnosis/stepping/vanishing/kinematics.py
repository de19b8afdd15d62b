"""What attitude, position and omega follow in steps that vanish, in place of what they should."""

from __future__ import annotations

from collections.abc import Collection

import numpy as np
from numpy.typing import NDArray

from omegadot.diagnosis.equations.evidence import SLACK
from omegadot.diagnosis.stepping.vanishing.vanishing_steps import STILL, VanishingSteps, better
from omegadot.diagnosis.wording.digits import factor, limits
from omegadot.gates.bounds.scales import norm
from omegadot.reference_impl.cross_product import cross
from omegadot.reference_impl.rotations import rotate, rotate_inverse
from omegadot.reference_impl.system import Array
from omegadot.written import written

CLEAR = 10.0  # times what is allowed: a part of omega-dot is distinguished from another
LEAST = 3  # states at which it is


def kinematic_causes(steps: VanishingSteps) -> list[str]:
    """What attitude or position moves by in place of omega or the velocity; none where it is right.

    Several where the states do not decide.
    """
    for channel, named in _wrong_rates(steps).items():
        limit = steps.rates[channel]
        found, bound = better(limit)
        if not np.all(limit.shares() <= 1.0):
            # what is not finite has no bound, and shows nothing
            seen = {t: norm(limit.expected - rate) > SLACK * bound for t, rate in named.items()}
            shown = {t: rate for t, rate in named.items() if np.any(seen[t])}
            fits = [t for t, rate in shown.items() if np.all(norm(found - rate) <= SLACK * bound)]
            return [f"in the steps, {text}" for text in fits]
    return []


def _wrong_rates(steps: VanishingSteps) -> dict[str, dict[str, Array]]:
    system, states = steps.system, steps.states
    q, w, v = states.orientation, states.angular_velocity, states.linear_velocity
    lever = rotate(q, cross(w, system.body.center_of_mass))
    attitude = {
        "the attitude turns by omega taken in world axes, multiplied from the left": (
            rotate_inverse(q, w)
        ),
        "the attitude turns by R omega taken in body axes": rotate(q, w),
        "the attitude turns the wrong way": -w,
    }
    for axis, sign in zip("xyz", 1.0 - 2.0 * np.eye(3), strict=True):
        attitude[f"the attitude turns by omega with {axis} reversed"] = sign * w
    for order, what in (([1, 0, 2], "x and y"), ([0, 2, 1], "y and z"), ([2, 1, 0], "z and x")):
        attitude[f"the attitude turns by omega with {what} swapped"] = w[:, order]
    if system.load.pivot is not None:
        return {"attitude": attitude}
    position = {
        "the position moves by the velocity taken in body axes": rotate(q, v),
        "the position moves by R^T v": rotate_inverse(q, v),
        "the position moves with the velocity of the body's origin": v - lever,
        "the position moves with the velocity of a point on the centre of mass's other side": (
            v + lever
        ),
        "the position moves the wrong way": -v,
    }
    return {"attitude": attitude, "position": position}


def shows_in_motion(steps: VanishingSteps, text: str) -> NDArray[np.bool_]:
    """(m,): where a cause in what attitude or position move by makes them move otherwise.

    One that is not known here scales their rate, or leaves them still.
    """
    channel = "position" if "position" in text else "attitude"
    limit, named = steps.rates[channel], _wrong_rates(steps).get(channel, {})
    known = (rate for own, rate in named.items() if text.endswith(own))
    apart = norm(limit.expected - next(known, np.zeros_like(limit.expected)))
    return np.asarray(apart > CLEAR * SLACK * np.min(limit.bound, axis=0))


def least_step(stays_below: Collection[tuple[float, float]]) -> str:
    """Steps below a limit do not move the body: between which lengths it lies on all scenarios.

    "" where none is still, or a shorter step moves a body than one that leaves another.
    stays_below: of each scenario, see `VanishingSteps`.
    """
    still = max((one for one, _ in stays_below), default=0.0)
    moving = min((one for _, one in stays_below), default=np.inf)
    if still == 0.0 or moving <= still:
        return ""
    if not np.isfinite(moving):
        return f"steps of {written(still, 2)} s and shorter do not move the body"
    return f"steps below a limit between {limits(still, moving, 's')} do not move the body"


def still_cause(steps: VanishingSteps) -> str:
    """Attitude or position does not change in the first step of a run."""
    channels = ("attitude",) if steps.system.load.pivot is not None else ("attitude", "position")
    for channel in channels:
        limit = steps.rates[channel]
        found, bound = better(limit)
        if not np.all(limit.shares() <= 1.0):
            still = bool(np.all(norm(found) <= SLACK * bound))
            text = f"in the steps, the {channel} does not move, or not in the first step of a run"
            return text if still else ""
    return ""


def moves_by_cause(steps: VanishingSteps) -> str:
    """The attitude or the position moves by a factor of what it should; "" where it does not.

    By half or by one and a half it is as well of another time than the rest.
    """
    for channel, what in (("attitude", "omega"), ("position", "the velocity")):
        limit = steps.rates[channel]
        found, bound = better(limit)
        if np.all(limit.shares() <= 1.0) or (
            channel == "position" and steps.system.load.pivot is not None
        ):
            continue
        weight = np.where(np.isfinite(bound) & (bound > 0.0), 1.0 / bound, 0.0)[:, None]
        size = float(np.sum((limit.expected * weight) ** 2))
        k = float(np.sum(found * limit.expected * weight**2)) / size if size > 0.0 else 1.0
        if not np.all(norm(found - k * limit.expected) <= SLACK * bound) or abs(k) < STILL:
            continue
        clear = abs(k - 1.0) * norm(limit.expected) > CLEAR * bound
        if np.count_nonzero(clear) < LEAST:
            continue  # what is hardly off is off by many factors
        text = f"in the steps, the {channel} moves by {factor(k)} times {what}"
        for half, when in ((0.5, "before"), (1.5, "after")):
            if abs(k - half) < 1e-6:
                return f"either the {channel} is reported as of half a step {when}, or, {text}"
        return text
    return ""


def omega_still_cause(steps: VanishingSteps) -> str:
    """That the first step does not change omega, which has several explanations."""
    limit = steps.rates["omega"]
    found, bound = better(limit)
    still = bool(np.all(norm(found) <= SLACK * bound)) and not np.all(limit.shares() <= 1.0)
    return "the first step of a run does not change omega, however short it is" if still else ""


def velocity_share_cause(steps: VanishingSteps) -> str:
    """The velocity alone moves by a part of its rate, as where it is of another time."""
    if steps.system.load.pivot is not None:
        return ""
    sound = [np.all(steps.rates[c].shares() <= 1.0) for c in ("attitude", "omega", "position")]
    limit = steps.rates["linear_momentum"]
    found, bound = better(limit)
    clear = np.count_nonzero(norm(limit.expected) > CLEAR * SLACK * bound) >= LEAST
    for k, when in ((0.5, "before"), (1.5, "after")) if all(sound) and clear else ():
        if np.all(norm(found - k * limit.expected) <= SLACK * bound):
            return f"the linear velocity is reported as of half a step {when}"
    return ""


def omega_share_cause(steps: VanishingSteps) -> str:
    """Omega alone moves by a part of omega-dot, as where it is of another time than the rest."""
    if not all(np.all(one.shares() <= 1.0) for c, one in steps.rates.items() if c == "attitude"):
        return ""
    found, bound = better(steps.rates["omega"])
    true = steps.rates["omega"].expected
    if np.count_nonzero(norm(true) > CLEAR * SLACK * bound) < LEAST:
        return ""
    for k, when in ((0.5, "before"), (1.5, "after")):
        if np.all(norm(found - k * true) <= SLACK * bound) and np.any(true):
            moved = f"in one step it moves by {written(k)} of it"
            return f"omega is reported as of half a step {when}: {moved}"
    return ""
