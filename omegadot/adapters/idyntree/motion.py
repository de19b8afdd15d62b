"""iDynTree's own forward dynamics as a motion that the reference's schemes step.

Coordinates are the reference's: q is (position, w, x, y, z) and v the spatial velocity (linear,
angular) in body axes of a free body; of a pivoted one they are (w, x, y, z) and omega.
"""

from __future__ import annotations

from types import ModuleType
from typing import Any

import numpy as np

from omegadot.adapters.idyntree.model import gyration, in_unit
from omegadot.adapters.joint_torque import joint_torque
from omegadot.adapters.protocol import Setup
from omegadot.reference_impl.arithmetic.components import rotated
from omegadot.reference_impl.one_body.body_configurations import ATTITUDE, SPATIAL
from omegadot.reference_impl.schemes import Motion
from omegadot.reference_impl.schemes.motion import Velocity
from omegadot.reference_impl.system import Array, Load

BASE = 6  # the velocities of the base, which are the first of a model


def body_motion(engine: ModuleType, model: Any, load: Load, setup: Setup) -> Motion:
    """The body's motion under its loads."""
    if load.pivot is None:
        length = gyration(model) if setup == "physics" else 1.0
        own = in_unit(engine, model, length)
        return Motion(acceleration=_articulated(engine, own, load, length), **SPATIAL)
    return Motion(acceleration=_solved(engine, model, load), **ATTITUDE)


def dynamics_of(engine: ModuleType, model: Any) -> Any:
    """`KinDynComputations` of a model, its velocities and forces in body axes."""
    of: Any = engine
    dynamics = of.KinDynComputations()
    dynamics.loadRobotModel(model)
    dynamics.setFrameVelocityRepresentation(of.BODY_FIXED_REPRESENTATION)
    return dynamics


def _articulated(engine: ModuleType, model: Any, load: Load, length: float) -> Velocity:
    """``v̇`` of a free body by the articulated-body algorithm.

    It takes no gravity: what it gives is the proper acceleration, to which g is added. It solves
    the six equations by QR without scaling them, so that its rounding depends on the unit of
    length: the model is in one of so many m.
    """
    of: Any = engine
    traversal, buffers = of.Traversal(), of.ArticulatedBodyAlgorithmInternalBuffers(model)
    model.computeFullTreeTraversal(traversal)
    place, moving, found = (
        kind(model) for kind in (of.FreeFloatingPos, of.FreeFloatingVel, of.FreeFloatingAcc)
    )
    joints, wrenches = of.JointDOFsDoubleArray(model), of.LinkWrenches(model)
    wrenches.zero()
    wrench, answer = wrenches(0), found.baseAcc
    given = (model, traversal, place, moving, wrenches, joints, buffers, found)
    aba, twist = of.ArticulatedBodyAlgorithm, of.Twist.FromPython
    torque = joint_torque(load, BASE, scalar_last=False)
    units, work = np.array([length] * 3 + [1.0] * 3), length * length
    gravity = [float(x) for x in load.gravity]
    falls = any(gravity)

    def push(values: Array) -> None:
        for n, value in enumerate(values[3:].tolist(), 3):
            wrench.setVal(n, value / work)

    if not callable(torque):
        push(torque)

    def acceleration(q: Array, v: Array) -> Array:
        moving.baseVel = twist(v / units)
        if callable(torque):
            push(torque(q, v))
        if not aba(*given):
            raise RuntimeError("iDynTree's articulated-body algorithm refuses the model.")
        proper: Array = answer.toNumPy() * units
        if falls:
            w, x, y, z = q[3:].tolist()
            proper[:3] += rotated((-w, x, y, z), gravity)
        return proper

    return acceleration


def _solved(engine: ModuleType, model: Any, load: Load) -> Velocity:
    """omega-dot of a pivoted body by mass matrix and bias forces, ``M ω̇ = τ - h``.

    The articulated-body algorithm refuses joints of several degrees of freedom.
    """
    of: Any = engine
    dynamics, count = dynamics_of(engine, model), BASE + 3
    mass, bias = of.MatrixDynSize(count, count), of.FreeFloatingGeneralizedTorques(model)
    still, rest = of.Transform.Identity(), of.Twist.Zero()
    gravity, vector = of.Vector3.FromPython(np.array(load.gravity, float)), of.VectorDynSize
    torque = joint_torque(load, 3, scalar_last=False)

    def acceleration(q: Array, v: Array) -> Array:
        dynamics.setRobotState(still, vector.FromPython(q), rest, vector.FromPython(v), gravity)
        dynamics.getFreeFloatingMassMatrix(mass)
        dynamics.generalizedBiasForces(bias)
        applied = torque(q, v) if callable(torque) else torque
        left = applied - bias.jointTorques().toNumPy()
        found: Array = np.linalg.solve(mass.toNumPy()[BASE:, BASE:], left)
        return found

    return acceleration
