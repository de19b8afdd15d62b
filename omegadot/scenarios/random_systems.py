"""Random bodies, states, loads and runs, drawn from a seed: the same seed gives the same ones.

They come in blocks of 24. Within a block every two traits occur together, and magnitudes are spread
evenly over their decades. Numbers have few digits, so that a file of one can be read.
"""

from __future__ import annotations

import re
from collections import defaultdict
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import numpy as np
from numpy.random import Generator
from numpy.typing import NDArray

from omegadot.scenarios.model import Scenario
from omegadot.scenarios.pairs import covering_rows
from omegadot.scenarios.solids import rotation_of

Array = NDArray[np.float64]
BLOCK = 24
NAME = re.compile(r"random-(0|[1-9]\d{0,8})-(0|[1-9]\d{0,5})")
TRAITS = {
    "support": ("free", "flying", "pivot", "pivot-at-origin"),
    "center": ("offset", "origin"),
    "gravity": ("none", "down", "axis", "oblique"),
    "damping": ("none", "weak", "strong"),
    "torque": ("none", "body", "world"),
    "inertia": ("diagonal", "full", "near-equal", "thin"),
    "bulk": ("light-small", "light-large", "heavy-small", "heavy-large"),
    "rate": ("slow", "middle", "fast"),
    "scalar": ("positive", "negative", "zero"),
    "steps": ("coarse", "medium", "long"),
    "end": ("whole", "short"),
}
# Decades, by the trait that they belong to.
MASSES = {"light": (-3.0, -0.3), "heavy": (0.3, 3.0)}  # kg
SIZES = {"small": (-3.0, -1.0), "large": (-0.3, 2.7)}  # m
RATES = {"slow": (-3.0, -1.4), "middle": (-0.7, 0.7), "fast": (1.5, 3.0)}  # rad/s
AT_REST = 0.25  # of the slow ones: they start at rest, and are driven at a rate of the middle
SPEEDS = (3.0, 4.0)  # m/s, of a flying body
FASTEST = 300.0  # size times rate, beyond which its turning would drown in rounding
DAMPINGS = {"weak": (-2.0, -1.0), "strong": (-0.3, 0.0)}  # of what stops it within a radian
SPREADS = {"near-equal": (-6.0, -3.0), "thin": (-4.0, -1.5)}
# Radians a step at the rate of the body, steps between samples and of the run, and step sizes.
RUNS = {
    ("coarse", "whole"): (0.5, 1, 13, 4),
    ("coarse", "short"): (0.5, 2, 15, 4),
    ("medium", "whole"): (0.1, 2, 40, 3),
    ("medium", "short"): (0.1, 4, 43, 3),
    ("long", "whole"): (0.1, 10, 250, 3),
    ("long", "short"): (0.1, 12, 257, 3),
}
AXES = ((0, 0, 1), (1, 0, 0), (-1, 0, 0), (0, 1, 0), (0, -1, 0))
# Signs of the components of a torque; two neighbours have both signs of each.
OCTANTS = (0b000, 0b111, 0b001, 0b110, 0b010, 0b101, 0b011, 0b100)
SPREAD_BY = {
    **{"mass": "bulk", "size": "bulk", "rate": "rate", "speed": "support"},
    **{"damping": "damping", "gravity": "gravity", "inertia": "inertia"},
}


@dataclass(frozen=True)
class Draw:
    """What is drawn of a system before its numbers.

    share: of the range of each magnitude.  octant: of a torque, a bit for each component's sign.
    """

    traits: Mapping[str, str]
    share: Mapping[str, float]
    octant: int


def _ranks(groups: Sequence[object], random: Generator) -> list[tuple[int, int]]:
    """For every row its number within its group, in random order, and how many these are."""
    places = defaultdict(list)
    for row, group in enumerate(groups):
        places[group].append(row)
    found = [(0, 1)] * len(groups)
    for rows in places.values():
        for rank, row in enumerate(random.permutation(rows)):
            found[row] = (rank, len(rows))
    return found


@lru_cache(64)
def _block(seed: int, number: int) -> tuple[Draw, ...]:
    random = np.random.default_rng([seed, number, BLOCK])
    rows = covering_rows(TRAITS, BLOCK, random)
    shares = [dict[str, float]() for _ in rows]
    for name, by in SPREAD_BY.items():
        for share, (rank, of) in zip(shares, _ranks([r[by] for r in rows], random), strict=True):
            share[name] = (rank + random.random()) / of
    # those of large torques have every sign among them, and so have the others
    ranks = _ranks([_drive(row) for row in rows], random)
    octants = [OCTANTS[rank % len(OCTANTS)] for rank, _ in ranks]
    return tuple(map(Draw, rows, shares, octants))


