"""Random systems as cases, and what each has in it for a fault to show."""

from __future__ import annotations

import numpy as np

from omegadot.gates.bounds.scales import EPS, norm
from omegadot.gates.case import Case
from omegadot.harness.arguments import case_of
from omegadot.reference_impl.inertia import lever
from omegadot.reference_impl.schemes.scheme import kinds_of
from omegadot.scenarios.random_systems import random_scenario

SLEEPY = 0.05  # rad/s, below which engines may put a body to sleep
FASTEST = 1.0  # rad/s, above which some limit a body's rate
CAPPED = 100.0  # rad/s and m/s, above which others do
LEAST_SPREAD = 0.02  # of neighbouring moments, relative, for a body to count as asymmetric
NEARLY = 0.01  # of all three
ILL_CONDITIONED = 20.0
LIGHT, HEAVY = 0.1, 10.0  # kg
STRONG = 0.25  # N m
OBLIQUE = 0.1  # of a vector, in each component
NEXT_TO_ZERO = 0.02
LONG = 1000  # steps
COARSE = 0.4  # rad a step


def random_case(seed: int, index: int) -> Case:
    """The random system of this number with its own steps."""
    return case_of(random_scenario(seed, index), ())


def features_of(case: Case) -> frozenset[str]:
    """What a case has in it for a fault to show.

    Body: ``full-inertia``: products of inertia; ``asymmetric``: three different moments;
    ``near-equal``: different, within 1 %; ``ill-conditioned``: the largest moment 20 times the
    smallest; ``offset``: the centre of mass off the origin; ``light``, ``heavy``: below 0.1 kg,
    above 10 kg.
    Support: ``free``, ``pivot``, ``pivot-off-origin``; ``lever``: the centre of mass is off the
    pivot.
    Loads: ``gravity``, ``gravity-not-down``: not along -z, ``gravity-oblique``: off every axis;
    ``damping``, ``damping-above-1``: N m s/rad; ``torque``, ``torque-body``, ``torque-world``,
    ``torque-x-``, ``torque-x+`` and so on: a component beyond 0.25 N m of this sign;
    ``torque-free``: it turns, and nothing acts on it.
    Motion: ``at-rest``, ``slow``, ``fast``, ``very-fast``: it starts at 0, below 0.05, above 1,
    above 100 rad/s; ``high-speed``: above 100 m/s; ``scalar-negative``, ``scalar-zero``: so is w of
    the start's quaternion, next to zero at least.
    Run: ``long``: 1000 steps or more; ``coarse``: a turn of 0.4 rad or more in a step at the
    start's rate; ``short-interval``: between the last two samples.
    """
    named = _of_the_body(case) | _of_the_loads(case) | _of_the_motion(case)
    return frozenset(name for name, holds in named.items() if holds)


def _of_the_body(case: Case) -> dict[str, bool]:
    body = case.system.body
    tensor, mass = np.asarray(body.inertia), float(body.mass)
    moments = np.linalg.eigvalsh(tensor)
    products = np.max(np.abs(tensor - np.diag(np.diag(tensor))))
    spread = np.diff(moments) / moments[-1]
    return {
        "full-inertia": bool(products > LEAST_SPREAD * moments[-1]),
        "asymmetric": bool(np.min(spread) > LEAST_SPREAD),
        "near-equal": bool(np.min(spread) > EPS and np.sum(spread) < NEARLY),
        "ill-conditioned": bool(moments[-1] > ILL_CONDITIONED * moments[0]),
        "offset": bool(np.any(body.center_of_mass)),
        "light": mass < LIGHT,
        "heavy": mass > HEAVY,
    }


def _of_the_loads(case: Case) -> dict[str, bool]:
    load = case.system.load
    held, damping = load.pivot is not None, float(load.damping)
    turns = bool(np.any(case.initial.angular_velocity))
    frames = {"body": np.asarray(load.torque_body), "world": np.asarray(load.torque_world)}
    gravity = np.asarray(load.gravity)
    named = {
        "free": not held,
        "pivot": held,
        "pivot-off-origin": held and bool(np.any(load.pivot)),
        "lever": bool(np.any(lever(case.system))),
        "gravity": bool(np.any(gravity)),
        "gravity-not-down": bool(np.any(gravity)) and gravity[2] != -norm(gravity),
        "gravity-oblique": int(np.sum(np.abs(gravity) > OBLIQUE * norm(gravity))) == 3,
        "damping": damping > 0.0,
        "damping-above-1": damping > 1.0,
        "torque": any(bool(np.any(torque)) for torque in frames.values()),
        "torque-free": "torque-free" in kinds_of(case.system) and turns and not np.any(gravity),
    }
    named |= {f"torque-{frame}": bool(np.any(torque)) for frame, torque in frames.items()}
    for axis, name in enumerate("xyz"):
        parts = [torque[axis] for torque in frames.values()]
        named[f"torque-{name}+"] = max(parts) > STRONG
        named[f"torque-{name}-"] = min(parts) < -STRONG
    return named


def _of_the_motion(case: Case) -> dict[str, bool]:
    start = case.initial
    rate, speed = float(norm(start.angular_velocity)), float(norm(start.linear_velocity))
    coarsest = max(sweep.timestep for sweep in case.sweeps)
    scalar = float(start.orientation[0])
    return {
        "at-rest": rate == 0.0,
        "slow": rate < SLEEPY,
        "fast": rate > FASTEST,
        "very-fast": rate > CAPPED,
        "high-speed": speed > CAPPED,
        "scalar-negative": scalar < -NEXT_TO_ZERO,
        "scalar-zero": abs(scalar) <= NEXT_TO_ZERO,
        "long": any(sweep.steps >= LONG for sweep in case.sweeps),
        "coarse": coarsest * rate >= COARSE,
        "short-interval": any(sweep.steps % sweep.every for sweep in case.sweeps),
    }
