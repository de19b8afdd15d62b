"""Spin about an axis that stays: driven and damped, of a sphere or about a principal axis."""

from __future__ import annotations

from math import factorial

import numpy as np

from omegadot.reference_impl.closed_forms.digits import (
    RESOLUTION,
    ZERO,
    Row,
    apply,
    cross,
    dot,
    doubles,
    many_digits,
)
from omegadot.reference_impl.closed_forms.given import Given
from omegadot.reference_impl.closed_forms.phase import unit_circle
from omegadot.reference_impl.closed_forms.problem import (
    IDENTITY,
    MeasuredRun,
    Motion,
    Problem,
    place,
    product,
)
from omegadot.reference_impl.closed_forms.times import Times
from omegadot.reference_impl.system import Array


def fixed_axis_of(given: Given) -> Problem | None:
    """The spin about one axis, or None where the axis moves.

    Angular velocity, applied torques and ``I n`` must all lie along one axis n, exactly, and
    gravity must have no moment. Numbers: moment about n, torque along n, damping, speed about n,
    n (3) in body axes, orientation (4).
    """
    if given.hangs:
        return None
    omega, turned = given.omega, _to_body(given.orientation, given.torque_world)
    torque = [a + b for a, b in zip(given.torque_body, turned, strict=True)]
    axis = max(omega, torque, key=lambda v: dot(v, v))
    size = dot(axis, axis).sqrt()
    n = [x / size for x in axis] if size else IDENTITY[0]
    along = apply(given.inertia, n) if size else n
    if not all(_parallel(v, n) for v in (along, omega, torque, turned)):
        return None
    numbers = [dot(along, n), dot(torque, n), given.damping, dot(omega, n)]
    return Problem("fixed axis", [*numbers, *n, *given.orientation], _solve)


def _solve(numbers: Row) -> Motion:
    with many_digits():
        return place(_trajectory(numbers[:4], numbers[4:7]), numbers[7:])


def _trajectory(numbers: Row, axis: Row) -> MeasuredRun:
    """``I dω/dt = τ - d ω``, with ``x = d t / I``, ``φ_1 = (1 - e^-x)/x``, ``φ_2 = (1 - φ_1)/x``:

    ω = ω_0 e^-x + (τ/I) t φ_1,  angle = ω_0 t φ_1 + (τ/I) t² φ_2.
    """
    inertia, torque, damping, speed = numbers
    decay, drive, start = float(damping / inertia), float(torque / inertia), float(speed)
    n = doubles(axis)[:, None]

    def trajectory(times: Times, vector: Array, q: Array) -> None:
        t = times.value
        x = decay * t
        first, second = _phi(x)
        omega = start * np.exp(-x) + drive * t * first
        angle = t * (start * first + drive * t * second)
        turns = angle / (4 * np.pi)
        half = unit_circle(turns - np.rint(turns))
        q[0] = half.real
        np.multiply(n, half.imag, out=q[1:])
        np.multiply(n, omega, out=vector)

    return trajectory


def _phi(x: Array) -> tuple[Array, Array]:
    """``(1 - e^-x)/x`` and ``(1 - first)/x``; below 1 the second by its series Σ (-x)^k/(k+2)!."""
    near = np.abs(x) < 1.0
    safe = np.where(x == 0, 1.0, x)
    first = np.where(x == 0, 1.0, -np.expm1(-safe) / safe)
    series = np.zeros_like(x)
    small = np.where(near, x, 0.0)
    for k in range(17, -1, -1):  # 1/19! is below 1e-17
        series = 1.0 / factorial(k + 2) - small * series
    return first, np.where(near, series, (1.0 - first) / np.where(near, 1.0, safe))


def _to_body(q: Row, v: Row) -> Row:
    back = [q[0], -q[1], -q[2], -q[3]]
    turned = product(product(back, [ZERO, *v]), q)
    return [x / dot(q, q) for x in turned[1:]]


def _parallel(v: Row, n: Row) -> bool:
    off = cross(v, n)
    return dot(off, off) <= RESOLUTION**2 * dot(v, v)
