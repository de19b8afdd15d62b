"""The schemes by name: one a file, and those that are a method on a chart of the attitude."""

from __future__ import annotations

from omegadot.reference_impl.schemes import (
    body_axes_midpoint,
    frozen_torque_midpoint,
    implicit_damping_euler,
    implicit_midpoint,
    lie_rk4,
    lie_rk4_naive,
    linearly_implicit_euler,
    munthe_kaas,
    rescaled_momentum_euler,
    rescaled_momentum_substeps,
    rk4_quaternion,
    semi_implicit_euler,
    short_turns_euler,
)
from omegadot.reference_impl.schemes.charted import CHARTED
from omegadot.reference_impl.schemes.motion import Motion
from omegadot.reference_impl.schemes.scheme import Scheme

COMMON: dict[str, Scheme] = {
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
        munthe_kaas,
        lie_rk4_naive,
        implicit_midpoint,
        frozen_torque_midpoint,
        body_axes_midpoint,
    )
}
"""Those that any engine may step, and that are tried where none is declared."""

SCHEMES: dict[str, Scheme] = COMMON | {one.name: one for one in (*munthe_kaas.OTHERS, *CHARTED)}
"""All that may be declared. The others are of coordinates that an engine is known to have."""

__all__ = ["COMMON", "SCHEMES", "Motion", "Scheme"]
