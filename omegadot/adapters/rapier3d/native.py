"""Conventions and defaults of the installed Rapier, measured on it, not read in its documents."""

from __future__ import annotations

from typing import Any

import numpy as np

from omegadot.adapters.native_axes import (
    GIVEN,
    TURNED_QUATERNION,
    axes_observed,
    described,
)
from omegadot.adapters.rapier3d.model import quaternion_of
from omegadot.reference_impl.rotations import conjugate, normalize, quaternion_product
from omegadot.reference_impl.system import Array

TURNING, SLOWING = 0.5, 2.0**-10  # s, steps: one that turns far, one that is short
DIGITS = 5  # of numbers in single precision that are compared to exact ones


def _sphere(rapier: Any, spin: Array) -> tuple[Any, Any]:
    """A world without gravity, and in it a sphere of 1 kg and 1 kg m^2 with these velocities."""
    world = rapier.PhysicsWorld()
    inertia = rapier.MassProperties((0.0, 0.0, 0.0), 1.0, (1.0, 1.0, 1.0))
    made = rapier.RigidBody.dynamic().additional_mass_properties(inertia)
    body = world.rigid_bodies[world.add_body(made)]
    body.recompute_mass_properties_from_colliders(world.colliders)
    body.rotation = rapier.Rotation3(*TURNED_QUATERNION)
    body.linvel = body.angvel = tuple(spin.tolist())
    return world, body


def _stepped(rapier: Any, spin: Array, h: float) -> Any:
    world, body = _sphere(rapier, spin)
    world.integration_parameters.dt = h
    world.step()
    return body


def _seen(rapier: Any) -> tuple[Array, Array]:
    """Linear and angular velocity in world axes, from a step at velocities ``GIVEN``.

    Omega of a sphere stays what it is; its attitude tells what it was, by Cayley's increment.
    """
    body = _stepped(rapier, GIVEN, TURNING)
    turn = quaternion_product(
        normalize(np.array(quaternion_of(body.rotation))), conjugate(np.array(TURNED_QUATERNION))
    )
    axis = np.sign(turn[0]) * turn[1:]
    place = np.array(body.translation.to_tuple(), float)
    return place / TURNING, axis / np.linalg.norm(axis)


def _of_a_joint(rapier: Any) -> dict[str, str]:
    """The frame of a spherical joint's velocity, of a body turned on it, and its damping."""
    world, _ = _sphere(rapier, np.zeros(3))
    fixed = world.add_body(rapier.RigidBody.fixed())
    body = next(iter(world.rigid_bodies.handles()))
    joint = rapier.SphericalJoint.builder().build()
    multibody, _ = world.multibody_joints.get(world.multibody_joints.insert(fixed, body, joint))
    multibody.forward_kinematics(world.rigid_bodies, True)
    lost = described(np.round(multibody.damping(), DIGITS))
    third = 2 * np.pi / 3 / np.sqrt(3.0)
    multibody.apply_displacements([third] * 3)
    multibody.set_generalized_velocity(GIVEN.tolist())
    multibody.forward_kinematics(world.rigid_bodies)
    multibody.update_rigid_bodies(world.rigid_bodies, True)
    world.integration_parameters.dt = 2.0**-100
    world.step()
    spin = np.array(world.rigid_bodies[body].angvel.to_tuple(), float)
    return {
        "spherical joint velocity frame": axes_observed(np.round(spin, DIGITS)),
        "spherical joint damping, N m s": lost,
    }


def conventions(rapier: Any) -> dict[str, str]:
    """As measured, name to value."""
    linear, angular = _seen(rapier)
    turned = rapier.Rotation3(1.0, 0.0, 0.0, 0.0)
    read = turned.quaternion
    return {
        "linear velocity frame": axes_observed(np.round(linear, DIGITS)),
        "angular velocity frame": axes_observed(np.round(angular, DIGITS)),
        "quaternion order, given": "w, x, y, z" if turned.w == 1.0 else "x, y, z, w",
        "quaternion order, read": "w, x, y, z" if read[0] == 1.0 else "x, y, z, w",
        "spherical joint velocity frame": _of_a_joint(rapier)["spherical joint velocity frame"],
    }


def defaults(rapier: Any) -> dict[str, str]:
    """As they come, name to value."""
    world, body = _sphere(rapier, GIVEN)
    found = {}
    for name in ("angular_damping", "linear_damping", "allow_fast_rotation"):
        found[name] = described(getattr(body, name))
    found["gyroscopic_forces_enabled"] = described(body.gyroscopic_forces_enabled)
    for name in ("linear_threshold", "angular_threshold", "time_until_sleep"):
        found[f"activation {name}"] = described(round(getattr(body.activation, name), DIGITS))
    for name in ("dt", "length_unit", "normalized_max_linear_velocity", "num_solver_iterations"):
        value = getattr(world.integration_parameters, name)
        found[name] = described(round(value, DIGITS))
    found["spherical joint damping, N m s"] = _of_a_joint(rapier)["spherical joint damping, N m s"]
    fastest = float(_stepped(rapier, 1e3 * GIVEN, SLOWING * 4).angvel.norm())
    found["largest turn in a step, rad"] = described(round(fastest * SLOWING * 4, DIGITS))
    return found
