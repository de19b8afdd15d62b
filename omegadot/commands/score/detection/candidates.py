"""The readings that a trace may come in, each with how far it misses the exact trajectory."""

from __future__ import annotations

import itertools
from collections.abc import Iterator

import numpy as np

from omegadot.commands.score.detection.numbers import (
    AXES,
    AXES_Q,
    Numbers,
    Rotated,
    runs,
    stacked,
)
from omegadot.commands.score.detection.parts import Attitude, Omega
from omegadot.commands.units import UNITS
from omegadot.gates.scales import norm
from omegadot.reference_impl.rotations import (
    attitude_angle,
    conjugate,
    quaternion_product,
    rotate_inverse,
)
from omegadot.reference_impl.system import Array

# A candidate that misses by more than this part of the motion is none.
GROSS = 0.05


def attitudes(numbers: Numbers, axes: int, limit: float = GROSS) -> list[Attitude]:
    """Every reading of the attitude that misses by `limit` at most; none if the body never turns.

    How far the body has turned since the first sample does not depend on the axes, so that is
    looked at before any axes are tried: the first `axes` of AXES, for world and body each.
    """
    exact = numbers.orientation
    found: list[Attitude] = []
    if numbers.turn == 0.0:
        return []
    turned = attitude_angle(exact[:1], exact)
    for rotated in numbers.rotations:
        q = rotated.q
        apart = np.abs(attitude_angle(q[:1], q) - turned)
        if np.median(apart) > limit * numbers.turn:
            continue
        for direction in ("world-from-body", "body-from-world"):
            own = q if direction == "world-from-body" else conjugate(q)
            found += _with_axes(numbers, own, rotated, direction, axes, limit)
    return found


def _with_axes(
    numbers: Numbers, q: Array, rotated: Rotated, direction: str, axes: int, limit: float
) -> Iterator[Attitude]:
    """The reading with every pair of world and body axes: ``world q body^-1``."""
    left = quaternion_product(AXES_Q[:axes, None], q)
    for body, turn in enumerate(AXES_Q[:axes]):
        own = quaternion_product(left, conjugate(turn))
        misfits = np.median(attitude_angle(own, numbers.orientation), axis=-1) / numbers.turn
        for world in np.flatnonzero(misfits < limit):
            yield Attitude(
                float(misfits[world]),
                rotated.columns,
                rotated.kind,
                rotated.unit,
                direction,
                int(world),
                body,
                own[world],
            )


def omegas(
    numbers: Numbers, attitude: Attitude | None, axes: int, limit: float = GROSS
) -> list[Omega]:
    """Every reading of omega that misses by `limit` at most; in world axes too with an attitude."""
    found: list[Omega] = []
    sizes = norm(numbers.angular_velocity)
    for three in runs(list(numbers.columns), 3):
        given = norm(stacked(numbers.columns, three))
        for unit, scale in UNITS["rate"].items():
            if np.median(np.abs(scale * given - sizes)) > limit * numbers.rate:
                continue
            for order in itertools.permutations(three):
                values = scale * stacked(numbers.columns, order)
                found += _spins(numbers, values, order, unit, attitude, axes, limit)
    return found


def _spins(
    numbers: Numbers,
    values: Array,
    columns: tuple[str, ...],
    unit: str,
    attitude: Attitude | None,
    axes: int,
    limit: float,
) -> Iterator[Omega]:
    """The reading in body and, with an attitude, in world axes; the axes are the attitude's."""
    turned: Array = values @ np.swapaxes(AXES[:axes], -1, -2)
    readings = {"body": turned}
    if attitude is not None:
        readings["world"] = rotate_inverse(attitude.orientation, turned)
    for frame, own in readings.items():
        gaps = np.median(norm(own - numbers.angular_velocity), axis=-1) / numbers.rate
        wanted = None
        if attitude is not None:
            wanted = attitude.body if frame == "body" else attitude.world
        for place in np.flatnonzero(gaps < limit):
            if wanted is None or place == wanted:
                yield Omega(float(gaps[place]), columns, unit, frame, int(place))
