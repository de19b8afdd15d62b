"""Tensors that an inertia is often mistaken for."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import permutations, product

import numpy as np

from omegadot.reference_impl.inertia import parallel_axis
from omegadot.reference_impl.system import Array, Body, System

AXES = "xyz"


def _permuted(tensor: Array) -> Iterator[tuple[str, Array]]:
    for order in permutations(range(3)):
        if order != (0, 1, 2):
            names = ", ".join(AXES[k] for k in order)
            text = f"the inertia's axes are permuted: x, y, z hold what belongs to {names}"
            yield text, tensor[np.ix_(order, order)]


def _turned_back(tensor: Array) -> Iterator[tuple[str, Array]]:
    """``R^T D R`` for ``R D R^T``, whatever order and signs the axes are kept in."""
    moments, axes = np.linalg.eigh(tensor)
    for order, signs in product(permutations(range(3)), product((1.0, -1.0), repeat=3)):
        turn = axes[:, order] * np.array(signs)
        text = "the rotation of the inertia's principal axes looks transposed"
        yield text, turn.T @ np.diag(moments[list(order)]) @ turn


def mistaken_inertias(body: Body, system: System) -> Iterator[tuple[str, Array]]:
    """What it would be, and the tensor; the plainest first."""
    tensor = np.asarray(body.inertia, dtype=float)
    diagonal = np.diag(np.diag(tensor))
    moments = np.linalg.eigvalsh(tensor)
    yield "only the diagonal of the inertia is used", diagonal
    yield "the products of inertia have the wrong sign", 2 * diagonal - tensor
    about = "instead of the centre of mass"
    shifted = tensor + parallel_axis(body.mass, body.center_of_mass)
    yield f"the inertia is about the body's origin {about}", shifted
    if system.load.pivot is not None:
        lever = body.center_of_mass - system.load.pivot
        yield f"the inertia is about the pivot {about}", tensor + parallel_axis(body.mass, lever)
    yield "the inertia is inverted: its reciprocal is used", np.linalg.inv(tensor)
    yield from _permuted(tensor)
    for order in permutations(range(3)):
        text = "the principal moments stand on the diagonal: the rotation of their axes is dropped"
        yield text, np.diag(moments[list(order)])
    yield from _turned_back(tensor)
