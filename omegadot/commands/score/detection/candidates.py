"""The readings that a trace may come in, each with how far it misses the exact trajectory."""

from __future__ import annotations

import itertools
from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from omegadot.commands.score.detection.numbers import (
    AXES,
    AXES_Q,
    SAME,
    Numbers,
    Rotated,
    runs,
    stacked,
)
from omegadot.commands.units import UNITS
from omegadot.gates.bounds.scales import norm
from omegadot.reference_impl.rotations import (
    attitude_angle,
    conjugate,
    quaternion_product,
    rotate_inverse,
)
from omegadot.reference_impl.system import Array

# A candidate that misses by more than this part of the motion is none.
GROSS = 0.05
USUAL = ("quaternion wxyz", "quaternion xyzw", "ZYX", "matrix")


@dataclass(frozen=True)
class Attitude(Rotated):
    """One way to read the attitude. misfit: the median error over the turn of the motion.

    world and body: rows of AXES.  orientation: (n, 4), as it is then read.
    """

    direction: str
    world: int
    body: int
    misfit: float
    orientation: Array

    def read(self, columns: dict[str, Array]) -> Array:
        """(n, 4): other numbers in these columns, read so."""
        q = super().read(columns)
        own = q if self.direction == "world-from-body" else conjugate(q)
        return quaternion_product(
            quaternion_product(AXES_Q[self.world], own), conjugate(AXES_Q[self.body])
        )

    @property
    def plainness(self) -> tuple[object, ...]:
        """For ordering readings that fit alike: the plainer one first."""
        place = USUAL.index(self.kind) if self.kind in USUAL else len(USUAL)
        return (self.world != SAME, self.body != SAME, self.direction != "world-from-body", place)


@dataclass(frozen=True)
class Omega:
    """One way to read omega. axes: a row of AXES, of the body's or the world's."""

    columns: tuple[str, ...]
    unit: str
    frame: str
    axes: int
    misfit: float = 0.0

    def read(self, columns: dict[str, Array], orientation: Array | None) -> Array:
        """(n, 3) rad/s in body axes: the numbers in these columns, read so."""
        scale = UNITS["rate"][self.unit]
        values: Array = scale * stacked(columns, self.columns) @ AXES[self.axes].T
        if self.frame == "body" or orientation is None:
            return values
        return rotate_inverse(orientation, values)

    @property
    def plainness(self) -> tuple[object, ...]:
        """For ordering readings that fit alike: the plainer one first."""
        units = list(UNITS["rate"])
        return (self.axes != SAME, self.frame != "body", units.index(self.unit))


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
    for rotated, q in numbers.rotations:
        apart = np.abs(attitude_angle(q[:1], q) - turned)
        if np.median(apart) <= limit * numbers.turn:
            found += _with_axes(numbers, q, rotated, "world-from-body", axes, limit)
            found += _with_axes(numbers, conjugate(q), rotated, "body-from-world", axes, limit)
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
            how = (direction, int(world), body, float(misfits[world]), own[world])
            yield Attitude(rotated.columns, rotated.kind, rotated.unit, *how)


def omegas(
    numbers: Numbers, attitude: Attitude | None, axes: int, limit: float = GROSS
) -> list[Omega]:
    """Every reading of omega that misses by `limit` at most; in world axes too with an attitude.

    The axes are then the attitude's.
    """
    found: list[Omega] = []
    sizes = norm(numbers.angular_velocity)
    orientation = None if attitude is None else attitude.orientation
    tried = [("body", axis) for axis in range(axes)]
    if attitude is not None:
        own = [("body", attitude.body), ("world", attitude.world)]
        tried = [(frame, axis) for frame, axis in own if axis < axes]
    for three in runs(list(numbers.columns), 3):
        given = norm(stacked(numbers.columns, three))
        for unit, scale in UNITS["rate"].items():
            if np.median(np.abs(scale * given - sizes)) > limit * numbers.rate:
                continue
            for order, (frame, axis) in itertools.product(itertools.permutations(three), tried):
                one = Omega(order, unit, frame, axis)
                gap = norm(one.read(numbers.columns, orientation) - numbers.angular_velocity)
                misfit = float(np.median(gap, axis=-1) / numbers.rate)
                found += [replace(one, misfit=misfit)] if misfit < limit else []
    return found
