"""One way to read the attitude, and one to read omega."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from omegadot.commands.score.detection.numbers import (
    AXES,
    AXES_Q,
    SAME,
    rotation_of,
    stacked,
)
from omegadot.commands.units import UNITS
from omegadot.reference_impl.rotations import conjugate, quaternion_product, rotate_inverse
from omegadot.reference_impl.system import Array


@dataclass(frozen=True)
class Attitude:
    """One way to read the attitude. misfit: the median error over the turn of the motion.

    world and body: rows of AXES.  orientation: (n, 4), as it is then read.
    """

    misfit: float
    columns: tuple[str, ...]
    kind: str
    unit: str = "rad"
    direction: str = "world-from-body"
    world: int = SAME
    body: int = SAME
    orientation: Array = field(default_factory=lambda: np.empty(0), repr=False, compare=False)

    def read(self, columns: dict[str, Array]) -> Array:
        """(n, 4): other numbers in these columns, read so."""
        q = rotation_of(columns, self.columns, self.kind, self.unit)
        own = q if self.direction == "world-from-body" else conjugate(q)
        return quaternion_product(
            quaternion_product(AXES_Q[self.world], own), conjugate(AXES_Q[self.body])
        )

    @property
    def plainness(self) -> tuple[object, ...]:
        """For ordering readings that fit alike: the plainer one first."""
        usual = ["quaternion wxyz", "quaternion xyzw", "ZYX", "matrix"]
        place = usual.index(self.kind) if self.kind in usual else len(usual)
        return (self.world != SAME, self.body != SAME, self.direction != "world-from-body", place)


@dataclass(frozen=True)
class Omega:
    """One way to read omega. axes: a row of AXES, of the body's or the world's."""

    misfit: float
    columns: tuple[str, ...]
    unit: str
    frame: str = "body"
    axes: int = SAME

    def read(self, columns: dict[str, Array], orientation: Array | None) -> Array:
        """(n, 3) rad/s in body axes: other numbers in these columns, read so."""
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
