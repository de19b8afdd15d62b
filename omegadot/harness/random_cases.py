"""Random bodies, states and loads, drawn from a seed: the same seed gives the same scenarios."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.random import Generator

from omegadot.gates.case import Case
from omegadot.gates.scales import norm
from omegadot.harness.arguments import case_of
from omegadot.reference_impl.rotations import normalize, rotation_matrix
from omegadot.reference_impl.schemes.scheme import kinds_of
from omegadot.reference_impl.system import Array
from omegadot.scenarios import scenario

SLEEPY = 0.05  # rad/s, below which engines may put a body to sleep
FASTEST = 1.0  # rad/s, above which some limit a body's rate
FLAVOURS = ("free", "loaded", "pivoted", "slow")
RADIANS = 3.0  # that a run lasts, at the rate of its own motion
STEPS = (40, 80, 160)
SAMPLES = 20
LEAST_SPREAD = 0.02  # of neighbouring moments, relative, for a body to count as asymmetric


def _direction(random: Generator) -> Array:
    vector = random.standard_normal(3)
    return np.asarray(vector / np.linalg.norm(vector))


def _spread(random: Generator, decades: float) -> float:
    return float(10.0 ** random.uniform(-0.5 * decades, 0.5 * decades))


def _inertia(random: Generator, mass: float, size: float) -> tuple[Array, float]:
    """A tensor that matter can have, three times out of four in turned axes, and its least moment.

    With mean squares G of x, y, z it is ``m (tr G 1 - G)``.
    """
    squares = size**2 * 10.0 ** random.uniform(-1.0, 0.0, 3)
    moments = mass * (np.sum(squares) - squares)
    axes = rotation_matrix(normalize(random.standard_normal(4)))
    tensor = axes @ np.diag(moments) @ axes.T if random.random() < 0.75 else np.diag(moments)
    return 0.5 * (tensor + tensor.T), float(np.min(moments))


def _loads(random: Generator, flavour: str, torque: float, size: float, rate: float) -> Any:
    """Loads about as strong as the motion: a torque, a damping and a weight within a decade of it.

    torque: N m, the least moment times the rate squared.
    """
    load: dict[str, Any] = {}
    pull = size * rate**2 * _spread(random, 1.0)
    if flavour == "loaded":
        load["damping"] = 0.3 * torque / rate * _spread(random, 1.0)
        frame = "world" if random.random() < 0.5 else "body"
        value = torque * _spread(random, 1.0) * _direction(random)
        load["torque"] = {"frame": frame, "value": value}
        load["gravity"] = pull * _direction(random)
    if flavour == "pivoted":
        load["gravity"] = pull * _direction(random)
        load["pivot"] = size * random.uniform(0.1, 1.0) * _direction(random)
    return load


def random_case(seed: int, index: int) -> Case:
    """The scenario of this number: free, loaded and pivoted bodies and slow ones take turns.

    Mass and size are drawn over two decades and one, the rate over two (0.1 to 10 rad/s; a slow
    body turns at less than 0.05), and the centre of mass lies off the origin two times out of
    three.
    """
    random = np.random.default_rng([seed, index])
    flavour = FLAVOURS[index % len(FLAVOURS)]
    mass, size = _spread(random, 2.0), _spread(random, 1.0)
    tensor, least = _inertia(random, mass, size)
    rate = _spread(random, 2.0)
    if flavour == "slow":
        rate = SLEEPY * 10.0 ** random.uniform(-1.0, -0.1)
    offset = size * random.uniform(0.1, 1.0) * _direction(random) * (random.random() < 2 / 3)
    initial: dict[str, Any] = {
        "orientation": random.standard_normal(4),
        "angular_velocity": rate * _direction(random),
    }
    if flavour != "pivoted":
        initial["position"] = size * random.standard_normal(3)
        initial["linear_velocity"] = size * rate * random.standard_normal(3)
    duration = RADIANS / rate
    data = {
        "name": f"random-{seed}-{index}",
        "body": {"mass": mass, "inertia": tensor, "center_of_mass": offset},
        "initial": initial,
        "load": _loads(random, flavour, least * rate**2, size, rate),
        "run": {
            "duration": duration,
            "timesteps": [duration / steps for steps in STEPS],
            "sample": duration / SAMPLES,
        },
    }
    return case_of(scenario(data), [])


def features_of(case: Case) -> frozenset[str]:
    """What a case has in it for a fault to show.

    ``full-inertia``: products of inertia.  ``asymmetric``: three different moments.  ``offset``:
    the centre of mass off the origin.  ``free``, ``pivot``, ``pivot-off-origin``.  ``gravity``,
    ``damping``, ``torque``; ``torque-free``: none of these acts on the turning.  ``slow`` and
    ``fast``: it starts below `SLEEPY`, above `FASTEST`.
    """
    system, load = case.system, case.system.load
    rate = float(norm(case.initial.angular_velocity))
    held = load.pivot is not None
    tensor = np.asarray(system.body.inertia)
    moments = np.linalg.eigvalsh(tensor)
    products = tensor - np.diag(np.diag(tensor))
    named = {
        "full-inertia": np.max(np.abs(products)) > LEAST_SPREAD * moments[-1],
        "asymmetric": np.min(np.diff(moments)) > LEAST_SPREAD * moments[-1],
        "offset": np.any(system.body.center_of_mass),
        "free": not held,
        "pivot": held,
        "pivot-off-origin": held and np.any(load.pivot),
        "gravity": np.any(load.gravity),
        "damping": np.any(load.damping),
        "torque": np.any(load.torque_body) or np.any(load.torque_world),
        "torque-free": "torque-free" in kinds_of(system),
        "slow": rate < SLEEPY,
        "fast": rate > FASTEST,
    }
    return frozenset(name for name, holds in named.items() if holds)
