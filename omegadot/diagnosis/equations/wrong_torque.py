"""What the torque of inverse dynamics leaves out, counts twice or is made of in error."""

from __future__ import annotations

from collections.abc import Callable, Iterator

import numpy as np

from omegadot.diagnosis.equations.evidence import BEYOND_ROUNDING, SLACK
from omegadot.diagnosis.models.fitted_misreadings import order_text, signed_orders
from omegadot.diagnosis.wording.digits import factor
from omegadot.diagnosis.wording.kinds import MOST_NAMED, either
from omegadot.gates.bounds.scales import EPS, ROUNDINGS_PER_EVALUATION, norm, torque_size
from omegadot.reference_impl.cross_product import cross
from omegadot.reference_impl.inertia import lever, moving_inertia, parallel_axis
from omegadot.reference_impl.loads import applied_torque, damping_torque, gravity_torque
from omegadot.reference_impl.motion import forward_dynamics, inverse_dynamics
from omegadot.reference_impl.rotations import rotate, rotate_inverse
from omegadot.reference_impl.symmetric import apply, inverse
from omegadot.reference_impl.system import Acceleration, Array, State, System

WHOLE = 1e-9  # a share that is a whole number but for rounding
# Of each load that acts: where one acts alone, this and that it is left out are one.
APPLIED = "the applied torque"
PARTS = ("the torque in body axes", "the torque in world axes")
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
    parts = {what: 0.0 * w + torque for what, torque in zip(PARTS, of_frames, strict=True)}

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
    bodies = _other_bodies(system, states, requested)
    found += [text for text, made in bodies.items() if not fits(true) and fits(made())]
    for what, term in _other_gyroscopic(inertia, w, requested.angular) if not found else ():
        if fits(true - terms["the gyroscopic term"] + term):
            found.append(f"inverse dynamics have {what} for the gyroscopic term")
    for what, term in terms.items() if not found else ():
        for axis in range(3):
            alone = np.where(np.arange(3) == axis, term, 0.0)
            k = _share(torque - true, alone, bound)
            if k is not None and fits(true + k * alone):
                found.append(_worded(f"the {'xyz'[axis]} component of {what}", 1.0 + k))
    return found


def _share(rest: Array, term: Array, bound: Array) -> float | None:
    known = bound > 0.0  # at rest there may be no torque, of any size
    line, off = (np.ravel(one[known] / bound[known, None]) for one in (term, rest))
    size = float(line @ line)
    if not (size > 0.0 and np.isfinite(size)):
        return None
    k = float(off @ line) / size
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


def _other_gyroscopic(inertia: Array, w: Array, rate: Array) -> Iterator[tuple[str, Array]]:
    """With omega-dot in the place of an omega."""
    yield "omega-dot x I omega", np.asarray(cross(rate, apply(inertia, w)))
    yield "omega x I omega-dot", np.asarray(cross(w, apply(inertia, rate)))


def _other_bodies(
    system: System, states: State, requested: Acceleration
) -> dict[str, Callable[[], Array]]:
    """The torque by another inertia."""
    inertia, w = np.asarray(moving_inertia(system), dtype=float), states.angular_velocity
    gravity, body = gravity_torque(system, states), system.body.inertia
    diagonal = np.diag(np.diag(inertia))
    about_origin = np.asarray(body) + parallel_axis(
        float(system.body.mass), np.asarray(system.body.center_of_mass)
    )

    def by(mass: Array, spin: Array) -> Callable[[], Array]:
        return lambda: apply(mass, requested.angular) + cross(w, apply(spin, w)) - gravity

    return {
        "inverse dynamics use the inertia's diagonal alone": by(diagonal, diagonal),
        "inverse dynamics use the inertia's diagonal alone for omega-dot": by(diagonal, inertia),
        "inverse dynamics use the inertia's diagonal alone in the gyroscopic term": by(
            inertia, diagonal
        ),
        "inverse dynamics use the inertia about the centre of mass, not about the pivot": by(
            np.asarray(body), np.asarray(body)
        ),
        "inverse dynamics take the body for a free one: with the inertia about its centre of mass, "
        "without gravity": lambda: (
            apply(np.asarray(body), requested.angular) + cross(w, apply(np.asarray(body), w))
        ),
        "inverse dynamics use the inertia about the body's origin": by(about_origin, about_origin),
        "inverse dynamics have the products of inertia with the wrong sign": by(
            2.0 * diagonal - inertia, 2.0 * diagonal - inertia
        ),
        **_other_acceleration(system, states, requested),
        "inverse dynamics invert the inertia": by(np.asarray(inverse(inertia)), inertia),
        "inverse dynamics give the torque of the acceleration that the loads cause": lambda: (
            inverse_dynamics(system, states, forward_dynamics(system, states))
        ),
    }


def _other_acceleration(
    system: System, states: State, requested: Acceleration
) -> dict[str, Callable[[], Array]]:
    """The sum of what turns the body and of ``r x m (a - g)``, with another acceleration a.

    One that lacks a part is another inertia in a term of the torque about the pivot.
    """
    arm, w, q = lever(system), states.angular_velocity, states.orientation
    tangential, inward = cross(requested.angular, arm), cross(w, cross(w, arm))
    mass = float(system.body.mass)

    def by(other: Array) -> Callable[[], Array]:
        more = cross(arm, mass * (other - tangential - inward))
        return lambda: inverse_dynamics(system, states, requested) + more

    if system.load.pivot is None:
        return {}
    of = "inverse dynamics have the acceleration of the centre of mass"
    return {
        f"{of} in world axes, in place of body axes": by(rotate(q, tangential + inward)),
        f"{of} with the wrong sign": by(-tangential - inward),
    }
