"""What is made of a vector by mistake: other axes, limits, thresholds, powers, rounding, places."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from omegadot.diagnosis.models.fitted_misreadings import order_text, signed_orders
from omegadot.diagnosis.wording.digits import number
from omegadot.gates.bounds.scales import norm
from omegadot.reference_impl.rotations import conjugate, rotate, rotate_inverse
from omegadot.reference_impl.system import Array, State
from omegadot.scenarios.written import written

DECIMALS = range(9)
NOT_ZERO = 1e-3  # an exponent that is one
NEAR = 1e-5  # a fitted exponent or factor is the plain number that is meant


@dataclass(frozen=True)
class Seen:
    """What is known when a number is looked for, at states (n,).

    due: the right vectors.  came: the engine's, None where they are hidden.  sound: whether the
    engine is right.  bound: what rounding makes of its answer.
    """

    due: Array
    came: Array | None
    states: State
    sound: NDArray[np.bool_]
    bound: Array


@dataclass(frozen=True)
class Operator:
    """One change of a vector.

    change: of vectors (n, k) at states with numbers (p,).  text: with what it changes, its unit and
    the numbers.  guess: the numbers, nearly; None of an operator without any.  turns: it makes
    another vector of a constant one, too.  among: it depends on the other states of the request.
    """

    change: Callable[[Array, State, Array], Array]
    text: Callable[[str, str, Array], str]
    guess: Callable[[Seen], Array | None] | None = None
    turns: bool = False
    among: bool = False


def _plain(
    change: Callable[[Array, State], Array], text: str, turns: bool = False, among: bool = False
) -> Operator:
    return Operator(
        lambda v, x, p: change(v, x), lambda what, unit, p: f"{what} {text}", None, turns, among
    )


def _ordered(order: list[int], signs: Array) -> Operator:
    held = order_text(order, signs)
    return Operator(
        lambda v, x, p: signs * v[:, order],
        lambda what, unit, p: f"the components of {what.rstrip(',')} are others: {held}",
    )


def _decimal(digits: int, how: Callable[[Array], Array], what: str) -> Operator:
    scale = 10.0**digits
    return _plain(lambda v, x: how(v * scale) / scale, f"is {what} to {digits} decimals")


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
    yield from of_any()


def of_any() -> Iterator[Operator]:
    """Those without numbers, of vectors and quaternions."""
    yield _plain(lambda v, x: v.astype(np.float32).astype(float), "is rounded to single precision")
    together = "among those that are requested together"
    yield _plain(lambda v, x: v[:1] + 0 * v, f"is that of the first state {together}", among=True)
    yield _plain(
        lambda v, x: np.roll(v, 1, axis=0), f"is that of the state before {together}", among=True
    )
    for digits in DECIMALS:
        yield _decimal(digits, np.round, "rounded")
        yield _decimal(digits, np.trunc, "cut")


def with_numbers() -> Sequence[Operator]:
    """Those with a number or two."""
    return (
        Operator(_held, lambda w, u, p: f"{w} is held below {_n(p)} {u}", _size_limit),
        Operator(
            lambda v, x, p: np.clip(v, -p[0], p[0]),
            lambda w, u, p: f"each component of {w} is held within {_n(p)} {u}",
            _component_limit,
        ),
        Operator(
            lambda v, x, p: np.where(norm(v)[:, None] <= p[0], 0.0, v),
            lambda w, u, p: f"{w} is zero below a limit near {_n(p)} {u}",
            _size_threshold,
        ),
        Operator(
            lambda v, x, p: np.where(np.abs(v) <= p[0], 0.0, v),
            lambda w, u, p: f"each component of {w} is zero below a limit near {_n(p)} {u}",
            _component_threshold,
        ),
        Operator(
            lambda v, x, p: v - np.clip(v, -p[0], p[0]),
            lambda w, u, p: f"each component of {w} has a dead zone of {_n(p)} {u}, taken off it",
            lambda seen: _most(seen, np.abs),
        ),
        Operator(
            lambda v, x, p: p[0] * np.tanh(v / p[0]),
            lambda w, u, p: f"each component of {w} saturates as {_n(p)} {u} times a tanh",
            lambda seen: None if seen.came is None else _largest(np.abs(seen.came)),
        ),
        Operator(
            lambda v, x, p: v * (p[1] * norm(x.angular_velocity) ** p[0])[:, None],
            _power_text("|omega|"),
            lambda seen: _power(seen, norm(seen.states.angular_velocity)),
        ),
        Operator(
            lambda v, x, p: v * (p[1] * np.where(norm(v) > 0, norm(v), 1.0) ** p[0])[:, None],
            _power_text("its size"),
            lambda seen: _power(seen, norm(seen.due)),
        ),
    )


def _n(p: Array) -> str:
    return number(float(f"{p[0]:.10g}"))


def _held(v: Array, _: State, p: Array) -> Array:
    size = norm(v)[:, None]
    return np.asarray(v * np.minimum(1.0, p[0] / np.where(size > 0.0, size, 1.0)))


def _largest(sizes: Array) -> Array | None:
    return np.array([float(np.max(sizes))]) if np.max(sizes) > 0.0 else None


def _between(seen: Seen, sizes: Array) -> Array | None:
    """Where sound states end and wrong ones begin, by the size of the vector."""
    if seen.sound.all() or not seen.sound.any():
        return None
    low, high = float(np.max(sizes[seen.sound])), float(np.min(sizes[~seen.sound]))
    return np.array([0.5 * (low + high)]) if 0.0 < low < high else None


def _changed(seen: Seen, came: Array) -> NDArray[np.bool_]:
    return np.asarray(norm(came - seen.due) > 0.0) & ~seen.sound


def _size_limit(seen: Seen) -> Array | None:
    """Of the state at which the engine's vector is known best."""
    if seen.came is None:
        return _between(seen, norm(seen.due))
    used = np.flatnonzero(_changed(seen, seen.came))
    if not len(used):
        return None
    return np.array([float(norm(seen.came)[used[np.argmin(seen.bound[used])]])])


