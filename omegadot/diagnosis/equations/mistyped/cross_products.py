"""A cross product of the equation with one of its components mistyped."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np

from omegadot.diagnosis.equations.evidence import Evidence
from omegadot.diagnosis.equations.mistyped.few import Few
from omegadot.diagnosis.equations.mistyped.kinds import ANGULAR, LINEAR, Kind
from omegadot.diagnosis.equations.mistyped.products import sum_text
from omegadot.diagnosis.equations.operators.operands import pushed
from omegadot.diagnosis.equations.readings import Reading
from omegadot.diagnosis.wording.digits import listed
from omegadot.reference_impl.cross_product import cross
from omegadot.reference_impl.inertia import lever, moving_inertia
from omegadot.reference_impl.loads import weight
from omegadot.reference_impl.rotations import rotate, rotate_inverse
from omegadot.reference_impl.symmetric import apply
from omegadot.reference_impl.system import Acceleration, Array

AXES = "xyz"
WEIGHT, SPIN, DOT, OUTER, INNER = "weight", "spin", "dot", "outer", "inner"
EVERY = (SPIN, WEIGHT, DOT, OUTER, INNER)
# What each is, and the names of its two vectors.
USES = {
    WEIGHT: ("the weight's torque r x f", "r", "f"),
    SPIN: ("the gyroscopic term omega x L, L = I omega,", "omega", "L"),
    DOT: ("omega-dot x r in the linear acceleration", "omega-dot", "r"),
    OUTER: ("omega x c, c = omega x r, in the linear acceleration", "omega", "c"),
    INNER: ("omega x r, the inner product of the linear acceleration,", "omega", "r"),
}
# Of which the numbers are found, then what else may have the same function for its product.
TORQUES: dict[tuple[str, ...], tuple[tuple[str, ...], ...]] = {
    (WEIGHT,): ((),),
    (SPIN,): ((),),
    (SPIN, WEIGHT): ((), (DOT, OUTER, INNER)),
}
LEVERS: dict[tuple[str, ...], tuple[tuple[str, ...], ...]] = {
    (DOT,): ((),),
    (OUTER,): ((),),
    (DOT, OUTER): ((),),
    (INNER,): ((), (OUTER,), (OUTER, DOT)),
}


@dataclass(frozen=True)
class _Typed:
    """``(a x b)_k + sum of c a_i b_j``. more: i and j as 3 i + j, and c."""

    k: int
    more: Few

    def off(self, a: Array, b: Array) -> Array:
        """What it adds to the right product, (n, 3)."""
        a, b = np.broadcast_arrays(a, b)
        added = np.zeros_like(a)
        for place, c in self.more:
            added[:, self.k] += c * a[:, place // 3] * b[:, place % 3]
        return added

    def made(self, e: Evidence, uses: tuple[str, ...]) -> Acceleration:
        """The accelerations by an equation that has it in these places."""
        w = e.states.angular_velocity
        torque = 0.0 * w
        for use, sign in ((WEIGHT, 1.0), (SPIN, -1.0)):
            if use in uses:
                torque = torque + sign * self.off(*_vectors(e, use))
        found = pushed(e, torque)
        if e.system.load.pivot is None or not {DOT, OUTER, INNER} & set(uses):
            return found
        r, angular = np.asarray(lever(e.system)), found.angular
        inner = cross(w, r) + (self.off(w, r) if INNER in uses else 0.0)
        moved = cross(angular, r) + cross(w, inner)
        moved = moved + (self.off(angular, r) if DOT in uses else 0.0)
        moved = moved + (self.off(w, inner) if OUTER in uses else 0.0)
        return Acceleration(angular, rotate(e.states.orientation, moved))

    def text(self, uses: tuple[str, ...]) -> str:
        """As it is typed in each place, and as it is right."""
        if set(uses) == set(EVERY):
            return self._typed("every cross product a x b", "a", "b")
        parts = [self._typed(*USES[use]) for use in uses]
        return listed(parts)

    def _typed(self, what: str, a: str, b: str) -> str:
        i, j = (self.k + 1) % 3, (self.k + 2) % 3
        factors = {3 * i + j: 1.0, 3 * j + i: -1.0}
        right = dict(factors)
        for place, c in self.more:
            factors[place] = factors.get(place, 0.0) + c
        typed, due = (
            sum_text({f"{a}_{AXES[p // 3]} {b}_{AXES[p % 3]}": c for p, c in of.items()})
            for of in (factors, right)
        )
        return f"the {AXES[self.k]} component of {what} is {typed}, where {due} is right"


def _vectors(e: Evidence, use: str) -> tuple[Array, Array]:
    """The two vectors of a product, in body axes."""
    w, r = e.states.angular_velocity, np.asarray(lever(e.system)) + 0.0 * e.states.angular_velocity
    if use == WEIGHT:
        return r, rotate_inverse(e.states.orientation, weight(e.system))
    if use == SPIN:
        return w, apply(moving_inertia(e.system), w)
    if use == DOT:
        return e.true.angular, r
    return (w, cross(w, r)) if use == OUTER else (w, r)


def kinds() -> Iterator[Kind]:
    """Every component of every product, or of several that one function makes."""
    for k in range(3):
        for what, places in ((ANGULAR, TORQUES), (LINEAR, LEVERS)):
            for uses, others in places.items():
                without = k if uses == (INNER,) else None
                yield Kind(what, _lines(k, uses), _readings(k, uses, others), without)


def _lines(k: int, uses: tuple[str, ...]) -> Callable[[Evidence], Array]:
    """What each of the nine products adds, (9, n, 3): to omega-dot, or to the linear acceleration.

    The inner product adds to the two components that the outer one does not change.
    """
    axis = np.eye(3)[k]

    def torques(e: Evidence) -> Array:
        made = _summed_products(e, uses)
        return np.asarray(made * apply(e.solve, axis))

    def levers(e: Evidence) -> Array:
        w = e.states.angular_velocity
        return _summed_products(e, uses) * (cross(w, axis) if uses == (INNER,) else axis)

    return torques if uses in TORQUES else levers


def _summed_products(e: Evidence, uses: tuple[str, ...]) -> Array:
    held = e.system.load.pivot is not None
    made = np.zeros((9, len(e.sound), 1))
    for use in uses:
        if held or use == SPIN:
            a, b = _vectors(e, use)
            sign = -1.0 if use == SPIN else 1.0
            made = made + sign * (a[:, :, None] * b[:, None, :]).reshape(-1, 9).T[..., None]
    return made


def _readings(
    k: int, uses: tuple[str, ...], others: tuple[tuple[str, ...], ...]
) -> Callable[[Few], Iterator[Reading]]:
    def readings(more: Few) -> Iterator[Reading]:
        typed = _Typed(k, more)
        for other in others:
            places = (*uses, *other)
            yield Reading(typed.text(places), lambda e, p=places: typed.made(e, p))  # type: ignore[misc]

    return readings
