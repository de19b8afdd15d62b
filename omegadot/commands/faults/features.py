"""What a case has in it for a fault to show, beyond what `harness.random_cases` names."""

from __future__ import annotations

import numpy as np

from omegadot.gates.case import Case
from omegadot.gates.scales import norm
from omegadot.harness.random_cases import features_of as common_features
from omegadot.reference_impl.inertia import lever, moving_inertia
from omegadot.reference_impl.symmetric import apply
from omegadot.reference_impl.system import Array, System

HEAVY, LIGHT = 100.0, 0.01  # kg
SMALL_INERTIA = 1e-3  # kg m^2
COARSE = 0.015  # s
DROWSY = 5e-5  # J/kg, PhysX's default, below which a body may be put to sleep
RATES, SPEEDS = (7, 25, 47, 100), (100, 300)  # rad/s, m/s
TURNS = (0.05, 0.1, 0.12, np.pi / 4)  # rad, of one step
MICROSECOND = 1e-6


def features_of(case: Case) -> frozenset[str]:
    """The features by which faults name what they need.

    Those of the harness, and: ``heavy``, ``light``, ``odd-mass``, ``small-inertia``,
    ``near-equal`` moments, ``unsorted-moments`` on a diagonal inertia;
    ``pivot-lever``: the centre of mass off the pivot, ``pivot-off-axis``: pivot and lever off z,
    with a component below zero; ``gravity-off-axis``; ``attitude-dependent`` torques; ``loaded``;
    ``damping-above-1``, ``torque-below-clamp``; at the start ``rest``, ``low-energy``,
    ``negative-scalar``, ``omega-above-R`` in rad/s; ``speed-above-V`` in m/s at either end;
    ``coarse`` steps, ``turn-above-A`` in rad a step, ``many-steps``, ``short-last`` intervals, and
    ``fine-times``, which microseconds do not hold.
    """
    groups = (_of_body(case.system), _of_load(case.system), _of_start(case), _of_steps(case))
    own = {name for group in groups for name, holds in group.items() if holds}
    return common_features(case) | own


def _of_body(system: System) -> dict[str, bool]:
    body = system.body
    diagonal, moments = np.diag(body.inertia), np.linalg.eigvalsh(body.inertia)
    gaps = np.diff(moments)
    plain = not np.any(body.inertia - np.diag(diagonal))
    return {
        "heavy": bool(body.mass > HEAVY),
        "light": bool(body.mass < LIGHT),
        "odd-mass": float(np.float32(body.mass)) != float(body.mass),
        "small-inertia": bool(moments[0] < SMALL_INERTIA),
        "near-equal": bool(np.any((gaps > 1e-9 * moments[1:]) & (gaps <= 0.01 * moments[1:]))),
        "unsorted-moments": plain and bool(np.any(np.diff(diagonal) < 0.0)),
    }


def _of_load(system: System) -> dict[str, bool]:
    load, arm = system.load, lever(system)
    pivoted = load.pivot is not None
    pivot = np.zeros(3) if load.pivot is None else load.pivot
    hangs = pivoted and bool(np.any(load.gravity)) and bool(np.any(arm))
    torques = np.concatenate([load.torque_body, load.torque_world])
    acting = (load.gravity, load.damping, torques, pivot)
    return {
        "pivot-lever": pivoted and bool(np.any(arm)),
        "pivot-off-axis": bool(np.all(pivot[:2])) and bool(np.any(arm < 0.0)),
        "gravity-off-axis": bool(np.all(load.gravity[:2])),
        "attitude-dependent": hangs or bool(np.any(load.torque_world)),
        "loaded": any(not _is_single(values) for values in acting),
        "damping-above-1": bool(load.damping > 1.0),
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
    return {
        "rest": rate == 0.0,
        "low-energy": 0.0 < float(energy) < DROWSY,
        "negative-scalar": bool(start.orientation[0] < 0.0),
        **{f"omega-above-{most}": rate > most for most in RATES},
        **{f"speed-above-{most}": speed > most for most in SPEEDS},
    }


def _of_steps(case: Case) -> dict[str, bool]:
    rate = float(norm(case.initial.angular_velocity))
    coarsest = max(sweep.timestep for sweep in case.sweeps)
    in_microseconds = [sweep.timestep / MICROSECOND for sweep in case.sweeps]
    return {
        "coarse": coarsest > COARSE,
        **{f"turn-above-{most:.2f}": rate * coarsest > most for most in TURNS},
        "many-steps": max(sweep.steps for sweep in case.sweeps) > 1000,
        "short-last": any(sweep.steps % sweep.every for sweep in case.sweeps),
        "fine-times": any(abs(n - round(n)) > 1e-6 for n in in_microseconds),
    }
