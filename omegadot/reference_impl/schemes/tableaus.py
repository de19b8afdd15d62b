"""Explicit Runge-Kutta methods by their Butcher tableaus, on any vector."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cache
from typing import Any

import numpy as np

from omegadot.reference_impl.system import Array

Rate = Callable[[Array], Array]
# The y after one step of h s on ``ẏ = rate(y)``, with the rate at y given: rate, y, first, h.
Method = Callable[[Rate, Array, Array, "float | Array"], Array]


@dataclass(frozen=True)
class Tableau:
    """``k_i = f(y + h Σ a_ij k_j)``, ``y₁ = y + h Σ b_i k_i``.

    rows: the a of each stage after the first.  weights: the b.  order: of the method.
    roots: like rows, multiples of the square root of 5 that are added; none where there are none.
    """

    title: str
    order: int
    rows: tuple[tuple[Fraction, ...], ...]
    weights: tuple[Fraction, ...]
    source: str
    roots: tuple[tuple[Fraction, ...], ...] = ()

    def step(self, rate: Rate, y: Array, first: Array, h: float | Array) -> Array:
        """The y after one step. first: the rate at y."""
        rows, weights = _numbers(self, y.dtype)
        slopes = np.empty((len(weights), *y.shape), y.dtype)
        slopes[0] = first
        for stage, row in enumerate(rows, 1):
            slopes[stage] = rate(y + h * _sum(row, slopes))
        return y + h * _sum(weights, slopes)


def _sum(numbers: Array, slopes: Array) -> Array:
    known = slopes[: len(numbers)]
    found: Array = (numbers @ known.reshape(len(known), -1)).reshape(known.shape[1:])
    return found


@cache
def _numbers(tableau: Tableau, dtype: Any) -> tuple[list[Array], Array]:
    """Rows and weights in a number format."""

    def rounded(row: Sequence[Fraction]) -> Array:
        whole = [np.array([getattr(f, part) for f in row], dtype) for part in PARTS]
        found: Array = whole[0] / whole[1]
        return found

    rows, root = [rounded(row) for row in tableau.rows], np.sqrt(np.array(5, dtype))
    if tableau.roots:
        rows = [a + root * rounded(b) for a, b in zip(rows, tableau.roots, strict=True)]
    return rows, rounded(tableau.weights)


PARTS = ("numerator", "denominator")


def _fractions(text: str) -> tuple[Fraction, ...]:
    return tuple(map(Fraction, text.split()))


def _tableau(
    title: str, order: int, rows: str, weights: str, source: str = "", roots: str = ""
) -> Tableau:
    """Of rows, and of roots, as text: each stage after the first, with semicolons between them."""
    given, added = (
        tuple(_fractions(row) for row in text.split(";") if row) for text in (rows, roots)
    )
    return Tableau(title, order, given, _fractions(weights), source or HAIRER, added)


HAIRER = "Hairer, Norsett, Wanner, Solving Ordinary Differential Equations I (1993), II.1"
EULER = _tableau("Explicit Euler", 1, "", "1")
MIDPOINT = _tableau("Explicit midpoint", 2, "1/2", "0 1")
HEUN = _tableau("Heun", 2, "1", "1/2 1/2")
KUTTA3 = _tableau("Kutta 3", 3, "1/2; -1 2", "1/6 2/3 1/6")
HEUN3 = _tableau("Heun 3", 3, "1/3; 0 2/3", "1/4 0 3/4")
BOGACKI_SHAMPINE3 = _tableau(
    "Bogacki-Shampine 3",
    *(3, "1/2; 0 3/4", "2/9 1/3 4/9"),
    source="Bogacki, Shampine, Appl. Math. Lett. 2 (1989) 321-325",
)
KUTTA4 = _tableau("Runge-Kutta 4", 4, "1/2; 0 1/2; 0 0 1", "1/6 1/3 1/3 1/6")
MERSON4 = _tableau(
    "Merson 4",
    *(4, "1/3; 1/6 1/6; 1/8 0 3/8; 1/2 0 -3/2 2", "1/6 0 0 2/3 1/6"),
    source=f"{HAIRER}, table II.4.1",
)
FEHLBERG4 = _tableau(
    "Fehlberg 4",
    4,
    "1/4; 3/32 9/32; 1932/2197 -7200/2197 7296/2197; 439/216 -8 3680/513 -845/4104",
    "25/216 0 1408/2565 2197/4104 -1/5",
    f"{HAIRER}, table II.5.1",
)
DORMAND_PRINCE5 = _tableau(
    "Dormand-Prince 5",
    5,
    "1/5; 3/40 9/40; 44/45 -56/15 32/9; 19372/6561 -25360/2187 64448/6561 -212/729;"
    "9017/3168 -355/33 46732/5247 49/176 -5103/18656",
    "35/384 0 500/1113 125/192 -2187/6784 11/84",
    "Dormand, Prince, J. Comput. Appl. Math. 6 (1980) 19-26",
)
# Of one parameter of Butcher's family: the nodes are those of Lobatto's quadrature of order 6.
BUTCHER6 = _tableau(
    "Butcher 6",
    6,
    "1/2; 0 1/2; -3/4 -1/4 3/2; 1/12 0 1/6 1/4; 1/12 0 3/4 1/6 -1/2; 1/6 0 -55/12 -25/12 5 5/2",
    "1/12 0 0 0 5/12 5/12 1/12",
    "Butcher, J. Austral. Math. Soc. 4 (1964) 179-194",
    "-1/10; -1/10 1/5; 7/20 1/4 -7/10; -1/60 0 0 7/60; 1/60 0 -5/12 0 3/10;0 0 25/12 -7/12 -2 1/2",
)
