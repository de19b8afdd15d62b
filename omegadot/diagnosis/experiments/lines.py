"""From a system in a state that shows a fault to one that does not, by small changes of all."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from omegadot.reference_impl.kinematics import place_on_pivot
from omegadot.reference_impl.rotations import normalize
from omegadot.reference_impl.system import Array, Body, Load, State, System


def between(one: Array, other: Array, t: Array | float) -> Array:
    """(..., k) at the parts t of the way: sizes by factors, directions by their difference.

    Where one of two is zero, or they are opposite, in a straight line.
    """
    a, b = (np.asarray(x, dtype=float) for x in (one, other))
    if np.array_equal(a, b):
        return np.broadcast_to(a, (*np.shape(t), *a.shape)).copy()
    t = np.asarray(t, dtype=float)[..., None]
    with np.errstate(all="ignore"):
        sizes = [np.sqrt(np.sum(x * x, axis=-1, keepdims=True)) for x in (a, b)]
        direction = (1.0 - t) * a / sizes[0] + t * b / sizes[1]
        length = np.sqrt(np.sum(direction * direction, axis=-1, keepdims=True))
        bent = direction / length * np.exp((1.0 - t) * np.log(sizes[0]) + t * np.log(sizes[1]))
    straight = (1.0 - t) * a + t * b
    return np.asarray(np.where(np.isfinite(bent).all(-1, keepdims=True), bent, straight))


def states_between(system: System, one: State, other: State, t: Array) -> State:
    """(n,) states at the parts t (n,) of the way from one to the other, of one system."""
    q = normalize((1.0 - t)[:, None] * one.orientation + t[:, None] * other.orientation)
    fields = ("angular_velocity", "position", "linear_velocity")
    rest = {name: between(getattr(one, name), getattr(other, name), t) for name in fields}
    return place_on_pivot(system, State(q, **rest))


def system_between(one: System, other: System, t: float) -> System:
    """The system at the part t of the way; both are free, or both pivoted."""

    def scalar(a: Array, b: Array) -> Array:
        return np.asarray(between(np.reshape(a, 1), np.reshape(b, 1), t)[0])

    def tensor(a: Array, b: Array) -> Array:
        return np.reshape(between(np.ravel(a), np.ravel(b), t), (3, 3))

    a, b, x, y = one.body, other.body, one.load, other.load
    body = Body(
        scalar(a.mass, b.mass),
        between(a.center_of_mass, b.center_of_mass, t),
        tensor(a.inertia, b.inertia),
    )
    pivot = None if x.pivot is None or y.pivot is None else between(x.pivot, y.pivot, t)
    vectors = ("gravity", "torque_body", "torque_world")
    load = Load(
        pivot=pivot,
        damping=scalar(x.damping, y.damping),
        **{name: between(getattr(x, name), getattr(y, name), t) for name in vectors},
    )
    return replace(one, bodies=(body,), load=load)
