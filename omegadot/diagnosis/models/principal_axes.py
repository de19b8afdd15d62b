"""The principal axes of a tensor, in the orders and with the signs in which engines keep them.

The tensor gives neither: ``I = V D V^T`` holds for every order and every sign of V's columns.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from itertools import permutations, product

import numpy as np

from omegadot.reference_impl.system import Array

Signs = Callable[[Array], Array]


def right_handed(axes: Array) -> Array:
    """With the last axis turned over where they are no rotation."""
    last = np.array([1.0, 1.0, np.sign(np.linalg.det(axes))])
    return np.asarray(axes * last)


def mostly_positive(axes: Array) -> Array:
    """The largest component of every axis is positive."""
    largest = np.argmax(np.abs(axes), axis=0)
    return np.asarray(axes * np.sign(axes[largest, range(3)]))


SIGNS: tuple[Signs, ...] = (
    lambda axes: axes,
    right_handed,
    mostly_positive,
    lambda axes: right_handed(mostly_positive(axes)),
)


def near_the_bodys(axes: Array) -> Array:
    """The numbers of the axes, each the nearest to one of the body's."""
    return np.asarray(np.argmax(np.abs(axes), axis=1))


def conventions(tensor: Array) -> Iterator[tuple[Array, Array]]:
    """Moments and axes: by size, each the nearest to one of the body's, the nearest rotation."""
    moments, axes = np.linalg.eigh(tensor)
    for order in (np.arange(3), np.arange(3)[::-1], near_the_bodys(axes)):
        yield from ((moments[order], signs(axes[:, order])) for signs in SIGNS)
    every = product(map(np.array, permutations(range(3))), product((1.0, -1.0), repeat=3))
    turns = ((moments[order], axes[:, order] * signs) for order, signs in every)
    rotations = (one for one in turns if np.linalg.det(one[1]) > 0.0)
    yield max(rotations, key=lambda one: float(np.trace(one[1])))
