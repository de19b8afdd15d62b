"""How the configuration of one body moves: exponentials of SO(3) and SE(3), in components.

q ends in the quaternion and v in ω, body axes; see `Coordinates` for what stands before them.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from omegadot.reference_impl.components import (
    Number,
    apart,
    arctan,
    cos_sin,
    cross3,
    half_turn,
    length,
    rotated,
    together,
)
from omegadot.reference_impl.schemes.motion import Turn
from omegadot.reference_impl.system import Array

Quaternion = tuple[Number, Number, Number, Number]


def _turned(
    w: Number, x: Number, y: Number, z: Number, rx: Number, ry: Number, rz: Number
) -> Quaternion:
    """``q exp(r)``, ``exp(r) = (cos |r|/2, sin(|r|/2) r/|r|)``: section 2.2."""
    c, s = half_turn(rx * rx + ry * ry + rz * rz)
    a, b, d = s * rx, s * ry, s * rz
    return (
        w * c - x * a - y * b - z * d,
        w * a + x * c + y * d - z * b,
        w * b - x * d + y * c + z * a,
        w * d + x * b - y * a + z * c,
    )


def retract_attitude(q: Array, u: Array) -> Array:
    """``q exp(u)`` on the rotation group, (..., 4)."""
    return together([*_turned(*apart(q), *apart(u))], u)


def retract_in_world(q: Array, u: Array) -> Array:
    """``(p + x, q exp(r))`` with u = (x, r), (..., 7): translation is a vector space of its own."""
    px, py, pz, qw, qx, qy, qz = apart(q)
    x, y, z, rx, ry, rz = apart(u)
    return together([px + x, py + y, pz + z, *_turned(qw, qx, qy, qz, rx, ry, rz)], u)


def retract_spatial(q: Array, u: Array) -> Array:
    """``(p + R V(r) x, q exp(r))`` with u = (x, r), (..., 7): the exponential of SE(3).

    ``V x = x + (1 - cos |r|)/|r|² r × x + (|r| - sin |r|)/|r|³ r × (r × x)``: Murray, Li, Sastry,
    A Mathematical Introduction to Robotic Manipulation (1994), (2.36).
    """
    px, py, pz, qw, qx, qy, qz = apart(q)
    x, y, z, rx, ry, rz = apart(u)
    angle = length(rx * rx + ry * ry + rz * rz)
    c, s = cos_sin(0.5 * angle)
    a, b = 2 * s * s / (angle * angle), (angle - 2 * s * c) / (angle * angle * angle)
    tx, ty, tz = cross3(rx, ry, rz, x, y, z)
    nx, ny, nz = cross3(rx, ry, rz, tx, ty, tz)
    x, y, z = x + a * tx + b * nx, y + a * ty + b * ny, z + a * tz + b * nz
    dx, dy, dz = rotated(qw, qx, qy, qz, x, y, z)
    attitude = _turned(qw, qx, qy, qz, rx, ry, rz)
    return together([px + dx, py + dy, pz + dz, *attitude], u)


def rate_to_second_order(u: Array, v: Array) -> Array:
    """``ω + ½ r × ω + ¹⁄₁₂ r × (r × ω)``: the series in attitude alone, (..., 3) or (..., 6)."""
    moved = apart(v)
    rx, ry, rz = apart(u)[-3:]
    wx, wy, wz = moved[-3:]
    bx, by, bz = ry * wz - rz * wy, rz * wx - rx * wz, rx * wy - ry * wx
    cx, cy, cz = ry * bz - rz * by, rz * bx - rx * bz, rx * by - ry * bx
    moved[-3:] = wx + 0.5 * bx + cx / 12, wy + 0.5 * by + cy / 12, wz + 0.5 * bz + cz / 12
    return together(moved, v)


def spatial_rate_to_second_order(u: Array, v: Array) -> Array:
    """The series of dexp⁻¹ of SE(3), (..., 6): ``[(x, r), (y, w)] = (r × y + x × w, r × w)``."""
    x, y, z, rx, ry, rz = apart(u)
    vx, vy, vz, wx, wy, wz = apart(v)
    bx, by, bz = cross3(rx, ry, rz, wx, wy, wz)
    lx, ly, lz = cross3(rx, ry, rz, vx, vy, vz)
    mx, my, mz = cross3(x, y, z, wx, wy, wz)
    lx, ly, lz = lx + mx, ly + my, lz + mz
    cx, cy, cz = cross3(rx, ry, rz, bx, by, bz)
    nx, ny, nz = cross3(rx, ry, rz, lx, ly, lz)
    mx, my, mz = cross3(x, y, z, bx, by, bz)
    return together(
        [
            vx + 0.5 * lx + (nx + mx) / 12,
            vy + 0.5 * ly + (ny + my) / 12,
            vz + 0.5 * lz + (nz + mz) / 12,
            wx + 0.5 * bx + cx / 12,
            wy + 0.5 * by + cy / 12,
            wz + 0.5 * bz + cz / 12,
        ],
        v,
    )


def rate(u: Array, v: Array) -> Array:
    """``u̇ = ω + ½ r × ω + c r × (r × ω)``, ``c = (1 - ½|r| cot ½|r|) / |r|²``, |r| below 2π.

    dexp⁻¹ in attitude alone, (..., 3) or (..., 6). Towards zero c tends to ¹⁄₁₂ and is lost to
    rounding, which leaves no mark: it multiplies |r|².
    """
    moved = apart(v)
    rx, ry, rz = apart(u)[-3:]
    wx, wy, wz = moved[-3:]
    half = 0.5 * length(rx * rx + ry * ry + rz * rz + 1e-30)
    cosine, sine = cos_sin(half)
    c = (1 - half * cosine / sine) / (4 * half * half)
    bx, by, bz = ry * wz - rz * wy, rz * wx - rx * wz, rx * wy - ry * wx
    cx, cy, cz = ry * bz - rz * by, rz * bx - rx * bz, rx * by - ry * bx
    moved[-3:] = wx + 0.5 * bx + c * cx, wy + 0.5 * by + c * cy, wz + 0.5 * bz + c * cz
    return together(moved, v)


def cayley(u: Array) -> Array:
    """``2 atan(|r|/2) r/|r|`` in place of r, (..., 3) or (..., 6).

    Its exponential is ``(1 - r_×/2)⁻¹ (1 + r_×/2)``, the midpoint rule's own.
    """
    *linear, rx, ry, rz = apart(u)
    angle = length(rx * rx + ry * ry + rz * rz)
    s = 2 * arctan(0.5 * angle) / angle
    return together([*linear, s * rx, s * ry, s * rz], u)


def spatial_cayley(u: Array) -> Array:
    """The vector whose exponential in SE(3) is ``(1 - U/2)⁻¹ (1 + U/2)``, (..., 6).

    ``2 artanh(U/2)``, an odd series in U: what is perpendicular to r shrinks as r does, and what is
    along r stays.
    """
    x, y, z, rx, ry, rz = apart(u)
    angle = length(rx * rx + ry * ry + rz * rz)
    s = 2 * arctan(0.5 * angle) / angle
    along = (1 - s) * (x * rx + y * ry + z * rz) / (angle * angle)
    return together(
        [s * x + along * rx, s * y + along * ry, s * z + along * rz, s * rx, s * ry, s * rz], u
    )


def _quaternion_rate(
    w: Number, x: Number, y: Number, z: Number, wx: Number, wy: Number, wz: Number
) -> Quaternion:
    """``½ q (0, ω)``."""
    a, b, c = 0.5 * wx, 0.5 * wy, 0.5 * wz
    return (
        -x * a - y * b - z * c,
        w * a + y * c - z * b,
        w * b - x * c + z * a,
        w * c + x * b - y * a,
    )


def coordinate_rate(q: Array, v: Array) -> Array:
    """``(ṗ, ½ q (0, ω))``, (..., 4) or (..., 7), with ṗ in v as it is."""
    moved = apart(v)
    w, x, y, z = apart(q)[-4:]
    wx, wy, wz = moved[-3:]
    moved[-3:] = _quaternion_rate(w, x, y, z, wx, wy, wz)
    return together(moved, v)


def spatial_coordinate_rate(q: Array, v: Array) -> Array:
    """``(R u, ½ q (0, ω))``, (..., 7), with R at the direction of q."""
    vx, vy, vz, wx, wy, wz = apart(v)
    *_, w, x, y, z = apart(q)
    velocity = rotated(w, x, y, z, vx, vy, vz, 2 / (w * w + x * x + y * y + z * z))
    return together([*velocity, *_quaternion_rate(w, x, y, z, wx, wy, wz)], v)


def normalize(q: Array) -> Array:
    """Q with its quaternion made unit, (..., 4) or (..., 7)."""
    unit = apart(q)
    w, x, y, z = unit[-4:]
    size = length(w * w + x * x + y * y + z * z)
    unit[-4:] = w / size, x / size, y / size, z / size
    return together(unit, q)


def turned_by(turn: Turn, q: Array, u: Array) -> Array:
    """As `retract_in_world` or `retract_attitude`, the attitude by ``turn(quaternion, r)``."""
    attitude = turn(q[..., -4:], u[..., -3:])
    return np.concatenate((q[..., :-4] + u[..., :-3], attitude), axis=-1)


def _unknown(u: Array, v: Array) -> Array:
    """dexp⁻¹ of SE(3) is known here as a series alone. Raises NotImplementedError."""
    raise NotImplementedError("the inverse of dexp of SE(3) is not given in closed form")


ATTITUDE: dict[str, Any] = {
    "retract": retract_attitude,
    "rate": rate,
    "rate_to_second_order": rate_to_second_order,
    "cayley": cayley,
    "coordinate_rate": coordinate_rate,
    "normalize": normalize,
    "turned_by": turned_by,
    "spin": slice(-3, None),
}
WORLD: dict[str, Any] = {**ATTITUDE, "retract": retract_in_world}
SPATIAL: dict[str, Any] = {
    "retract": retract_spatial,
    "rate": _unknown,
    "rate_to_second_order": spatial_rate_to_second_order,
    "cayley": spatial_cayley,
    "coordinate_rate": spatial_coordinate_rate,
    "normalize": normalize,
    "spin": slice(-3, None),
}
"""Fields of a `Motion` of one body: on a pivot, in the world, and in body axes."""
