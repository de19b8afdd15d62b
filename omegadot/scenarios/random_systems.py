"""Random systems: bodies, states, loads and runs drawn from a seed, each with a name."""

from __future__ import annotations

import re

import numpy as np

from omegadot.scenarios.model import Scenario
from omegadot.scenarios.random_numbers import (
    MASSES,
    RATES,
    between,
    initial_of,
    loads_of,
    oblique,
    rests,
    rounded,
    run_of,
    size_of,
    tensor_of,
)
from omegadot.scenarios.random_traits import BLOCK, drawn

__all__ = ["BLOCK", "random_names", "random_of_name", "random_scenario"]

LARGEST_SEED, MOST_SYSTEMS = 999_999_999, 1_000_000  # nine digits and six, as in NAME
NAME = re.compile(r"random-(0|[1-9]\d{0,8})-(0|[1-9]\d{0,5})")


def random_scenario(seed: int, index: int) -> Scenario:
    """The system of this number, called ``random-SEED-INDEX``.

    Masses span ten decades (0.1 g to 1000 t), sizes eight (1 mm to 100 km), rates seven (1e-4 to
    1000 rad/s, or at rest), speeds go up to 10 km/s and places to 3000 km. A run lasts 4 to 26
    rad at the body's own rate, in steps of 0.5 rad or of 0.1, up to 1028 of them; of 0.9 or 1.8 rad
    where it spins steadily. One or two of a block creep: their steps are of 1e-8 rad.
    """
    draw, random = drawn(seed, index), np.random.default_rng([seed, index])
    bulk = draw.traits["bulk"]
    mass = rounded(between(MASSES[bulk], draw.share["mass"]), 8)
    size = size_of(draw)
    rate = between(RATES["middle" if rests(draw) else draw.traits["rate"]], draw.share["rate"])
    tensor = np.array(rounded(tensor_of(random, draw, mass, size), 9))
    center, pivot = np.zeros(3), None
    if draw.traits["center"] == "offset":
        center = np.array(rounded(size * random.uniform(0.1, 1.0) * oblique(random)))
    if draw.traits["support"] == "pivot":
        pivot = np.array(rounded(size * random.uniform(0.1, 1.0) * oblique(random)))
    elif draw.traits["support"] == "pivot-at-origin":
        pivot = np.zeros(3)
    lever = np.zeros(3) if pivot is None else center - pivot
    about = tensor + mass * (lever @ lever * np.eye(3) - np.outer(lever, lever))
    run, turn = run_of(draw, rate)
    arm = mass * float(np.linalg.norm(lever))
    load = loads_of(random, draw, about, arm, size, rate, turn)
    if pivot is not None:
        load["pivot"] = pivot.tolist()
    shown = {**draw.traits, "torque": "body and world"} if draw.both else draw.traits
    return Scenario.model_validate(
        {
            "schema": 1,
            "name": f"random-{seed}-{index}",
            "shows": ", ".join(f"{trait} {level}" for trait, level in shown.items()),
            "body": {"mass": mass, "inertia": tensor.tolist(), "center_of_mass": center.tolist()},
            "initial": initial_of(random, draw, tensor, size, rate),
            "load": load,
            "run": run,
        }
    )


def random_names(seed: int, count: int) -> list[str]:
    """The names of the first systems of a seed."""
    return [f"random-{seed}-{index}" for index in range(count)]


def random_of_name(name: str) -> Scenario | None:
    """The system called so; None where this is no name of one."""
    found = NAME.fullmatch(name)
    return random_scenario(int(found[1]), int(found[2])) if found else None
