"""Other states than the one given that a run may begin at: one quantity of it made another."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from omegadot.diagnosis.models.fitted_misreadings import order_text, signed_orders
from omegadot.diagnosis.models.of_other_point import of_other_point
from omegadot.diagnosis.wording.digits import factor, number, vector
from omegadot.gates.bounds.scales import norm
from omegadot.reference_impl.rotations import (
    conjugate,
    normalize,
    quaternion_product,
    rotate,
    rotate_inverse,
)
from omegadot.reference_impl.system import Array, State, System

VECTORS = {
    "angular_velocity": "omega",
    "linear_velocity": "the linear velocity",
    "position": "the position",
}
PLAIN = 3  # digits of a fitted number that is tried first
CLOSE = 1e-4  # of an angle or of an axis that is a plain one
PLAIN_ANGLES = {np.pi: "half a turn", np.pi / 2: "a quarter of a turn"}
Made = Callable[[System, State], Array]


@dataclass(frozen=True)
class OtherStart:
    """statement: completes ``a run begins ...``.

    made: the quantity, of a system and of the states given.
    """

    statement: str
    made: Made


def other_starts(name: str, given: State, begins: State) -> Iterator[OtherStart]:
    """Ways to make this quantity of the start of runs (n, ...), those without a number first.

    given, begins: states of which the two differ. What is fitted is of these, and is to be tried on
    all others.
    """
    if name == "orientation":
        yield from _attitudes()
        yield from _turned(given.orientation, begins.orientation)
        return
    what = VECTORS[name]
    yield from _vectors(name, what)
    for text, made in of_other_point(name):
        yield OtherStart(text, made)
    came, due = getattr(begins, name), getattr(given, name)
    size = float(np.sum(due * due))
    k = float(np.sum(came * due)) / size if size > 0.0 else 0.0
    for value in dict.fromkeys((float(f"{k:.{PLAIN}g}"), k)):
        if value:
            yield OtherStart(f"with {what} scaled by {factor(value)}", _by(name, value))


def _attitudes() -> Iterator[OtherStart]:
    of = "with the quaternion"
    yield OtherStart(f"{of} conjugated", lambda _, s: conjugate(s.orientation))
    yield OtherStart(f"{of}'s scalar part without its sign", _unsigned)
    yield OtherStart(
        "at the identity, whatever attitude it is given",
        lambda _, s: 0.0 * s.orientation + np.array([1.0, 0.0, 0.0, 0.0]),
    )
    first, last = "(w, x, y, z)", "(x, y, z, w)"
    yield OtherStart(f"{of} {first} taken as {last}", _rolled(1))
    yield OtherStart(f"{of} put in as {last} and taken as {first}", _rolled(-1))
    for axes, world in (("world", True), ("body", False)):
        for k, axis in enumerate("xyz"):
            turn = np.eye(4)[1 + k]
            text = f"turned by half a turn about the {axes}'s {axis} axis"
            yield OtherStart(text, _by_turn(turn, world))
    for order, signs in signed_orders():

        def made(_: System, s: State, order: list[int] = order, signs: Array = signs) -> Array:
            q = s.orientation
            return np.concatenate((q[..., :1], signs * q[..., 1:][..., order]), axis=-1)

        yield OtherStart(_reordered("the quaternion", order, signs), made)


def _unsigned(_: System, state: State) -> Array:
    q = state.orientation
    return np.concatenate((np.abs(q[..., :1]), q[..., 1:]), axis=-1)


def _rolled(shift: int) -> Made:
    return lambda _, s: np.roll(s.orientation, shift, axis=-1)


def _by_turn(turn: Array, world: bool) -> Made:
    def made(_: System, state: State) -> Array:
        whole = np.broadcast_to(turn, state.orientation.shape)
        pair = (whole, state.orientation) if world else (state.orientation, whole)
        return quaternion_product(*pair)

    return made


def _turned(given: Array, begins: Array) -> Iterator[OtherStart]:
    """By the turn between the first two, about an axis of the world or of the body."""
    back = conjugate(normalize(given[0]))
    for axes, world in (("world", True), ("body", False)):
        pair = (begins[0], back) if world else (back, begins[0])
        turn = normalize(quaternion_product(*pair))
        turn = turn * (np.sign(turn[0]) or 1.0)
        angle = 2.0 * float(np.arctan2(norm(turn[1:]), turn[0]))
        axis = turn[1:] / max(float(norm(turn[1:])), np.finfo(float).tiny)
        for plain, shown in PLAIN_ANGLES.items():
            if abs(angle - plain) <= CLOSE:
                angle, size = plain, shown
                break
        else:
            size = f"{number(float(f'{angle:.4g}'))} rad"
        main = int(np.argmax(np.abs(axis)))
        if abs(abs(axis[main]) - 1.0) <= CLOSE:
            axis = np.sign(axis[main]) * np.eye(3)[main]
            sign = "minus " if axis[main] < 0.0 else ""
            about = f"about {sign}the {axes}'s {'xyz'[main]} axis"
        else:
            about = f"about {vector(np.round(axis, 4))} in {axes} axes"
        plain_turn = np.concatenate(([np.cos(angle / 2.0)], np.sin(angle / 2.0) * axis))
        yield OtherStart(f"turned by {size} {about}", _by_turn(plain_turn, world))


def _vectors(name: str, what: str) -> Iterator[OtherStart]:
    yield OtherStart(f"with {what} zero", lambda _, s: 0.0 * getattr(s, name))
    for order, signs in _orders():

        def made(_: System, s: State, order: list[int] = order, signs: Array = signs) -> Array:
            return np.asarray(signs * getattr(s, name)[..., order])

        yield OtherStart(_reordered(what, order, signs), made)
    for turn, text in ((rotate, "R"), (rotate_inverse, "R^T")):

        def turned(_: System, s: State, turn: Callable[[Array, Array], Array] = turn) -> Array:
            return turn(s.orientation, getattr(s, name))

        yield OtherStart(f"with {what} turned by {text}", turned)


def _orders() -> list[tuple[list[int], Array]]:
    """Those that change the fewest axes first."""
    return sorted(signed_orders(), key=lambda one: -_plainness(*one))


def _plainness(order: Sequence[int], signs: Array) -> int:
    """How many axes are as they were."""
    return sum(k == j for k, j in enumerate(order)) + int(np.sum(signs > 0.0))


def _reordered(what: str, order: list[int], signs: Array) -> str:
    moved = [k for k in range(3) if order[k] != k]
    if len(moved) == 2 and np.all(signs > 0.0):
        return f"with {'xyz'[moved[0]]} and {'xyz'[moved[1]]} of {what} swapped"
    if not moved and np.all(signs < 0.0):
        return f"with {what} reversed"
    if not moved and np.count_nonzero(signs < 0.0) == 1:
        return f"with the sign of {what}'s {'xyz'[int(np.argmin(signs))]} changed"
    return f"with {what} in other axes: {order_text(order, signs)}"


def _by(name: str, k: float) -> Made:
    return lambda _, s: k * getattr(s, name)
