"""Ways to misread a state, and what undoes each."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from itertools import permutations, product

import numpy as np
from numpy.typing import NDArray

from omegadot.diagnosis.wording.digits import factor, vector
from omegadot.gates.bounds.scales import norm
from omegadot.reference_impl.inertia import moving_inertia
from omegadot.reference_impl.kinematics import at_point
from omegadot.reference_impl.rotations import conjugate, normalize, rotate, rotate_inverse
from omegadot.reference_impl.symmetric import apply, inverse
from omegadot.reference_impl.system import Array, State, System

FIELDS = {
    "angular_velocity": "omega",
    "position": "the position",
    "linear_velocity": "the linear velocity",
}
ADDED = "the same at every sample"
LEAST = 3  # samples that have the same addition
CLOSE = 1e-6  # relative: a factor that is none
LOOSE = 1e-3  # relative: what is fitted is tried, where it is as close as this

Change = Callable[[State], State]


@dataclass(frozen=True)
class Misreading:
    """A state reported in another convention.

    statement: the cause as text.  right: from the state as reported to the one that is meant.
    """

    statement: str
    right: Change


def _turned(field: str, turn: Callable[[Array, Array], Array]) -> Change:
    """A vector of the state, turned by its orientation."""
    return lambda state: replace(state, **{field: turn(state.orientation, getattr(state, field))})


def _changed(field: str, change: Callable[[Array], Array]) -> Change:
    return lambda state: replace(state, **{field: change(getattr(state, field))})


OF_ANY_STATE = (
    Misreading(
        "omega looks like world axes: it matches after R^T",
        _turned("angular_velocity", rotate_inverse),
    ),
    Misreading("omega looks turned twice: it matches after R", _turned("angular_velocity", rotate)),
    Misreading(
        "omega looks like degrees per second: it matches after pi/180",
        _changed("angular_velocity", lambda w: w * (np.pi / 180)),
    ),
    Misreading("omega has the wrong sign", _changed("angular_velocity", lambda w: -w)),
    Misreading(
        "the rotation looks transposed: it matches after the quaternion is conjugated",
        _changed("orientation", conjugate),
    ),
    Misreading(
        "the quaternion looks like (x, y, z, w): it matches with the scalar first",
        _changed("orientation", lambda q: np.roll(q, 1, axis=-1)),
    ),
    Misreading(
        "the linear velocity looks like body axes: it matches after R",
        _turned("linear_velocity", rotate),
    ),
)
NOT_UNIT = Misreading(
    "the quaternion is not of unit length: it matches once normalised",
    _changed("orientation", normalize),
)


def misreadings(system: System) -> tuple[Misreading, ...]:
    """All of them, for what comes out of an engine.

    Position or velocity may be reported at the body's origin instead of the centre of mass.
    """

    def meant(state: State) -> State:
        return at_point(state, system.body.center_of_mass)

    def position(state: State) -> State:
        return replace(state, position=meant(state).position)

    def velocity(state: State) -> State:
        return replace(state, linear_velocity=meant(state).linear_velocity)

    at = "looks like that of the body's origin, not of the centre of mass"
    both = f"position and linear velocity {at}".replace("looks", "look").replace("that", "those")
    of_origin = (
        Misreading(f"the position {at}", position),
        Misreading(f"the linear velocity {at}", velocity),
        Misreading(both, meant),
    )
    by_inertia = (
        Misreading(
            "omega is the angular momentum I omega: it matches after the inverse of the inertia",
            _changed("angular_velocity", lambda w: apply(inverse(moving_inertia(system)), w)),
        ),
        Misreading(
            "omega is the angular momentum in world axes",
            lambda state: replace(
                state,
                angular_velocity=apply(
                    inverse(moving_inertia(system)),
                    rotate_inverse(state.orientation, state.angular_velocity),
                ),
            ),
        ),
    )
    return (*OF_ANY_STATE, *of_origin, NOT_UNIT, *by_inertia)


def fitted_misreadings(reported: State, meant: State) -> Iterator[Misreading]:
    """What makes the vectors of one trajectory out of another's: a factor, an addition, an order.

    Each is found in one quantity and has to be tried: the others must be right, and all samples.
    """
    for field, what in FIELDS.items():
        came, due = getattr(reported, field), getattr(meant, field)
        size = float(np.max(np.abs(due)))
        if not np.all(np.isfinite(came)):
            continue
        k = float(np.sum(came * due) / np.sum(due * due)) if size > 0.0 else 0.0
        if k and np.max(np.abs(came - k * due)) <= LOOSE * abs(k) * size and abs(k - 1.0) > CLOSE:
            yield Misreading(f"{what} is scaled by {factor(k)}", _by(field, k))
        more = np.mean(came - due, axis=0)
        several = came.ndim > 1 and len(came) >= LEAST  # any one vector is another and a rest
        if several and np.max(np.abs(came - due - more)) <= LOOSE * float(norm(more)):
            text = f"{what} is off by {vector(more)}, {ADDED}"
            yield Misreading(text, _less(field, more))
        if size > 0.0:
            yield from _other_axes(field, what, came, due)
    yield from _other_quaternion(reported.orientation, meant.orientation)


def _by(field: str, k: float) -> Change:
    return _changed(field, lambda values: values / k)


def _less(field: str, more: Array) -> Change:
    return _changed(field, lambda values: values - more)


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
    return _changed(field, lambda values: (values * signs)[..., back])


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
            yield Misreading(text, _changed("orientation", right))
