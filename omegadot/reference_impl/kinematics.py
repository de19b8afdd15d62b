"""Velocities of points of a moving body: section 2.2.1, equation (3).

The paper's two-dimensional example differentiates ``(sin θ, cos θ)`` to ``(-cos θ, sin θ)``; the
derivative is ``(cos θ, -sin θ)``, which is ``r(θ + π/2)`` as the line after it states. Equation (3)
is not touched by the slip.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from omegadot.reference_impl.cross_product import cross
from omegadot.reference_impl.inertia import lever
from omegadot.reference_impl.rotations import rotate
from omegadot.reference_impl.system import Array, State, System


def point_position(state: State, r: Array) -> Array:
    """Where the point ``r`` is, (..., 3) m, world; r from the centre of mass, body axes."""
    position: Array = state.position + rotate(state.orientation, r)
    return position


def point_velocity(state: State, r: Array) -> Array:
    """``v(r) = ω × r + ẋ``, (..., 3) m/s, world. Equation (3).

    r: (..., 3) m from the centre of mass, body axes. The product is formed in body axes, where ω
    and r are given, and then turned into the world.
    """
    velocity: Array = (
        rotate(state.orientation, cross(state.angular_velocity, r)) + state.linear_velocity
    )
    return velocity


def at_point(state: State, r: Array) -> State:
    """The state with position and velocity of the point ``r``, from the centre of mass, body axes.

    With -r of that state, back again.
    """
    return replace(
        state, position=point_position(state, r), linear_velocity=point_velocity(state, r)
    )


def place_on_pivot(system: System, state: State) -> State:
    """The state with position and velocity of the centre of mass as the pivot dictates.

    The pivot is at rest at the world origin, so ``x = R r`` and, by (3), ``ẋ = R (ω × r)`` with r
    from the pivot to the centre of mass. A free body's state comes back as it is.
    """
    if system.load.pivot is None:
        return state
    origin = np.zeros_like(state.angular_velocity)
    return at_point(replace(state, position=origin, linear_velocity=origin), lever(system))
