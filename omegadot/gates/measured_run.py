"""A run measured in each channel: its distance from the exact solution and from its scheme."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from omegadot.adapters.protocol import Integrator
from omegadot.gates.case import Sweep
from omegadot.gates.measures import INVARIANT_CHANNELS, TRAJECTORY_UNITS, Yardstick
from omegadot.gates.verdicts import (
    VANISHED,
    Evidence,
    Finding,
    ObservedOrder,
    judge,
    observed_order,
)
from omegadot.reference_impl.coordinates import Coordinates, canonical
from omegadot.reference_impl.schemes import SCHEMES
from omegadot.reference_impl.system import Array, State, System

CHANNELS = (*TRAJECTORY_UNITS, *INVARIANT_CHANNELS)


@dataclass(frozen=True)
class Companion:
    """The reference stepping one scheme with one step: its states and the growth of rounding."""

    state: State
    growth: Array
    omega_dot: Array


@dataclass(frozen=True)
class MeasuredRun:
    """One engine's run, measured. All arrays are (n,) at the sample times, by channel."""

    sweep: Sweep
    error: dict[str, Array]
    round_off: dict[str, Array]
    against_scheme: dict[str, Array] = field(default_factory=dict)
    floor: dict[str, Array] = field(default_factory=dict)


@dataclass(frozen=True)
class ExactSamples:
    """The exact trajectory at the samples of a sweep, its growth of rounding and its floor."""

    state: State
    growth: Array
    floor: dict[str, Array]


def measure(
    yardstick: Yardstick, sweep: Sweep, exact: ExactSamples, state: State, own: Companion | None
) -> MeasuredRun:
    """Distances of `state` from the exact trajectory and, where there is one, the scheme's own."""
    growth = own.growth if own else exact.growth
    return MeasuredRun(
        sweep=sweep,
        error={c: yardstick.distance(c, state, exact.state) for c in CHANNELS},
        round_off=yardstick.round_off(sweep.timestep, sweep.sample_steps, growth),
        against_scheme={c: yardstick.distance(c, state, own.state) for c in CHANNELS}
        if own
        else {},
        floor=exact.floor,
    )


def _order(
    measured_runs: list[MeasuredRun], sizes: list[float], channel: str
) -> ObservedOrder | None:
    """The order of some sizes, one a trajectory, where they stand above rounding."""
    bounds = [float(np.max(measured.round_off[channel])) for measured in measured_runs]
    steps = [measured.sweep.timestep for measured in measured_runs]
    clear = [(h, e) for h, e, b in zip(steps, sizes, bounds, strict=True) if e > b]
    return observed_order([h for h, _ in clear], [e for _, e in clear])


def order_of(measured_runs: list[MeasuredRun], channel: str) -> ObservedOrder | None:
    """The order of the error over the steps of one integrator."""
    return _order(measured_runs, [float(np.max(c.error[channel])) for c in measured_runs], channel)


def order_left(measured_runs: list[MeasuredRun], channel: str) -> ObservedOrder | None:
    """The order of what is left after the declared scheme."""
    known = [measured for measured in measured_runs if measured.against_scheme]
    return _order(known, [float(np.max(c.against_scheme[channel])) for c in known], channel)


def _vanishes(measured_runs: list[MeasuredRun], sizes: list[Array], channel: str) -> bool:
    """Whether an error that stands above rounding somewhere is within it at the finest step."""
    above = {
        measured.sweep.timestep: bool(np.any(size > measured.round_off[channel]))
        for measured, size in zip(measured_runs, sizes, strict=True)
    }
    return bool(above) and any(above.values()) and not above[min(above)]


def evidence_of(measured: MeasuredRun, measured_runs: list[MeasuredRun], channel: str) -> Evidence:
    """What one run and the others of its sweep show in a channel."""
    error, left = measured.error[channel], measured.against_scheme.get(channel)
    gone = _vanishes(measured_runs, [c.error[channel] for c in measured_runs], channel)
    orders = [VANISHED if gone else order_of(measured_runs, channel)]
    if left is not None:
        known = [c for c in measured_runs if c.against_scheme]
        gone = _vanishes(known, [c.against_scheme[channel] for c in known], channel)
        orders.append(VANISHED if gone else order_left(measured_runs, channel))
    return Evidence(
        error, measured.round_off[channel], left, tuple(orders), measured.floor.get(channel)
    )


@dataclass(frozen=True)
class Declared:
    """What an integrator is judged by: its scheme, and its order per channel (None: conserved)."""

    scheme: str | None
    orders: dict[str, int | None]


@dataclass(frozen=True)
class SchemeKey:
    """Which of the reference's runs an integrator is compared with."""

    scheme: str
    coordinates: Coordinates = "com-world"


def scheme_key(integrator: Integrator, system: System) -> SchemeKey | None:
    """The run of the reference that this integrator should equal; None for an unknown scheme."""
    if integrator.scheme is None:
        return None
    return SchemeKey(integrator.scheme, canonical(system, integrator.coordinates))


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
    found = {}
    for channel in CHANNELS:
        evidence = evidence_of(measured, measured_runs, channel)
        found[channel] = judge(evidence, declared.scheme, declared.orders[channel])
    return found
