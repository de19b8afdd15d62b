"""Rotations as robot files write them, and an inertia turned by one."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from omegadot.scenarios.links.place import Place
from omegadot.scenarios.quantities import read_quaternion

Matrix = NDArray[np.float64]


def _about(axis: int, angle: float) -> Matrix:
    """The rotation by `angle` rad about the axis x, y or z."""
    c, s = math.cos(angle), math.sin(angle)
    turned = np.eye(3)
    y, z = (axis + 1) % 3, (axis + 2) % 3
    turned[y, y], turned[y, z], turned[z, y], turned[z, z] = c, -s, s, c
    return turned


def roll_pitch_yaw(roll: float, pitch: float, yaw: float) -> Matrix:
    """``Rz(yaw) Ry(pitch) Rx(roll)``: about fixed x, y, z in turn, as URDF and SDF define."""
    found: Matrix = _about(2, yaw) @ _about(1, pitch) @ _about(0, roll)
    return found


def of_quaternion(quaternion: list[float], place: Place) -> Matrix:
    """The rotation of (w, x, y, z) once it is made unit; zero is refused."""
    if not any(quaternion):
        place.refuse("a quaternion of zeros", "give 0 0 0 1 for no rotation")
    w, x, y, z = read_quaternion(quaternion)
    skew = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    vector = np.array([x, y, z])
    outer = np.outer(vector, vector)
    found: Matrix = (w * w - vector @ vector) * np.eye(3) + 2.0 * (outer + w * skew)
    return found


def turned_tensor(rotation: Matrix, tensor: Matrix) -> list[list[float]]:
    """``R I R^T``, symmetric to the last digit."""
    found = rotation @ tensor @ rotation.T
    rows: list[list[float]] = (0.5 * (found + found.T)).tolist()
    return rows


def symmetric(xx: float, xy: float, xz: float, yy: float, yz: float, zz: float) -> Matrix:
    """The tensor of its six numbers."""
    return np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