def _drive(traits: Mapping[str, str]) -> tuple[bool, bool]:
    """Whether a torque acts, and whether it is large."""
    large = traits["bulk"].endswith("large") and traits["rate"] != "slow"
    return traits["torque"] != "none", large


def drawn(seed: int, index: int) -> Draw:
    """The traits of the system of this number."""
    number, row = divmod(index, BLOCK)
    return _block(seed, number)[row]


def _between(decades: tuple[float, float], share: float) -> float:
    return float(10.0 ** (decades[0] + share * (decades[1] - decades[0])))


def _rounded(values: Any, digits: int = 6) -> Any:
    """Numbers with so many decimal digits; those of an array, with as many for its largest."""
    if isinstance(values, float):
        return float(f"{values:.{digits}g}")
    largest = float(np.max(np.abs(values)))
    if not largest:
        return [0.0] * len(values)
    last = digits - 1 - int(np.floor(np.log10(largest)))
    return np.vectorize(lambda value: float(f"{value:.{max(last, 0)}f}"))(values).tolist()


def _oblique(random: Generator) -> Array:
    """A direction off every axis and plane, no two of its components of a size."""
    while True:
        vector = random.standard_normal(3)
        vector /= np.linalg.norm(vector)
        sizes = np.sort(np.abs(vector))
        if sizes[0] > 0.15 and np.min(sizes[1:] / sizes[:-1]) > 1.2:
            return np.asarray(vector)


def _inertia(random: Generator, draw: Draw, mass: float, size: float) -> Array:
    """A tensor that matter can have: with mean squares G of x, y, z it is ``m (tr G 1 - G)``."""
    kind, share = draw.traits["inertia"], draw.share["inertia"]
    squares = 10.0 ** random.uniform(-1.0, 0.0, 3)
    if kind == "near-equal":
        squares = 1.0 + _between(SPREADS[kind], share) * random.uniform(-1.0, 1.0, 3)
    elif kind == "thin":  # rods, and plates now and then
        squares[1:] *= _between(SPREADS[kind], share)
        squares[1] = squares[0] if random.random() < 0.25 else squares[1]
    elif kind == "diagonal" and share < 1 / 3:  # a symmetric top, or a sphere
        squares[:2] = squares[0]
        squares[2] = squares[0] if share < 0.1 else squares[2]
    squares = random.permutation(squares)
    moments = mass * size**2 * (np.sum(squares) - squares)
    if kind == "diagonal":
        return np.diag(moments)
    axes = rotation_of(_quaternion(random, "positive"))
    tensor = axes @ np.diag(moments) @ axes.T
    return np.asarray(0.5 * (tensor + tensor.T))


def _quaternion(random: Generator, scalar: str) -> tuple[float, float, float, float]:
    """Of a turn by any angle; its scalar part positive, negative, or next to zero or zero."""
    w, x, y, z = random.standard_normal(4)
    w = 0.1 + abs(w) if scalar == "positive" else -0.1 - abs(w)
    if scalar == "zero":
        w = random.choice([-1.0, 0.0, 1.0]) * 10.0 ** random.uniform(-6.0, -2.0)
    length = np.linalg.norm((w, x, y, z))
    return tuple(float(f"{part / length:.8f}") for part in (w, x, y, z))  # type: ignore[return-value]


def _run(draw: Draw, rate: float) -> tuple[dict[str, Any], float]:
    """The run of a body that turns at this rate, and how many radians that is."""
    short = draw.traits["end"] == "short"
    angle, every, steps, sizes = RUNS[draw.traits["steps"], draw.traits["end"]]
    coarsest = _rounded(angle / rate, 4)
    run = {
        # not a whole number of steps, and less than one of the finest more than one
        "duration": _rounded((steps + 0.1 * short) * coarsest, 12),
        "timesteps": [coarsest / 2**n for n in range(sizes)],
        "sample": every * coarsest,
    }
    return run, angle * steps


