"""Rotations as robot files write them, and an inertia turned by one."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

Matrix = NDArray[np.float64]


def about(axis: str, angle: float) -> Matrix:
    """The rotation by `angle` rad about the axis x, y or z."""
    c, s = math.cos(angle), math.sin(angle)
    turned = {
        "x": [[1.0, 0.0, 0.0], [0.0, c, -s], [0.0, s, c]],
        "y": [[c, 0.0, s], [0.0, 1.0, 0.0], [-s, 0.0, c]],
        "z": [[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]],
    }
    return np.array(turned[axis])


def roll_pitch_yaw(roll: float, pitch: float, yaw: float) -> Matrix:
    """``Rz(yaw) Ry(pitch) Rx(roll)``: about the fixed axes x, y, z in turn, as URDF and SDF say."""
    found: Matrix = about("z", yaw) @ about("y", pitch) @ about("x", roll)
    return found


def of_quaternion(quaternion: Sequence[float]) -> Matrix | None:
    """The rotation of (w, x, y, z) once it is made unit; None for zero."""
    size = math.hypot(*quaternion)
    if size == 0.0:
        return None
    w, x, y, z = (component / size for component in quaternion)
    skew = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    vector = np.array([x, y, z])
    outer = np.outer(vector, vector)
    found: Matrix = (w * w - vector @ vector) * np.eye(3) + 2.0 * (outer + w * skew)
    return found


def quaternion_of(rotation: Matrix) -> tuple[float, float, float, float]:
    """(w, x, y, z) of a rotation: the largest component is found first, so nothing cancels."""
    trace = float(np.trace(rotation))
    squares = np.array([trace, *np.diag(rotation)])
    largest = int(np.argmax(squares))
    r = rotation
    products = np.array([
        [1.0 + trace, r[2, 1] - r[1, 2], r[0, 2] - r[2, 0], r[1, 0] - r[0, 1]],
        [r[2, 1] - r[1, 2], 1.0 + 2.0 * r[0, 0] - trace, r[0, 1] + r[1, 0], r[0, 2] + r[2, 0]],
        [r[0, 2] - r[2, 0], r[0, 1] + r[1, 0], 1.0 + 2.0 * r[1, 1] - trace, r[1, 2] + r[2, 1]],
        [r[1, 0] - r[0, 1], r[0, 2] + r[2, 0], r[1, 2] + r[2, 1], 1.0 + 2.0 * r[2, 2] - trace],
    ])  # fmt: skip
    row = products[largest] / np.linalg.norm(products[largest])
    w, x, y, z = (float(component) for component in row)
    return w, x, y, z


def turned_tensor(rotation: Matrix, tensor: Matrix) -> list[list[float]]:
    """``R I R^T``, symmetric to the last digit."""
    found = rotation @ tensor @ rotation.T
    rows: list[list[float]] = (0.5 * (found + found.T)).tolist()
    return rows


def symmetric(xx: float, xy: float, xz: float, yy: float, yz: float, zz: float) -> Matrix:
    """The tensor of its six numbers."""
    return np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
