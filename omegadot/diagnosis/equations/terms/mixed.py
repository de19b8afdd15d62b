"""Terms that mix what is right: components in another order, other powers of omega, a spring."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from omegadot.diagnosis.equations.terms.parts import (
    along_omega,
    by_rows,
    gyroscopic,
    rows,
    solved,
    world,
)
from omegadot.diagnosis.equations.terms.terms import AXES, Terms
from omegadot.diagnosis.wording.digits import number, vector
from omegadot.reference_impl.loads import gravity_torque
from omegadot.reference_impl.rotations import normalize, rotate, rotate_inverse
from omegadot.reference_impl.system import Array, State, System
from omegadot.written import written

CLOSE = 1e-5  # relative: a factor is the whole number that is meant
POWERS = (1.0, 0.0, 0.5, 1.5, 2.0, 2.5, 3.0)


def _components(system: System, vectors: Array) -> Array:
    """Each component of torques (n, 3) along each axis, (9, n, 3), as omega-dot."""
    axes = np.eye(3)
    return np.stack([solved(system, vectors[:, [j]] * axes[i]) for i in range(3) for j in range(3)])


def _mixture(what: str) -> Callable[[System, Array], str]:
    """Of a vector multiplied by ``1 + p``: which components stand where, or the matrix."""

    def text(_: System, p: Array) -> str:
        matrix = np.eye(3) + p.reshape(3, 3)
        near = np.round(matrix)
        whole = float(np.max(np.abs(matrix - near))) < CLOSE
        if whole and np.array_equal(near @ near.T, np.eye(3)):
            axes = ", ".join(_signed(row) for row in near)
            return f"the components of {what} are others: x, y, z hold {axes}"
        shown = "; ".join(vector(row) for row in matrix)
        return f"{what} is multiplied by the matrix ({shown})"

    return text


def _signed(row: Array) -> str:
    axis = int(np.argmax(np.abs(row)))
    return f"{'-' if row[axis] < 0.0 else ''}{AXES[axis]}"


def _damping(system: System, states: State) -> Array:
    return -float(system.load.damping) * np.asarray(states.angular_velocity)


def _world_rows(system: System, states: State, torque: Array) -> Array:
    """A torque's components in world axes, each alone, as omega-dot (3, n, 3)."""
    q = states.orientation
    return np.stack([solved(system, rotate_inverse(q, one)) for one in rows(rotate(q, torque))])


def _powers(system: System, states: State) -> Array:
    """The damping by other powers of omega, as omega-dot."""
    damping = -float(system.load.damping)
    return np.stack([solved(system, damping * along_omega(states, k)) for k in POWERS])


def _powers_text(_: System, p: Array) -> str:
    kept = [*(p + (np.arange(len(p)) == 0))]  # of the damping itself what is left
    kept = [0.0 if abs(k) < CLOSE else float(k) for k in kept]
    shown = [
        f"{'' if abs(k - 1.0) < CLOSE else f'{number(k)} '}|omega|^{written(power)}"
        for k, power in zip(kept, POWERS, strict=True)
        if k
    ]
    if not shown:
        return "the damping is missing"
    return f"the damping torque is -d ({' + '.join(shown)}) along omega, not -d omega"


def _from_identity(states: State) -> Array:
    """The attitude's vector part, twice that of the quaternion with a positive scalar, (n, 3)."""
    q = normalize(states.orientation)
    return np.asarray(2.0 * np.where(q[:, :1] < 0.0, -q[:, 1:], q[:, 1:]))


def _rotation_vector(states: State) -> Array:
    part = _from_identity(states)
    half = 0.5 * np.sqrt(np.sum(part * part, axis=-1, keepdims=True))
    angle = 2.0 * np.arcsin(np.clip(half, 0.0, 1.0))
    return np.asarray(part * np.where(half > 0.0, 0.5 * angle / np.where(half > 0, half, 1.0), 1.0))


def _spring(what: str, unit: str) -> Callable[[System, Array], str]:
    return lambda _, p: (
        f"a {'torque' if unit == 'N m' else 'rate'} of {number(float(p[0]))} {unit} a radian acts "
        f"that depends on the attitude, as a spring does: along {what}"
    )


SINE, TURN = "2 sin(angle/2) of the turn from the identity", "the turn from the identity"
MIXED: tuple[Terms, ...] = (
    Terms(
        "gyroscopic components",
        lambda s, x, a: -_components(s, gyroscopic(s, x)),
        _mixture("the gyroscopic term"),
    ),
    Terms(
        "gravity torque components",
        lambda s, x, a: _components(s, gravity_torque(s, x)),
        _mixture("the torque of gravity"),
    ),
    Terms(
        "world torque components",
        lambda s, x, a: _components(s, world(s, x, np.asarray(s.load.torque_world)[None])[0]),
        _mixture("the torque in world axes, taken to body axes,"),
    ),
    Terms(
        "damping components",
        lambda s, x, a: _components(s, _damping(s, x)),
        _mixture("the damping torque"),
    ),
    Terms(
        "damping rows in world",
        lambda s, x, a: _world_rows(s, x, _damping(s, x)),
        by_rows("the damping in world axes"),
        by_rows=True,
    ),
    Terms(
        "gravity torque rows in world",
        lambda s, x, a: _world_rows(s, x, gravity_torque(s, x)),
        by_rows("the torque of gravity in world axes"),
        by_rows=True,
    ),
    Terms("powers of omega", lambda s, x, a: _powers(s, x), _powers_text),
    Terms(
        "spring as a torque",
        lambda s, x, a: solved(s, _from_identity(x))[None],
        _spring(SINE, "N m"),
    ),
    Terms("spring as a rate", lambda s, x, a: _from_identity(x)[None], _spring(SINE, "rad/s^2")),
    Terms(
        "angle as a torque",
        lambda s, x, a: solved(s, _rotation_vector(x))[None],
        _spring(TURN, "N m"),
    ),
    Terms("angle as a rate", lambda s, x, a: _rotation_vector(x)[None], _spring(TURN, "rad/s^2")),
)