def _component_limit(seen: Seen) -> Array | None:
    if seen.came is None:
        return _between(seen, np.max(np.abs(seen.due), axis=-1))
    used = np.flatnonzero(_changed(seen, seen.came))
    if not len(used):
        return None
    best = used[np.argmin(seen.bound[used])]
    off = np.abs(seen.came[best] - seen.due[best])
    return np.array([float(np.abs(seen.came[best, np.argmax(off)]))])


def _size_threshold(seen: Seen) -> Array | None:
    size = norm(seen.due)
    if seen.sound.all() or not seen.sound.any():
        return None
    low, high = float(np.max(size[~seen.sound])), size[size > np.max(size[~seen.sound])]
    return np.array([0.5 * (low + float(np.min(high)))]) if len(high) else None


def _component_threshold(seen: Seen) -> Array | None:
    if seen.came is None:
        return None
    allowed = 1e-6 * np.max(np.abs(seen.due), axis=-1, keepdims=True)
    kept = np.abs(seen.came) > allowed
    sizes = np.abs(seen.due)
    if kept.all() or not kept.any():
        return None
    gone = sizes[~kept & (sizes > allowed)]
    if not len(gone):
        return None
    more = sizes[sizes > np.max(gone)]
    return np.array([0.5 * float(np.max(gone) + np.min(more))]) if len(more) else None


def _most(seen: Seen, size: Callable[[Array], Array]) -> Array | None:
    if seen.came is None:
        return None
    used = np.flatnonzero(_changed(seen, seen.came))
    if not len(used):
        return None
    return np.array([float(np.max(size(seen.came - seen.due)[used[np.argmin(seen.bound[used])]]))])


def _power(seen: Seen, of: Array) -> Array | None:
    """Exponent and factor of what the size is multiplied by."""
    if seen.came is None:
        return None
    size, due = norm(seen.came), norm(seen.due)
    used = (of > 0.0) & (size * NOT_ZERO > seen.bound) & (due > 0.0)
    if np.count_nonzero(used) < 4 or np.ptp(np.log(of[used])) < 0.5:
        return None
    slope, start = np.polyfit(np.log(of[used]), np.log(size[used] / due[used]), 1)
    if abs(slope) < NOT_ZERO:
        return None
    near = round(2.0 * slope) / 2.0
    if abs(slope - near) < 1e-3:
        slope = near
        start = float(np.median(np.log(size[used] / due[used]) - slope * np.log(of[used])))
    return np.array([float(slope), float(np.exp(start))])


def _power_text(of: str) -> Callable[[str, str, Array], str]:
    def text(what: str, unit: str, p: Array) -> str:
        shown = "" if abs(p[1] - 1.0) < NEAR else f"{written(p[1])} times "
        return f"{what} is multiplied by {shown}{of}^{written(p[0])}"

    return text
