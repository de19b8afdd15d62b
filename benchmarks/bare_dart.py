"""DART stepped through dartpy: `World.step` in a loop, the joint's coordinates at samples."""

from __future__ import annotations

from collections.abc import Callable
from itertools import repeat
from typing import Any

import dartpy
import numpy as np
from bare import Bare

from omegadot.reference_impl.rotations import rotation_matrix
from omegadot.reference_impl.system import Array, State, System


def _world(system: System, timestep: float) -> tuple[Any, Any, Any]:
    body, load = system.body, system.load
    world, skeleton = dartpy.simulation.World(), dartpy.dynamics.Skeleton()
    world.setTimeStep(timestep)
    world.setGravity(np.asarray(load.gravity, float))
    if load.pivot is None:
        joint, node = skeleton.createFreeJointAndBodyNodePair()
    else:
        joint, node = skeleton.createBallJointAndBodyNodePair()
        pivot = dartpy.math.Isometry3(np.eye(3), np.asarray(load.pivot, float))
        joint.setTransformFromChildBodyNode(pivot)
    inertia = dartpy.dynamics.Inertia(float(body.mass), body.center_of_mass, body.inertia)
    node.setInertia(inertia)
    world.addSkeleton(skeleton)
    options = world.getDeactivationOptions()
    options.mEnabled = False
    world.setDeactivationOptions(options)
    return world, joint, node


def loops(
    system: System, initial: State, _: str, timestep: float, steps: int, every: int
) -> list[Bare]:
    """A loop for each way to apply the load; steps is a multiple of every."""
    world, joint, node = _world(system, timestep)
    frame = dartpy.dynamics.Frame.World()

    def start() -> None:
        world_R_body, w = rotation_matrix(initial.orientation), initial.angular_velocity
        node.clearExternalForces()
        joint.resetForces()
        if system.load.pivot is not None:
            joint.setPositions(joint.convertToPositions(world_R_body))
            joint.setVelocities(w)
            return
        arm = system.body.center_of_mass
        origin = initial.position - world_R_body @ arm
        joint.setTransform(dartpy.math.Isometry3(world_R_body, origin))
        velocity = initial.linear_velocity @ world_R_body - np.cross(w, arm)
        joint.setSpatialVelocity(np.concatenate([w, velocity]), frame, node)

    def omega() -> Array:
        found: Array = node.getCOMSpatialVelocity()[:3]
        return found

    ways = _ways(system, joint, node)
    return [
        Bare(name, start, _stepper(world, joint, push, once, steps, every), omega)
        for name, (once, push) in ways.items()
    ]


Call = Callable[[], object]


def _ways(system: System, joint: Any, node: Any) -> dict[str, tuple[Call, Call | None]]:
    """What is called once before a run, and what before each step."""
    load = system.load
    torque_body, torque_world = load.torque_body, load.torque_world
    if load.damping:
        turning = np.zeros(joint.getNumDofs())
        turning[:3] = -load.damping
        against = turning[:3]
        velocities, twist = joint.getVelocities, node.getCOMSpatialVelocity
        put, apply = joint.setForces, node.setExtTorque
        return {
            "step, setForces": (list, lambda: put(turning * velocities())),
            "step, setExtTorque": (list, lambda: apply(against * twist()[:3], True)),
        }
    if np.any(torque_world):
        apply = node.setExtTorque
        return {"step, setExtTorque": (list, lambda: apply(torque_world, False))}
    if np.any(torque_body):
        return {"step(False)": (lambda: node.setExtTorque(torque_body, True), None)}
    return {"step(False)": (list, None)}


def _stepper(
    world: Any, joint: Any, push: Call | None, once: Call, steps: int, every: int
) -> Callable[[], list[Array]]:
    def run() -> list[Array]:
        samples: list[Array] = []
        keep, step = samples.append, world.step
        positions, velocities = joint.getPositions, joint.getVelocities
        once()
        if push is not None:
            for _ in repeat(None, steps // every):
                for _ in repeat(None, every):
                    push()
                    step(False)
                keep(positions())
                keep(velocities())
        elif every == 1:
            for _ in repeat(None, steps):
                step(False)
                keep(positions())
                keep(velocities())
        else:
            for _ in repeat(None, steps // every):
                for _ in repeat(None, every):
                    step(False)
                keep(positions())
                keep(velocities())
        return samples

    return run
