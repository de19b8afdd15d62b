"""A scheme stepped from a start to an end, with the steps kept that were requested."""

from __future__ import annotations

import time
from dataclasses import dataclass
from itertools import repeat

import numpy as np

from omegadot.reference_impl.arithmetic.components import in_lanes
from omegadot.reference_impl.coordinates import (
    Coordinates,
    canonical,
    from_coordinates,
    to_coordinates,
)
from omegadot.reference_impl.one_body.body_motion import body_motion
from omegadot.reference_impl.schemes import Motion, Scheme
from omegadot.reference_impl.system import Array, State, System


def kept_steps(steps: int, every: int) -> list[int]:
    """The numbers of the steps that are logged: 0, each `every`-th, and the last."""
    if steps < 0 or every < 1:
        raise ValueError(f"steps is {steps} and every is {every}; give steps >= 0 and every >= 1")
    kept = list(range(0, steps + 1, every))
    return kept if kept[-1] == steps else [*kept, steps]


@dataclass(frozen=True)
class Stepped:
    """The kept steps of a motion: time (samples, ...) s, q and v (samples, ..., k).

    seconds: s that the steps took, with what is kept of them but nothing made of it.
    """

    time: Array
    q: Array
    v: Array
    seconds: float


def step_through(
    scheme: Scheme,
    motion: Motion,
    q: Array,
    v: Array,
    dt: float | Array,
    steps: int,
    every: int,
) -> Stepped:
    """A motion stepped, with step 0, each `every`-th and the last kept.

    dt: s, a float, or an array; the lanes are those of dt, of q and of v, broadcast against each
    other, and all take as many steps. Times are ``n * dt``, (samples,) or (samples, *dt.shape);
    q and v have the samples in front. A run that diverges goes on with infinities and NaN, without
    warnings.
    Raises ValueError for negative steps or `every` below one.
    """
    kept, step = kept_steps(steps, every), scheme.step
    times = np.multiply.outer(kept, dt)
    lanes = np.broadcast_shapes(np.shape(dt), q.shape[:-1], v.shape[:-1])
    plain = np.ndim(dt) == 0 and not isinstance(dt, np.longdouble)
    h = float(dt) if plain else np.asarray(dt)[..., None]
    if lanes:
        q, v = in_lanes(q, lanes), in_lanes(v, lanes)
    places, velocities = [q], [v]
    with np.errstate(over="ignore", invalid="ignore", divide="ignore"):
        began = time.perf_counter()
        for count in np.diff(kept).tolist():
            for _ in repeat(None, count):
                q, v = step(motion, q, v, h)
            places.append(q)
            velocities.append(v)
        seconds = time.perf_counter() - began
    return Stepped(times, np.stack(places), np.stack(velocities), seconds)


def step_body(
    scheme: Scheme,
    system: System,
    initial: State,
    dt: float | Array,
    steps: int,
    every: int,
    coordinates: Coordinates = "com-world",
    motion: Motion | None = None,
) -> tuple[Array, State]:
    """Times and states of one body, as `step_through`, stepped in these coordinates.

    motion: what is stepped in place of the reference's own `body_motion`. A pivoted body's
    position and velocity follow from its attitude and ω. Raises ValueError where the scheme cannot
    be stepped in these coordinates.
    """
    if canonical(system, coordinates) not in scheme.coordinates:
        raise ValueError(f"{scheme.name} is not known in {coordinates} coordinates")
    q, v = to_coordinates(system, initial, coordinates)
    stepped = motion or body_motion(system, coordinates)
    found = step_through(scheme, stepped, q, v, dt, steps, every)
    with np.errstate(over="ignore", invalid="ignore"):
        return found.time, from_coordinates(system, found.q, found.v, coordinates)


def stack(states: list[State]) -> State:
    """Many states as one, with a new axis in front."""
    fields = zip(*(vars(state).values() for state in states), strict=True)
    return State(*(np.stack(values) for values in fields))
