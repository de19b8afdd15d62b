"""The exact solution through the gates: what must be constant is, and the floor of every channel.

The resolvable floor is how far a perfect answer in double may be off.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from omegadot.gates.bounds.measures import INVARIANT_CHANNELS
from omegadot.gates.case import Case, Sweep
from omegadot.gates.errors.measured_run import MeasuredRun
from omegadot.gates.errors.verdicts import Finding
from omegadot.gates.rows import Row
from omegadot.gates.runs import invariants
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
    yardstick, eps = truth.yardstick, truth.yardstick.eps
    omega, attitude = truth.floor["omega"], truth.floor["attitude"]
    by_omega, by_attitude = slopes(yardstick.system, truth.state, yardstick.rate)
    theta = np.maximum(omega, attitude)
    speed = eps * yardstick.speed + theta * yardstick.rate * yardstick.scale.lever
    reach = eps * yardstick.reach + theta * yardstick.scale.lever
    return {
        **truth.floor,
        "omega_dot": by_omega * yardstick.rate * (omega + eps) + by_attitude * (attitude + eps),
        **yardstick.invariant_round_off(theta + eps, speed, reach),
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


def conserved_channels(case: Case) -> tuple[str, ...]:
    """The invariants that this load leaves constant."""
    load = case.system.load
    turned = np.any(load.torque_body) or np.any(load.torque_world) or float(load.damping) != 0.0
    falls = bool(np.any(load.gravity))
    if turned:
        return () if falls or load.pivot is not None else ("linear_momentum",)
    if load.pivot is not None:
        return ("energy",) if falls else ("energy", "angular_momentum")
    return ("energy", "angular_momentum") if falls else INVARIANT_CHANNELS


def exact_rows(case: Case, truth: Truth) -> list[Row]:
    """Drift of what the load leaves constant, within the rounding of the answer itself."""
    channels = conserved_channels(case)
    times, count = truth.times, len(truth.times)
    still = State(*(np.broadcast_to(v[:1], v.shape) for v in vars(truth.state).values()))
    rounding = truth.yardstick.round_off(0.0, np.zeros(count), np.ones(count))
    drift = {c: truth.yardstick.distance(c, truth.state, still) for c in channels}
    whole = Sweep(float(times[-1]), 1, 1)
    measured = MeasuredRun(whole, drift, rounding)
    findings = {c: Finding("unexplained", "it should be constant") for c in channels}
    return invariants.rows(measured, findings, times, channels)
