"""Conventions and defaults of the installed biorbd, measured on it, not read in its documents."""

from __future__ import annotations

from typing import Any

import numpy as np

from omegadot.adapters.biorbd.model import SEGMENT, build_model
from omegadot.adapters.native_axes import (
    GIVEN,
    TURNED,
    TURNED_QUATERNION,
    axes_observed,
    described,
)
from omegadot.reference_impl.system import Array, Body, Load, System

PLACE = np.array([0.0, 0.0, 1.0])  # m, of the body's origin
HALF = np.array(0.5)  # N m s


def _ball(biorbd: Any, lever: Array, load: Load) -> Any:
    """A ball of 1 kg with its centre there."""
    system = System((Body(np.array(1.0), lever, np.eye(3)),), load)
    return build_model(biorbd, system, damped=True)


def _seen(biorbd: Any, lever: Array, linear: Array, angular: Array) -> Array:
    """Velocity (3,) in world axes of a turned free body's centre of mass, there in the body."""
    q = np.concatenate((PLACE, TURNED_QUATERNION))
    v = np.concatenate((linear, angular))
    found: Array = _ball(biorbd, lever, Load()).CoMdot(q, v).to_array()
    return found


def _turning(biorbd: Any) -> Array:
    """``ω = ½ Σ r x (ω x r)`` of the ends r of the body's axes, and their velocities."""
    still = np.zeros(3)
    velocities = [_seen(biorbd, lever, still, GIVEN) for lever in np.eye(3)]
    found: Array = np.cross(TURNED.T, np.array(velocities)).sum(axis=0) / 2
    return found


def _torques(biorbd: Any) -> Array:
    """Of `InverseDynamics` of a pivoted ball that is damped and not accelerated."""
    model = _ball(biorbd, np.zeros(3), Load(pivot=np.zeros(3), damping=HALF))
    q = np.array([0.0, 0.0, 0.0, 1.0])
    found: Array = model.InverseDynamics(q, GIVEN, np.zeros(3)).to_array()
    return found


def conventions(biorbd: Any) -> dict[str, str]:
    """As measured, name to value."""
    model, still = _ball(biorbd, np.zeros(3), Load()), np.zeros(3)
    straight = np.concatenate((PLACE, (0.0, 0.0, 0.0, 1.0)))
    frame = model.globalJCS(straight, SEGMENT).to_array()[:3, :3]
    upright = bool(np.array_equal(frame, np.eye(3)))
    answered = model.ForwardDynamics(straight, np.zeros(6), np.zeros(6)).to_array()
    spin = model.segmentAngularVelocity(
        np.concatenate((PLACE, TURNED_QUATERNION)), np.concatenate((still, GIVEN)), SEGMENT
    )
    in_world = bool(np.allclose(spin.to_array(), TURNED @ GIVEN, atol=1e-12))
    sign = "subtracted" if _torques(biorbd)[0] < 0 else "added"
    return {
        "quaternion order": "x, y, z, w" if upright else "w, x, y, z",
        "linear velocity frame": axes_observed(_seen(biorbd, still, GIVEN, still)),
        "angular velocity frame": axes_observed(_turning(biorbd)),
        "segmentAngularVelocity frame": "world axes" if in_world else "body axes",
        "numbers that ForwardDynamics answers with, of 6": described(len(answered)),
        "damping in InverseDynamics": sign,
    }


def defaults(biorbd: Any) -> dict[str, str]:
    """What new objects have, name to value."""
    model = biorbd.Model()
    return {"gravity": described(np.array(model.getGravity().to_array()))}
