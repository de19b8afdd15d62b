"""Runge-Kutta methods: the classical one, and any on q and v or in exponential coordinates."""

from __future__ import annotations

from collections.abc import Callable
from functools import lru_cache

import numpy as np

from omegadot.reference_impl.arithmetic.components import Numbers, formulas_of, in_components
from omegadot.reference_impl.schemes.motion import Motion, Velocity
from omegadot.reference_impl.schemes.tableaus import Method
from omegadot.reference_impl.system import Array


def kutta(rate: Callable[[Array], Array], y: Array, first: Array, h: float | Array) -> Array:
    """The y after one step of Kutta's method of 1901 on ``ẏ = rate(y)``. first: the rate at y."""
    h, half, sixth = _fractions(h) if isinstance(h, float) else (h, 0.5 * h, h / 6)
    second = rate(y + half * first)
    third = rate(y + half * second)
    fourth = rate(y + h * third)
    middle = second + third
    return y + sixth * (first + middle + middle + fourth)


@lru_cache
def _fractions(h: float) -> tuple[Array, Array, Array]:
    """H, h/2 and h/6 as arrays: a number of Python's is converted by NumPy at each product."""
    return np.array(h), np.array(0.5 * h), np.array(h / 6)


def step_in_exponential(
    motion: Motion,
    rate: Velocity,
    q: Array,
    v: Array,
    h: float | Array,
    method: Method = kutta,
) -> tuple[Array, Array]:
    """`step_coupled` on (u, v) with ``q = q₀ exp(u)``, u zero at the step's start.

    rate: u̇ as a function of u and v, which at u = 0 is v.
    """
    n, acceleration, retract = v.shape[-1], motion.acceleration, motion.retract
    start = np.zeros((*v.shape[:-1], 2 * n), v.dtype, "F")
    start[..., n:] = v
    u, v = step_coupled(rate, acceleration, retract, q, start, v, h, method)
    return retract(q, u), v


def step_coupled(
    rate: Velocity,
    acceleration: Velocity,
    place: Velocity,
    q: Array,
    y: Array,
    x_dot: Array,
    h: float | Array,
    method: Method = kutta,
) -> tuple[Array, Array]:
    """A method on y = (x, v), ``ẋ = rate(x, v)`` and ``v̇ = acceleration(place(q, x), v)``.

    q: the configuration at the step's start, `place` of this x.  x_dot: the rate there.
    """
    count = x_dot.shape[-1]
    moving = _moving(rate, acceleration, place, count)
    first = joined(x_dot, acceleration(q, y[..., count:]))
    y = method(lambda y: moving(q, y), y, first, h)
    return y[..., :count], y[..., count:]


def joined(first: Array, second: Array) -> Array:
    """Two vectors as one, (..., m + n)."""
    return np.concatenate((first, second), -1)


@lru_cache(maxsize=8)
def _moving(rate: Velocity, acceleration: Velocity, place: Velocity, count: int) -> Velocity:
    """``(ẋ, v̇)`` as a function of q and (x, v); of formulas in components, one such formula."""
    formulas = formulas_of(rate, acceleration, place)
    head, tail = np.s_[..., :count], np.s_[..., count:]

    def of_vectors(q: Array, y: Array) -> Array:
        x, v, found = y[head], y[tail], y.copy("K")
        found[head] = rate(x, v)
        found[tail] = acceleration(place(q, x), v)
        return found

    if formulas is None:
        return of_vectors
    rate_of, acceleration_of, place_of = formulas

    def of_components(q: Numbers, y: Numbers) -> Numbers:
        x, v = y[:count], y[count:]
        return [*rate_of(x, v), *acceleration_of(place_of(q, x), v)]

    return in_components(of_components)
