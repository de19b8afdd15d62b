"""The matrix of a quaternion by entries, and what may be added to one of them."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from itertools import combinations_with_replacement

import numpy as np

from omegadot.diagnosis.equations.mistyped.few import Few
from omegadot.diagnosis.equations.mistyped.products import sum_text
from omegadot.reference_impl.system import Array

AXES = "xyz"
PARTS = "wxyz"
PRODUCTS = list(combinations_with_replacement(range(4), 2))
SQUARES = [PRODUCTS.index((k, k)) for k in range(4)]


def products_of(i: int, j: int) -> Callable[[Array], Array]:
    """Each product of two parts of a quaternion, added to one entry: (10, n, 3, 3)."""

    def matrices(q: Array) -> Array:
        more = np.zeros((len(PRODUCTS), len(q), 3, 3))
        more[:, :, i, j] = np.stack([q[:, a] * q[:, b] for a, b in PRODUCTS])
        return more

    return matrices


def right_entry(i: int, j: int) -> dict[int, float]:
    """Of ``world_R_body``, the factors by number of the product; 1 is what they are added to."""
    if i == j:
        return {SQUARES[1 + k]: -2.0 for k in range(3) if k != i}
    third = 3 - i - j
    sign = -1.0 if (j - i) % 3 == 1 else 1.0
    own = PRODUCTS.index((1 + min(i, j), 1 + max(i, j)))
    return {own: 2.0, PRODUCTS.index((0, 1 + third)): 2.0 * sign}


def entry_text(i: int, j: int, more: Few) -> str:
    """``R_xz is 2 (q_x q_z - q_w q_y), where 2 (q_x q_z + q_w q_y) is right``."""
    right = right_entry(i, j)
    typed = dict(right)
    for place, c in more:
        typed[place] = typed.get(place, 0.0) + c
    made, due = (_text(of, diagonal=i == j) for of in (typed, right))
    return f"R_{AXES[i]}{AXES[j]} is {made}, where {due} is right"


def _text(factors: Mapping[int, float], diagonal: bool) -> str:
    sign = -1.0 if diagonal else 1.0
    named = {" ".join(f"q_{PARTS[k]}" for k in PRODUCTS[p]): sign * c for p, c in factors.items()}
    inner = sum_text(named)
    if not diagonal:
        return inner
    return "1" if inner == "zero" else f"1 - {inner if inner.endswith(')') else f'({inner})'}"
