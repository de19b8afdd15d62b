"""Tensors that engines take in place of the requested inertia."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from functools import lru_cache, partial
from itertools import permutations, product

import numpy as np

from omegadot.diagnosis.models.principal_axes import conventions
from omegadot.reference_impl.inertia import parallel_axis
from omegadot.reference_impl.system import Array, Body, Load, System

DECIMALS, SMALL, DIGITS = range(1, 8), range(1, 7), range(2, 10)
SPHERE = "the inertia is that of a sphere with the same trace"
UNIT = "the inertia is the unit matrix"
DROPPED = "what is smaller than"
TRANSPOSED = "the rotation of the inertia's principal axes looks transposed"


def _diagonal(matrix: Array) -> Array:
    return np.diag(np.diag(matrix))


def _symmetric(tensor: Array, change: Callable[[list[float]], Sequence[float]]) -> Array:
    """A tensor with the products (xy, xz, yz) changed."""
    xy, xz, yz = change([tensor[0, 1], tensor[0, 2], tensor[1, 2]])
    products = np.array([[0.0, xy, xz], [xy, 0.0, yz], [xz, yz, 0.0]])
    return np.asarray(_diagonal(tensor) + products)


def _in_order(order: Sequence[int], products: list[float]) -> list[float]:
    return [products[k] for k in order]


def _times(factors: Sequence[float], products: list[float]) -> list[float]:
    return [a * b for a, b in zip(factors, products, strict=True)]


def in_single(values: Array) -> Array:
    """Every number rounded to single precision."""
    return np.asarray(np.asarray(values, dtype=np.float32), dtype=float)


def diagonal_in_single(tensor: Array) -> Array:
    """A tensor (3, 3) with the numbers on its diagonal alone rounded to single precision."""
    return np.asarray(tensor - _diagonal(tensor) + _diagonal(in_single(tensor)))


def products_in_single(tensor: Array) -> Array:
    """A tensor (3, 3) with its products alone, off the diagonal, rounded to single precision."""
    rounded = in_single(tensor)
    return np.asarray(_diagonal(tensor) + rounded - _diagonal(rounded))


def product_mistakes(tensor: Array) -> Iterator[tuple[str, Array]]:
    """The products of inertia in another order, or single ones wrong."""
    names = ("xy", "xz", "yz")
    for order in permutations(range(3)):
        if order != (0, 1, 2):
            held = ", ".join(names[k] for k in order)
            text = f"the products of inertia are in another order: xy, xz, yz hold {held}"
            yield text, _symmetric(tensor, partial(_in_order, order))
    for index, name in enumerate(names):
        for what, factor in (("has the wrong sign", -1.0), ("is dropped", 0.0)):
            text = f"the product of inertia {name} {what}"
            signs = [factor if k == index else 1.0 for k in range(3)]
            yield text, _symmetric(tensor, partial(_times, signs))
    for index in range(3):
        one, other = (names[k] for k in range(3) if k != index)
        text = f"the products of inertia {one} and {other} have the wrong sign"
        signs = [1.0 if k == index else -1.0 for k in range(3)]
        yield text, _symmetric(tensor, partial(_times, signs))
    for index, name in enumerate(names):
        kept = [1.0 if k == index else 0.0 for k in range(3)]
        text = f"of the products of inertia only {name} is kept"
        yield text, _symmetric(tensor, partial(_times, kept))


def other_tensors(system: System) -> dict[str, Array]:
    """Tensors about the centre of mass that an engine may take instead, the plainest first.

    Where a mistake can be made in several ways, blanks at the end of its text keep them apart.
    """
    body, pivot = system.body, system.load.pivot
    numbers = (
        body.mass,
        body.center_of_mass,
        body.inertia,
        np.zeros(0) if pivot is None else pivot,
    )
    return _other_tensors(*(np.asarray(values, dtype=float).tobytes() for values in numbers))


@lru_cache(maxsize=64)
def _other_tensors(*numbers: bytes) -> dict[str, Array]:
    mass, center, inertia, held = (np.frombuffer(values) for values in numbers)
    body = Body(mass.reshape(()), center, inertia.reshape(3, 3))
    system = System((body,), Load(pivot=held if len(held) else None))
    return _tensors(system, float(body.mass))


def _tensors(system: System, mass: float) -> dict[str, Array]:
    tensor, body = np.asarray(system.body.inertia), system.body
    found = dict[str, Array]()
    # order and signs of principal axes may be another one of these for every tensor
    chosen = ((TRANSPOSED, turn.T @ np.diag(m) @ turn) for m, turn in conventions(tensor))
    for text, other in (*mistaken_inertias(body, system), *product_mistakes(tensor), *chosen):
        while text in found:
            text += " "
        found[text] = other
    found[SPHERE] = np.trace(tensor) / 3.0 * np.eye(3)
    found[UNIT] = np.eye(3)
    for digits in DECIMALS:
        found[f"the inertia is rounded to {digits} decimals"] = np.round(tensor, digits)
    for power in SMALL:
        kept = np.abs(tensor) >= 10.0**-power * np.trace(tensor)
        text = f"{DROPPED} 1e-{power} of the trace is dropped from the inertia"
        found[text] = np.where(kept, tensor, 0.0)
    for digits in DIGITS:
        found[f"the inertia is rounded to {digits} digits"] = _of_digits(tensor, digits)
    found.update(_replaced_moments(tensor))
    found["the inertia is divided by the mass"] = tensor / mass
    found["the inertia is multiplied by the mass"] = tensor * mass
    if np.any(body.center_of_mass):
        less = tensor - parallel_axis(mass, body.center_of_mass)
        found["the inertia is moved from the origin to the centre of mass once too often"] = less
    return found


def _of_digits(tensor: Array, digits: int) -> Array:
    return np.array([float(f"{x:.{digits - 1}e}") for x in tensor.ravel()]).reshape(3, 3)


def _replaced_moments(tensor: Array) -> Iterator[tuple[str, Array]]:
    """One number on the diagonal in the place of another, or two that are both their mean."""
    kept = np.diag(tensor)
    for i, j in permutations(range(3), 2):
        other = kept.copy()
        other[i] = kept[j]
        text = f"the moment of inertia {2 * 'xyz'[i]} is that of {2 * 'xyz'[j]}"
        yield text, tensor + np.diag(other - kept)
        if i < j:
            other = kept.copy()
            other[[i, j]] = 0.5 * (kept[i] + kept[j])
            text = f"the moments of inertia {2 * 'xyz'[i]} and {2 * 'xyz'[j]} are both their mean"
            yield text, tensor + np.diag(other - kept)


def mistaken_inertias(body: Body, system: System) -> Iterator[tuple[str, Array]]:
    """What it would be, and the tensor; the plainest first."""
    tensor = np.asarray(body.inertia, dtype=float)
    diagonal = np.diag(np.diag(tensor))
    moments, axes = np.linalg.eigh(tensor)
    yield "only the diagonal of the inertia is used", diagonal
    yield "the products of inertia have the wrong sign", 2 * diagonal - tensor
    about = "instead of the centre of mass"
    shifted = tensor + parallel_axis(body.mass, body.center_of_mass)
    yield f"the inertia is about the body's origin {about}", shifted
    if system.load.pivot is not None:
        lever = body.center_of_mass - system.load.pivot
        yield f"the inertia is about the pivot {about}", tensor + parallel_axis(body.mass, lever)
    yield "the inertia is inverted: its reciprocal is used", np.linalg.inv(tensor)
    for order in permutations(range(3)):
        if order != (0, 1, 2):
            names = ", ".join("xyz"[k] for k in order)
            text = f"the inertia's axes are permuted: x, y, z hold what belongs to {names}"
            yield text, tensor[np.ix_(order, order)]
    for order in permutations(range(3)):
        text = "the principal moments stand on the diagonal: the rotation of their axes is dropped"
        yield text, np.diag(moments[list(order)])
    # R^T D R for R D R^T, whatever order and signs the axes are kept in; those of -R are the same
    for order, signs in product(permutations(range(3)), product((1.0, -1.0), repeat=2)):
        turn = axes[:, order] * np.array((1.0, *signs))
        yield TRANSPOSED, turn.T @ np.diag(moments[list(order)]) @ turn
