"""Terms as vectors at states, and their factors as text."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from omegadot.diagnosis.equations.terms.terms import AXES
from omegadot.diagnosis.wording.digits import factor, number, vector
from omegadot.reference_impl.cross_product import cross
from omegadot.reference_impl.inertia import moving_inertia
from omegadot.reference_impl.loads import applied_torque
from omegadot.reference_impl.rotations import rotate_inverse
from omegadot.reference_impl.symmetric import apply, inverse
from omegadot.reference_impl.system import Acceleration, Array, State, System


def solved(system: System, torque: Array) -> Array:
    """The omega-dot of a torque, (n, 3) N m in body axes."""
    return np.asarray(apply(inverse(moving_inertia(system)), torque))


def rows(vectors: Array) -> Array:
    """(n, 3) to (3, n, 3): each component alone."""
    return np.eye(3)[:, None, :] * vectors


def gyroscopic(system: System, states: State) -> Array:
    """``omega x I omega``, (n, 3) N m."""
    w = states.angular_velocity
    return np.asarray(cross(w, apply(moving_inertia(system), w)))


def by_rows(what: str) -> Callable[[System, Array], str]:
    """Of components that are scaled by 1 + p: which, and by how much."""

    def text(_: System, p: Array) -> str:
        ways = {0.0: "is missing", -1.0: "has the wrong sign", 2.0: "counts twice"}
        found = dict[str, list[str]]()
        for axis, more in zip(AXES, p, strict=True):
            if more != 0.0:
                k = 1.0 + float(more)
                near = next((t for v, t in ways.items() if abs(k - v) < 1e-5), None)
                found.setdefault(near or f"is scaled by {factor(k)}", []).append(axis)
        parts = [f"the {' and '.join(axes)} component {way}" for way, axes in found.items()]
        parts = [_plural(part) if " and " in part else part for part in parts]
        return f"of {what} {', and '.join(parts)}"

    return text


def _plural(part: str) -> str:
    """Of several components."""
    verbs = {"component is": "components are", "component has": "components have"}
    for one, several in (*verbs.items(), ("component counts", "components count")):
        part = part.replace(one, several)
    return part


def constant(frame: str) -> Callable[[System, Array], str]:
    """Of a constant rate: how it is worded."""

    def text(_: System, p: Array) -> str:
        return (
            f"omega-dot has a constant {vector(p)} rad/s^2 in {frame} axes in it, whatever the "
            "state and the inertia"
        )

    return text


def turning(frame: str) -> Callable[[System, Array], str]:
    """Of ``omega x c``: how it is worded."""

    def text(_: System, p: Array) -> str:
        return (
            f"omega-dot has omega x c in it with c = {vector(p)} rad/s, constant in {frame} axes, "
            f"as where the axes turn or a rate is added to omega"
        )

    return text


def world(system: System, states: State, vectors: Array) -> Array:
    """(k, n, 3): constant vectors (k, 3) of world axes, in body axes."""
    n = len(states.angular_velocity)
    whole = np.broadcast_to(vectors[:, None, :], (len(vectors), n, 3))
    return np.stack([rotate_inverse(states.orientation, one) for one in whole])


def omega_cross(states: State, vectors: Array) -> Array:
    """``omega x c`` of vectors c (k, n, 3)."""
    return np.stack([cross(states.angular_velocity, one) for one in vectors])


def body_constant(states: State) -> Array:
    """The axes at every state, (3, n, 3)."""
    return np.eye(3)[:, None, :] + 0.0 * states.angular_velocity


def unit_rates(_: System, states: State, __: Acceleration) -> Array:
    """The axes at every state, as a basis."""
    return body_constant(states)


def full_linear(states: State) -> Array:
    """Each component of omega along each axis, (9, n, 3)."""
    w = states.angular_velocity
    return np.stack([w[:, [j]] * np.eye(3)[i] for i in range(3) for j in range(3)])


def linear_text(_: System, p: Array) -> str:
    """Of a matrix times omega: how it is worded."""
    m = p.reshape(3, 3)
    if np.any(m[~np.eye(3, dtype=bool)]):
        rows = "; ".join(vector(row) for row in m)
        return f"omega-dot has M omega in it with M = ({rows}) 1/s, whatever the inertia"
    own = [(number(float(k)), axis) for k, axis in zip(np.diag(m), AXES, strict=True) if k]
    shown = " and ".join(f"{k} omega_{axis} in {axis}" for k, axis in own)
    return f"omega-dot has {shown} in it, whatever the inertia"


def gravity_at(system: System, states: State) -> Array:
    """Gravity at every state, (n, 3) m/s^2."""
    return np.asarray(system.load.gravity + 0.0 * states.linear_velocity)


def applied(system: System, states: State) -> Array:
    """The applied torque at every state, (n, 3) N m in body axes."""
    return np.asarray(applied_torque(system, states))


def scaled_report(what: str) -> Callable[[System, Array], str]:
    """Of a vector that is scaled by 1 + p: how it is worded."""

    def text(_: System, p: Array) -> str:
        k = 1.0 + float(p[0])
        if abs(k - np.pi / 180) < 1e-6:
            return f"{what} is scaled by pi/180"
        if abs(k - 180 / np.pi) < 1e-5:
            return f"{what} looks like degrees: it is scaled by 180/pi"
        return f"{what} is missing" if abs(k) < 1e-6 else f"{what} is scaled by {factor(k)}"

    return text


def along_omega(states: State, power: float) -> Array:
    """``|omega|^power`` along omega, (n, 3)."""
    w = states.angular_velocity
    size = np.sqrt(np.sum(w * w, axis=-1, keepdims=True))
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.where(size > 0.0, size ** (power - 1) * w, 0.0)


def free(system: System) -> bool:
    """Whether nothing holds the body."""
    return system.load.pivot is None
