"""Ways to misread vectors and attitudes that have numbers in them, found from all samples."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import permutations, product

import numpy as np
from numpy.typing import NDArray

from omegadot.diagnosis.models.misreadings import Change, Misreading, changed
from omegadot.diagnosis.wording.digits import factor, vector
from omegadot.gates.bounds.scales import norm
from omegadot.reference_impl.rotations import conjugate, normalize, quaternion_product
from omegadot.reference_impl.system import Array, State
from omegadot.written import written

FIELDS = {
    "angular_velocity": "omega",
    "position": "the position",
    "linear_velocity": "the linear velocity",
}
ADDED = "the same at every sample"
NOTHING = 1e-12  # relative: an addition that is none
LEAST = 3  # samples that have the same addition
CLOSE = 1e-6  # relative: a factor that is none
LOOSE = 1e-3  # relative: what is fitted is tried, where it is as close as this
PLAIN = 3  # digits of a factor that is tried first: single precision leaves little more
DECIMALS = 6  # of an axis


def fitted_misreadings(
    reported: State, meant: State, together: bool = True
) -> Iterator[Misreading]:
    """What makes the vectors of one trajectory out of another's: a factor, an addition, an order.

    Each is found in one quantity and has to be tried: the others must be right, and all samples.
    together: position and velocity may be misread both, each in its way.
    """
    found = {field: list(_fitted(field, reported, meant)) for field in FIELDS}
    for one in found.values():
        yield from one
    for first in found["position"] if together else ():
        for second in found["linear_velocity"]:
            yield Misreading(f"{first.statement}, and {second.statement}", _both(first, second))
    yield from _other_quaternion(reported.orientation, meant.orientation)
    yield from _turned_attitude(reported.orientation, meant.orientation)


def _both(first: Misreading, second: Misreading) -> Change:
    return lambda state: second.right(first.right(state))


def _fitted(field: str, reported: State, meant: State) -> Iterator[Misreading]:
    what = FIELDS[field]
    came, due = getattr(reported, field), getattr(meant, field)
    size = float(np.max(np.abs(due)))
    if not np.all(np.isfinite(came)):
        return
    k = float(np.sum(came * due) / np.sum(due * due)) if size > 0.0 else 0.0
    near = k != 0.0 and np.max(np.abs(came - k * due)) <= LOOSE * abs(k) * size
    if near and abs(k - 1.0) > NOTHING:
        plain = float(f"{k:.{PLAIN}g}")
        for number in dict.fromkeys((plain, k) if plain != 1.0 else (k,)):
            yield Misreading(f"{what} is scaled by {factor(number)}", _by(field, number))
    more = np.mean(came - due, axis=0)
    several = came.ndim > 1 and len(came) >= LEAST  # any one vector is another and a rest
    added = several and float(norm(more)) > NOTHING * size
    if added and np.max(np.abs(came - due - more)) <= LOOSE * float(norm(more)):
        shown = np.where(np.abs(more) > CLOSE * np.max(np.abs(more)), more, 0.0)
        text = f"{what} is off by {vector(np.round(shown, DECIMALS + 3))}, {ADDED}"
        yield Misreading(text, _less(field, more))
    if size > 0.0:
        others = list(_other_axes(field, what, came, due))
        yield from others or (_turned_axes(field, what, came, due) if several else ())


def _turned_axes(field: str, what: str, came: Array, due: Array) -> Iterator[Misreading]:
    """One rotation that turns all vectors, by Kabsch's method, where they span more than a line."""
    left, sizes, right = np.linalg.svd(due.T @ came)
    if not sizes[1] > CLOSE * sizes[0]:
        return
    turn = right.T @ np.diag([1.0, 1.0, np.linalg.det(right.T @ left.T)]) @ left.T
    if np.max(np.abs(turn - np.eye(3))) <= CLOSE:
        return
    if np.max(np.abs(came - due @ turn.T)) <= LOOSE * float(np.max(np.abs(due))):
        axis = np.array([turn[2, 1] - turn[1, 2], turn[0, 2] - turn[2, 0], turn[1, 0] - turn[0, 1]])
        angle = float(np.arctan2(norm(axis), np.trace(turn) - 1.0))
        text = f"{what} is turned by one rotation at every sample, by {written(angle)} rad"
        yield Misreading(text, changed(field, lambda values: values @ turn))


