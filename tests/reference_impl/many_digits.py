"""The motion to forty digits by other means than the package's: a rotation matrix in body axes.

Its nine entries and ω are expanded in Taylor series of mpmath numbers, with the full tensor and its
inverse; the package expands a quaternion in principal axes.
"""

from __future__ import annotations

from collections.abc import Sequence
from decimal import Decimal

import mpmath as mp
import numpy as np

from omegadot.reference_impl.arithmetic.precision import from_decimals
from omegadot.reference_impl.system import Array, State, System

DIGITS, ORDER = 40, 46
Row = list[mp.mpf]


def _numbers(values: object) -> Row:
    return [mp.mpf(float(x)) for x in np.ravel(values)]


def _cross(a: Sequence[mp.mpf], b: Sequence[mp.mpf]) -> Row:
    return [a[i - 2] * b[i - 1] - a[i - 1] * b[i - 2] for i in range(3)]


def _matrix_of(q: Row) -> Row:
    n = mp.sqrt(mp.fdot(q, q))
    w, x, y, z = (c / n for c in q)
    return [
        1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y),
        2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x),
        2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y),
    ]  # fmt: skip


class Motion:
    """One system in mpmath numbers."""

    def __init__(self, system: System) -> None:
        body, load = system.body, system.load
        self.inertia = mp.matrix(3, 3)
        for i in range(3):
            for j in range(3):
                self.inertia[i, j] = (
                    mp.mpf(float(body.inertia[i, j])) + float(body.inertia[j, i])
                ) / 2
        mass, self.lever = mp.mpf(float(body.mass)), [mp.mpf(0)] * 3
        if load.pivot is not None:
            c, p = _numbers(body.center_of_mass), _numbers(load.pivot)
            self.lever = [a - b for a, b in zip(c, p, strict=True)]
            square = mp.fdot(self.lever, self.lever)
            for i in range(3):
                for j in range(3):
                    shift = (square if i == j else 0) - self.lever[i] * self.lever[j]
                    self.inertia[i, j] += mass * shift
        self.inverse = self.inertia**-1
        self.weight = [mass * g for g in _numbers(load.gravity)]
        self.torque_body, self.torque_world = (
            _numbers(load.torque_body),
            _numbers(load.torque_world),
        )
        self.damping = mp.mpf(float(load.damping))

    def coefficients(self, R: Row, w: Row) -> tuple[list[Row], list[Row]]:
        """Taylor coefficients of R (row by row) and ω."""
        Rs, ws, hs = [[x] for x in R], [[x] for x in w], [[], [], []]
        for n in range(ORDER):
            for i in range(3):
                hs[i].append(mp.fdot([self.inertia[i, j] for j in range(3)], [x[n] for x in ws]))
            backwards = [x[::-1] for x in ws]
            gyroscopic = [
                mp.fdot(hs[i - 1], backwards[i - 2]) - mp.fdot(hs[i - 2], backwards[i - 1])
                for i in range(3)
            ]
            now = [x[n] for x in Rs]
            in_body = [
                [mp.fdot(now[i::3], vector) for i in range(3)]
                for vector in (self.weight, self.torque_world)
            ]
            torque = _cross(self.lever, in_body[0])
            for i in range(3):
                torque[i] += in_body[1][i] - self.damping * ws[i][n] - gyroscopic[i]
                torque[i] += self.torque_body[i] if n == 0 else 0
            for row in range(3):  # Ṙ = R ω_×: its rows move as r × ω
                r = Rs[3 * row : 3 * row + 3]
                rates = [
                    mp.fdot(r[i - 2], backwards[i - 1]) - mp.fdot(r[i - 1], backwards[i - 2])
                    for i in range(3)
                ]
                for i in range(3):
                    r[i].append(rates[i] / (n + 1))
            for i in range(3):
                rate = mp.fdot([self.inverse[i, j] for j in range(3)], torque)
                ws[i].append(rate / (n + 1))
        return Rs, ws


def exact_states(
    system: System, initial: State, times: Sequence[float]
) -> list[tuple[Array, Array]]:
    """``(world_R_body, ω)`` in the extended type at times that go outwards from zero."""
    with mp.workdps(DIGITS):
        motion, now = Motion(system), mp.mpf(0)
        R, w = _matrix_of(_numbers(initial.orientation)), _numbers(initial.angular_velocity)
        found = []
        for time in map(mp.mpf, times):
            while now != time:
                Rs, ws = motion.coefficients(R, w)
                size = max(
                    (abs(row[k]) + mp.mpf(10) ** -400) ** (mp.mpf(1) / k)
                    for row in Rs + ws
                    for k in (ORDER - 1, ORDER)
                )
                reach = mp.mpf(10) ** (-mp.mpf(DIGITS - 2) / ORDER) / size
                step = mp.sign(time - now) * min(abs(time - now), reach)
                powers = [step**k for k in range(ORDER + 1)]
                R, w = ([mp.fdot(row, powers) for row in rows] for rows in (Rs, ws))
                now += step
            found.append((_extended(R).reshape(3, 3), _extended(w)))
        return found


def _extended(values: Row) -> Array:
    return from_decimals([Decimal(mp.nstr(value, DIGITS)) for value in values])
