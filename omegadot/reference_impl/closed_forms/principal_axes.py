"""Principal moments and axes of an inertia tensor, to eighty digits."""

from __future__ import annotations

from decimal import Decimal

from omegadot.reference_impl.closed_forms.digits import (
    ONE,
    PRECISION,
    RESOLUTION,
    ZERO,
    Matrix,
    Row,
)


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
