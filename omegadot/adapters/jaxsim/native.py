"""Conventions and defaults of the installed JaxSim, measured on it, not read in its documents."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from omegadot.adapters.jaxsim.model import Engine, described_model
from omegadot.adapters.native_axes import (
    GIVEN,
    TURNED_QUATERNION,
    axes_observed,
    described,
)
from omegadot.reference_impl.rotations import conjugate, quaternion_product
from omegadot.reference_impl.system import Array

PLACE = np.array([0.0, 0.0, 1.0])  # m, of the body's origin
REPRESENTATIONS = ("Mixed", "Body", "Inertial")


def _seen(engine: Engine, model: Any, representation: str, turning: bool) -> tuple[Array, Array]:
    """Omega and the velocity of the body's origin, (3,) each, in world axes, where the angular or
    the linear velocity in a representation is ``GIVEN``.

    By the rates of position and quaternion: omega is ``2 Q̇ Q*``.
    """
    still = np.zeros(3)
    data = engine.api.data.JaxSimModelData.build(
        model,
        base_position=PLACE,
        base_quaternion=np.array(TURNED_QUATERNION),
        base_linear_velocity=still if turning else GIVEN,
        base_angular_velocity=GIVEN if turning else still,
        velocity_representation=engine.jaxsim.VelRepr[representation],
    )
    with data.switch_velocity_representation(engine.jaxsim.VelRepr.Inertial):
        moved, turned, _ = engine.api.ode.system_position_dynamics(data)
    rate = 2.0 * quaternion_product(np.array(turned), conjugate(np.array(TURNED_QUATERNION)))
    return rate[1:], np.array(moved)


def conventions(engine: Engine) -> dict[str, str]:
    """As measured, name to value."""
    engine = replace(engine, precision="float64")
    found, model = {}, described_model(engine)
    with engine.active():
        zero = engine.api.data.JaxSimModelData.zero(model)
        scalar_first = float(zero.base_quaternion[0]) == 1.0
        for name in REPRESENTATIONS:
            (omega, drawn), (_, velocity) = (_seen(engine, model, name, t) for t in (True, False))
            at_rest = np.all(np.abs(drawn) <= 64 * np.finfo(float).eps)
            point = "body origin" if at_rest else "the point at the world's origin"
            found[f"{name}: angular velocity frame"] = axes_observed(omega)
            found[f"{name}: linear velocity frame"] = axes_observed(velocity)
            found[f"{name}: linear velocity point"] = point
        _, _, falling = np.array(engine.api.model.forward_dynamics(model, zero)[0][:3], float)
    return {
        "quaternion order": "w, x, y, z" if scalar_first else "x, y, z, w",
        "gravity": f"{described(falling)} m/s^2 along z",
        **found,
    }


def defaults(engine: Engine) -> dict[str, str]:
    """What a new model and new data have, name to value."""
    engine = replace(engine, precision="float64")
    model = described_model(engine)
    with engine.active():
        data = engine.api.data.JaxSimModelData.zero(model)
        return {
            "time_step": described(model.time_step),
            "gravity": described(model.gravity),
            "integrator": model.integrator.name,
            "contact_model": type(model.contact_model).__name__,
            "velocity_representation": data.velocity_representation.name,
        }
