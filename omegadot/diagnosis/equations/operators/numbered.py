"""Operators with a number or two: limits, thresholds and powers, and a first guess of each."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import NDArray

from omegadot.diagnosis.equations.operators.operator import Operator, Seen
from omegadot.diagnosis.wording.digits import number
from omegadot.gates.bounds.scales import norm
from omegadot.reference_impl.system import Array, State
from omegadot.written import written

NOT_ZERO = 1e-3  # an exponent that is one
NOTHING = 1e-9  # of a vector, that rounding leaves of it
NEAR = 1e-5  # a fitted exponent or factor is the plain number that is meant


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
            lambda seen: None if seen.came is None else _largest(np.abs(seen.came), seen.due),
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


def _largest(sizes: Array, due: Array) -> Array | None:
    most = float(np.max(sizes))
    return np.array([most]) if most > NOTHING * float(np.max(norm(due))) else None


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
    best = used[np.argmin(seen.bound[used])]
    return _unless_nothing(float(norm(seen.came)[best]), seen.due[best])


def _unless_nothing(limit: float, due: Array) -> Array | None:
    """None of a limit that is nothing beside what it holds: that is missing."""
    return np.array([limit]) if limit > NOTHING * float(norm(due)) else None


def _component_limit(seen: Seen) -> Array | None:
    if seen.came is None:
        return _between(seen, np.max(np.abs(seen.due), axis=-1))
    used = np.flatnonzero(_changed(seen, seen.came))
    if not len(used):
        return None
    best = used[np.argmin(seen.bound[used])]
    off = np.abs(seen.came[best] - seen.due[best])
    return _unless_nothing(float(np.abs(seen.came[best, np.argmax(off)])), seen.due[best])


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
    best = used[np.argmin(seen.bound[used])]
    if _unless_nothing(float(norm(seen.came)[best]), seen.due[best]) is None:
        return None
    return np.array([float(np.max(size(seen.came - seen.due)[best]))])


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
