"""Conventions and defaults of the installed MuJoCo, measured on it, not read in its documents."""

from __future__ import annotations

from typing import Any

import numpy as np

from omegadot.adapters.native_axes import GIVEN, TURNED_QUATERNION, axes_observed, described
from omegadot.reference_impl.system import Array

# Settings that are numbers of an enumeration, and the enumeration.
_ENUMERATED = {
    "integrator": "mjtIntegrator",
    "cone": "mjtCone",
    "jacobian": "mjtJacobian",
    "solver": "mjtSolver",
}


def offset_body(mujoco: Any, joint: str) -> Any:
    """A body on a joint, its centre of mass off its origin."""
    spec = mujoco.MjSpec()
    body = spec.worldbody.add_body(name="body")
    body.add_joint(type=getattr(mujoco.mjtJoint, joint))
    body.explicitinertial, body.mass, body.inertia = True, 1.0, np.ones(3)
    body.ipos = np.array([0.0, 0.0, 0.5])
    return spec.compile()


def _seen(mujoco: Any, joint: str, first: int) -> Array:
    """Angular and linear velocity (6,) of the body's origin in world axes where the joint's
    velocities from `first` on are ``GIVEN``.
    """
    model = offset_body(mujoco, joint)
    data = mujoco.MjData(model)
    data.qpos[-4:] = TURNED_QUATERNION
    data.qvel[first : first + 3] = GIVEN
    mujoco.mj_forward(model, data)
    found, origin = np.empty(6), int(mujoco.mjtObj.mjOBJ_XBODY)
    mujoco.mj_objectVelocity(model, data, origin, 1, found, 0)
    return found


def conventions(mujoco: Any) -> dict[str, str]:
    """As measured, name to value."""
    free, ball = "mjJNT_FREE", "mjJNT_BALL"
    turning, moving = _seen(mujoco, free, 3), _seen(mujoco, free, 0)
    at_rest = np.all(np.abs(turning[3:]) <= 64 * np.finfo(float).eps)
    scalar_first = offset_body(mujoco, free).qpos0[3] == 1.0
    return {
        "quaternion order": "w, x, y, z" if scalar_first else "x, y, z, w",
        "free joint angular velocity frame": axes_observed(turning[:3]),
        "free joint linear velocity frame": axes_observed(moving[3:]),
        "free joint linear velocity point": "body origin" if at_rest else "another point",
        "ball joint angular velocity frame": axes_observed(_seen(mujoco, ball, 0)[:3]),
    }


def defaults(mujoco: Any) -> dict[str, str]:
    """Every option of a new model, name to value."""
    option = offset_body(mujoco, "mjJNT_FREE").opt
    found = {}
    for name in sorted(dir(option)):
        value = getattr(option, name)
        if name.startswith("_") or callable(value):
            continue
        enumeration = getattr(mujoco, _ENUMERATED.get(name, ""), None)
        found[name] = described(value) if enumeration is None else enumeration(value).name
    return found
