"""A body, its loads and its start as exact numbers, and its principal axes to eighty digits."""

from __future__ import annotations

from dataclasses import dataclass
from decimal import Decimal

import numpy as np

from omegadot.reference_impl.closed_forms.digits import (
    ONE,
    PRECISION,
    RESOLUTION,
    ZERO,
    Matrix,
    Row,
    dot,
    exact,
    exact_matrix,
)
from omegadot.reference_impl.system import State, System


@dataclass(frozen=True)
class Given:
    """A body, its loads and, if given, its start in the numbers that their doubles are.

    lever: from the pivot to the centre of mass, body axes; zero for a free body.  inertia:
    ``I + m (d·d 1 - d dᵀ)`` with the lever d: about the pivot, or a free body's centre of mass.
    """

    mass: Decimal
    lever: Row
    inertia: Matrix
    damping: Decimal
    gravity: Row
    torque_body: Row
    torque_world: Row
    orientation: Row
    omega: Row

    @classmethod
    def of(cls, system: System, initial: State | None = None) -> Given:
        """In the decimal context at hand; of one body."""
        body, load = system.body, system.load
        (mass,), center, (damping,) = map(exact, (body.mass, body.center_of_mass, load.damping))
        pivot = center if load.pivot is None else exact(load.pivot)
        d = [a - b for a, b in zip(center, pivot, strict=True)]
        square, inertia = dot(d, d), exact_matrix(body.inertia)
        for i in range(3):
            for j in range(3):
                inertia[i][j] += mass * ((square if i == j else 0) - d[i] * d[j])
        none = np.empty(0)
        start = (initial.orientation, initial.angular_velocity) if initial else (none, none)
        vectors = (load.gravity, load.torque_body, load.torque_world, *start)
        return cls(mass, d, inertia, damping, *map(exact, vectors))

    @property
    def driven(self) -> bool:
        """Whether an applied torque acts."""
        return any(self.torque_body) or any(self.torque_world)

    @property
    def hangs(self) -> bool:
        """Whether gravity has a moment about the point that stays."""
        return any(self.lever) and any(self.gravity)


def principal_axes(inertia: Matrix) -> tuple[Row, Matrix]:
    """Moments in increasing order and the axes, row by row, a right-handed set.

    Cyclic Jacobi rotations (Golub and Van Loan, Matrix Computations, section 8.5). In double
    precision an axis is lost where two moments nearly agree, and the small moment of a thin bar
    keeps only the digits that the large one leaves; in eighty digits neither matters. Moments
    that agree to what eighty digits resolve are made equal. A diagonal tensor comes back untouched,
    its axes permuted.
    """
    a = [[(inertia[i][j] + inertia[j][i]) / 2 for j in range(3)] for i in range(3)]
    v = [[ONE if i == j else ZERO for j in range(3)] for i in range(3)]  # rows are axes
    size = sum((abs(x) for row in a for x in row), ZERO)
    while any(abs(a[i][j]) > size * Decimal(10) ** -(PRECISION - 2) for i, j in _PAIRS):
        for p, q in _PAIRS:
            if a[p][q] != 0:
                _rotate(a, v, p, q)
    order = sorted(range(3), key=lambda i: a[i][i])
    axes = [v[i] for i in order]
    if order in ([0, 2, 1], [1, 0, 2], [2, 1, 0]):  # an odd permutation: turn one axis round
        axes[1] = [-x for x in axes[1]]
    moments = [a[i][i] for i in order]
    if moments[1] - moments[0] <= RESOLUTION * moments[0]:
        moments[0] = moments[1]
    if moments[2] - moments[1] <= RESOLUTION * moments[1]:
        moments[2] = moments[1]
    return moments, axes


_PAIRS = ((0, 1), (0, 2), (1, 2))


def _rotate(a: Matrix, v: Matrix, p: int, q: int) -> None:
    """The rotation in the plane of p and q that clears a[p][q], in place."""
    theta = (a[q][q] - a[p][p]) / (2 * a[p][q])
    t = (ONE if theta >= 0 else -ONE) / (abs(theta) + (theta * theta + 1).sqrt())
    c = 1 / (t * t + 1).sqrt()
    s = t * c
    r = 3 - p - q
    shift = t * a[p][q]
    a[p][p] -= shift
    a[q][q] += shift
    a[p][q] = a[q][p] = ZERO
    a[p][r], a[q][r] = c * a[p][r] - s * a[q][r], s * a[p][r] + c * a[q][r]
    a[r][p], a[r][q] = a[p][r], a[q][r]
    v[p], v[q] = (
        [c * x - s * y for x, y in zip(v[p], v[q], strict=True)],
        [s * x + c * y for x, y in zip(v[p], v[q], strict=True)],
    )
