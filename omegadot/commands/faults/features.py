"""What a case has in it for a fault to show, beyond what `harness.random_cases` names."""

from __future__ import annotations

import numpy as np

from omegadot.gates.bounds.scales import norm
from omegadot.gates.case import Case
from omegadot.harness.random_cases import features_of as common_features
from omegadot.reference_impl.inertia import lever, moving_inertia
from omegadot.reference_impl.motion import forward_dynamics
from omegadot.reference_impl.schemes.scheme import kinds_of
from omegadot.reference_impl.symmetric import apply
from omegadot.reference_impl.system import Array, System

HEAVY, LIGHT, TON = 100.0, 0.01, 1000.0  # kg
VERY_HEAVY, VERY_LIGHT = 2e4, 1e-3  # kg
CLOSE, FAR, FURTHER = 1e4, 1e5, 1e6  # m
MOST_GRAVITY = 20.0  # m/s^2
SLIGHT_DAMPING = 1e-3  # N m s/rad
DROPPED = 0.01  # rad/s
SLIGHT = 0.01  # of a tensor's trace
SMALL_INERTIA = 1e-3  # kg m^2
LONG_STEP, SHORT_STEP = 0.015, 1e-4  # s
DROWSY = 5e-5  # J/kg, PhysX's default, below which a body may be put to sleep
RATES, SPEEDS = (7, 25, 47, 100), (100, 300)  # rad/s, m/s
TURNS = (0.05, 0.1, 0.12, 0.79, 1.57)  # rad, of one step
LEAST_TURN = 1e-6  # rad, of one step
MICROSECOND, NANOSECOND = 1e-6, 1e-9
NEAR = 0.01  # of two neighbouring moments, relative


def features_of(case: Case) -> frozenset[str]:
    """The features by which faults name what they need.

    Those of the harness, and:
    ``above-100-kg``, ``above-1-t``, ``above-20-t``, ``below-10-g``, ``below-1-g``; ``odd-mass``,
    ``odd-load``: of more digits than single precision has; ``small-inertia``: a moment below 1e-3
    kg m^2; ``near-pair``: two moments within 1 %; ``slight-products``: one below 1 % of the trace;
    ``unsorted-moments`` on a diagonal inertia;
    ``lever-negative``: a pivoted body with a component of the lever below zero;
    ``attitude-dependent`` torques; ``torque-below-clamp``: a component below -0.25 N m;
    ``gravity-above-20`` in m/s^2; ``damping-below-1e-3`` in N m s/rad;
    ``low-energy``; ``omega-above-R`` in rad/s at the start, ``speed-above-V`` in m/s at either end;
    ``beyond-D-km``: a coordinate of the place at either end;
    ``steady``: omega is constant, ``tumbling``: it is not, though nothing acts;
    ``step-above-15-ms``, ``step-below-100-us``: the finest, ``turn-above-A`` in rad a step,
    ``creeping``: by less than 1e-6 in the finest; ``beyond-1000-steps``; ``fine-steps``,
    ``fine-times``: steps, and times of samples, that microseconds do not hold; ``finer-times``: nor
    do nanoseconds.
    """
    groups = (_of_body(case.system), _of_load(case.system), _of_start(case), _of_steps(case))
    own = {name for group in groups for name, holds in group.items() if holds}
    return common_features(case) | own


def _of_body(system: System) -> dict[str, bool]:
    body = system.body
    diagonal, moments = np.diag(body.inertia), np.linalg.eigvalsh(body.inertia)
    gaps = np.diff(moments) / moments[1:]
    products = np.abs(body.inertia[[0, 0, 1], [1, 2, 2]]) / np.trace(body.inertia)
    plain = not np.any(body.inertia - np.diag(diagonal))
    return {
        "above-100-kg": bool(body.mass > HEAVY),
        "above-1-t": bool(body.mass > TON),
        "above-20-t": bool(body.mass > VERY_HEAVY),
        "below-10-g": bool(body.mass < LIGHT),
        "below-1-g": bool(body.mass < VERY_LIGHT),
        "odd-mass": not _is_single(body.mass),
        "slight-products": bool(np.any((products > 1e-6) & (products < SLIGHT))),
        "small-inertia": bool(moments[0] < SMALL_INERTIA),
        "near-pair": bool(np.any((gaps > 1e-9) & (gaps <= NEAR))),
        "unsorted-moments": plain and bool(np.any(np.diff(diagonal) < 0.0)),
    }


def _of_load(system: System) -> dict[str, bool]:
    load, arm = system.load, lever(system)
    hangs = bool(np.any(load.gravity)) and bool(np.any(arm))
    torques = np.concatenate([load.torque_body, load.torque_world])
    acting = (
        load.gravity,
        load.damping,
        torques,
        np.zeros(3) if load.pivot is None else load.pivot,
    )
    return {
        "lever-negative": bool(np.any(arm < 0.0)),
        "attitude-dependent": hangs or bool(np.any(load.torque_world)),
        "odd-load": not all(map(_is_single, acting)),
        "gravity-above-20": bool(norm(load.gravity) > MOST_GRAVITY),
        "damping-below-1e-3": bool(0.0 < load.damping < SLIGHT_DAMPING),
        "torque-below-clamp": bool(np.any(torques < -0.25)),
    }


def _is_single(values: Array) -> bool:
    return bool(np.all(np.asarray(values, np.float32) == values))


def _of_start(case: Case) -> dict[str, bool]:
    system, start = case.system, case.initial
    w, v = start.angular_velocity, start.linear_velocity
    rate, end = float(norm(w)), v + system.load.gravity * case.scenario.run.duration
    free = system.load.pivot is None
    energy = 0.5 * (w @ apply(moving_inertia(system), w) / system.body.mass + free * v @ v)
    speed = max(float(norm(v)), float(norm(end))) if free else 0.0
    away = start.position + v * case.scenario.run.duration
    place = float(np.max(np.abs([start.position, away]))) if free else 0.0
    changes = float(norm(forward_dynamics(system, start).angular)) > 1e-12 * rate**2
    return {
        "steady": rate > 0.0 and not changes,
        "tumbling": rate > 0.0 and changes and "torque-free" in kinds_of(system),
        "low-energy": 0.0 < float(energy) < DROWSY,
        **{f"omega-above-{most}": rate > most for most in RATES},
        **{f"speed-above-{most}": speed > most for most in SPEEDS},
        **{f"beyond-{most / 1e3:.0f}-km": place > most for most in (CLOSE, FAR, FURTHER)},
    }


def _of_steps(case: Case) -> dict[str, bool]:
    rate = float(norm(case.initial.angular_velocity))
    coarsest = max(sweep.timestep for sweep in case.sweeps)
    return {
        "step-above-15-ms": coarsest > LONG_STEP,
        "step-below-100-us": min(sweep.timestep for sweep in case.sweeps) < SHORT_STEP,
        **{f"turn-above-{most:.2f}": rate * coarsest > most for most in TURNS},
        "creeping": 0.0 < rate * min(sweep.timestep for sweep in case.sweeps) < LEAST_TURN,
        "beyond-1000-steps": max(sweep.steps for sweep in case.sweeps) > 1000,
        "fine-steps": any(_is_finer(np.array(sweep.timestep)) for sweep in case.sweeps),
        "fine-times": any(_is_finer(sweep.times) for sweep in case.sweeps),
        "finer-times": any(_is_finer(sweep.times, NANOSECOND) for sweep in case.sweeps),
    }


def _is_finer(times: Array, unit: float = MICROSECOND) -> bool:
    parts = times / unit
    return bool(np.any(np.abs(parts - np.round(parts)) > 1e-3))