def _loads(
    random: Generator, draw: Draw, inertia: Array, arm: float, size: float, rate: float, turn: float
) -> dict[str, Any]:
    """Loads that change a motion at `rate` within a run of `turn` radians, and leave it resolvable.

    inertia: about the point that it turns about.  arm: kg m, mass times the lever of its weight.
    """
    load: dict[str, Any] = {}
    least = float(np.linalg.eigvalsh(inertia)[0])
    kind = draw.traits["gravity"]
    if kind != "none":
        directions = {"down": (0, 0, -1), "axis": AXES[int(len(AXES) * draw.share["gravity"])]}
        direction = np.asarray(directions.get(kind, _oblique(random)))
        # on a pivot the weight's work stays about the energy of the motion
        pull = float(np.trace(inertia)) / 3.0 / arm if arm else size
        load["gravity"] = _rounded(pull * rate**2 * random.uniform(0.3, 1.5) * direction)
    if (kind := draw.traits["damping"]) != "none":
        load["damping"] = _rounded(_between(DAMPINGS[kind], draw.share["damping"]) * least * rate)
    if (frame := draw.traits["torque"]) != "none":
        signs = np.array([1.0 if draw.octant >> bit & 1 else -1.0 for bit in range(3)])
        gain = random.uniform(1.5, 4.0) * (0.4 if draw.traits["steps"] == "coarse" else 1.0)
        torque = least * rate**2 * gain / np.sqrt(6.0 * turn)
        load["torque"] = {"frame": frame, "value": _rounded(torque * signs * abs(_oblique(random)))}
    return load


def _rests(draw: Draw) -> bool:
    return draw.traits["rate"] == "slow" and draw.share["rate"] < AT_REST


def _initial(random: Generator, draw: Draw, size: float, rate: float) -> dict[str, Any]:
    """Omega with three different components; a free body somewhere, and moving."""
    omega = np.zeros(3) if _rests(draw) else rate * _oblique(random)
    initial: dict[str, Any] = {
        "orientation": list(_quaternion(random, draw.traits["scalar"])),
        "angular_velocity": _rounded(omega),
    }
    speed = size * rate
    if draw.traits["support"] == "flying":
        speed = min(_between(SPEEDS, draw.share["speed"]), FASTEST * speed)
    if not draw.traits["support"].startswith("pivot"):
        initial["position"] = _rounded(3.0 * size * random.standard_normal(3))
        initial["linear_velocity"] = _rounded(speed * _oblique(random))
    return initial


def random_scenario(seed: int, index: int) -> Scenario:
    """The system of this number, called ``random-SEED-INDEX``.

    Masses span six decades (1 g to 1 t), sizes nearly as many (1 mm to 500 m), rates six (0.001 to
    1000 rad/s, or at rest), speeds go up to 10 km/s. A run lasts 4 to 26 rad at the body's own
    rate, in steps of 0.5 rad or of 0.1, up to 1028 of them.
    """
    draw, random = drawn(seed, index), np.random.default_rng([seed, index])
    weight, extent = draw.traits["bulk"].split("-")
    mass = _rounded(_between(MASSES[weight], draw.share["mass"]))
    flying = draw.traits["support"] == "flying"  # the larger a body, the faster it may go
    size = _between(SIZES[extent], max(draw.share["size"], 0.6 * flying))
    rate = _between(RATES["middle" if _rests(draw) else draw.traits["rate"]], draw.share["rate"])
    tensor = np.array(_rounded(_inertia(random, draw, mass, size), 9))
    center, pivot = np.zeros(3), None
    if draw.traits["center"] == "offset":
        center = np.array(_rounded(size * random.uniform(0.1, 1.0) * _oblique(random)))
    if draw.traits["support"] == "pivot":
        pivot = np.array(_rounded(size * random.uniform(0.1, 1.0) * _oblique(random)))
    elif draw.traits["support"] == "pivot-at-origin":
        pivot = np.zeros(3)
    lever = np.zeros(3) if pivot is None else center - pivot
    about = tensor + mass * (lever @ lever * np.eye(3) - np.outer(lever, lever))
    run, turn = _run(draw, rate)
    arm = mass * float(np.linalg.norm(lever))
    load = _loads(random, draw, about, arm, size, rate, turn)
    if pivot is not None:
        load["pivot"] = pivot.tolist()
    return Scenario.model_validate(
        {
            "schema": 1,
            "name": f"random-{seed}-{index}",
            "shows": _sentence(draw.traits.items()),
            "body": {"mass": mass, "inertia": tensor.tolist(), "center_of_mass": center.tolist()},
            "initial": _initial(random, draw, size, rate),
            "load": load,
            "run": run,
        }
    )


def _sentence(traits: Iterable[tuple[str, str]]) -> str:
    return ", ".join(f"{trait} {level}" for trait, level in traits)


def random_names(seed: int, count: int) -> list[str]:
    """The names of the first systems of a seed."""
    return [f"random-{seed}-{index}" for index in range(count)]


def random_of_name(name: str) -> Scenario | None:
    """The system called so; None where this is no name of one."""
    found = NAME.fullmatch(name)
    return random_scenario(int(found[1]), int(found[2])) if found else None
