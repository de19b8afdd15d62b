"""Conventions and defaults of the installed Drake, measured on it, not read in its documents."""

from __future__ import annotations

from typing import Any

import numpy as np

from omegadot.adapters.native_axes import GIVEN, TURNED_QUATERNION, axes_observed, described
from omegadot.reference_impl.system import Array


def _plant(drake: Any, kind: str) -> tuple[Any, Any, Any]:
    """A plant, its body and a context, on a joint of this kind."""
    plant = drake.MultibodyPlant(0.0)
    inertia = drake.SpatialInertia.SolidBoxWithMass(1.0, 1.0, 1.0, 1.0)
    body = plant.AddRigidBody("body", inertia)
    plant.AddJoint(getattr(drake, kind)("joint", plant.world_frame(), body.body_frame()))
    plant.Finalize()
    return plant, body, plant.CreateDefaultContext()


def _seen(drake: Any, kind: str, first: int) -> tuple[Array, Array]:
    """Angular and linear velocity in world axes where a plant's velocities from `first` on are
    ``GIVEN``.
    """
    plant, body, context = _plant(drake, kind)
    positions = np.zeros(plant.num_positions())
    if plant.num_positions() == 7:
        positions[:4] = TURNED_QUATERNION
    else:
        positions[:] = drake.RollPitchYaw(drake.Quaternion(TURNED_QUATERNION)).vector()
    velocities = np.zeros(plant.num_velocities())
    velocities[first : first + 3] = GIVEN
    plant.SetPositionsAndVelocities(context, np.concatenate((positions, velocities)))
    found = plant.EvalBodySpatialVelocityInWorld(context, body)
    return found.rotational(), found.translational()


def conventions(drake: Any) -> dict[str, str]:
    """As measured, name to value."""
    free, ball = "QuaternionFloatingJoint", "BallRpyJoint"
    angular, linear = _seen(drake, free, 0)
    angular_first = bool(np.any(angular) and not np.any(linear))
    turning = 0 if angular_first else 3
    plant, _, context = _plant(drake, free)
    scalar_first = plant.GetPositions(context)[0] == 1.0
    return {
        "quaternion order": "w, x, y, z" if scalar_first else "x, y, z, w",
        f"{free} velocity order": "angular, linear" if angular_first else "linear, angular",
        f"{free} angular velocity frame": axes_observed(_seen(drake, free, turning)[0]),
        f"{free} linear velocity frame": axes_observed(_seen(drake, free, 3 - turning)[1]),
        f"{ball} velocity frame": axes_observed(_seen(drake, ball, 0)[0]),
        "quaternion after a step": _after_a_step(drake),
    }


def _after_a_step(drake: Any) -> str:
    """Whether a discrete step leaves the quaternion's length as it was."""
    plant = drake.MultibodyPlant(0.1)
    plant.AddRigidBody("body", drake.SpatialInertia.SolidBoxWithMass(1.0, 1.0, 1.0, 1.0))
    plant.Finalize()
    simulator = drake.Simulator(plant)
    context = simulator.get_mutable_context()
    plant.SetVelocities(context, np.tile(GIVEN, 2))
    simulator.AdvanceTo(0.1)
    length = float(np.linalg.norm(plant.GetPositions(context)[:4]))
    return "unit" if abs(length - 1.0) <= 64 * np.finfo(float).eps else "of another length"


def defaults(drake: Any) -> dict[str, str]:
    """As they come, name to value."""
    found = {}
    config = drake.MultibodyPlantConfig()
    for name in sorted(name for name in dir(config) if not name.startswith("_")):
        value = getattr(config, name)
        if not callable(value):
            found[f"MultibodyPlantConfig {name}"] = described(value)
    plain = drake.SimulatorConfig()
    found["Simulator integrator"] = str(plain.integration_scheme)
    found["Simulator accuracy"] = described(plain.accuracy)
    found["Simulator largest step"] = described(plain.max_step_size)
    gravity = drake.MultibodyPlant(0.0).gravity_field().gravity_vector()
    found["gravity"] = described(gravity)
    return found
