"""Pinocchio stepped by hand: loops over `aba` and `integrate`, as its users write them."""

from __future__ import annotations

from collections.abc import Callable
from itertools import repeat
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
    make, load = _STEPS.get(integrator), system.load
    turns = load.damping or np.any(load.torque_world)
    if make is None or (make is _linearly_implicit and turns):
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


def _acceleration(model: Any, data: Any, system: System) -> Callable[[Array, Array], Array]:
    """``aba`` under the load; the array is Pinocchio's own."""
    load, aba = system.load, pin.aba
    torque = np.zeros(model.nv)
    torque[-3:] = load.torque_body
    if load.damping:
        against = np.zeros(model.nv)
        against[-3:] = -load.damping
        return lambda q, v: aba(model, data, q, v, against * v)
    if np.any(load.torque_world):
        in_world, quaternion = load.torque_world, pin.Quaternion

        def turned(q: Array, v: Array) -> Array:
            torque[-3:] = in_world @ quaternion(q[-4:]).toRotationMatrix()
            found: Array = aba(model, data, q, v, torque)
            return found

        return turned
    return lambda q, v: aba(model, data, q, v, torque)


def _semi_implicit(model: Any, data: Any, system: System, h: float) -> Step:
    acceleration, integrate = _acceleration(model, data, system), pin.integrate

    def step(q: Array, v: Array) -> tuple[Array, Array]:
        v = v + h * acceleration(q, v)
        return integrate(model, q, h * v), v

    return step


def _linearly_implicit(model: Any, data: Any, system: System, h: float) -> Step:
    """The torque must not depend on the state: it is not differentiated."""
    torque, one = np.zeros(model.nv), np.eye(model.nv)
    torque[-3:] = system.load.torque_body
    derive, integrate, solve = pin.computeABADerivatives, pin.integrate, np.linalg.solve

    def step(q: Array, v: Array) -> tuple[Array, Array]:
        by_v = derive(model, data, q, v, torque)[1]
        v = v + solve(one - h * by_v, h * data.ddq)
        return integrate(model, q, h * v), v

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
    "aba+lie-rk4-naive": _naive,
    "aba+lie-rk4": _munthe_kaas,
}
