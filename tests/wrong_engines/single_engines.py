"""Engines in single precision, written apart from the reference: sound ones, and ones with a fault.

Everything that is kept is a number of 32 bits; what is computed is, too, unless `work` is double.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from omegadot.adapters.protocol import Description, Integrator, Trajectory
from omegadot.adapters.reference.adapter import FEATURES
from omegadot.reference_impl.schemes.scheme import every_channel
from omegadot.reference_impl.system import Acceleration, Array, Body, State, System

Floats = NDArray[np.floating]
F = np.float32


def cross(a: Floats, b: Floats) -> Floats:
    (x, y, z), (u, v, w) = np.moveaxis(a, -1, 0), np.moveaxis(b, -1, 0)
    return np.stack((y * w - z * v, z * u - x * w, x * v - y * u), -1)


def times(a: Floats, b: Floats) -> Floats:
    """The product of two quaternions."""
    vector = a[..., :1] * b[..., 1:] + b[..., :1] * a[..., 1:] + cross(a[..., 1:], b[..., 1:])
    scalar = a[..., 0] * b[..., 0] - np.sum(a[..., 1:] * b[..., 1:], axis=-1)
    return np.concatenate((scalar[..., None], vector), axis=-1)


def turned(q: Floats, x: Floats) -> Floats:
    """A vector from body axes to the world."""
    twice = 2 * cross(q[..., 1:], x)
    return x + q[..., :1] * twice + cross(q[..., 1:], twice)


def turned_back(q: Floats, x: Floats) -> Floats:
    return turned(np.concatenate((q[..., :1], -q[..., 1:]), axis=-1), x)


def unit(q: Floats) -> Floats:
    return q / np.sqrt(np.sum(q * q, axis=-1, keepdims=True))


class Single:
    """Runge-Kutta of order 4 on the quaternion, all of it in single precision.

    work: the type that is computed in.  gyroscopic, damping, mass, gravity, stretch: factors, one
    where it is sound; stretch is that of the step, and stepped_gyroscopic acts in the steps alone.
    declared: the scheme.
    """

    work: type = F
    order, declared = 4, ""
    gyroscopic = damping = mass = gravity = stretch = stepped_gyroscopic = 1.0

    def __init__(self, setup: str = "physics") -> None:
        pass

    @property
    def description(self) -> Description:
        own = Integrator("step", self.declared or None, every_channel(self.order))
        return Description("single", "1.0", (own,), precision="float32", features=FEATURES)

    def kept(self, values: object) -> Floats:
        """Numbers as they are kept, in the type that is computed in."""
        return np.asarray(values, F).astype(self.work)

    def load(self, system: System) -> None:
        body, load, kept = system.body, system.load, self.kept
        self.body = Body(*map(kept, (body.mass, body.center_of_mass, body.inertia)))
        self.m, self.g = self.body.mass * F(self.mass), kept(self.gravity * load.gravity)
        self.d = kept(load.damping) * F(self.damping)
        self.couples = kept(load.torque_body), kept(load.torque_world)
        self.free = load.pivot is None
        self.r = np.zeros(3, self.work)
        if load.pivot is not None:
            self.r = self.body.center_of_mass - kept(load.pivot)
        square = np.sum(self.r * self.r) * np.eye(3, dtype=self.work)
        self.inertia = self.body.inertia + self.m * (square - np.outer(self.r, self.r))
        self.inverse = np.linalg.inv(self.inertia.astype(float)).astype(self.work)

    def model(self) -> tuple[Body, ...]:
        return (self.body,)

    def placed(self, q: Floats, w: Floats, x: Floats, v: Floats) -> State:
        if not self.free:
            x, v = turned(q, self.r + 0 * w), turned(q, cross(w, self.r + 0 * w))
        return State(*(part.astype(F) for part in (q, w, x, v)))

    def set_state(self, state: State) -> None:
        self.state = self.placed(*map(self.kept, vars(state).values()))

    def get_state(self) -> State:
        return self.state

    def forces(self, q: Floats) -> tuple[Floats, Floats]:
        """Applied torques, and the weight's about the pivot, in body axes."""
        in_body, in_world = self.couples
        applied = in_body + turned_back(q, in_world + 0 * q[..., 1:])
        weight = turned_back(q, self.m * self.g + 0 * q[..., 1:])
        return applied, cross(self.r + 0 * weight, weight) * (not self.free)

    def angular(self, q: Floats, w: Floats) -> Floats:
        spin = F(self.gyroscopic) * cross(w, w @ self.inertia)
        return (sum(self.forces(q)) - self.d * w - spin) @ self.inverse

    def forward_dynamics(self, states: State) -> Acceleration:
        q, w = self.kept(states.orientation), self.kept(states.angular_velocity)
        found, r = self.angular(q, w), self.r + 0 * w
        linear = turned(q, cross(found, r) + cross(w, cross(w, r))) if not self.free else 0 * w
        return Acceleration(found, linear + self.g * self.free)

    def inverse_dynamics(self, states: State, acceleration: Acceleration) -> Array:
        q, w = self.kept(states.orientation), self.kept(states.angular_velocity)
        spin = F(self.gyroscopic) * cross(w, w @ self.inertia)
        return self.kept(acceleration.angular) @ self.inertia + spin - self.forces(q)[1]

    def to_chart(self, q: Floats) -> Floats:
        return q

    def from_chart(self, chart: Floats) -> Floats:
        return unit(chart)

    def chart_rate(self, chart: Floats, w: Floats) -> Floats:
        return times(chart, np.concatenate(([0 * w[0]], w))) / 2

    def rates(self, y: Floats) -> Floats:
        chart, w, _, v = np.split(y, (-9, -6, -3))
        angular = self.angular(self.from_chart(chart), w)
        more = F(self.stepped_gyroscopic - 1.0)
        angular = angular - more * (cross(w, w @ self.inertia) @ self.inverse)
        moving = (v, self.g) if self.free else (0 * v, 0 * v)
        return np.concatenate((self.chart_rate(chart, w), angular, *moving))

    def step(self, y: Floats, h: np.floating) -> Floats:
        k1 = self.rates(y)
        k2 = self.rates(y + h / 2 * k1)
        k3 = self.rates(y + h / 2 * k2)
        k4 = self.rates(y + h * k3)
        y = y + h / 6 * (k1 + 2 * k2 + 2 * k3 + k4)
        return np.concatenate((self.to_chart(self.from_chart(y[:-9])), y[-9:]))

    def _stepped(self, y: Floats, h: np.floating, steps: int, kept: set[int]) -> Iterator[Floats]:
        for n in range(steps + 1):
            if n in kept:
                yield y
            if n < steps:
                y = self.kept(self.step(y, h))

    def run(
        self, initial: State, integrator: str, timestep: float, steps: int, every: int
    ) -> Trajectory:
        q, *others = map(self.kept, vars(initial).values())
        h = self.kept(timestep * self.stretch)[()]
        numbers = sorted({*range(0, steps + 1, every), steps})
        start = np.concatenate((self.kept(self.to_chart(q)), *others))
        y = np.stack(list(self._stepped(start, h, steps, set(numbers))))
        chart, w, x, v = np.split(y, (-9, -6, -3), axis=1)
        state = self.placed(self.from_chart(chart), w, x, v)
        return Trajectory(np.array(numbers, F) * F(timestep), state)


