"""An attitude that goes through a matrix with one entry mistyped, and is read from it again."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import product

import numpy as np

from omegadot.diagnosis.equations.mistyped.few import Few
from omegadot.diagnosis.equations.mistyped.matrices import (
    PRODUCTS,
    SQUARES,
    entry_text,
    products_of,
    right_entry,
)
from omegadot.gates.bounds.scales import ROUNDINGS_PER_EVALUATION
from omegadot.reference_impl.rotations import attitude_angle, normalize, rotation_matrix
from omegadot.reference_impl.system import Array

CHANGES = {"missing": -1.0, "of the wrong sign": -2.0, "half": -0.5, "twice": 1.0}
LEAST = 1e-6  # of a quaternion's part by which the others are divided


def matrix_mistyped(requested: Array, back: Array, eps: float) -> str:
    """The entry that makes all attitudes back (n, 4) of those requested; "" without one."""
    worst = [int(np.argmax(attitude_angle(requested, back)))]
    for i, j in product(range(3), repeat=2):
        slips = [*_slips(i, j)]
        near = _fitting(slips, i, j, requested[worst], back[worst], eps)
        fits = _fitting(near, i, j, requested, back, eps) if near else []
        if fits:
            return entry_text(i, j, fits[0])
    return ""


def _fitting(
    slips: Sequence[Few], i: int, j: int, requested: Array, back: Array, eps: float
) -> list[Few]:
    """Those of one entry that make all attitudes, read from the matrix by any of four formulas."""
    factors = np.zeros((len(slips), len(PRODUCTS)))
    for row, slip in zip(factors, slips, strict=True):
        for place, c in slip:
            row[place] = c
    more = np.tensordot(factors, products_of(i, j)(requested), 1)
    for read in (_largest, _by_trace, _by_signs, _nearest):
        made, known = read(rotation_matrix(requested) + more)
        apart = attitude_angle(made, back)
        bound = ROUNDINGS_PER_EVALUATION * eps / np.maximum(known, LEAST)
        fits = np.flatnonzero(np.all(apart <= bound, axis=-1))
        if len(fits):
            return [slips[int(k)] for k in fits]
    return []


def _slips(i: int, j: int) -> Iterator[Few]:
    """A product of an entry that is changed, or another in its place."""
    right = right_entry(i, j)
    for place, factor in right.items():
        yield from (((place, change * factor),) for change in CHANGES.values())
        others = (k for k in range(len(PRODUCTS)) if k != place)
        yield from (((place, -factor), (other, factor)) for other in others)
    if i == j:  # as typed in squares alone
        yield from (((k, c),) for k in SQUARES for c in (-2.0, -1.0, 1.0, 2.0) if k not in right)


def _parts(m: Array) -> tuple[Array, Array]:
    """4 w^2, 4 x^2, 4 y^2, 4 z^2 by the diagonal, and 4 w (w, x, y, z)."""
    a, b, c = m[..., 0, 0], m[..., 1, 1], m[..., 2, 2]
    squares = np.stack([1 + a + b + c, 1 + a - b - c, 1 - a + b - c, 1 - a - b + c], axis=-1)
    sides = [m[..., 2, 1] - m[..., 1, 2], m[..., 0, 2] - m[..., 2, 0], m[..., 1, 0] - m[..., 0, 1]]
    return squares, np.stack([squares[..., 0], *sides], axis=-1)


def _largest(m: Array) -> tuple[Array, Array]:
    """By the part that is largest, of which all others are quotients."""
    squares, by_w = _parts(m)
    x, y, z = by_w[..., 1], by_w[..., 2], by_w[..., 3]
    xy, xz, yz = (m[..., i, j] + m[..., j, i] for i, j in ((0, 1), (0, 2), (1, 2)))
    every = np.stack(
        [
            by_w,
            np.stack([x, squares[..., 1], xy, xz], axis=-1),
            np.stack([y, xy, squares[..., 2], yz], axis=-1),
            np.stack([z, xz, yz, squares[..., 3]], axis=-1),
        ],
        axis=-2,
    )
    traced = squares[..., 0] - 1.0  # the trace, next to the numbers on the diagonal
    diagonal = np.diagonal(m, axis1=-2, axis2=-1)
    place = np.argmax(np.concatenate([traced[..., None], diagonal], axis=-1), axis=-1)
    made = np.take_along_axis(every, place[..., None, None], axis=-2)[..., 0, :]
    return normalize(made), np.ones(made.shape[:-1])


def _by_trace(m: Array) -> tuple[Array, Array]:
    """By the scalar part, whatever it is."""
    made = normalize(_parts(m)[1])
    return made, np.abs(made[..., 0])


def _by_signs(m: Array) -> tuple[Array, Array]:
    """Each part by its own square root, with the sign that the sides give it."""
    squares, by_w = _parts(m)
    made = normalize(np.copysign(np.sqrt(np.maximum(squares, 0.0)), by_w))
    return made, np.min(np.abs(made), axis=-1)


def _nearest(m: Array) -> tuple[Array, Array]:
    """Of the nearest rotation, by singular values."""
    left, _, right = np.linalg.svd(m)
    return _largest(left @ right)
