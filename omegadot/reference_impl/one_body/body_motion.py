"""One body as a motion that schemes step: equations (7) and (8) in components."""

from __future__ import annotations

from functools import partial
from typing import Any

import numpy as np

from omegadot.reference_impl.arithmetic.components import (
    Formula,
    Numbers,
    constants,
    cross3,
    in_components,
    rotated,
)
from omegadot.reference_impl.coordinates import Coordinates, acceleration_in, from_coordinates
from omegadot.reference_impl.cross_product import skew
from omegadot.reference_impl.formed_once import formed_once
from omegadot.reference_impl.inertia import lever, moving_inertia
from omegadot.reference_impl.loads import weight
from omegadot.reference_impl.motion import AccelerationOf
from omegadot.reference_impl.one_body.body_configurations import ATTITUDE, SPATIAL, WORLD
from omegadot.reference_impl.schemes.jacobian import by_differences
from omegadot.reference_impl.schemes.motion import Motion, Velocity
from omegadot.reference_impl.symmetric import inverse, times_symmetric
from omegadot.reference_impl.system import Array, System


@formed_once
def body_motion(system: System, coordinates: Coordinates = "com-world") -> Motion:
    """One body under its loads, in these coordinates."""
    if system.load.pivot is not None:
        return attitude_motion(system)
    return _motion(system, _free_acceleration(system, coordinates), _fields_in(coordinates))


@formed_once
def attitude_motion(system: System) -> Motion:
    """The turning of a body alone: q is the quaternion, v is ω. A pivoted body has no more."""
    return _motion(system, in_components(_angular(system)), ATTITUDE)


def motion_over(system: System, coordinates: Coordinates, acceleration: AccelerationOf) -> Motion:
    """Any accelerations of a body's states, an engine's or wrong ones, as a motion.

    They must broadcast over leading axes, and not depend on the linear velocity.
    """

    def rate(q: Array, v: Array) -> Array:
        state = from_coordinates(system, q, v, coordinates)
        return acceleration_in(system, state, acceleration(state), coordinates)

    pivoted = system.load.pivot is not None
    return _motion(system, rate, ATTITUDE if pivoted else _fields_in(coordinates))


def _fields_in(coordinates: Coordinates) -> dict[str, Any]:
    return SPATIAL if coordinates == "body-spatial" else WORLD


def _motion(system: System, acceleration: Velocity, fields: dict[str, Any]) -> Motion:
    jacobian = _jacobian_by_all if fields is SPATIAL else _jacobian_by_omega
    return Motion(
        acceleration=acceleration,
        jacobian=partial(jacobian, acceleration),
        momentum=times_symmetric(moving_inertia(system)),
        **fields,
    )


def _jacobian_by_omega(
    acceleration: Velocity, q: Array, v: Array, size: Array | None
) -> tuple[Array, Array]:
    """In the world, where accelerations do not depend on the linear velocity: (..., n, 3)."""
    return by_differences(acceleration, q, v, 3, size)


def _jacobian_by_all(
    acceleration: Velocity, q: Array, v: Array, size: Array | None
) -> tuple[Array, Array]:
    """In body axes ``∂u̇/∂u = -ω_×``, and the rest by differences: (..., 6, 6)."""
    found, by_omega = by_differences(acceleration, q, v, 3, size)
    by_u = np.concatenate((-skew(v[..., 3:]), np.zeros_like(by_omega[..., 3:, :])), axis=-2)
    return found, np.concatenate((by_u, by_omega), axis=-1)


def _angular(system: System) -> Formula:
    """``ω̇ = I⁻¹ (τ - ω × I ω)``, equation (8), of q and the components of ω.

    τ is the torque of `loads.torque_of`; what is zero is left out here, not at each step.
    """
    load, inertia = system.load, moving_inertia(system)
    ixx, ixy, ixz, _, iyy, iyz, _, _, izz = constants(inertia)
    jxx, jxy, jxz, _, jyy, jyz, _, _, jzz = constants(inverse(inertia))
    driven, damped = bool(np.any(load.torque_body)), bool(np.any(load.damping))
    bx, by, bz = constants(load.torque_body)
    (d,) = constants(np.asarray(load.damping)[..., None])
    in_world = bool(np.any(load.torque_world))
    couple = constants(load.torque_world)
    hangs = load.pivot is not None and bool(np.any(load.gravity))
    force = constants(weight(system))
    arm = constants(lever(system))

    def angular(q: Numbers, v: Numbers) -> Numbers:
        wx, wy, wz = v[-3:]
        hx = ixx * wx + ixy * wy + ixz * wz
        hy = ixy * wx + iyy * wy + iyz * wz
        hz = ixz * wx + iyz * wy + izz * wz
        tx, ty, tz = hy * wz - hz * wy, hz * wx - hx * wz, hx * wy - hy * wx
        if driven:
            tx, ty, tz = tx + bx, ty + by, tz + bz
        if damped:
            tx, ty, tz = tx - d * wx, ty - d * wy, tz - d * wz
        if in_world or hangs:
            qw, qx, qy, qz = q[-4:]
            inverse_q = -qw, qx, qy, qz
        if in_world:
            ax, ay, az = rotated(inverse_q, couple)
            tx, ty, tz = tx + ax, ty + ay, tz + az
        if hangs:
            ax, ay, az = cross3(arm, rotated(inverse_q, force))
            tx, ty, tz = tx + ax, ty + ay, tz + az
        return (
            jxx * tx + jxy * ty + jxz * tz,
            jxy * tx + jyy * ty + jyz * tz,
            jxz * tx + jyz * ty + jzz * tz,
        )

    return angular


def _free_acceleration(system: System, coordinates: Coordinates) -> Velocity:
    """``v̇`` of a free body, equations (7) and (8): see `coordinates.acceleration_in`."""
    angular = _angular(system)
    gx, gy, gz = gravity = constants(system.load.gravity)
    c = constants(system.body.center_of_mass)

    def of_center(q: Numbers, v: Numbers) -> Numbers:
        return [gx, gy, gz, *angular(q, v)]

    def of_origin(q: Numbers, v: Numbers) -> Numbers:
        w, w_dot = v[3:], angular(q, v)
        x, y, z = cross3(w, cross3(w, c))
        dx, dy, dz = cross3(w_dot, c)
        lx, ly, lz = rotated(q[3:], (x + dx, y + dy, z + dz))
        return [gx - lx, gy - ly, gz - lz, *w_dot]

    def spatial(q: Numbers, v: Numbers) -> Numbers:
        w, w_dot = v[3:], angular(q, v)
        qw, qx, qy, qz = q[3:]
        x, y, z = cross3(w, c)
        x, y, z = cross3(w, (v[0] + x, v[1] + y, v[2] + z))
        dx, dy, dz = cross3(w_dot, c)
        fx, fy, fz = rotated((-qw, qx, qy, qz), gravity)
        return [fx - x - dx, fy - y - dy, fz - z - dz, *w_dot]

    by_name: dict[Coordinates, Formula] = {
        "com-world": of_center,
        "origin-world": of_origin,
        "body-spatial": spatial,
    }
    return in_components(by_name[coordinates])
