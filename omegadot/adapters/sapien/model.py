"""The SAPIEN body of one system: an entity with one rigid component, in a scene of its own.

PhysX keeps a body's pose at its origin, its inertia as principal moments about the centre of mass
and along the axes of a local pose there, and both velocities in world axes, the linear one of the
centre of mass. All numbers are in single precision.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from omegadot.adapters.mujoco.model import principal_frame
from omegadot.adapters.protocol import Setup, UnsupportedError, mends
from omegadot.reference_impl.rotations import normalize, rotate, rotate_inverse, rotation_matrix
from omegadot.reference_impl.system import Array, Body, Load, State, System

SWITCHED_OFF = (
    "angular_damping of 0.05: omega is multiplied by 1 - d h at each step",
    "sleep (set_sleep_threshold, 0.005 J/kg)",
    "max_angular_velocity of 100 rad/s",
)
SETTINGS = ("angular_damping", "sleep_threshold", "max_angular_velocity")
FAST = 1e18  # rad/s; its square, which PhysX keeps, is finite in single precision
PLACE, ATTITUDE, VELOCITY, SPIN = slice(0, 3), slice(3, 7), slice(7, 10), slice(10, 13)


class SapienModel:
    """world: what steps; actor: the component. Raises UnsupportedError for what SAPIEN has not.

    A row is place and quaternion (w, x, y, z) of the body's origin, the velocity of its centre of
    mass, and omega in world axes: 13 numbers.
    """

    def __init__(self, engine: Any, system: System, setup: Setup) -> None:
        _refuse(system.load)
        self._engine, self.system, self.strict = engine, system, setup == "physics"
        inertia = np.array(system.body.inertia, float)
        self.moments, frame = principal_frame(0.5 * (inertia + inertia.T))
        physx = engine.physx
        physx.set_scene_config(gravity=np.array(system.load.gravity, float))  # of scenes to come
        self.world = physx.PhysxCpuSystem()
        self._scene = engine.Scene([self.world])
        self.entity, self.actor = engine.Entity(), physx.PhysxRigidDynamicComponent()
        self.actor.set_mass(float(system.body.mass))
        self.actor.set_inertia(self.moments)
        self.actor.set_cmass_local_pose(engine.Pose(system.body.center_of_mass, frame))
        if self.strict:
            self.actor.set_linear_damping(0.0)
        for name, value in zip(SETTINGS, (0.0, 0.0, FAST), strict=True):
            if mends(setup, name):
                getattr(self.actor, f"set_{name}")(value)
        self.entity.add_component(self.actor)
        self._scene.add_entity(self.entity)
        self._center = np.array(self.actor.get_cmass_local_pose().p, float)

    def body(self) -> Body:
        """Mass, centre of mass and inertia about it."""
        pose = self.actor.get_cmass_local_pose()
        axes = rotation_matrix(normalize(np.array(pose.q, float)))
        moments = np.diag(np.array(self.actor.get_inertia(), float))
        return Body(np.array(self.actor.get_mass(), float), self._center, axes @ moments @ axes.T)

    def set_state(self, state: State) -> None:
        """Put the body in the state."""
        q = np.array(state.orientation, float)
        origin = np.array(state.position, float) - rotate(q, self._center)
        self.entity.set_pose(self._engine.Pose(origin, q))
        self.actor.set_linear_velocity(np.array(state.linear_velocity, float))
        self.actor.set_angular_velocity(rotate(q, np.array(state.angular_velocity, float)))

    def row(self) -> Array:
        """The numbers of the present state, as SAPIEN has them."""
        pose, actor = self.entity.get_pose(), self.actor
        parts = (pose.p, pose.q, actor.get_linear_velocity(), actor.get_angular_velocity())
        return np.concatenate(parts).astype(float)

    def get_state(self) -> State:
        """The present state."""
        return self.states(self.row()[None])[0]

    def states(self, rows: Array) -> State:
        """The states of rows (n, 13)."""
        q = normalize(rows[:, ATTITUDE])
        place = rows[:, PLACE] + rotate(q, self._center)
        return State(q, rotate_inverse(q, rows[:, SPIN]), place, rows[:, VELOCITY])


def _refuse(load: Load) -> None:
    if load.pivot is not None:
        raise UnsupportedError("the adapter of sapien has no pivoted bodies")
    if load.damping:
        raise UnsupportedError(
            "sapien has no damping torque -damping * omega: its own damping slows every body "
            "alike, whatever its inertia"
        )
