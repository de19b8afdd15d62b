"""The schemes, one a file, by name."""

from __future__ import annotations

from omegadot.reference_impl.schemes import (
    body_axes_midpoint,
    frozen_torque_midpoint,
    implicit_damping_euler,
    implicit_midpoint,
    lie_rk4,
    lie_rk4_naive,
    linearly_implicit_euler,
    munthe_kaas_rk4,
    rescaled_momentum_euler,
    rescaled_momentum_substeps,
    rk4_quaternion,
    semi_implicit_euler,
    short_turns_euler,
)
from omegadot.reference_impl.schemes.motion import Motion
from omegadot.reference_impl.schemes.scheme import Scheme

SCHEMES: dict[str, Scheme] = {
    module.SCHEME.name: module.SCHEME
    for module in (
        semi_implicit_euler,
        short_turns_euler,
        implicit_damping_euler,
        linearly_implicit_euler,
        rescaled_momentum_euler,
        rescaled_momentum_substeps,
        rk4_quaternion,
        lie_rk4,
        munthe_kaas_rk4,
        lie_rk4_naive,
        implicit_midpoint,
        frozen_torque_midpoint,
        body_axes_midpoint,
    )
}

__all__ = ["SCHEMES", "Motion", "Scheme"]
