"""Conventions and defaults of the installed Pinocchio, measured on it, not read in documents."""

from __future__ import annotations

from typing import Any

import numpy as np

from omegadot.adapters.native_axes import GIVEN, TURNED, TURNED_QUATERNION, axes_observed, described
from omegadot.reference_impl.system import Array


def _model(pin: Any, joint: Any) -> Any:
    model = pin.Model()
    model.addJoint(0, joint, pin.SE3.Identity(), "body")
    return model


def _moved(pin: Any, joint: Any, first: int, size: float) -> tuple[Any, Any]:
    """A turned body before and after `pinocchio.integrate` of a velocity ``size * GIVEN``."""
    model = _model(pin, joint)
    data, velocity = model.createData(), np.zeros(model.nv)
    velocity[first : first + 3] = size * GIVEN
    q = pin.neutral(model)
    q[-4:] = TURNED_QUATERNION
    places = []
    for configuration in (q, pin.integrate(model, q, velocity)):
        pin.forwardKinematics(model, data, configuration)
        places.append(pin.SE3(data.oMi[1]))
    return places[0], places[1]


def _shift(pin: Any, first: int) -> Array:
    before, after = _moved(pin, pin.JointModelFreeFlyer(), first, 1.0)
    shift: Array = after.translation - before.translation
    return shift


def _turn(pin: Any, joint: Any, first: int) -> Array:
    """The turn in world axes, (3,) rad: a quarter of one each, in units of a quarter."""
    _before, after = _moved(pin, joint, first, np.pi / 2)
    turn: Array = pin.log3(after.rotation @ TURNED.T) / (np.pi / 2)
    return turn


def conventions(pin: Any) -> dict[str, str]:
    """As measured, name to value."""
    neutral = pin.neutral(_model(pin, pin.JointModelSpherical()))
    linear_first = bool(np.any(_shift(pin, 0)))
    moving, turning = (0, 3) if linear_first else (3, 0)
    free = pin.JointModelFreeFlyer
    return {
        "quaternion order": "x, y, z, w" if neutral[3] == 1.0 else "w, x, y, z",
        "free-flyer velocity order": "linear, angular" if linear_first else "angular, linear",
        "free-flyer linear velocity frame": axes_observed(_shift(pin, moving)),
        "free-flyer angular velocity frame": axes_observed(_turn(pin, free(), turning)),
        "spherical joint velocity frame": axes_observed(_turn(pin, pin.JointModelSpherical(), 0)),
    }


def defaults(pin: Any) -> dict[str, str]:
    """As they come, name to value."""
    model = _model(pin, pin.JointModelFreeFlyer())
    names = ("armature", "damping", "friction", "lowerDryFrictionLimit", "rotorInertia")
    settings = {name: described(getattr(model, name)) for name in names if hasattr(model, name)}
    return {"gravity": described(model.gravity.linear), **settings}
