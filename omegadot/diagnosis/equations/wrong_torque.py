"""What the torque of inverse dynamics leaves out, counts twice or is made of in error."""

from __future__ import annotations

import numpy as np

from omegadot.diagnosis.equations.evidence import BEYOND_ROUNDING, SLACK
from omegadot.diagnosis.equations.other_torques import other_bodies, other_gyroscopic
from omegadot.diagnosis.models.fitted_misreadings import order_text, signed_orders
from omegadot.diagnosis.wording.digits import factor
from omegadot.diagnosis.wording.kinds import MOST_NAMED, either
from omegadot.gates.bounds.scales import EPS, ROUNDINGS_PER_EVALUATION, norm, torque_size
from omegadot.reference_impl.cross_product import cross
from omegadot.reference_impl.inertia import moving_inertia
from omegadot.reference_impl.loads import applied_torque, damping_torque, gravity_torque
from omegadot.reference_impl.motion import inverse_dynamics
from omegadot.reference_impl.rotations import rotate, rotate_inverse
from omegadot.reference_impl.symmetric import apply
from omegadot.reference_impl.system import Acceleration, Array, State, System

SHOWN = 1e6  # of rounding: a term that is so large shows, were it off by the least that is named
WHOLE = 1e-9  # a share that is a whole number but for rounding
APPLIED = "the applied torque"
PARTS = ("the torque in body axes", "the torque in world axes")
# Of each load that acts: where one acts alone, this and that it is left out are one.
LOADS_LEFT_OUT = "inverse dynamics leave out the loads that act: damping and torque"


def torque_causes(
    system: System, states: State, requested: Acceleration, torque: Array, eps: float = EPS
) -> list[str]:
    """What the torque of inverse dynamics leaves out or counts, forward dynamics being sound."""
    found = plainest(fitting_torques(system, states, requested, torque, eps))
    return either(found) if len(found) <= MOST_NAMED else []


def plainest(found: list[str]) -> list[str]:
    """Without what states more, or is about a part, where another of these fits as well.

    A torque in one frame is the applied torque where there is none in the other.
    """
    found = [text for text in found if text != LOADS_LEFT_OUT] or found
    of_parts = {
        text: text.replace(part, APPLIED) for text in found for part in PARTS if part in text
    }
    return [text for text in found if of_parts.get(text) not in found]


def fitting_torques(
    system: System, states: State, requested: Acceleration, torque: Array, eps: float = EPS
) -> list[str]:
    """Every cause that fits one system; many are one where it lacks what would tell them apart."""
    true, w = inverse_dynamics(system, states, requested), states.angular_velocity
    bound = ROUNDINGS_PER_EVALUATION * eps * torque_size(system, states, requested)
    if np.all(norm(torque - true) <= BEYOND_ROUNDING * bound):
        return []
    inertia = moving_inertia(system)
    terms, loads, parts = _terms(system, states, requested)

    def fits(candidate: Array, times: float = 1.0) -> bool:
        return bool(np.all(norm(torque - candidate) <= SLACK * max(1.0, abs(times)) * bound))

    found = []
    if fits(rotate(states.orientation, true)):
        found.append("inverse dynamics report the torque in world axes")
    if fits(rotate_inverse(states.orientation, true)):
        found.append("inverse dynamics report the torque turned by R^T once more")
    if fits(-true):
        found.append("inverse dynamics have the wrong sign")
    for order, signs in signed_orders():
        if not np.all(signs < 0.0) and fits(signs * true[:, order]):
            axes = order_text(order, signs)
            found.append(f"inverse dynamics report the torque in other axes: {axes}")
    k = _share(torque, true, bound)
    if k is not None and abs(k) != 1.0 and fits(k * true, k):
        found.append(f"inverse dynamics report the torque scaled by {factor(k)}")
    if any(np.any(one) for one in loads.values()) and fits(true - sum(loads.values())):
        found.append(LOADS_LEFT_OUT)
    for what, term in terms.items():
        k = _share(torque - true, term, bound)
        if k is not None and fits(true + k * term):
            found.append(_worded(what, 1.0 + k))
    for what, term in (*loads.items(), *parts.items()):
        k = _share(torque - true, term, bound)
        if k is not None and fits(true + k * term):
            found.append(_load_worded(what, k))
    bodies = other_bodies(system, states, requested)
    found += [text for text, made in bodies.items() if not fits(true) and fits(made())]
    for what, term in other_gyroscopic(inertia, w, requested.angular) if not found else ():
        if fits(true - terms["the gyroscopic term"] + term):
            found.append(f"inverse dynamics have {what} for the gyroscopic term")
    for what, term in terms.items() if not found else ():
        for axis in range(3):
            alone = np.where(np.arange(3) == axis, term, 0.0)
            k = _share(torque - true, alone, bound)
            if k is not None and fits(true + k * alone):
                found.append(_worded(f"the {'xyz'[axis]} component of {what}", 1.0 + k))
    return found


def would_show(
    text: str, system: System, states: State, requested: Acceleration, eps: float = EPS
) -> bool:
    """Whether a cause in one term, found on another system, makes a torque of this one another."""
    bound = ROUNDINGS_PER_EVALUATION * eps * torque_size(system, states, requested)
    named = [
        term
        for known in _terms(system, states, requested)
        for what, term in known.items()
        if what in text
    ]
    return any(bool(np.any(norm(term) > SHOWN * bound)) for term in named)


def _terms(
    system: System, states: State, requested: Acceleration
) -> tuple[dict[str, Array], dict[str, Array], dict[str, Array]]:
    """By name, (n, 3): the terms of the torque, the loads that act, and parts of these."""
    w, inertia = states.angular_velocity, moving_inertia(system)
    terms: dict[str, Array] = {
        "the gyroscopic term": cross(w, apply(inertia, w)),
        "gravity": -gravity_torque(system, states),
        "the inertia times omega-dot": apply(inertia, requested.angular),
    }
    loads: dict[str, Array] = {
        "damping": damping_torque(system, states),
        APPLIED: applied_torque(system, states),
    }
    of_frames = (
        system.load.torque_body,
        rotate_inverse(states.orientation, system.load.torque_world),
    )
    return terms, loads, {what: 0.0 * w + one for what, one in zip(PARTS, of_frames, strict=True)}


def _share(rest: Array, term: Array, bound: Array) -> float | None:
    known = bound > 0.0  # at rest there may be no torque, of any size
    line, off = (np.ravel(one[known] / bound[known, None]) for one in (term, rest))
    size = float(line @ line)
    if not (size > 0.0 and np.isfinite(size)):
        return None
    k = float(off @ line) / size
    if not np.isfinite(k):  # of a torque that is not, or that overflows
        return None
    return float(round(k)) if abs(k - round(k)) < WHOLE else k  # its rounding may be that of a load


def _worded(what: str, k: float) -> str:
    known = {0: f"leave out {what}", -1: f"have {what}'s sign wrong", 2: f"count {what} twice"}
    if k == round(k) and round(k) in known:
        return f"inverse dynamics {known[round(k)]}"
    return f"inverse dynamics have {what} scaled by {factor(k)}"


def _load_worded(what: str, k: float) -> str:
    """Of a load that belongs to what is found, k times the torque that it exerts added to it."""
    if k == -1.0:
        return f"inverse dynamics leave out what {what} takes up: it is counted among what is given"
    if k == 1.0:
        return f"inverse dynamics count {what} on top of the torque that is found"
    if k == -2.0:
        return f"inverse dynamics count {what} twice among what is given"
    return f"inverse dynamics have {factor(k)} times {what} in them"
