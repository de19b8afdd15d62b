"""Conventions and defaults of the installed MJX, measured on it, not read in its documents."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from omegadot.adapters.mjx.model import Engine
from omegadot.adapters.mujoco.model import BODY
from omegadot.adapters.mujoco.native import offset_body
from omegadot.adapters.native_axes import GIVEN, TURNED_QUATERNION, axes_observed, described
from omegadot.reference_impl.system import Array

FREE, BALL = "mjJNT_FREE", "mjJNT_BALL"


def _model(engine: Engine, joint: str) -> Any:
    return engine.mjx.put_model(offset_body(engine.mujoco, joint))


def _seen(engine: Engine, joint: str, first: int) -> tuple[Array, Array]:
    """Angular and linear velocity of the body's origin, (3,) each, in world axes, where the
    joint's velocities from `first` on are ``GIVEN``.
    """
    model = _model(engine, joint)
    data = engine.mjx.make_data(model)
    data = data.replace(
        qpos=data.qpos.at[-4:].set(np.array(TURNED_QUATERNION)),
        qvel=data.qvel.at[first : first + 3].set(GIVEN),
    )
    data = engine.jax.jit(engine.mjx.forward)(model, data)
    turning, moving = np.split(np.array(data.cvel[BODY], float), 2)  # of the centre of mass
    arm = np.array(data.subtree_com[BODY] - data.xpos[BODY], float)
    return turning, moving - np.cross(turning, arm)


def conventions(engine: Engine) -> dict[str, str]:
    """As measured, name to value."""
    engine = replace(engine, precision="float64")
    with engine.active():
        (turning, still), (_, moving) = _seen(engine, FREE, 3), _seen(engine, FREE, 0)
        ball, scalar_first = _seen(engine, BALL, 0)[0], _model(engine, FREE).qpos0[3] == 1.0
    at_rest = np.all(np.abs(still) <= 64 * np.finfo(float).eps)
    return {
        "quaternion order": "w, x, y, z" if scalar_first else "x, y, z, w",
        "free joint angular velocity frame": axes_observed(turning),
        "free joint linear velocity frame": axes_observed(moving),
        "free joint linear velocity point": "body origin" if at_rest else "another point",
        "ball joint angular velocity frame": axes_observed(ball),
    }


def defaults(engine: Engine) -> dict[str, str]:
    """The options of a new model, name to value, and the precision that JAX has by itself."""
    with replace(engine, precision="float64").active():
        option = _model(engine, FREE).opt
        found = {
            name: getattr(value, "name", None) or described(value)  # a flag of none has no name
            for name in sorted(field.name for field in option.fields())
            if not name.startswith("_") and (value := getattr(option, name)) is not None
        }
    found["jax_enable_x64"] = str(engine.jax.config.jax_enable_x64)
    return found
