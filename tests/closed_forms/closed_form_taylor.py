"""A Taylor series of the equations of motion in mpmath: truth that knows nothing of closed forms.

``2 q̇ = q (0, ω)``, ``I ω̇ = τ - ω × I ω`` with ``τ = r × R^T m g - d ω``. Every product of series is
a convolution of coefficients; the equations are polynomial, so nothing else is needed.
"""

from __future__ import annotations

from collections.abc import Sequence

import mpmath as mp

Vector = list[mp.mpf]

_HAMILTON = (  # rows: product component; entries: (index of q, index of ω, sign)
    ((1, 0, -1), (2, 1, -1), (3, 2, -1)),
    ((0, 0, 1), (2, 2, 1), (3, 1, -1)),
    ((0, 1, 1), (3, 0, 1), (1, 2, -1)),
    ((0, 2, 1), (1, 1, 1), (2, 0, -1)),
)


def _convolve(a: list[Vector], i: int, b: list[Vector], j: int, n: int) -> mp.mpf:
    return mp.fdot((a[k][i], b[n - k][j]) for k in range(n + 1))


def _matvec(matrix: Sequence[Vector], v: Vector) -> Vector:
    return [mp.fdot(row, v) for row in matrix]


def _value(coefficients: list[Vector], i: int, x: mp.mpf) -> mp.mpf:
    total = mp.mpf(0)
    for row in reversed(coefficients):
        total = total * x + row[i]
    return total


class TaylorSeries:
    """inertia 3x3, damping d, and (optionally) moment ``m g`` (world) with lever r (body)."""

    def __init__(
        self,
        inertia: Sequence[Sequence[float]],
        damping: float = 0.0,
        weight: Sequence[float] = (0.0, 0.0, 0.0),
        lever: Sequence[float] = (0.0, 0.0, 0.0),
    ) -> None:
        self.inertia = [[mp.mpf(x) for x in row] for row in inertia]
        inverse = mp.matrix(self.inertia) ** -1
        self.inverse = [[inverse[i, j] for j in range(3)] for i in range(3)]
        self.damping = mp.mpf(damping)
        self.weight = [mp.mpf(x) for x in weight]
        self.lever = [mp.mpf(x) for x in lever]
        self.heavy = any(weight) and any(lever)

    def coefficients(self, q: Vector, w: Vector, order: int) -> tuple[list[Vector], list[Vector]]:
        qs, ws, hs, squares = [q], [w], [_matvec(self.inertia, w)], []
        for n in range(order):
            torque = [-self.damping * x for x in ws[n]]
            for i in range(3):
                j, k = (i + 1) % 3, (i + 2) % 3
                torque[i] -= _convolve(ws, j, hs, k, n) - _convolve(ws, k, hs, j, n)
            if self.heavy:
                squares.append(
                    {(i, j): _convolve(qs, i, qs, j, n) for i in range(4) for j in range(i, 4)}
                )
                torque = [a + b for a, b in zip(torque, self._gravity(squares[n]), strict=True)]
            w_next = [x / (n + 1) for x in _matvec(self.inverse, torque)]
            q_next = [
                mp.fsum(s * _convolve(qs, i, ws, j, n) for i, j, s in row) / (2 * (n + 1))
                for row in _HAMILTON
            ]
            ws.append(w_next)
            qs.append(q_next)
            hs.append(_matvec(self.inertia, w_next))
        return qs, ws

    def _gravity(self, p: dict[tuple[int, int], mp.mpf]) -> Vector:
        """``r × R^T m g`` from the products of the quaternion's components."""
        rotation = [
            [
                p[0, 0] + p[1, 1] - p[2, 2] - p[3, 3],
                2 * (p[1, 2] - p[0, 3]),
                2 * (p[1, 3] + p[0, 2]),
            ],
            [
                2 * (p[1, 2] + p[0, 3]),
                p[0, 0] - p[1, 1] + p[2, 2] - p[3, 3],
                2 * (p[2, 3] - p[0, 1]),
            ],
            [
                2 * (p[1, 3] - p[0, 2]),
                2 * (p[2, 3] + p[0, 1]),
                p[0, 0] - p[1, 1] - p[2, 2] + p[3, 3],
            ],
        ]
        g = [mp.fdot((rotation[j][i], self.weight[j]) for j in range(3)) for i in range(3)]
        r = self.lever
        return [r[i - 2] * g[i - 1] - r[i - 1] * g[i - 2] for i in range(3)]

    def states(
        self, q: Sequence[float], w: Sequence[float], times: Sequence[float]
    ) -> list[Vector]:
        """(q, ω) at the times, in their order from zero, each as seven numbers.

        The order is that of the working precision; the step is where the last terms fall below it.
        """
        q, w = [mp.mpf(x) for x in q], [mp.mpf(x) for x in w]
        norm = mp.sqrt(mp.fdot(q, q))
        q = [x / norm for x in q]
        order, now, found = int(1.2 * mp.mp.dps), mp.mpf(0), []
        for time in map(mp.mpf, times):
            while now != time:
                qs, ws = self.coefficients(q, w, order)
                size = max(
                    max(map(abs, row)) ** (mp.mpf(1) / n)
                    for rows in (qs, ws)
                    for n, row in ((order - 1, rows[-2]), (order, rows[-1]))
                )
                step = time - now
                if size:
                    longest = mp.mpf(10) ** (-mp.mpf(mp.mp.dps) / order) / size
                    step = mp.sign(step) * min(abs(step), longest)
                q = [_value(qs, i, step) for i in range(4)]
                w = [_value(ws, i, step) for i in range(3)]
                now += step
            found.append(q + w)
        return found
