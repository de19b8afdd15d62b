"""Conventions and defaults of the installed OpenSim, measured on it, not read in its documents."""

from __future__ import annotations

from typing import Any

import numpy as np

from omegadot.adapters.native_axes import GIVEN, axes_observed, described
from omegadot.adapters.opensim.charts import WORLD
from omegadot.adapters.opensim.model import array, attitude

TURNED_ANGLES = (0.5 * np.pi, 0.5 * np.pi, 0.0)  # of `native_axes.TURNED`


def _seen(opensim: Any, kind: str, first: int) -> tuple[Any, Any]:
    """Angular and linear velocity in world axes where a joint's speeds from `first` on are
    ``GIVEN``.
    """
    model, body = opensim.Model(), _body(opensim)
    model.addBody(body)
    model.addJoint(getattr(opensim, kind)("joint", model.getGround(), body))
    state = model.initSystem()
    y = np.zeros(state.getNY())
    y[:3] = TURNED_ANGLES
    y[state.getNQ() + first :][:3] = GIVEN
    state.setY(opensim.Vector.createFromMat(y))
    model.realizeVelocity(state)
    spin = array(body.getAngularVelocityInGround(state))
    return spin, array(body.getLinearVelocityInGround(state))


def _body(opensim: Any) -> Any:
    return opensim.Body("body", 1.0, opensim.Vec3(0.0), opensim.Inertia(1.0, 1.0, 1.0))


def conventions(opensim: Any) -> dict[str, str]:
    """As measured, name to value."""
    angular, linear = _seen(opensim, "FreeJoint", 0)
    return {
        "FreeJoint speeds": "angular, linear" if angular.any() and not linear.any() else "another",
        "FreeJoint angular velocity frame": axes_observed(angular),
        "FreeJoint linear velocity frame": axes_observed(_seen(opensim, "FreeJoint", 3)[1]),
        "BallJoint velocity frame": axes_observed(_seen(opensim, "BallJoint", 0)[0]),
        "angles": _order(opensim),
    }


def _order(opensim: Any) -> str:
    """Whether the angles are those of ``R = Rx Ry Rz``."""
    model, body, given = opensim.Model(), _body(opensim), np.array([0.3, 0.5, 0.2])
    model.addBody(body)
    model.addJoint(opensim.BallJoint("joint", model.getGround(), body))
    state = model.initSystem()
    state.setY(opensim.Vector.createFromMat(np.array([*given, 0.0, 0.0, 0.0, 0.0])))
    model.realizePosition(state)
    seen = WORLD.angles_of(attitude(body, state))
    close = np.all(np.abs(seen - given) <= 64 * np.finfo(float).eps)
    return "R = Rx Ry Rz" if close else f"another order: {described(seen)}"


def defaults(opensim: Any) -> dict[str, str]:
    """As they come, name to value."""
    model = opensim.Model()
    model.initSystem()
    methods = {
        value: name.removeprefix("IntegratorMethod_")
        for name, value in vars(opensim.Manager).items()
        if name.startswith("IntegratorMethod_")
    }
    manager = opensim.Manager(model)
    return {
        "Manager integrator": methods.get(manager.getIntegratorMethod(), "another"),
        "gravity": described(array(model.getGravity())),
        "assembly_accuracy": described(model.get_assembly_accuracy()),
        "log level": str(opensim.Logger.getLevelString()),
    }
