"""Conventions and defaults of the installed SAPIEN, measured on it, not read in its documents."""

from __future__ import annotations

from typing import Any

import numpy as np

from omegadot.adapters.native_axes import GIVEN, TURNED_QUATERNION, axes_observed, described
from omegadot.reference_impl.rotations import conjugate, quaternion_product
from omegadot.reference_impl.system import Array

TURNING, SLOWING = 0.5, 2.0**-10  # s, steps: one that turns far, one that is short
DIGITS = 5  # of numbers in single precision that are compared to exact ones


class _Sphere:
    """A sphere of 1 kg and 1 kg m^2 in a scene without gravity, that turns as it is given."""

    def __init__(self, sapien: Any, spin: Array, q: Any = (1.0, 0.0, 0.0, 0.0)) -> None:
        physx = sapien.physx
        physx.set_scene_config(gravity=np.zeros(3))
        self.world = physx.PhysxCpuSystem()
        self._scene = sapien.Scene([self.world])
        self.entity, self.body = sapien.Entity(), physx.PhysxRigidDynamicComponent()
        self.body.set_mass(1.0)
        self.body.set_inertia(np.ones(3))
        self.entity.add_component(self.body)
        self._scene.add_entity(self.entity)
        self.entity.set_pose(sapien.Pose(np.zeros(3), q))
        self.body.set_linear_velocity(spin)
        self.body.set_angular_velocity(spin)

    def undamped(self) -> _Sphere:
        self.body.set_linear_damping(0.0)
        self.body.set_angular_damping(0.0)
        return self

    def step(self, h: float) -> None:
        self.world.set_timestep(h)
        self.world.step()


def _seen(sapien: Any) -> tuple[Array, Array]:
    """Linear and angular velocity in world axes, from a step at velocities ``GIVEN``.

    Omega of a sphere stays what it is; its attitude tells what it was.
    """
    sphere = _Sphere(sapien, GIVEN, TURNED_QUATERNION).undamped()
    sphere.step(TURNING)
    pose = sphere.entity.get_pose()
    turn = quaternion_product(np.array(pose.q, float), conjugate(np.array(TURNED_QUATERNION)))
    angular = turn[1:] / np.sin(0.5 * TURNING)
    return np.array(pose.p, float) / TURNING, np.sign(turn[0]) * angular


def _largest(sapien: Any) -> float:
    """rad/s: omega after a step of a sphere that is given 1000 rad/s."""
    sphere = _Sphere(sapien, 1e3 * GIVEN).undamped()
    sphere.step(SLOWING)
    return float(np.linalg.norm(sphere.body.get_angular_velocity()))


def _slowed(sapien: Any) -> float:
    """1/s: the part of omega that a sphere loses in a step, by the step."""
    sphere = _Sphere(sapien, GIVEN)
    sphere.step(SLOWING)
    return (1.0 - float(sphere.body.get_angular_velocity()[0])) / SLOWING


def _shown(value: Any, digits: int = 6) -> str:
    """A setting, which single precision has made longer than it was written."""
    array = np.asarray(value)
    return described(np.round(array.astype(float), digits) if array.dtype.kind == "f" else value)


def conventions(sapien: Any) -> dict[str, str]:
    """As measured, name to value."""
    linear, angular = _seen(sapien)
    return {
        "linear velocity frame": axes_observed(np.round(linear, DIGITS)),
        "angular velocity frame": axes_observed(np.round(angular, DIGITS)),
        "quaternion order": "w, x, y, z" if sapien.Pose().q[0] == 1.0 else "x, y, z, w",
    }


def defaults(sapien: Any) -> dict[str, str]:
    """As they come, name to value."""
    body = sapien.physx.PhysxRigidDynamicComponent()
    found = {
        name: _shown(getattr(body, name))
        for name in ("angular_damping", "linear_damping", "max_angular_velocity", "sleep_threshold")
    }
    for kind in ("PhysxBodyConfig", "PhysxSceneConfig"):
        config = getattr(sapien.physx, kind)()
        for name in sorted(name for name in dir(config) if not name.startswith("_")):
            found[f"{kind} {name}"] = _shown(getattr(config, name))
    found["part of omega lost in 1 s, in a short step"] = _shown(_slowed(sapien), 3)
    found["largest omega, rad/s"] = _shown(_largest(sapien), 3)
    return found