def _turned_attitude(came: Array, due: Array) -> Iterator[Misreading]:
    """The attitude with one more rotation, the same at every sample, in body or in world axes."""
    if came.ndim < 2 or len(came) < LEAST or not np.all(np.isfinite(came)):
        return
    back = conjugate(normalize(due))
    for axes, more in (
        ("body", quaternion_product(back, came)),
        ("world", quaternion_product(came, back)),
    ):
        same = more * np.sign(np.sum(more * more[:1], axis=-1, keepdims=True))
        turn = normalize(np.mean(same, axis=0))
        angle = 2.0 * float(np.arctan2(norm(turn[1:]), abs(turn[0])))
        if np.max(np.abs(same - turn)) <= LOOSE * angle and angle > CLOSE:
            undo = conjugate(turn)

            def right(q: Array, undo: Array = undo, body: bool = axes == "body") -> Array:
                whole = np.broadcast_to(undo, q.shape)
                return quaternion_product(q, whole) if body else quaternion_product(whole, q)

            text = (
                f"the attitude is turned by one rotation in {axes} axes at every sample, by "
                f"{written(angle)} rad about "
                f"{vector(np.round(turn[1:] / norm(turn[1:]), DECIMALS))}"
            )
            yield Misreading(text, changed("orientation", right))


def _by(field: str, k: float) -> Change:
    return changed(field, lambda values: values / k)


def _less(field: str, more: Array) -> Change:
    return changed(field, lambda values: values - more)


def signed_orders() -> Iterator[tuple[list[int], Array]]:
    """Every order of three axes with every choice of signs, but for the right one."""
    for order in permutations(range(3)):
        for signs in product((1.0, -1.0), repeat=3):
            if order != (0, 1, 2) or min(signs) < 0.0:
                yield list(order), np.array(signs)


def order_text(order: list[int], signs: Array) -> str:
    """What x, y and z hold."""
    shown = (f"{'-' if s < 0 else ''}{'xyz'[k]}" for k, s in zip(order, signs, strict=True))
    return f"x, y, z hold {', '.join(shown)}"


def _other_axes(field: str, what: str, came: Array, due: Array) -> Iterator[Misreading]:
    size = float(np.max(np.abs(due)))
    for order, signs in sorted(signed_orders(), key=lambda one: one[0] != [0, 1, 2]):
        if np.max(np.abs(came - signs * due[..., order])) <= LOOSE * size:
            text = f"the axes of {what.removeprefix('the ')} are others: {order_text(order, signs)}"
            yield Misreading(text, _reordered(field, order, signs))


def _reordered(field: str, order: list[int], signs: Array) -> Change:
    back = np.argsort(order)
    return changed(field, lambda values: (values * signs)[..., back])


def _other_quaternion(came: Array, due: Array) -> Iterator[Misreading]:
    """The vector part in another order or with other signs; q and -q are one attitude."""
    for order, signs in signed_orders():
        made = np.concatenate((due[..., :1], signs * due[..., 1:][..., order]), axis=-1)
        same = np.minimum(np.abs(came - made).max(-1), np.abs(came + made).max(-1))
        if np.max(same) <= LOOSE:
            back = np.argsort(order)

            def right(q: Array, signs: Array = signs, back: NDArray[np.intp] = back) -> Array:
                return np.concatenate((q[..., :1], (q[..., 1:] * signs)[..., back]), axis=-1)

            text = f"the quaternion's vector part is another: {order_text(order, signs)}"
            yield Misreading(text, changed("orientation", right))
