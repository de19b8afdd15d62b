"""A run measured in each channel: its distance from the exact solution and from its scheme."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from omegadot.adapters.protocol import Integrator
from omegadot.gates.case import Sweep
from omegadot.gates.measures import INVARIANT_CHANNELS, TRAJECTORY_UNITS
from omegadot.gates.truth import Companion, Truth, scheme_key
from omegadot.gates.verdicts import (
    VANISHED,
    Evidence,
    Finding,
    ObservedOrder,
    judge,
    observed_order,
)
from omegadot.reference_impl.schemes import SCHEMES
from omegadot.reference_impl.system import Array, State, System

CHANNELS = (*TRAJECTORY_UNITS, *INVARIANT_CHANNELS)


@dataclass(frozen=True)
class MeasuredRun:
    """One engine's run, measured. All arrays are (n,) at the sample times, by channel."""

    sweep: Sweep
    error: dict[str, Array]
    round_off: dict[str, Array]
    against_scheme: dict[str, Array] = field(default_factory=dict)
    floor: dict[str, Array] = field(default_factory=dict)


def measure(truth: Truth, sweep: Sweep, state: State, own: Companion | None) -> MeasuredRun:
    """Distances of `state` from the exact trajectory and, where there is one, the scheme's own."""
    yardstick, rows, exact = truth.yardstick, truth.rows(sweep), truth.at(sweep)

    def apart(other: State) -> dict[str, Array]:
        return {c: yardstick.distance(c, state, other) for c in CHANNELS}

    growth = own.growth if own else truth.growth[rows]
    return MeasuredRun(
        sweep=sweep,
        error=apart(exact),
        round_off=yardstick.round_off(sweep.timestep, sweep.sample_steps, growth),
        against_scheme=apart(own.state) if own else {},
        floor={channel: values[rows] for channel, values in truth.floor.items()},
    )


def _sizes(
    measured_runs: list[MeasuredRun], channel: str, left: bool
) -> list[tuple[MeasuredRun, Array]]:
    """Runs with their error, or with what is left of it after the declared scheme."""
    if left:
        return [(run, run.against_scheme[channel]) for run in measured_runs if run.against_scheme]
    return [(run, run.error[channel]) for run in measured_runs]


def order_of(
    measured_runs: list[MeasuredRun], channel: str, *, left: bool = False
) -> ObservedOrder | None:
    """The order over the steps of one integrator, of errors that stand above rounding.

    left: of what is left after the declared scheme.
    """
    steps, errors = [], []
    for run, size in _sizes(measured_runs, channel, left):
        if np.max(size) > np.max(run.round_off[channel]):
            steps.append(run.sweep.timestep)
            errors.append(float(np.max(size)))
    return observed_order(steps, errors)


def _order_shown(
    measured_runs: list[MeasuredRun], channel: str, left: bool
) -> ObservedOrder | None:
    """`order_of`; VANISHED where an error above rounding somewhere is within it at the finest."""
    above = {
        run.sweep.timestep: bool(np.any(size > run.round_off[channel]))
        for run, size in _sizes(measured_runs, channel, left)
    }
    if any(above.values()) and not above[min(above)]:
        return VANISHED
    return order_of(measured_runs, channel, left=left)


def evidence_of(measured: MeasuredRun, measured_runs: list[MeasuredRun], channel: str) -> Evidence:
    """What one run and the others of its sweep show in a channel."""
    left = measured.against_scheme.get(channel)
    parts = (False,) if left is None else (False, True)
    orders = tuple(_order_shown(measured_runs, channel, part) for part in parts)
    bound, floor = measured.round_off[channel], measured.floor.get(channel)
    return Evidence(measured.error[channel], bound, left, orders, floor)


@dataclass(frozen=True)
class Declared:
    """What an integrator is judged by: its scheme, and its order per channel (None: conserved)."""

    scheme: str | None
    orders: dict[str, int | None]


def orders_for(integrator: Integrator, system: System) -> dict[str, int | None]:
    """The declared orders; those of a known scheme are higher where the system is simple."""
    key = scheme_key(integrator, system)
    if key is None or key.scheme not in SCHEMES:
        return {c: integrator.orders.get(c) for c in CHANNELS}
    scheme = SCHEMES[key.scheme]
    return {c: scheme.order(c, system, key.coordinates) for c in CHANNELS}


def findings_of(
    measured: MeasuredRun, declared: Declared, measured_runs: list[MeasuredRun]
) -> dict[str, Finding]:
    """Judge every channel of one run; the other runs of its sweep show the orders."""
    return {
        c: judge(evidence_of(measured, measured_runs, c), declared.scheme, declared.orders[c])
        for c in CHANNELS
    }