class SingleEuler(Single):
    """Semi-implicit Euler: omega first, then the attitude by its exponential."""

    order = 1

    def turned_on(self, q: Floats, w: Floats, h: np.floating) -> Floats:
        return w + h * self.angular(q, w)

    def step(self, y: Floats, h: np.floating) -> Floats:
        q, w, x, v = np.split(y, (-9, -6, -3))
        w = self.turned_on(q, w, h)
        half = h * w / 2
        angle = np.sqrt(half @ half)
        part = half * (np.sin(angle) / angle if angle else 1)
        q = unit(times(q, np.concatenate(([np.cos(angle)], part)).astype(self.work)))
        v = v + h * self.g * self.free
        return np.concatenate((q, w, x + h * v * self.free, v))


class SingleCoupling(SingleEuler):
    """The gyroscopic term is a quarter too large, in forward dynamics and in the steps."""

    gyroscopic = 1.25


class DeclaredEuler(SingleEuler):
    """The same, with its scheme declared: the reference's run of it is in double."""

    declared = "semi-implicit-euler"


class SingleMomentum(SingleEuler):
    """The angular momentum is what is stepped and rounded; omega follows from it."""

    def turned_on(self, q: Floats, w: Floats, h: np.floating) -> Floats:
        momentum = w @ self.inertia
        torque = sum(self.forces(q)) - self.d * w - cross(w, momentum)
        return (momentum + h * torque) @ self.inverse


class StoredSingle(SingleEuler):
    """Each step is computed in double, and kept in single precision."""

    work = float


class SingleRodrigues(Single):
    """Modified Rodrigues parameters, of two sets the one that turns by less than half a turn."""

    def to_chart(self, q: Floats) -> Floats:
        near = q if q[..., 0] >= 0 else -q
        return near[1:] / (1 + near[0])

    def from_chart(self, chart: Floats) -> Floats:
        square = np.sum(chart * chart, axis=-1, keepdims=True)
        return unit(np.concatenate((1 - square, 2 * chart), axis=-1) / (1 + square))

    def chart_rate(self, chart: Floats, w: Floats) -> Floats:
        square, along = chart @ chart, chart @ w
        return ((1 - square) * w + 2 * cross(chart, w) + 2 * along * chart) / 4


def with_fault(engine: type[Single], **factors: float) -> Single:
    """One of the engines with a term scaled, or its steps stretched."""
    found = engine()
    for name, factor in factors.items():
        assert hasattr(engine, name)
        setattr(found, name, factor)
    return found


def declared_double(engine: type[Single]) -> Single:
    """The engine, wrongly described as one in double."""

    class Declared(engine):  # type: ignore[misc, valid-type]
        @property
        def description(self) -> Description:
            return replace(super().description, precision="float64")

    return Declared()
