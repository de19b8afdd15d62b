"""The coordinates of Exudyn's nodes of rigid bodies: those of a place, then those of an attitude.

| node | attitude | its rates |
|---|---|---|
| rotation vector | r, with ``R = exp(r)`` | omega in body axes |
| Euler parameters | quaternion (w, x, y, z), less (1, 0, 0, 0) | that of the quaternion |
| Rxyz | a, b, c with ``R = Rx(a) Ry(b) Rz(c)`` | a', b', c' |

Rates of the place are its velocity, in world axes.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal

import numpy as np

from omegadot.reference_impl.rotations import (
    conjugate,
    exp_quaternion,
    normalize,
    quaternion_product,
    rotation_between,
    rotation_matrix,
)
from omegadot.reference_impl.system import Array

Kind = Literal["rotation-vector", "euler-parameters", "rxyz"]
NO_TURN = np.array([1.0, 0.0, 0.0, 0.0])


@dataclass(frozen=True)
class NodeKind:
    """name: of the node in Exudyn.  reference: its reference coordinates, to which others add.

    given: coordinates of an attitude and their rates, of a unit quaternion (4,) and omega (3,).
    read: unit quaternions (n, 4) and omega (n, 3) of such coordinates (n, k) and rates.
    """

    name: str
    reference: Array
    given: Callable[[Array, Array], tuple[Array, Array]]
    read: Callable[[Array, Array], tuple[Array, Array]]


def _vector_of(q: Array, w: Array) -> tuple[Array, Array]:
    return rotation_between(NO_TURN, q), w


def _of_vector(r: Array, w: Array) -> tuple[Array, Array]:
    return exp_quaternion(r), w


def _parameters_of(q: Array, w: Array) -> tuple[Array, Array]:
    """``q' = q (0, omega) / 2``."""
    return q - NO_TURN, 0.5 * quaternion_product(q, np.array([0.0, *w]))


def _of_parameters(moved: Array, rates: Array) -> tuple[Array, Array]:
    """``omega = 2 q* q'``, as Exudyn has it, of a q that is of unit length to a tolerance."""
    q = moved + NO_TURN
    return normalize(q), 2 * quaternion_product(conjugate(q), rates)[..., 1:]


def _angles_of(q: Array, w: Array) -> tuple[Array, Array]:
    """Of the entries of ``R``, and ``omega = G (a', b', c')``; b' = 0 where G has no inverse."""
    R = rotation_matrix(q)
    a, b = np.arctan2(-R[1, 2], R[2, 2]), np.arctan2(R[0, 2], np.hypot(R[0, 0], R[0, 1]))
    c = np.arctan2(-R[0, 1], R[0, 0])
    along = w[0] * np.cos(c) - w[1] * np.sin(c)
    first = along / np.cos(b)
    rates = np.array([first, w[0] * np.sin(c) + w[1] * np.cos(c), w[2] - first * np.sin(b)])
    return np.array([a, b, c]), rates


def _of_angles(angles: Array, rates: Array) -> tuple[Array, Array]:
    cosines, sines = np.cos(0.5 * angles), np.sin(0.5 * angles)
    turns = np.zeros((3, len(angles), 4))
    for axis, turn in enumerate(turns):
        turn[:, 0], turn[:, 1 + axis] = cosines[:, axis], sines[:, axis]
    q = quaternion_product(turns[0], quaternion_product(turns[1], turns[2]))
    (_, b, c), (first, second, third) = angles.T, rates.T
    spin = [
        first * np.cos(b) * np.cos(c) + second * np.sin(c),
        second * np.cos(c) - first * np.cos(b) * np.sin(c),
        third + first * np.sin(b),
    ]
    return normalize(q), np.stack(spin, axis=-1)


NODES: dict[Kind, NodeKind] = {
    "rotation-vector": NodeKind("NodeRigidBodyRotVecLG", np.zeros(6), _vector_of, _of_vector),
    "euler-parameters": NodeKind(
        "NodeRigidBodyEP", np.array([0.0, 0, 0, 1, 0, 0, 0]), _parameters_of, _of_parameters
    ),
    "rxyz": NodeKind("NodeRigidBodyRxyz", np.zeros(6), _angles_of, _of_angles),
}
