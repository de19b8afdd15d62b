"""One vector of a body's motion, with the attitude in numbers of one kind, and steps of it.

It is ``y = (place, attitude, velocity, spin)``. A motion whose configurations have no quaternion is
stepped as ``y = (q, v)``: a configuration with one has one number more than there are velocities.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache

from omegadot.reference_impl.arithmetic.components import (
    Number,
    Numbers,
    apart,
    cross3,
    formulas_of,
    in_components,
    rotated,
    together,
)
from omegadot.reference_impl.schemes.motion import Motion, Velocity
from omegadot.reference_impl.schemes.runge_kutta import joined
from omegadot.reference_impl.schemes.scheme import Step
from omegadot.reference_impl.schemes.tableaus import Rate, Tableau
from omegadot.reference_impl.system import Array

Vector3 = tuple[Number, Number, Number]


@dataclass(frozen=True)
class Chart:
    """Numbers for an attitude, by formulas in components.

    count: of the numbers, with those that are held through a step.  of_quaternion: they, of a unit
    quaternion.  quaternion: the unit quaternion of them.  rate: theirs, by them and the spin.
    in_world: the spin is ``R ω``, in the world's axes, else ω in the body's.
    from_start: the velocity is that of the body's point at the place where the step starts.
    """

    count: int
    of_quaternion: Callable[[Numbers], Numbers]
    quaternion: Callable[[Numbers], Numbers]
    rate: Callable[[Numbers, Numbers], Numbers]
    in_world: bool = True
    from_start: bool = False

    def entered(self, q: Numbers, v: Numbers) -> Numbers:
        """Y of a configuration and its velocities."""
        spin = rotated(q[-4:], v[-3:]) if self.in_world else v[-3:]
        return [*q[:-4], *self.of_quaternion(q[-4:]), *v[:-3], *spin]

    def motion(self, start: Numbers, y: Numbers) -> Numbers:
        """Q and v in one, of a y. start: q at the step's start."""
        place, attitude, velocity, spin = self.parts(y)
        w, *axis = q = self.quaternion(attitude)
        if self.from_start and place:
            velocity = _added(velocity, cross3(spin, _arm(start, place)))
        turning = rotated((-w, *axis), spin) if self.in_world else spin
        return [*place, *q, *velocity, *turning]

    def slope(self, start: Numbers, y: Numbers, moving: Numbers, a: Numbers) -> Numbers:
        """ẏ. moving: q and v of y.  a: the accelerations v̇ there."""
        place, attitude, _, spin = self.parts(y)
        many = len(place)
        q, linear, pushed = moving[many : many + 4], a[:-3], a[-3:]
        velocity = moving[many + 4 : -3]
        pushed = rotated(q, pushed) if self.in_world else pushed
        if self.from_start and place:  # of u = ṗ - W × (p - p₀)
            carried = cross3(pushed, _arm(start, place)), cross3(spin, velocity)
            linear = [x - b - c for x, b, c in zip(linear, *carried, strict=True)]
        return [*velocity, *self.rate(attitude, spin), *linear, *pushed]

    def parts(self, y: Numbers) -> tuple[Numbers, Numbers, Numbers, Numbers]:
        """Place and velocity, of three numbers or of none, attitude and spin."""
        many = (len(y) - self.count - 3) // 2
        return y[:many], y[many : many + self.count], y[many + self.count : -3], y[-3:]


def _arm(start: Numbers, place: Numbers) -> Numbers:
    return [p - p0 for p, p0 in zip(place, start[: len(place)], strict=True)]


def _added(one: Numbers, other: Numbers) -> Numbers:
    return [a + b for a, b in zip(one, other, strict=True)]


@lru_cache(maxsize=64)
def _moving(chart: Chart, acceleration: Velocity) -> Velocity:
    """ẏ of (q at the step's start, y); where accelerations are in components, one such formula."""
    formulas = formulas_of(acceleration)
    if formulas is not None:
        (own,) = formulas

        def of_components(start: Numbers, y: Numbers) -> Numbers:
            moving = chart.motion(start, y)
            count = (len(moving) + 1) // 2
            return chart.slope(start, y, moving, own(moving[:count], moving[count:]))

        return in_components(of_components)
    both = in_components(chart.motion)

    def of_vectors(start: Array, y: Array) -> Array:
        moving = both(start, y)
        a = acceleration(*_split(moving))
        numbers = apart(start), apart(y), apart(moving), apart(a)
        return together(chart.slope(*numbers), y)

    return of_vectors


def _split(moving: Array) -> tuple[Array, Array]:
    count = (moving.shape[-1] + 1) // 2
    return moving[..., :count], moving[..., count:]


def _on(chart: Chart, method: Callable[[Rate, Array, float | Array, int], Array]) -> Step:
    """A step by a method of (rate, y, h, n), the last n of y the velocities."""
    entered, both = in_components(chart.entered), in_components(chart.motion)

    def step(motion: Motion, q: Array, v: Array, h: float | Array) -> tuple[Array, Array]:
        n, acceleration = v.shape[-1], motion.acceleration
        if q.shape[-1] != n + 1:

            def straight(y: Array) -> Array:
                return joined(y[..., -n:], acceleration(y[..., :-n], y[..., -n:]))

            y = method(straight, joined(q, v), h, n)
            return y[..., :-n], y[..., -n:]
        moving = _moving(chart, acceleration)
        return _split(both(q, method(lambda y: moving(q, y), entered(q, v), h, n)))

    return step


def by_tableau(chart: Chart, tableau: Tableau) -> Step:
    """An explicit Runge-Kutta method on y."""
    return _on(chart, lambda rate, y, h, _: tableau.step(rate, y, rate(y), h))


def semi_implicit(chart: Chart, parts: int = 1) -> Step:
    """``v₁ = v₀ + h v̇``, then the rest of y by v₁ and its own start; in so many equal parts."""

    def method(rate: Rate, y: Array, h: float | Array, n: int) -> Array:
        y = y.copy("K")
        for _ in range(parts):
            y[..., -n:] += h / parts * rate(y)[..., -n:]
            y[..., :-n] += h / parts * rate(y)[..., :-n]
        return y

    return _on(chart, method)


def drifted(chart: Chart) -> Step:
    """The places alone, by velocities that stay in the axes in which they are stepped."""

    def method(rate: Rate, y: Array, h: float | Array, n: int) -> Array:
        y = y.copy("K")
        y[..., :-n] += h * rate(y)[..., :-n]
        return y

    return _on(chart, method)
