"""A run measured in each channel: its distance from the exact solution and from its scheme."""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace

import numpy as np

from omegadot.adapters.protocol import Integrator
from omegadot.gates.case import Sweep
from omegadot.gates.measures import INVARIANT_CHANNELS, TRAJECTORY_UNITS
from omegadot.gates.truth import Companion, Truth, scheme_key
from omegadot.gates.verdicts import (
    ORDER_TOLERANCE,
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
ROTATION = ("omega", "attitude")
# Beyond half a radian, or half its size, an error is no longer a power of the step: it saturates.
SATURATED = 0.5
# Rounding is then a tenth of the error at most, and its bound is seldom reached.
CLEAR_OF_ROUNDING = 10.0
HORIZONS = tuple(0.5**n for n in range(7))  # of a run's samples
FEWEST_STEPS = 3  # two slopes, which must agree


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


def saturates(run: MeasuredRun, samples: int | None = None) -> bool:
    """Whether a run is so far off, within its first samples, that no power of the step is seen."""
    return not all(np.max(run.error[c][:samples]) <= SATURATED for c in ROTATION)


def order_of(
    measured_runs: list[MeasuredRun], channel: str, *, left: bool = False
) -> ObservedOrder | None:
    """The order over the steps of one integrator, of errors that stand above rounding.

    It is that of the whole run, where this shows one. Late errors may saturate, and late bounds of
    rounding hide all but the coarsest steps: then a shorter horizon decides, the longest that can.
    left: of what is left after the declared scheme.
    """
    shown = None
    for horizon in HORIZONS:
        steps, errors, clear, saturated = [], [], 0, False
        for run, size in _sizes(measured_runs, channel, left):
            samples = math.ceil(horizon * len(size))
            largest = float(np.max(size[:samples]))
            bound = float(np.max(run.round_off[channel][:samples]))
            if largest > bound:
                steps.append(run.sweep.timestep)
                errors.append(largest)
            clear += largest > CLEAR_OF_ROUNDING * bound
            saturated |= saturates(run, samples)
        found = observed_order(steps, errors)
        # Of errors that saturate, only those that do not shrink at all show something: no order.
        usable = not saturated or (found is not None and found.value <= ORDER_TOLERANCE)
        if found is not None and found.resolved and usable:
            return found
        shown = shown or (found and replace(found, resolved=False))
        if clear >= FEWEST_STEPS and not saturated:
            break  # nothing hides the order: the errors follow no power of the step
    return shown


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
