"""Several theta series at once: polynomials with common powers, summed by one matrix product."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from decimal import Decimal
from threading import local

import numpy as np

from omegadot.reference_impl.closed_forms.digits import Row
from omegadot.reference_impl.closed_forms.theta import Frame
from omegadot.reference_impl.system import Array

_NEGLIGIBLE = Decimal("1e-18")  # of the largest coefficient
_UNTHREADED = 4096  # columns at once: small enough for OpenBLAS not to start threads for them


class _Scratch(local):
    """Two arrays kept between calls: fresh ones of this size would cost a page fault a page."""

    kept: tuple[Array, Array] | None = None

    def arrays(self, rows: int, powers: int, n: int) -> tuple[Array, Array]:
        """(powers, n) and (rows, n)."""
        if self.kept is None or self.kept[0].shape[1] < n:
            self.kept = np.empty((powers, n)), np.empty((rows, n))
        return self.kept[0][:, :n], self.kept[1][:, :n]


@dataclass(frozen=True)
class Series:
    """``Σ c_k x^k + Σ d_k y^k`` with the frame's x and y, for several rows of c and d.

    matrix: (rows, powers), the powers being ``1, x, x², ..., y, y², ...``.  first: how many of them
    are powers of x, with the one.
    """

    matrix: Array
    first: int
    scratch: _Scratch

    @classmethod
    def of(cls, rows: Sequence[tuple[Row, Row]]) -> Series:
        """Rows of (c, d), d_0 being zero; trailing terms that no double can feel are left out."""
        kept = [(_felt(c), _felt(d)) for c, d in rows]
        first = max(len(c) for c, _ in kept)
        matrix = np.zeros((len(rows), first + max(len(d) for _, d in kept) - 1))
        for row, (c, d) in zip(matrix, kept, strict=True):
            row[: len(c)] = [float(x) for x in c]
            row[first : first + len(d) - 1] = [float(x) for x in d[1:]]
        return cls(matrix, first, _Scratch())

    @property
    def constant(self) -> bool:
        """Whether nothing depends on the frame."""
        return bool(self.matrix.shape[1] == 1)

    def __call__(self, frame: Frame) -> Array:
        """The values, (rows, n), to be used up before the next call in the same thread."""
        x, y = frame.bases
        rows, count = self.matrix.shape
        powers, values = self.scratch.arrays(rows, count, x.size)
        powers[0] = 1.0
        for k in range(1, self.first):
            _next(powers, k, x, k == 1)
        for k in range(self.first, count):
            _next(powers, k, y, k == self.first)
        for k in range(0, x.size, _UNTHREADED):
            part = slice(k, k + _UNTHREADED)
            np.matmul(self.matrix, powers[:, part], out=values[:, part])
        return values


def _felt(row: Row) -> Row:
    least = _NEGLIGIBLE * max(map(abs, row))
    count = max((k for k, x in enumerate(row) if abs(x) > least), default=0)
    return row[: count + 1]


def _next(powers: Array, k: int, base: Array, begins: bool) -> None:
    if begins:
        powers[k] = base
    else:
        np.multiply(powers[k - 1], base, out=powers[k])
