"""How the configuration of one body moves: exponentials of SO(3) and SE(3), in components.

q ends in the quaternion and v in ω, body axes; see `Coordinates` for what stands before them.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from omegadot.reference_impl.arithmetic.components import (
    Number,
    Numbers,
    arctan,
    cross3,
    half_turn,
    in_components,
    length,
    one_in_components,
    rotated,
)
from omegadot.reference_impl.schemes.motion import Turn
from omegadot.reference_impl.system import Array


def _turned(q: Numbers, r: Numbers) -> Numbers:
    """``q exp(r)``, ``exp(r) = (cos |r|/2, sin(|r|/2) r/|r|)``: section 2.2."""
    w, x, y, z = q
    rx, ry, rz = r
    c, s = half_turn(rx * rx + ry * ry + rz * rz)
    a, b, d = s * rx, s * ry, s * rz
    return (
        w * c - x * a - y * b - z * d,
        w * a + x * c + y * d - z * b,
        w * b - x * d + y * c + z * a,
        w * d + x * b - y * a + z * c,
    )


retract_attitude = in_components(_turned)


@in_components
def retract_in_world(q: Numbers, u: Numbers) -> Numbers:
    """``(p + x, q exp(r))`` with u = (x, r), (..., 7): translation is a vector space of its own."""
    return [q[0] + u[0], q[1] + u[1], q[2] + u[2], *_turned(q[3:], u[3:])]


@in_components
def retract_spatial(q: Numbers, u: Numbers) -> Numbers:
    """``(p + R V(r) x, q exp(r))`` with u = (x, r), (..., 7): the exponential of SE(3).

    ``V x = x + (1 - cos |r|)/|r|² r × x + (|r| - sin |r|)/|r|³ r × (r × x)``: Murray, Li, Sastry,
    A Mathematical Introduction to Robotic Manipulation (1994), (2.36).
    """
    x, y, z, rx, ry, rz = u
    square = rx * rx + ry * ry + rz * rz + 1e-30  # so that zero needs no branch
    c, s = half_turn(square)
    a, b = 2 * s * s, (1 - 2 * s * c) / square
    tx, ty, tz = once = cross3(u[3:], u[:3])
    nx, ny, nz = cross3(u[3:], once)
    way = x + a * tx + b * nx, y + a * ty + b * ny, z + a * tz + b * nz
    dx, dy, dz = rotated(q[3:], way)
    return [q[0] + dx, q[1] + dy, q[2] + dz, *_turned(q[3:], u[3:])]


def _rate_with(c: Number, u: Numbers, v: Numbers) -> Numbers:
    """``ω + ½ r × ω + c r × (r × ω)`` in attitude alone; any translation moves as v does."""
    *linear, wx, wy, wz = v
    rx, ry, rz = u[-3:]
    bx, by, bz = ry * wz - rz * wy, rz * wx - rx * wz, rx * wy - ry * wx
    cx, cy, cz = ry * bz - rz * by, rz * bx - rx * bz, rx * by - ry * bx
    return [
        *linear,
        wx + 0.5 * bx + c * cx,
        wy + 0.5 * by + c * cy,
        wz + 0.5 * bz + c * cz,
    ]


@in_components
def rate_to_second_order(u: Numbers, v: Numbers) -> Numbers:
    """``ω + ½ r × ω + ¹⁄₁₂ r × (r × ω)``: the series in attitude alone, (..., 3) or (..., 6)."""
    return _rate_with(1 / 12, u, v)


def _spatial_commutator(u: Numbers, v: Numbers) -> Numbers:
    """``[(x, r), (y, w)] = (r × y + x × w, r × w)``."""
    x, y, z, rx, ry, rz = u
    vx, vy, vz, wx, wy, wz = v
    return (
        (ry * vz - rz * vy) + (y * wz - z * wy),
        (rz * vx - rx * vz) + (z * wx - x * wz),
        (rx * vy - ry * vx) + (x * wy - y * wx),
        ry * wz - rz * wy,
        rz * wx - rx * wz,
        rx * wy - ry * wx,
    )


@in_components
def spatial_rate_to_second_order(u: Numbers, v: Numbers) -> Numbers:
    """``v + ½ [u, v] + ¹⁄₁₂ [u, [u, v]]``: the series of dexp⁻¹ of SE(3), (..., 6)."""
    lx, ly, lz, bx, by, bz = once = _spatial_commutator(u, v)
    nx, ny, nz, cx, cy, cz = _spatial_commutator(u, once)
    vx, vy, vz, wx, wy, wz = v
    return [
        vx + 0.5 * lx + nx / 12,
        vy + 0.5 * ly + ny / 12,
        vz + 0.5 * lz + nz / 12,
        wx + 0.5 * bx + cx / 12,
        wy + 0.5 * by + cy / 12,
        wz + 0.5 * bz + cz / 12,
    ]


@in_components
def rate(u: Numbers, v: Numbers) -> Numbers:
    """``u̇ = ω + ½ r × ω + c r × (r × ω)``, ``c = (1 - ½|r| cot ½|r|) / |r|²``, |r| below 2π.

    dexp⁻¹ in attitude alone, (..., 3) or (..., 6). Towards zero c tends to ¹⁄₁₂ and is lost to
    rounding, which leaves no mark: it multiplies |r|².
    """
    rx, ry, rz = u[-3:]
    square = rx * rx + ry * ry + rz * rz + 1e-30
    cosine, sine_by_angle = half_turn(square)
    return _rate_with((1 - 0.5 * cosine / sine_by_angle) / square, u, v)


@one_in_components
def cayley(u: Numbers) -> Numbers:
    """``2 atan(|r|/2) r/|r|`` in place of r, (..., 3) or (..., 6).

    Its exponential is ``(1 - r_×/2)⁻¹ (1 + r_×/2)``, the midpoint rule's own.
    """
    *linear, rx, ry, rz = u
    angle = length(rx * rx + ry * ry + rz * rz)
    s = 2 * arctan(0.5 * angle) / angle
    return [*linear, s * rx, s * ry, s * rz]


@one_in_components
def spatial_cayley(u: Numbers) -> Numbers:
    """The vector whose exponential in SE(3) is ``(1 - U/2)⁻¹ (1 + U/2)``, (..., 6).

    ``2 artanh(U/2)``, an odd series in U: what is perpendicular to r shrinks as r does, and what is
    along r stays.
    """
    x, y, z, rx, ry, rz = u
    angle = length(rx * rx + ry * ry + rz * rz)
    s = 2 * arctan(0.5 * angle) / angle
    along = (1 - s) * (x * rx + y * ry + z * rz) / (angle * angle)
    return [s * x + along * rx, s * y + along * ry, s * z + along * rz, s * rx, s * ry, s * rz]


def _quaternion_rate(q: Numbers, v: Numbers) -> Numbers:
    """``½ q (0, ω)``."""
    w, x, y, z = q[-4:]
    wx, wy, wz = v[-3:]
    a, b, c = 0.5 * wx, 0.5 * wy, 0.5 * wz
    return (
        -x * a - y * b - z * c,
        w * a + y * c - z * b,
        w * b - x * c + z * a,
        w * c + x * b - y * a,
    )


@in_components
def coordinate_rate(q: Numbers, v: Numbers) -> Numbers:
    """``(ṗ, ½ q (0, ω))``, (..., 4) or (..., 7), with ṗ in v as it is."""
    return [*v[:-3], *_quaternion_rate(q, v)]


@in_components
def spatial_coordinate_rate(q: Numbers, v: Numbers) -> Numbers:
    """``(R u, ½ q (0, ω))``, (..., 7), with R at the direction of q."""
    w, x, y, z = q[3:]
    velocity = rotated(q[3:], v[:3], 2 / (w * w + x * x + y * y + z * z))
    return [*velocity, *_quaternion_rate(q, v)]


@one_in_components
def normalize(q: Numbers) -> Numbers:
    """Q with its quaternion made unit, (..., 4) or (..., 7)."""
    *place, w, x, y, z = q
    size = length(w * w + x * x + y * y + z * z)
    return [*place, w / size, x / size, y / size, z / size]


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
    **ATTITUDE,
    "retract": retract_spatial,
    "rate": _unknown,
    "rate_to_second_order": spatial_rate_to_second_order,
    "cayley": spatial_cayley,
    "coordinate_rate": spatial_coordinate_rate,
    "turned_by": None,
}
"""Fields of a `Motion` of one body: on a pivot, in the world, and in body axes."""
