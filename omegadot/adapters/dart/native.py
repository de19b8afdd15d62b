"""Conventions and defaults of the installed DART, measured on it, not read in its documents."""

from __future__ import annotations

from typing import Any

import numpy as np

from omegadot.adapters.native_axes import GIVEN, TURNED, axes_observed, described
from omegadot.reference_impl.system import Array

SMALL_TURN = 5e-4  # rad, below the 1e-3 rad where some versions expand a turn


def _body(dart: Any, kind: str) -> tuple[Any, Any, Any]:
    skeleton = dart.dynamics.Skeleton()
    joint, node = getattr(skeleton, f"create{kind}AndBodyNodePair")()
    return skeleton, joint, node


def _seen(dart: Any, kind: str, first: int) -> tuple[Array, Array]:
    """Angular and linear velocity in world axes where the joint's velocities from `first` on are
    ``GIVEN``.
    """
    _skeleton, joint, node = _body(dart, kind)  # the skeleton must outlive its parts
    free = kind == "FreeJoint"
    place = dart.math.Isometry3(TURNED, np.zeros(3)) if free else TURNED
    joint.setPositions(joint.convertToPositions(place))
    velocities = np.zeros(joint.getNumDofs())
    velocities[first : first + 3] = GIVEN
    joint.setVelocities(velocities)
    world = dart.dynamics.Frame.World()
    return node.getAngularVelocity(world, world), node.getLinearVelocity(world, world)


def conventions(dart: Any) -> dict[str, str]:
    """As measured, name to value."""
    angular, linear = _seen(dart, "FreeJoint", 0)
    angular_first = np.any(angular) and not np.any(linear)
    turning = 0 if angular_first else 3
    return {
        "FreeJoint velocity order": "angular, linear" if angular_first else "linear, angular",
        "FreeJoint velocity frame": axes_observed(_seen(dart, "FreeJoint", turning)[0]),
        "FreeJoint linear velocity frame": axes_observed(_seen(dart, "FreeJoint", 3 - turning)[1]),
        "BallJoint velocity frame": axes_observed(_seen(dart, "BallJoint", 0)[0]),
        "turns below 1e-3 rad": _small_turn(dart),
        "acceleration at a velocity that is not finite": _after_overflow(dart),
    }


def _small_turn(dart: Any) -> str:
    """Whether a turn r is taken as ``1 + [r] + [r]^2 / 2``, off by r^3 / 6, or as it is."""
    _skeleton, joint, node = _body(dart, "BallJoint")
    joint.setPositions(SMALL_TURN * GIVEN)
    rotation = node.getTransform().rotation()
    off = abs(float(rotation[2, 1]) - np.sin(SMALL_TURN))
    return "exact" if off <= 64 * np.finfo(float).eps else "expanded to second order"


def _after_overflow(dart: Any) -> str:
    skeleton, joint, _ = _body(dart, "BallJoint")
    joint.setVelocities(np.full(3, np.inf))
    skeleton.computeForwardDynamics()
    found = joint.getAccelerations()
    return "not finite" if not np.all(np.isfinite(found)) else described(found)


def defaults(dart: Any) -> dict[str, str]:
    """As they come, name to value."""
    world = dart.simulation.World()
    _skeleton, joint, node = _body(dart, "FreeJoint")
    inertia = node.getInertia()
    return {
        "World time step": described(world.getTimeStep()),
        "World gravity": described(world.getGravity()),
        "deactivation of slow bodies": _deactivation(world),
        "joint limits enforced": _answer(joint, "areLimitsEnforced", "isPositionLimitEnforced"),
        "constraint solver": type(world.getConstraintSolver()).__name__,
        "BodyNode mass": described(inertia.getMass()),
        "BodyNode inertia": described(inertia.getMoment()),
    }


def _answer(owner: Any, *names: str) -> str:
    """What the first of these calls that there is answers; some versions rename them."""
    name = next((name for name in names if hasattr(owner, name)), None)
    return "no such setting" if name is None else described(getattr(owner, name)())


def _deactivation(world: Any) -> str:
    if not hasattr(world, "getDeactivationOptions"):
        return "no such setting"
    options = world.getDeactivationOptions()
    names = [name for name in dir(options) if name.startswith("m") and name != "mEnabled"]
    values = ", ".join(f"{name} {described(getattr(options, name))}" for name in sorted(names))
    return f"{'on' if options.mEnabled else 'off'} ({values})"
