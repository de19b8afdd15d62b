"""Conventions and defaults of the installed iDynTree, measured on it, not read in documents."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import numpy as np

from omegadot.adapters.body_files import NAME
from omegadot.adapters.native_axes import (
    GIVEN,
    TURNED,
    TURNED_QUATERNION,
    axes_observed,
    described,
)
from omegadot.reference_impl.system import Array

PLACE = np.array([0.0, 0.0, 1.0])  # m, of the body's origin
STILL = np.zeros(3)
REPRESENTATIONS = ("BODY_FIXED", "MIXED", "INERTIAL_FIXED")


def _model(idyn: Any, lever: Array, pivoted: bool) -> Any:
    """A ball of 1 kg with its centre there, free or on a spherical joint."""
    model, link, inertia = idyn.Model(), idyn.Link(), idyn.SpatialInertia()
    center, unit = idyn.Position.FromPython(lever), idyn.RotationalInertia(np.eye(3))
    inertia.fromRotationalInertiaWrtCenterOfMass(1.0, center, unit)
    link.setInertia(inertia)
    if pivoted:
        model.addLink("world", idyn.Link())
        joint = idyn.SphericalJoint(idyn.Transform.Identity())
        model.addJointAndLink("world", "joint", joint, NAME, link)
    else:
        model.addLink(NAME, link)
    return model


def _seen(idyn: Any, representation: str, lever: Array, linear: Array, angular: Array) -> Array:
    """Velocity (3,) in world axes of a turned free body's centre of mass, there in the body."""
    dynamics, none = idyn.KinDynComputations(), idyn.VectorDynSize(0)
    dynamics.loadRobotModel(_model(idyn, lever, pivoted=False))
    dynamics.setFrameVelocityRepresentation(getattr(idyn, f"{representation}_REPRESENTATION"))
    twist = idyn.Twist.FromPython(np.concatenate((linear, angular)))
    place = idyn.Transform(idyn.Rotation(TURNED), idyn.Position.FromPython(PLACE))
    dynamics.setRobotState(place, none, twist, none, idyn.Vector3.FromPython(STILL))
    found: Array = dynamics.getCenterOfMassVelocity().toNumPy()
    return found


def _seen_on_joint(idyn: Any, lever: Array) -> Array:
    """The same of a turned body on a spherical joint, of which ``GIVEN`` is the velocity."""
    dynamics, vector = idyn.KinDynComputations(), idyn.VectorDynSize.FromPython
    dynamics.loadRobotModel(_model(idyn, lever, pivoted=True))
    turned = vector(np.array(TURNED_QUATERNION))
    parts = (idyn.Transform.Identity(), turned, idyn.Twist.Zero(), vector(GIVEN))
    dynamics.setRobotState(*parts, idyn.Vector3.FromPython(STILL))
    found: Array = dynamics.getCenterOfMassVelocity().toNumPy()
    return found


def _turning(velocities: Iterable[Array]) -> Array:
    """``ω = ½ Σ r × (ω × r)`` of the ends r of the body's axes, and their velocities."""
    found: Array = np.cross(TURNED.T, np.array([*velocities])).sum(axis=0) / 2
    return found


def _of_representation(idyn: Any, name: str) -> dict[str, str]:
    drawn = _seen(idyn, name, STILL, STILL, GIVEN)
    ends = [_seen(idyn, name, lever, STILL, GIVEN) - drawn for lever in np.eye(3)]
    at_origin = bool(np.all(np.abs(drawn) <= 64 * np.finfo(float).eps))
    return {
        f"{name}: linear velocity frame": axes_observed(_seen(idyn, name, STILL, GIVEN, STILL)),
        f"{name}: angular velocity frame": axes_observed(_turning(ends)),
        f"{name}: linear velocity point": "body origin" if at_origin else "the world's origin",
    }


def _articulated(idyn: Any) -> str:
    """What the articulated-body algorithm makes of a spherical joint."""
    model, traversal = _model(idyn, STILL, pivoted=True), idyn.Traversal()
    model.computeFullTreeTraversal(traversal)
    place, moving, found = (
        kind(model) for kind in (idyn.FreeFloatingPos, idyn.FreeFloatingVel, idyn.FreeFloatingAcc)
    )
    wrenches, joints = idyn.LinkWrenches(model), idyn.JointDOFsDoubleArray(model)
    buffers = idyn.ArticulatedBodyAlgorithmInternalBuffers(model)
    given = (model, traversal, place, moving, wrenches, joints, buffers, found)
    return "taken" if idyn.ArticulatedBodyAlgorithm(*given) else "refused"


def conventions(idyn: Any) -> dict[str, str]:
    """As measured, name to value."""
    first = idyn.Rotation.Identity().asQuaternion().getVal(0)
    moved = np.any(_seen(idyn, "BODY_FIXED", STILL, GIVEN, STILL))
    found = {
        "quaternion order": "w, x, y, z" if first == 1.0 else "x, y, z, w",
        "spatial vectors": "linear, angular" if moved else "angular, linear",
    }
    for name in REPRESENTATIONS:
        found |= _of_representation(idyn, name)
    ends = [_seen_on_joint(idyn, lever) for lever in np.eye(3)]
    found["spherical joint velocity frame"] = axes_observed(_turning(ends))
    found["articulated-body algorithm, spherical joint"] = _articulated(idyn)
    return found


def defaults(idyn: Any) -> dict[str, str]:
    """What new objects have, name to value."""
    dynamics, joint = idyn.KinDynComputations(), idyn.SphericalJoint()
    named = {getattr(idyn, f"{name}_REPRESENTATION"): name for name in REPRESENTATIONS}
    return {
        "velocity representation": named[dynamics.getFrameVelocityRepresentation()],
        "spherical joint damping": described(joint.getDamping(0)),
        "spherical joint static friction": described(joint.getStaticFriction(0)),
        "spherical joint limits": described(joint.hasPosLimits()),
    }
