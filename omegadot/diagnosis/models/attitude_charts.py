"""An attitude that comes back about the axis that was set, turned by another angle.

Three numbers along the axis stand for an attitude in many charts; with half the angle
``phi = atan2(|v|, w)`` of a quaternion ``(w, v)`` they are ``2 phi`` (the rotation vector),
``tan phi`` (Rodrigues parameters), ``tan(phi / 2)`` (modified ones) or ``sin phi`` (the
quaternion's vector part). Taken in one chart and put together in another the angle is another.
Of q and -q, which are one attitude, phi and pi - phi are the halves.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from itertools import permutations, product

import numpy as np

from omegadot.gates.bounds.scales import ROUNDINGS_PER_EVALUATION, norm
from omegadot.reference_impl.rotations import attitude_angle
from omegadot.reference_impl.system import Array

Function = Callable[[Array], Array]
STEEPEST = 1e6  # of a chart, where it hardly tells an attitude
SIDE = 1e-7  # of half the angle: a derivative
# From half the angle to the size of the three numbers, and back.
CHARTS: dict[str, tuple[Function, Function]] = {
    "the rotation vector": (lambda phi: 2.0 * phi, lambda size: size / 2.0),
    "Rodrigues parameters": (np.tan, np.arctan),
    "twice Rodrigues parameters": (
        lambda phi: 2.0 * np.tan(phi),
        lambda size: np.arctan(size / 2.0),
    ),
    "modified Rodrigues parameters": (
        lambda phi: np.tan(phi / 2.0),
        lambda size: 2.0 * np.arctan(size),
    ),
    "four times modified Rodrigues parameters": (
        lambda phi: 4.0 * np.tan(phi / 2.0),
        lambda size: 2.0 * np.arctan(size / 4.0),
    ),
    "the quaternion's vector part": (np.sin, np.arcsin),
    "twice the quaternion's vector part": (
        lambda phi: 2.0 * np.sin(phi),
        lambda size: np.arcsin(size / 2.0),
    ),
}


@dataclass(frozen=True)
class _Rule:
    """half: of half the angle, what comes of it.  shortest: it is first made a quarter turn at most

    (of q and -q, that with a scalar part that is not negative).
    """

    text: str
    half: Function
    shortest: bool

    def attitudes(self, q: Array, more: float = 0.0) -> Array:
        """What comes of attitudes (n, 4), with this much more of half the angle."""
        one = np.where(q[..., :1] < 0.0, -q, q) if self.shortest else q
        return _about(one, self.half(_half(one) + more))

    def rounding(self, q: Array, eps: float) -> Array:
        """(n,) rad: a chart is steep near half a turn."""
        change = attitude_angle(self.attitudes(q, SIDE), self.attitudes(q)) / SIDE
        slope = np.minimum(np.nan_to_num(change, nan=STEEPEST), STEEPEST)
        return np.asarray(ROUNDINGS_PER_EVALUATION * eps * (1.0 + slope))


def chart_misread(requested: Array, back: Array, eps: float) -> str:
    """The first rule by which all attitudes (n, 4) come back about their axes; "" without one."""
    with np.errstate(all="ignore"):
        for rule in _RULES:
            apart = attitude_angle(rule.attitudes(requested), back)
            if np.all(apart <= rule.rounding(requested, eps)):
                return rule.text
    return ""


def _rules() -> Iterator[_Rule]:
    """Those with a plain name first."""
    about = "about their own axes"
    yield _Rule(f"come back as half turns {about}", lambda phi: 0.0 * phi + np.pi / 2.0, True)
    yield _Rule(f"come back as twice the turn {about}", lambda phi: 2.0 * phi, True)
    for shortest in (True, False):
        yield _Rule(f"come back as half the turn {about}", lambda phi: phi / 2.0, shortest)
    for shortest, (one, other) in product((True, False), permutations(CHARTS, 2)):
        size, half = CHARTS[one][0], CHARTS[other][1]
        text = f"are taken as {one} and put together as {other}"
        yield _Rule(text, _composed(half, size), shortest)


def _composed(outer: Function, inner: Function) -> Function:
    return lambda phi: outer(inner(phi))


_RULES = tuple(_rules())


def _half(q: Array) -> Array:
    return np.asarray(np.arctan2(norm(q[..., 1:]), q[..., 0]))


def _about(q: Array, half: Array) -> Array:
    """The attitudes about the axes of q, by these halves of angles."""
    axis = q[..., 1:] / np.maximum(norm(q[..., 1:]), np.finfo(float).tiny)[..., None]
    return np.concatenate((np.cos(half)[..., None], np.sin(half)[..., None] * axis), axis=-1)
