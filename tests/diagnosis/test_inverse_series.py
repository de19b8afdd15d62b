"""An inverse that is cut short is named by where it ends."""

from __future__ import annotations

import numpy as np
import pytest
from test_solve_matrix import Solve, _by, _scenes, series

from omegadot.diagnosis.equations.across import Across
from omegadot.diagnosis.equations.evidence import FORWARD
from omegadot.diagnosis.equations.inverse_series import SOLVED, inverse_series
from omegadot.reference_impl.system import Array


def first_order(inertia: Array) -> Array:
    over = np.diag(1.0 / np.diag(inertia))
    return np.asarray(2.0 * over - over @ inertia @ over)


def two_of_newton(inertia: Array) -> Array:
    made = np.diag(1.0 / np.diag(inertia))
    for _ in range(2):
        made = 2.0 * made - made @ inertia @ made
    return np.asarray(made)


def gauss_seidel(sweeps: int, start: bool) -> Solve:
    """Column by column, as it is programmed."""

    def solve(inertia: Array) -> Array:
        made = np.diag(1.0 / np.diag(inertia)) if start else np.zeros((3, 3))
        for column, unit in zip(made.T, np.eye(3), strict=True):
            for _ in range(sweeps):
                for k in range(3):
                    rest = unit[k] - inertia[k] @ column + inertia[k, k] * column[k]
                    column[k] = rest / inertia[k, k]
        return made

    return solve


def jacobi(inertia: Array) -> Array:
    """Four from zero, the first of which gives the diagonal's inverse."""
    over, made = np.diag(1.0 / np.diag(inertia)), np.zeros((3, 3))
    for _ in range(4):
        made = made + over @ (np.eye(3) - inertia @ made)
    return np.asarray(made)


@pytest.mark.parametrize(
    ("solve", "text"),
    [
        (first_order, "its series in the products of inertia up to the first order"),
        (series, "its series in the products of inertia up to the second order"),
        (jacobi, "its series in the products of inertia up to the third order, as two steps of"),
        (two_of_newton, "its series in the products of inertia up to the third order, as two"),
        (gauss_seidel(2, False), "what two sweeps of Gauss-Seidel in the order xx, yy, zz give"),
        (
            gauss_seidel(2, True),
            "what two sweeps of Gauss-Seidel in the order xx, yy, zz give, from the diagonal's",
        ),
    ],
)
def test_an_inverse_that_is_cut_short_is_named(solve: Solve, text: str) -> None:
    """Caught: a matrix that is not the inertia, and no more."""
    across = Across()
    for scene in _scenes(_by(solve)):
        across.add(scene)
    for name in ("full", "other", "top", "free"):
        assert across.cause(name, FORWARD).startswith(f"{SOLVED} {text}")


def test_a_series_with_another_term_is_none() -> None:
    """Its last term counts 1.001 times."""

    def other(inertia: Array) -> Array:
        return first_order(inertia) + 1.001 * (series(inertia) - first_order(inertia))

    assert not inverse_series([one.evidence[FORWARD] for one in _scenes(_by(other))])
    assert not inverse_series([one.evidence[FORWARD] for one in _scenes(_by(np.linalg.inv))])
