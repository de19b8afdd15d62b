"""What one run shows in each channel: its distance from the exact course and from its scheme's."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from omegadot.adapters.protocol import Integrator
from omegadot.harness.measures import INVARIANT_CHANNELS, TRAJECTORY_UNITS, Yardstick
from omegadot.harness.plan import Sweep
from omegadot.harness.verdicts import Finding, ObservedOrder, judge, observed_order
from omegadot.reference_impl.body_origin import is_offset
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
class Course:
    """One engine's run, measured. All arrays are (n,) at the sample times, by channel."""

    sweep: Sweep
    error: dict[str, Array]
    round_off: dict[str, Array]
    against_scheme: dict[str, Array] = field(default_factory=dict)


def measure(
    yardstick: Yardstick, sweep: Sweep, exact: State, state: State, companion: Companion | None
) -> Course:
    """Distances of `state` from the exact course and, where there is one, the scheme's own."""
    growth = companion.growth if companion else np.ones(len(sweep.times))
    return Course(
        sweep=sweep,
        error={c: yardstick.distance(c, state, exact) for c in CHANNELS},
        round_off=yardstick.round_off(sweep.timestep, sweep.sample_steps, growth),
        against_scheme={c: yardstick.distance(c, state, companion.state) for c in CHANNELS}
        if companion
        else {},
    )


def order_of(courses: list[Course], channel: str) -> ObservedOrder | None:
    """The order seen over the steps of one integrator, where errors stand above rounding."""
    clear = [c for c in courses if np.max(c.error[channel]) > np.max(c.round_off[channel])]
    steps = [course.sweep.timestep for course in clear]
    return observed_order(steps, [float(np.max(course.error[channel])) for course in clear])


@dataclass(frozen=True)
class Declared:
    """What an integrator is held to: its scheme, and its order per channel (None: conserved)."""

    scheme: str | None
    orders: dict[str, int | None]


@dataclass(frozen=True)
class SchemeKey:
    """Which of the reference's runs an integrator is held against."""

    scheme: str
    at_origin: bool


def scheme_key(integrator: Integrator, system: System) -> SchemeKey | None:
    """The run of the reference that this integrator should equal; None for an unknown scheme."""
    if integrator.scheme is None:
        return None
    return SchemeKey(integrator.scheme, integrator.steps_origin and is_offset(system))


def orders_for(integrator: Integrator, system: System) -> dict[str, int | None]:
    """The declared orders; those of a known scheme are higher where the system is simple.

    Stepping an origin off the centre of mass couples translation to rotation, so that there the
    scheme's general orders hold for what translation takes part in.
    """
    key = scheme_key(integrator, system)
    if key is None or key.scheme not in SCHEMES:
        return {c: integrator.orders.get(c) for c in CHANNELS}
    scheme = SCHEMES[key.scheme]
    found = {c: scheme.order(c, system) for c in CHANNELS}
    if key.at_origin:
        found |= {c: scheme.orders[c] for c in ("energy", "linear_momentum", "position")}
    return found


def finding_of(
    course: Course, declared: Declared, channel: str, order: ObservedOrder | None
) -> Finding:
    """Judge one channel of one run."""
    return judge(
        course.error[channel],
        course.round_off[channel],
        declared.scheme,
        course.against_scheme.get(channel),
        declared.orders[channel],
        order,
    )
