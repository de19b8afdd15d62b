"""Mass, centre of mass and inertia of bodies built from parts: section 2.3.2, equation (5).

``I = ∫ ρ r_×ᵀ r_× dΩ`` about the centre of mass. The integral over each shape is held by the shape
itself (`mean_squares` in ``omegadot.scenarios.solids``: of x, y and z over the solid).
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from omegadot.reference_impl.cross_product import skew
from omegadot.reference_impl.formed_once import formed_once
from omegadot.reference_impl.rotations import rotation_matrix
from omegadot.reference_impl.system import Array, Body, System


def inertia_of_moments(mass: Array | float, mean_squares: Array) -> Array:
    """``I = m (tr G 1 - G)``, (..., 3, 3) kg m², of a solid with mean squares of x, y, z.

    Equation (5) with ``r_×ᵀ r_× = (r · r) 1 - r rᵀ`` taken under the integral: ``∫ ρ r rᵀ dΩ`` is
    ``m G``, and G is ``diag(mean_squares)`` in axes of symmetry. mean_squares: (..., 3) m².
    """
    g = np.asarray(mean_squares)
    moments = np.add.reduce(g, -1, keepdims=True) - g
    return np.asarray(mass)[..., None, None] * (moments[..., None] * np.eye(3))


def parallel_axis(mass: Array | float, offset: Array) -> Array:
    """``m d_×^T d_×``, (..., 3, 3): what (5) adds when the axes move by ``offset`` d (..., 3)."""
    d_x = skew(offset)
    return np.expand_dims(mass, (-2, -1)) * (np.swapaxes(d_x, -1, -2) @ d_x)


def place(part: Body, position: Array, orientation: Array) -> Body:
    """A part moved into the body: turned by the quaternion, then shifted to ``position`` (3,) m."""
    body_R_part = rotation_matrix(orientation)
    return Body(
        mass=part.mass,
        center_of_mass=position + body_R_part @ part.center_of_mass,
        inertia=body_R_part @ part.inertia @ body_R_part.T,
    )


def assemble(parts: Sequence[Body]) -> Body:
    """One body of many parts: (5) is additive, each part shifted to the common centre of mass."""
    mass = np.sum([part.mass for part in parts], axis=0)
    center = np.sum([part.mass * part.center_of_mass for part in parts], axis=0) / mass
    inertia = np.sum(
        [part.inertia + parallel_axis(part.mass, part.center_of_mass - center) for part in parts],
        axis=0,
    )
    return Body(mass=mass, center_of_mass=center, inertia=inertia)


@formed_once
def lever(system: System) -> Array:
    """From the pivot to the centre of mass, (..., 3) m, body axes. Zero for a free body."""
    center = system.body.center_of_mass
    pivot = system.load.pivot
    return np.zeros_like(center) if pivot is None else center - pivot


@formed_once
def moving_inertia(system: System) -> Array:
    """The inertia that angular motion meets, (..., 3, 3) kg m², body axes.

    About the centre of mass for a free body, about the pivot for a pivoted one.
    """
    body = system.body
    if system.load.pivot is None:
        return body.inertia
    return body.inertia + parallel_axis(body.mass, lever(system))
