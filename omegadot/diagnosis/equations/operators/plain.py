"""Operators without numbers: other axes and signs, rounding, places of other states."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import partial

import numpy as np

from omegadot.diagnosis.equations.operators.operator import Operator
from omegadot.diagnosis.models.fitted_misreadings import order_text, signed_orders
from omegadot.reference_impl.rotations import (
    conjugate,
    quaternion_product,
    rotate,
    rotate_inverse,
)
from omegadot.reference_impl.system import Array, State

DECIMALS = range(9)
BLOCKS = (2, 4, 8, 16, 32, 64)  # states, as vectorised code takes them together


def _repeated(count: int, v: Array) -> Array:
    return v[np.arange(len(v)) % count]


def _beside(by: int, v: Array) -> Array:
    """Of the state before or after; at the end there is none, and its own stays."""
    return v[np.clip(np.arange(len(v)) + by, 0, len(v) - 1)]


OF_OTHERS: dict[str, Callable[[Array], Array]] = {
    "that of the first state among those": lambda v: v[:1] + 0 * v,
    "that of the last state among those": lambda v: v[-1:] + 0 * v,
    "that of the state before among those": lambda v: np.roll(v, 1, axis=0),
    "that of the state after among those": lambda v: np.roll(v, -1, axis=0),
    "that of the state before (the first has its own) among those": partial(_beside, -1),
    "that of the state after (the last has its own) among those": partial(_beside, 1),
    "the mean over those": lambda v: np.mean(v, axis=0, keepdims=True) + 0 * v,
    **{
        f"that of the same place in the first {count} among those": partial(_repeated, count)
        for count in BLOCKS
    },
}


def _plain(
    change: Callable[[Array, State], Array],
    text: str,
    turns: bool = False,
    among: bool = False,
    rounds: bool = False,
) -> Operator:
    made = (lambda v, x, p: change(v, x)), (lambda what, unit, p: f"{what} {text}")
    return Operator(*made, None, turns, among, rounds)


def _ordered(order: list[int], signs: Array) -> Operator:
    held = order_text(order, signs)
    return Operator(
        lambda v, x, p: signs * v[:, order],
        lambda what, unit, p: f"the components of {what.rstrip(',')} are others: {held}",
    )


def _decimal(digits: int, how: Callable[[Array], Array], what: str) -> Operator:
    scale = 10.0**digits
    text = f"is {what} to {digits} decimals"
    return _plain(lambda v, x: how(v * scale) / scale, text, rounds=True)


def of_vectors() -> Iterator[Operator]:
    """Those without numbers, of vectors in body axes."""
    yield _plain(lambda v, x: rotate(x.orientation, v), "is turned by R", turns=True)
    yield _plain(lambda v, x: rotate_inverse(x.orientation, v), "is turned by R^T", turns=True)
    yield _plain(
        lambda v, x: np.abs(v), "loses its signs: the absolute value of each component is taken"
    )
    for order, signs in signed_orders():
        if order != [0, 1, 2]:
            yield _ordered(order, signs)
    yield from of_any()


def flips() -> Iterator[Operator]:
    """Signs of single components."""
    for order, signs in signed_orders():
        if order == [0, 1, 2]:
            yield _ordered(order, signs)


def of_quaternions() -> Iterator[Operator]:
    """Those without numbers, of an attitude on its way into a term."""
    identity = np.array([1.0, 0.0, 0.0, 0.0])
    yield _plain(lambda q, x: 0.0 * q + identity, "is left out: it is taken for the identity")
    yield _plain(lambda q, x: conjugate(q), "is transposed")
    yield _plain(_heading, "is its heading alone: roll and pitch are left out")
    yield _plain(
        lambda q, x: quaternion_product(conjugate(_heading(q, x)), q),
        "is without its heading: roll and pitch alone",
    )
    yield from of_any()


def _heading(q: Array, _: State) -> Array:
    """The turn about the world's z of yaw, pitch and roll, ``atan2(R_yx, R_xx)``."""
    w, x, y, z = np.moveaxis(q, -1, 0)
    half = 0.5 * np.arctan2(2.0 * (w * z + x * y), 1.0 - 2.0 * (y * y + z * z))
    return np.stack([np.cos(half), 0.0 * half, 0.0 * half, np.sin(half)], axis=-1)


def _of_states(of: Callable[[Array], Array], values: Array, _: State) -> Array:
    return of(values)


def of_any() -> Iterator[Operator]:
    """Those without numbers, of vectors and quaternions."""
    single = "is rounded to single precision"
    yield _plain(lambda v, x: v.astype(np.float32).astype(float), single, rounds=True)
    together = "that are requested together"
    for which, of in OF_OTHERS.items():
        yield _plain(partial(_of_states, of), f"is {which} {together}", among=True)
    for digits in DECIMALS:
        yield _decimal(digits, np.round, "rounded")
        yield _decimal(digits, np.trunc, "cut")
