"""The solids a body may be put together from, one ``[[body.part]]`` each.

Every part is homogeneous and has its own axes: `position` is its centre in body axes, from the
body origin, in m; `orientation` is the quaternion (w x y z) that turns part axes into body axes.
Its amount is `mass` in kg or `density` in kg/m^3, exactly one of the two; a point has a mass only.

==========  =====================================================================
shape       sizes, in m
==========  =====================================================================
box         ``size = [x, y, z]``, the full edge lengths
cylinder    ``radius`` and ``length``, the axis along z
sphere      ``radius``
ellipsoid   ``semi_axes = [x, y, z]``
capsule     ``radius`` and ``length`` of the cylinder between the caps, the axis along z
point       none
==========  =====================================================================
"""

from __future__ import annotations

from typing import Annotated, Literal, Self

from pydantic import Field, model_validator

from omegadot.scenarios.errors import Phrase
from omegadot.scenarios.quantities import Lengths, Positive, Quaternion, Table, Vector, refuse


class _Placed(Table):
    position: Vector = Field(default=(0.0, 0.0, 0.0), description="m, the centre, body axes")
    orientation: Quaternion = Field(default=(1.0, 0.0, 0.0, 0.0), description="w, x, y, z")


class _Solid(_Placed):
    mass: Positive | None = Field(default=None, description="kg")
    density: Positive | None = Field(default=None, description="kg/m^3")

    @model_validator(mode="after")
    def _mass_or_density(self) -> Self:
        if self.mass is None and self.density is None:
            raise refuse("give either mass or density", key="mass", found=Phrase("missing"))
        if self.mass is not None and self.density is not None:
            advice = "leave out mass or density, one gives the other"
            raise refuse(advice, key="density", found=self.density)
        return self


class Box(_Solid):
    """A cuboid."""

    shape: Literal["box"]
    size: Lengths = Field(description="m, the full edge lengths x, y, z")


class Cylinder(_Solid):
    """A solid circular cylinder, its axis along z."""

    shape: Literal["cylinder"]
    radius: Positive = Field(description="m")
    length: Positive = Field(description="m, along z")


class Sphere(_Solid):
    """A solid ball."""

    shape: Literal["sphere"]
    radius: Positive = Field(description="m")


class Ellipsoid(_Solid):
    """A solid ellipsoid."""

    shape: Literal["ellipsoid"]
    semi_axes: Lengths = Field(description="m, along x, y, z")


class Capsule(_Solid):
    """A solid cylinder along z with a half ball on either end."""

    shape: Literal["capsule"]
    radius: Positive = Field(description="m")
    length: Positive = Field(description="m, of the cylinder between the caps, along z")


class Point(_Placed):
    """A point mass."""

    shape: Literal["point"]
    mass: Positive = Field(description="kg")


SHAPES: dict[str, type[_Placed]] = {
    kind.__name__.lower(): kind for kind in (Box, Cylinder, Sphere, Ellipsoid, Capsule, Point)
}
Part = Annotated[
    Box | Cylinder | Sphere | Ellipsoid | Capsule | Point, Field(discriminator="shape")
]
