"""Pinocchio stepped by hand: loops over `aba` and `integrate`, as its users write them."""

from __future__ import annotations

from collections.abc import Callable
from itertools import repeat
from math import atan, sqrt
from typing import Any

import numpy as np
import pinocchio as pin
from bare import Bare

from omegadot.reference_impl.rotations import rotate
from omegadot.reference_impl.system import Array, State, System

Torque = Callable[[Array, Array], Array]
Step = Callable[[Array, Array], tuple[Array, Array]]


def loops(
    system: System, initial: State, integrator: str, timestep: float, steps: int, every: int
) -> list[Bare]:
    """One loop, where a hand-written one is known for the scheme; steps is a multiple of every."""
    make = _STEPS.get(integrator)
    if make is None:
        return []
    model = _model(system)
    step = make(model, model.createData(), system, timestep)
    q0, v0 = _coordinates(system, initial)
    last = [v0]

    def run() -> list[Array]:
        q, v = q0, v0
        samples: list[Array] = []
        keep = samples.append
        for _ in repeat(None, steps // every):
            for _ in repeat(None, every):
                q, v = step(q, v)
            keep(q)
            keep(v)
        last[0] = v
        return samples

    return [Bare("aba, integrate", list, run, lambda: last[0][-3:])]


def _model(system: System) -> Any:
    body, load = system.body, system.load
    model = pin.Model()
    kind = pin.JointModelFreeFlyer if load.pivot is None else pin.JointModelSpherical
    joint = model.addJoint(0, kind(), pin.SE3.Identity(), "body")
    origin = np.zeros(3) if load.pivot is None else np.asarray(load.pivot)
    model.inertias[joint] = pin.Inertia(
        float(body.mass), body.center_of_mass - origin, body.inertia
    )
    model.gravity.linear = np.asarray(load.gravity, float)
    return model


def _coordinates(system: System, state: State) -> tuple[Array, Array]:
    q, w = state.orientation, state.angular_velocity
    x, y, z, scalar = q[1], q[2], q[3], q[0]
    if system.load.pivot is not None:
        return np.array([x, y, z, scalar]), w
    arm = system.body.center_of_mass
    origin = state.position - rotate(q, arm)
    world_R_body = pin.Quaternion(scalar, x, y, z).toRotationMatrix()
    velocity = world_R_body.T @ state.linear_velocity - np.cross(w, arm)
    return np.array([*origin, x, y, z, scalar]), np.concatenate([velocity, w])


def _torque(model: Any, system: System) -> Array | Torque:
    """What the load applies to the joint, (nv,): constant, or a function of q and v."""
    load = system.load
    torque = np.zeros(model.nv)
    torque[-3:] = load.torque_body
    if load.damping:
        against = np.zeros(model.nv)
        against[-3:] = -load.damping
        return lambda q, v: against * v
    if np.any(load.torque_world):
        in_world, quaternion = load.torque_world, pin.Quaternion

        def turned(q: Array, v: Array) -> Array:
            torque[-3:] = in_world @ quaternion(q[-4:]).toRotationMatrix()
            return torque

        return turned
    return torque


def _acceleration(model: Any, data: Any, system: System) -> Callable[[Array, Array], Array]:
    """``aba`` under the load; the array is Pinocchio's own."""
    aba, torque = pin.aba, _torque(model, system)
    if callable(torque):
        return lambda q, v: aba(model, data, q, v, torque(q, v))
    return lambda q, v: aba(model, data, q, v, torque)


def _slopes(model: Any, data: Any, system: System) -> Callable[[Array, Array], Array]:
    """The derivatives of ``aba`` by v, the load's among them; ``data.ddq`` is the acceleration."""
    derive, torque, damping = pin.computeABADerivatives, _torque(model, system), system.load.damping
    if not callable(torque):
        return lambda q, v: derive(model, data, q, v, torque)[1]

    def of_load(q: Array, v: Array) -> Array:
        _, by_v, inverse_mass = derive(model, data, q, v, torque(q, v))
        if damping:
            by_v[:, -3:] -= damping * inverse_mass[:, -3:]
        return by_v

    return of_load


def _semi_implicit(model: Any, data: Any, system: System, h: float) -> Step:
    acceleration, integrate = _acceleration(model, data, system), pin.integrate

    def step(q: Array, v: Array) -> tuple[Array, Array]:
        v = v + h * acceleration(q, v)
        return integrate(model, q, h * v), v

    return step


def _linearly_implicit(model: Any, data: Any, system: System, h: float) -> Step:
    slopes, one = _slopes(model, data, system), np.eye(model.nv)
    integrate, solve = pin.integrate, np.linalg.solve

    def step(q: Array, v: Array) -> tuple[Array, Array]:
        by_v = slopes(q, v)
        v = v + solve(one - h * by_v, h * data.ddq)
        return integrate(model, q, h * v), v

    return step


def _implicit_midpoint(model: Any, data: Any, system: System, h: float) -> Step:
    """Newton's method with the Jacobian of the step's start, until omega stands still."""
    slopes, one, half = _slopes(model, data, system), np.eye(model.nv), 0.5 * h
    acceleration, integrate, invert = (
        _acceleration(model, data, system),
        pin.integrate,
        np.linalg.inv,
    )
    least = float(np.finfo(float).eps) ** 2

    def increment(v: Array) -> Array:
        """The vector whose exponential is Cayley's transform of h v."""
        *linear, a, b, c = (h * v).tolist()
        square = a * a + b * b + c * c
        angle = sqrt(square)
        s = 2 * atan(0.5 * angle) / angle
        if not linear:
            return np.array([s * a, s * b, s * c])
        x, y, z = linear
        along = (1 - s) * (x * a + y * b + z * c) / square
        return np.array(
            [s * x + along * a, s * y + along * b, s * z + along * c, s * a, s * b, s * c]
        )

    def step(q: Array, v: Array) -> tuple[Array, Array]:
        inverse = invert(one - half * slopes(q, v))
        w, last = v + inverse @ (half * data.ddq), np.inf
        while True:
            push = half * acceleration(integrate(model, q, 0.5 * increment(w)), w)
            change = inverse @ (v + push - w)
            w = w + change
            turned, whole = change[-3:], w[-3:]
            size = float(turned @ turned) / float(whole @ whole)
            if size <= least or size >= last:
                return integrate(model, q, increment(w)), 2 * w - v
            last = size

    return step


def _rk4(model: Any, data: Any, system: System, h: float, rate: Any) -> Step:
    """RK4 on u and v with ``q = q0 exp(u)``."""
    acceleration, integrate, half = _acceleration(model, data, system), pin.integrate, 0.5 * h

    def step(q: Array, v: Array) -> tuple[Array, Array]:
        a = h * acceleration(q, v)
        u, v2 = half * v, v + 0.5 * a
        b = h * acceleration(integrate(model, q, u), v2)
        u2, v3 = rate(u, v2), v + 0.5 * b
        u = half * u2
        c = h * acceleration(integrate(model, q, u), v3)
        u3, v4 = rate(u, v3), v + c
        u = h * u3
        d = h * acceleration(integrate(model, q, u), v4)
        mean = (h / 6) * (v + 2 * (u2 + u3) + rate(u, v4))
        return integrate(model, q, mean), v + (a + 2 * (b + c) + d) / 6

    return step


def _rk4_quaternion(model: Any, data: Any, system: System, h: float) -> Step:
    """RK4 on q and v, the quaternion as any four numbers, made unit for ``aba``."""
    acceleration, normalize, half = _acceleration(model, data, system), pin.normalize, 0.5 * h

    def rate(q: Array, v: Array) -> Array:
        *place, x, y, z, w = q.tolist()
        *linear, a, b, c = v.tolist()
        if place:  # R u of a quaternion that need not be unit
            (lx, ly, lz), s = linear, 2 / (w * w + x * x + y * y + z * z)
            tx, ty, tz = s * (y * lz - z * ly), s * (z * lx - x * lz), s * (x * ly - y * lx)
            linear = [
                lx + w * tx + y * tz - z * ty,
                ly + w * ty + z * tx - x * tz,
                lz + w * tz + x * ty - y * tx,
            ]
        a, b, c = 0.5 * a, 0.5 * b, 0.5 * c
        turning = (w * a + y * c - z * b, w * b + z * a - x * c, w * c + x * b - y * a)
        return np.array([*linear, *turning, -x * a - y * b - z * c])

    def step(q: Array, v: Array) -> tuple[Array, Array]:
        q1, a1 = rate(q, v), h * acceleration(q, v)
        p, u = q + half * q1, v + 0.5 * a1
        q2, a2 = rate(p, u), h * acceleration(normalize(model, p), u)
        p, u = q + half * q2, v + 0.5 * a2
        q3, a3 = rate(p, u), h * acceleration(normalize(model, p), u)
        p, u = q + h * q3, v + a3
        q4, a4 = rate(p, u), h * acceleration(normalize(model, p), u)
        q = q + (h / 6) * (q1 + 2 * (q2 + q3) + q4)
        return normalize(model, q), v + (a1 + 2 * (a2 + a3) + a4) / 6

    return step


def _naive(model: Any, data: Any, system: System, h: float) -> Step:
    return _rk4(model, data, system, h, lambda _, v: v)


def _munthe_kaas(model: Any, data: Any, system: System, h: float) -> Step:
    """The rate ``v + [u, v]/2 + [u, [u, v]]/12``, the brackets as products with a matrix of u."""
    count = model.nv
    bracket, crossed = np.zeros((count, count)), np.zeros((3, 3))

    def cross_matrix(r: list[float]) -> Array:
        x, y, z = r
        crossed[0, 1], crossed[0, 2], crossed[1, 2] = -z, y, -x
        crossed[1, 0], crossed[2, 0], crossed[2, 1] = z, -y, x
        return crossed

    def rate(u: Array, v: Array) -> Array:
        parts = u.tolist()
        turning = cross_matrix(parts[-3:])
        bracket[-3:, -3:] = turning
        if count == 6:
            bracket[:3, :3] = turning
            bracket[:3, 3:] = cross_matrix(parts[:3])
        first = bracket @ v
        return v + 0.5 * first + (1 / 12) * (bracket @ first)

    return _rk4(model, data, system, h, rate)


_STEPS: dict[str, Callable[[Any, Any, System, float], Step]] = {
    "aba+semi-implicit-euler": _semi_implicit,
    "aba+linearly-implicit-euler": _linearly_implicit,
    "aba+rk4-quaternion": _rk4_quaternion,
    "aba+implicit-midpoint": _implicit_midpoint,
    "aba+lie-rk4-naive": _naive,
    "aba+lie-rk4": _munthe_kaas,
}
