"""A trace's columns as numbers, and everything that they may be as rotations."""

from __future__ import annotations

import itertools
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.spatial.transform import Rotation

from omegadot.commands.score.attitude import MOST_OFF, off_rotation, wxyz
from omegadot.commands.units import UNITS
from omegadot.gates.bounds.scales import norm
from omegadot.reference_impl.rotations import attitude_angle, normalize
from omegadot.reference_impl.system import Array

SEQUENCES = tuple(
    "".join(axes)
    for axes in itertools.product("ZYX", repeat=3)
    if axes[0] != axes[1] and axes[1] != axes[2]
)


def _turns() -> Array:
    """(24, 3, 3): the rotations that take axes to axes, the identity first."""
    signs = list(itertools.product((1.0, -1.0), repeat=3))
    orders = itertools.permutations(range(3))
    turns = (np.diag(sign)[:, order] for order, sign in itertools.product(orders, signs))
    proper = [matrix for matrix in turns if np.linalg.det(matrix) > 0.0]
    return np.array(sorted(proper, key=lambda matrix: -np.trace(matrix)))


AXES = _turns()
AXES_Q = wxyz(Rotation.from_matrix(AXES))
SAME = 0


@dataclass(frozen=True)
class Rotated:
    """A way to read columns as rotations, whatever these turn into what.

    kind: quaternion wxyz, quaternion xyzw, matrix, or a sequence of Euler angles.
    """

    columns: tuple[str, ...]
    kind: str
    unit: str

    def read(self, columns: dict[str, Array]) -> Array:
        """(n, 4): the numbers in these columns, read so."""
        values = stacked(columns, self.columns)
        if self.kind.startswith("quaternion"):
            return normalize(np.roll(values, 1, axis=-1) if self.kind.endswith("xyzw") else values)
        if self.kind == "matrix":
            return wxyz(Rotation.from_matrix(values.reshape(-1, 3, 3)))
        return wxyz(Rotation.from_euler(self.kind, UNITS["angle"][self.unit] * values))


@dataclass(frozen=True)
class Numbers:
    """A trace's columns and the exact trajectory at its samples. turn: rad, how far it turns."""

    columns: dict[str, Array]
    orientation: Array
    angular_velocity: Array
    rotations: list[tuple[Rotated, Array]]

    @property
    def rate(self) -> float:
        """rad/s, the greatest |omega|; one where the body never turns."""
        return float(np.max(norm(self.angular_velocity))) or 1.0

    @property
    def turn(self) -> float:
        """rad, the farthest turn from the first sample, one at most."""
        angles = attitude_angle(self.orientation[:1], self.orientation)
        return min(1.0, float(np.max(angles)))


def stacked(columns: dict[str, Array], names: Sequence[str]) -> Array:
    """(n, k) of some columns."""
    return np.asarray(np.stack([columns[name] for name in names], axis=-1))


def runs(names: Sequence[str], length: int) -> Iterator[tuple[str, ...]]:
    """So many neighbouring columns, wherever they begin."""
    for start in range(len(names) - length + 1):
        yield tuple(names[start : start + length])


def rotations(columns: dict[str, Array]) -> Iterator[Rotated]:
    """Everything that neighbouring columns may be as a rotation."""
    names = list(columns)
    for four in runs(names, 4):
        if np.all(np.abs(norm(stacked(columns, four)) - 1.0) < MOST_OFF):
            yield Rotated(four, "quaternion wxyz", "rad")
            yield Rotated(four, "quaternion xyzw", "rad")
    for nine in runs(names, 9):
        if np.all(off_rotation(stacked(columns, nine)) < MOST_OFF):
            yield Rotated(nine, "matrix", "rad")
    for three in runs(names, 3):
        for order, unit in itertools.product(itertools.permutations(three), ("rad", "deg")):
            yield from (Rotated(order, sequence, unit) for sequence in SEQUENCES)
