"""The Rapier body of one system, in a world of its own.

A free body is by itself. A pivoted one is on a spherical joint in reduced coordinates, to a fixed
body at the world's origin. Rapier keeps the inertia as principal moments about the centre of mass
and the quaternion of their axes. All numbers are in single precision.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from omegadot.adapters.body_files import origin_at_pivot
from omegadot.adapters.mujoco.model import principal_frame
from omegadot.adapters.protocol import Setup, UnsupportedError, mends
from omegadot.reference_impl.kinematics import place_on_pivot
from omegadot.reference_impl.rotations import (
    normalize,
    rotate,
    rotate_inverse,
    rotation_between,
    rotation_matrix,
)
from omegadot.reference_impl.system import Array, Body, State, System

SWITCHED_OFF = (
    "sleep (RigidBodyBuilder.can_sleep)",
    "the limit of 400 m/s (IntegrationParameters.normalized_max_linear_velocity raises it)",
    "the cut of omega to what turns a body by 45 degrees in a step (RigidBody.allow_fast_rotation)",
    "the damping of 0.1 N m s of a spherical joint in reduced coordinates (Multibody.set_damping)",
)
SETTINGS = (
    "can_sleep",
    "normalized_max_linear_velocity",
    "allow_fast_rotation",
    "set_damping",
)
FAST = 1e18  # m/s; its square is finite in single precision
ORIGIN = (0.0, 0.0, 0.0)
NO_TURN = np.array([1.0, 0.0, 0.0, 0.0])
PLACE, ATTITUDE, VELOCITY, SPIN = slice(0, 3), slice(3, 7), slice(7, 10), slice(10, 13)


class RapierModel:
    """world: what steps; rigid: the body; multibody: it on its joint, None of a free body.

    A row is place and quaternion (w, x, y, z) of the body's origin, the velocity of its centre of
    mass, and omega in world axes: 13 numbers.  Raises UnsupportedError for damping of a free body.
    """

    def __init__(self, engine: Any, system: System, setup: Setup) -> None:
        load = system.load
        self.free = load.pivot is None
        if self.free and load.damping:
            raise UnsupportedError(
                "Rapier has no damping torque -damping * omega of a free body: its own damping "
                "slows every body alike, whatever its inertia"
            )
        self._engine, self.system, self._setup = engine, system, setup
        self._origin = np.array(origin_at_pivot(system), float)
        self.world = engine.PhysicsWorld(tuple(np.array(load.gravity, float).tolist()))
        made = engine.RigidBody.dynamic().additional_mass_properties(self._inertia())
        if mends(setup, "can_sleep"):
            made = made.can_sleep(False)
        handle = self.world.add_body(made)
        self.rigid = self.world.rigid_bodies[handle]
        # The mass is zero before the first step.
        self.rigid.recompute_mass_properties_from_colliders(self.world.colliders)
        if mends(setup, "normalized_max_linear_velocity"):
            self.world.integration_parameters.normalized_max_linear_velocity = FAST
        if mends(setup, "allow_fast_rotation"):
            self.rigid.allow_fast_rotation = True
        self.multibody = None if self.free else self._joined(handle)
        self._center = np.array(self.rigid.local_center_of_mass.to_tuple(), float)

    def _inertia(self) -> Any:
        body = self.system.body
        inertia = np.array(body.inertia, float)
        moments, frame = principal_frame(0.5 * (inertia + inertia.T))
        center = (np.array(body.center_of_mass, float) - self._origin).tolist()
        turned = self._engine.Rotation3(*frame.tolist())
        return self._engine.MassProperties(
            tuple(center), float(body.mass), tuple(moments.tolist()), turned
        )

    def _joined(self, handle: Any) -> Any:
        engine, world, damping = self._engine, self.world, float(self.system.load.damping)
        fixed = world.add_body(engine.RigidBody.fixed())
        joint = engine.SphericalJoint.builder().build()
        added = world.multibody_joints.insert(fixed, handle, joint)
        multibody, _ = world.multibody_joints.get(added)
        # Until its root is stated to be fixed, the root has six velocities of its own.
        multibody.forward_kinematics(world.rigid_bodies, True)
        if damping or mends(self._setup, "set_damping"):
            multibody.set_damping([damping] * 3)
        return multibody

    def body(self) -> Body:
        """Mass, centre of mass from the body's origin and inertia about it."""
        held = self.rigid.mass_properties
        turned = quaternion_of(held.principal_inertia_local_frame)
        axes = rotation_matrix(normalize(np.array(turned)))
        moments = np.diag(np.array(held.principal_inertia.to_tuple(), float))
        center = self._center + self._origin
        return Body(np.array(held.mass, float), center, axes @ moments @ axes.T)

    def set_state(self, state: State) -> None:
        """Put the body in the state: of a pivoted one once, as its joint is moved by turns."""
        q = np.array(state.orientation, float)
        spin = rotate(q, np.array(state.angular_velocity, float)).tolist()
        rigid = self.rigid
        if self.multibody is not None:
            self.multibody.apply_displacements(rotation_between(NO_TURN, q).tolist())
            self.multibody.forward_kinematics(self.world.rigid_bodies)
            self.multibody.update_rigid_bodies(self.world.rigid_bodies, True)
            self.multibody.set_generalized_velocity(spin)
            return
        origin = np.array(state.position, float) - rotate(q, self._center)
        rigid.translation = tuple(origin.tolist())
        rigid.rotation = self._engine.Rotation3(*q.tolist())
        rigid.linvel = tuple(np.array(state.linear_velocity, float).tolist())
        rigid.angvel = tuple(spin)

    def row(self) -> tuple[float, ...]:
        """The numbers of the present state, as Rapier has them."""
        rigid = self.rigid
        q = quaternion_of(rigid.rotation)
        if self.multibody is not None:
            return (*ORIGIN, *q, *ORIGIN, *self.multibody.generalized_velocity())
        place, velocity = rigid.translation.to_tuple(), rigid.linvel.to_tuple()
        return (*place, *q, *velocity, *rigid.angvel.to_tuple())

    def states(self, rows: Array) -> State:
        """The states of rows (n, 13)."""
        q = normalize(rows[:, ATTITUDE])
        spin = rotate_inverse(q, rows[:, SPIN])
        place = rows[:, PLACE] + rotate(q, self._center)
        found = State(q, spin, place, rows[:, VELOCITY])
        return found if self.free else place_on_pivot(self.system, found)


def quaternion_of(rotation: Any) -> tuple[float, float, float, float]:
    """(w, x, y, z): `Rotation3` is made of them in this order, and its quaternion ends with w."""
    return rotation.w, rotation.i, rotation.j, rotation.k
