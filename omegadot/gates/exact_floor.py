"""The resolvable floor of every channel: how far a perfect answer in double may be off."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from omegadot.gates.rows import Row
from omegadot.gates.scales import EPS
from omegadot.gates.truth import Truth
from omegadot.reference_impl.motion import forward_dynamics
from omegadot.reference_impl.rotations import turn_in_body
from omegadot.reference_impl.system import Array, State, System

# rad: a turn small enough for the attitude's part to be linear, to a part in a million.
_ANGLE = 1e-3
UNITS = {
    "omega_dot": "rad/s^2",
    "omega": "1",
    "attitude": "rad",
    "energy": "1",
    "angular_momentum": "1",
    "linear_momentum": "1",
}


def floors(truth: Truth) -> dict[str, Array]:
    """(n,) per channel, at the truth's times; omega_dot in rad/s^2, the others as in `UNITS`.

    That of omega and attitude is the exact solution's own. The others follow to first order: the
    invariants as rounding's does (`Yardstick.round_off`), velocities and positions being off by
    one rounding; omega-dot by its derivatives in omega and in the attitude.
    """
    yardstick, omega, attitude = truth.yardstick, truth.floor["omega"], truth.floor["attitude"]
    by_omega, by_attitude = slopes(yardstick.system, truth.state, yardstick.rate)
    theta = np.maximum(omega, attitude)
    speed = EPS * yardstick.speed + theta * yardstick.rate * yardstick.scale.lever
    reach = EPS * yardstick.reach + theta * yardstick.scale.lever
    return {
        **truth.floor,
        "omega_dot": by_omega * yardstick.rate * (omega + EPS) + by_attitude * (attitude + EPS),
        **yardstick.invariant_round_off(theta + EPS, speed, reach),
    }


def slopes(system: System, state: State, rate: float) -> tuple[Array, Array]:
    """(n,) 1/s and (n,) rad/s^2: how fast omega-dot changes with omega and, by rad, with attitude.

    Spectral norms of central differences: exact in omega, in which omega-dot is quadratic.
    """

    def faster(change: Array) -> State:
        return replace(state, angular_velocity=state.angular_velocity + change)

    def turned(change: Array) -> State:
        return replace(state, orientation=turn_in_body(state.orientation, change, 1.0))

    def spectral(changed: Callable[[Array], State], size: float) -> Array:
        ends = [
            forward_dynamics(system, changed(+size * axis)).angular
            - forward_dynamics(system, changed(-size * axis)).angular
            for axis in np.eye(3)
        ]
        columns = np.stack(ends, axis=-1) / (2.0 * size)
        return np.asarray(np.linalg.norm(columns, 2, axis=(-2, -1)))

    return spectral(faster, rate), spectral(turned, _ANGLE)


def floor_rows(truth: Truth) -> list[Row]:
    """The resolvable floor at its largest: below it no answer in double can be judged."""
    return [
        Row("trajectory", channel, "resolvable_floor", float(np.max(values)), UNITS[channel])
        for channel, values in floors(truth).items()
    ]
