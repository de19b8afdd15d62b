"""Drake stepped through pydrake: `Simulator.AdvanceTo`, the state at samples."""

from __future__ import annotations

import numpy as np
from bare import Bare
from pydrake.multibody.plant import MultibodyPlant
from pydrake.multibody.tree import QuaternionFloatingJoint, RotationalInertia, SpatialInertia
from pydrake.systems.analysis import ResetIntegratorFromFlags, Simulator

from omegadot.adapters.drake.integrators import PLANS
from omegadot.reference_impl.rotations import rotate
from omegadot.reference_impl.system import Array, State, System


def loops(
    system: System, initial: State, integrator: str, timestep: float, steps: int, every: int
) -> list[Bare]:
    """A loop from sample to sample, of fixed steps of a free body without damping or torque."""
    load, body, plan = system.load, system.body, PLANS[integrator]
    loaded = bool(load.damping) or bool(np.any(load.torque_body) or np.any(load.torque_world))
    if load.pivot is not None or loaded or not plan.fixed or plan.solves:
        return []
    plant = MultibodyPlant(0.0 if plan.scheme else timestep)
    tensor = np.asarray(body.inertia, float)
    inertia = RotationalInertia(*np.diagonal(tensor), *tensor[[0, 0, 1], [1, 2, 2]])
    center = np.asarray(body.center_of_mass, float)
    held = SpatialInertia.MakeFromCentralInertia(float(body.mass), center, inertia)
    link = plant.AddRigidBody("body", held)
    plant.AddJoint(QuaternionFloatingJoint("joint", plant.world_frame(), link.body_frame()))
    plant.mutable_gravity_field().set_gravity_vector(np.asarray(load.gravity, float))
    plant.Finalize()
    simulator = Simulator(plant)
    if plan.scheme:
        own = ResetIntegratorFromFlags(simulator, plan.scheme, timestep)
        own.set_fixed_step_mode(True)
    context = simulator.get_mutable_context()
    q, w = np.asarray(initial.orientation, float), initial.angular_velocity
    place = initial.position - rotate(q, center)
    velocity = initial.linear_velocity - rotate(q, np.cross(w, center))
    beginning = np.concatenate((q, place, rotate(q, w), velocity))

    def start() -> None:
        context.SetTime(0.0)
        plant.SetPositionsAndVelocities(context, beginning)
        simulator.Initialize()

    def run() -> list[Array]:
        samples: list[Array] = []
        keep, advance = samples.append, simulator.AdvanceTo
        state = plant.GetPositionsAndVelocities
        for number in range(every, steps + 1, every):
            advance(number * timestep)
            keep(state(context))
        return samples

    def omega() -> Array:
        found = plant.GetPositionsAndVelocities(context)
        inverse = found[:4] / np.linalg.norm(found[:4]) * np.array([1.0, -1.0, -1.0, -1.0])
        spin: Array = rotate(inverse, found[7:10])
        return spin

    return [Bare("AdvanceTo", start, run, omega)]
