"""The numbers of a random system, from its traits: few digits, so that a file of it can be read."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.random import Generator
from numpy.typing import NDArray

from omegadot.scenarios.random_traits import Draw
from omegadot.scenarios.solids import rotation_of

Array = NDArray[np.float64]
# Decades, by the trait that they belong to.
MASSES = {  # kg
    **{"light-small": (-3.5, -1.0), "light-large": (-4.0, -1.0)},
    **{"heavy-small": (1.0, 6.0), "heavy-large": (1.0, 6.0)},
}
SIZES = {"small": (-3.0, -1.0), "large": (-0.3, 2.7)}  # m
RATES = {"slow": (-4.0, -1.4), "middle": (-0.7, 0.7), "fast": (1.5, 3.0)}  # rad/s
SPHERES = 0.1  # of the diagonal ones
AT_REST = 0.25  # of the slow ones: they start at rest, and are driven at a rate of the middle
# The next slowest of seven or eight, at least one, turn by so few rad a step that engines drop it.
CREEPING, CREEP = (AT_REST, 3 / 7), 1e-8
SPEEDS = (3.0, 4.0)  # m/s, of a flying body
PLACES = (4.0, 6.5)  # m, from the world's origin, of a flying body
FASTEST = 300.0  # size times rate, beyond which its turning would drown in rounding
LARGER = 0.6  # of the range of sizes, of flying bodies
FURTHEST = 30.0  # sizes from the origin: where inertias are in world axes, m x^2 drowns them
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
# Engines cap a turn at a quarter of pi, or at half of pi. Some implicit steps end at 1 rad, and so
# the sphere alone turns further.
STEADY_RUNS = {"sphere": (1.8, 1, 13, 5), "axis": (0.9, 1, 13, 4)}
AXES = ((0, 0, 1), (1, 0, 0), (-1, 0, 0), (0, 1, 0), (0, -1, 0))


def between(decades: tuple[float, float], share: float) -> float:
    """The magnitude at this share of the way between two powers of ten."""
    return float(10.0 ** (decades[0] + share * (decades[1] - decades[0])))


def size_of(draw: Draw) -> float:
    """The size in m; the larger a body, the faster it may fly, and the further away."""
    kind = draw.traits["bulk"].partition("-")[2]
    if draw.traits["support"] != "flying":
        return between(SIZES[kind], draw.share["size"])
    size = between(SIZES[kind], max(draw.share["size"], LARGER))
    return max(size, between(PLACES, draw.share["place"]) / FURTHEST) if kind == "large" else size


def rounded(values: Any, digits: int = 6) -> Any:
    """Numbers with so many decimal digits; those of an array, with as many for its largest."""
    if isinstance(values, float):
        return float(f"{values:.{digits}g}")
    largest = float(np.max(np.abs(values)))
    if not largest:
        return [0.0] * len(values)
    last = digits - 1 - int(np.floor(np.log10(largest)))
    return np.vectorize(lambda value: float(f"{value:.{max(last, 0)}f}"))(values).tolist()


def oblique(random: Generator) -> Array:
    """A direction off every axis and plane, no two of its components of a size."""
    while True:
        vector = random.standard_normal(3)
        vector /= np.linalg.norm(vector)
        sizes = np.sort(np.abs(vector))
        if sizes[0] > 0.15 and np.min(sizes[1:] / sizes[:-1]) > 1.2:
            return np.asarray(vector)


def tensor_of(random: Generator, draw: Draw, mass: float, size: float) -> Array:
    """A tensor that matter can have: with mean squares G of x, y, z it is ``m (tr G 1 - G)``."""
    kind, share = draw.traits["inertia"], draw.share["inertia"]
    squares = 10.0 ** random.uniform(-1.0, 0.0, 3)
    if kind == "near-equal":
        squares = 1.0 + between(SPREADS[kind], share) * random.uniform(-1.0, 1.0, 3)
    elif kind == "thin":  # rods, and plates now and then
        squares[1:] *= between(SPREADS[kind], share)
        squares[1] = squares[0] if random.random() < 0.25 else squares[1]
    elif kind == "diagonal" and share < 1 / 3:  # a symmetric top, or a sphere
        squares[:2] = squares[0]
        squares[2] = squares[0] if is_sphere(draw) else squares[2]
    squares = random.permutation(squares)
    moments = mass * size**2 * (np.sum(squares) - squares)
    if kind == "diagonal":
        return np.diag(moments)
    axes = rotation_of(quaternion(random, "positive"))
    tensor = axes @ np.diag(moments) @ axes.T
    return np.asarray(0.5 * (tensor + tensor.T))


def quaternion(random: Generator, scalar: str) -> tuple[float, float, float, float]:
    """Of a turn by any angle; its scalar part positive, negative, or next to zero or zero."""
    w, x, y, z = random.standard_normal(4)
    w = 0.1 + abs(w) if scalar == "positive" else -0.1 - abs(w)
    if scalar == "zero":
        w = random.choice([-1.0, 0.0, 1.0]) * 10.0 ** random.uniform(-6.0, -2.0)
    length = np.linalg.norm((w, x, y, z))
    return tuple(float(f"{part / length:.8f}") for part in (w, x, y, z))  # type: ignore[return-value]


def is_sphere(draw: Draw) -> bool:
    """Whether all of its moments are equal."""
    return draw.traits["inertia"] == "diagonal" and draw.share["inertia"] < SPHERES


def run_of(draw: Draw, rate: float) -> tuple[dict[str, Any], float]:
    """The run of a body that turns at this rate, and how many radians that is."""
    short = draw.traits["end"] == "short"
    angle, every, steps, sizes = RUNS[draw.traits["steps"], draw.traits["end"]]
    if draw.steady:
        angle, every, steps, sizes = STEADY_RUNS["sphere" if is_sphere(draw) else "axis"]
    elif creeps(draw):
        angle = CREEP
    coarsest = rounded(angle / rate, 9)  # no whole number of microseconds, nor of nanoseconds
    run = {
        # not a whole number of steps, and less than one of the finest more than one
        "duration": rounded((steps + 0.1 * short) * coarsest, 12),
        "timesteps": [coarsest / 2**n for n in range(sizes)],
        "sample": every * coarsest,
    }
    return run, angle * steps


def in_both_frames(frame: str, value: list[float]) -> list[dict[str, Any]]:
    """Half of a torque in its frame, and in the other frame one as large of other components.

    Their sum is then at no attitude larger than the torque was.
    """
    half = 0.5 * np.array(value)
    other = np.roll(half, 1) * (1.0, -1.0, -1.0)
    frames = (frame, "world" if frame == "body" else "body")
    return [{"frame": f, "value": rounded(v)} for f, v in zip(frames, (half, other), strict=True)]


def loads_of(
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
        direction = np.asarray(directions.get(kind, oblique(random)))
        # on a pivot the weight's work stays about the energy of the motion
        pull = float(np.trace(inertia)) / 3.0 / arm if arm else size
        load["gravity"] = rounded(pull * rate**2 * random.uniform(0.3, 1.5) * direction)
    if (kind := draw.traits["damping"]) != "none":
        load["damping"] = rounded(between(DAMPINGS[kind], draw.share["damping"]) * least * rate)
    if (frame := draw.traits["torque"]) != "none":
        signs = np.array([1.0 if draw.octant >> bit & 1 else -1.0 for bit in range(3)])
        gain = random.uniform(1.5, 4.0) * (0.25 if draw.traits["steps"] == "coarse" else 1.0)
        torque = least * rate**2 * gain / np.sqrt(6.0 * turn)
        value = rounded(torque * signs * abs(oblique(random)))
        load["torque"] = (
            in_both_frames(frame, value) if draw.both else {"frame": frame, "value": value}
        )
    return load


def rests(draw: Draw) -> bool:
    """Whether it starts at rest."""
    return draw.traits["rate"] == "slow" and draw.share["rate"] < AT_REST


def creeps(draw: Draw) -> bool:
    """Whether it hardly turns from one step to the next."""
    share = draw.share["rate"]
    return draw.traits["rate"] == "slow" and CREEPING[0] <= share < CREEPING[1]


def spin_of(random: Generator, draw: Draw, inertia: Array) -> Array:
    """The direction of omega, with three different components.

    A body that spins steadily, and is no sphere, turns about the axis of its largest moment.
    """
    moments = np.diag(inertia)
    if not draw.steady or np.ptp(moments) == 0.0:
        return oblique(random)
    return np.where(moments == np.max(moments), random.choice([-1.0, 1.0]), 0.0)


def initial_of(
    random: Generator, draw: Draw, inertia: Array, size: float, rate: float
) -> dict[str, Any]:
    """A rate about some axis, or at rest; a free body somewhere, and moving."""
    omega = np.zeros(3) if rests(draw) else rate * spin_of(random, draw, inertia)
    initial: dict[str, Any] = {
        "orientation": list(quaternion(random, draw.traits["scalar"])),
        "angular_velocity": rounded(omega),
    }
    speed = size * rate
    if draw.traits["support"] == "flying":
        speed = min(between(SPEEDS, draw.share["speed"]), FASTEST * speed)
    if not draw.traits["support"].startswith("pivot"):
        place = 3.0 * size * random.standard_normal(3)
        if draw.traits["support"] == "flying":
            place = min(between(PLACES, draw.share["place"]), FURTHEST * size) * oblique(random)
        initial["position"] = rounded(place)
        initial["linear_velocity"] = rounded(speed * oblique(random))
    return initial
