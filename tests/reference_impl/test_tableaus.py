"""Butcher's order conditions of every tableau, over all rooted trees, and that no more hold."""

from __future__ import annotations

from collections.abc import Iterator
from functools import cache, partial
from itertools import combinations_with_replacement
from math import prod

import numpy as np
import pytest
from reference_cases import EPS

from omegadot.reference_impl.schemes import tableaus
from omegadot.reference_impl.schemes.runge_kutta import kutta
from omegadot.reference_impl.schemes.tableaus import KUTTA4, Tableau
from omegadot.reference_impl.system import Array

Tree = tuple["Tree", ...]  # a root's subtrees
ALL = {name: one for name, one in vars(tableaus).items() if isinstance(one, Tableau)}
every_tableau = pytest.mark.parametrize("name", sorted(ALL))


@cache
def size(tree: Tree) -> int:
    return 1 + sum(map(size, tree))


@cache
def trees(order: int) -> tuple[Tree, ...]:
    """All rooted trees of so many nodes."""
    return tuple(dict.fromkeys(_forests(order - 1, order - 1)))


def _forests(nodes: int, largest: int) -> Iterator[Tree]:
    """Subtrees of so many nodes together, the larger first, none of more than `largest`."""
    if nodes == 0:
        yield ()
    for own in range(min(nodes, largest), 0, -1):
        for count in range(1, nodes // own + 1):
            for first in combinations_with_replacement(trees(own), count):
                for rest in _forests(nodes - own * count, own - 1):
                    yield (*first, *rest)


def density(tree: Tree) -> int:
    return size(tree) * prod(map(density, tree))


def matrix_of(tableau: Tableau) -> tuple[Array, Array]:
    """A and b, read off one step on ``ẏ_i = given_i`` with the slopes of all stages unlike."""
    stages = len(tableau.weights)
    seen: list[Array] = []

    def rate(y: Array) -> Array:
        seen.append(y)
        return np.eye(stages)[len(seen)]

    end = tableau.step(rate, np.zeros(stages), np.eye(stages)[0], 1.0)
    return np.array([np.zeros(stages), *seen]), end


def off(tableau: Tableau, tree: Tree) -> float:
    """By how much ``Σ b_i Φ_i(tree)`` is not ``1 / γ(tree)``."""
    a, b = matrix_of(tableau)

    def elementary(tree: Tree) -> Array:
        found: Array = prod((a @ elementary(one) for one in tree), start=np.ones(len(b)))
        return found

    return float(abs(b @ elementary(tree) - 1 / density(tree)))


def test_there_are_as_many_trees_as_are_known() -> None:
    assert [len(trees(order)) for order in range(1, 8)] == [1, 1, 2, 4, 9, 20, 48]


@every_tableau
def test_a_tableau_has_its_order_and_no_higher_one(name: str) -> None:
    """Hairer, Norsett, Wanner, Solving Ordinary Differential Equations I (1993), theorem II.2.13.

    Coefficients of up to 12 are summed over seven stages, up to six times.
    """
    tableau = ALL[name]
    worst = partial(max, default=0.0)
    for order in range(1, tableau.order + 1):
        assert worst(off(tableau, tree) for tree in trees(order)) <= 12 * 7 * 6 * EPS, order
    assert worst(off(tableau, tree) for tree in trees(tableau.order + 1)) > 1e-5


@every_tableau
def test_lanes_of_any_shape_and_long_doubles_are_stepped(name: str) -> None:
    """``ẏ = -y²`` of lanes is that of each, and long doubles keep more digits."""
    y, tableau = np.linspace(0.1, 2.0, 12).reshape(2, 3, 2), ALL[name]
    steps = np.array([[0.1], [0.2], [0.3]])

    def slope(y: Array) -> Array:
        return -y * y

    found = tableau.step(slope, y, slope(y), steps)
    for lane in np.ndindex(2, 3):
        alone = tableau.step(slope, y[lane], slope(y[lane]), float(steps[lane[1], 0]))
        assert np.max(np.abs(found[lane] - alone)) <= 16 * EPS
    wide = tableau.step(slope, y.astype(np.longdouble), slope(y), steps.astype(np.longdouble))
    assert wide.dtype == np.longdouble
    if np.finfo(np.longdouble).eps < EPS:
        assert 0 < np.max(np.abs(wide - found)) <= 64 * EPS


def test_kuttas_method_is_the_one_that_is_written_out() -> None:
    def slope(y: Array) -> Array:
        return np.array([y[1], -np.sin(y[0])])

    y = np.array([1.0, 0.5])
    apart = KUTTA4.step(slope, y, slope(y), 0.1) - kutta(slope, y, slope(y), 0.1)
    assert np.max(np.abs(apart)) <= 4 * EPS
