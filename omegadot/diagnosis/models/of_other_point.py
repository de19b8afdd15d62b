"""A place or a velocity that is taken for that of the other of two points, or is made so.

The body's origin and its centre of mass, which is at c from it in body axes: ``x_com = x_o + R c``
and ``v_com = v_o + R (omega x c)``.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator

import numpy as np

from omegadot.reference_impl.cross_product import cross
from omegadot.reference_impl.rotations import rotate
from omegadot.reference_impl.system import Array, State, System

POINTS = {
    1.0: "of the centre of mass taken for that of the body's origin",
    -1.0: "of the body's origin in place of that of the centre of mass",
}
# By quantity: its name, and what lies between the two points, in world axes and not turned.
BETWEEN = {
    "linear_velocity": ("the linear velocity", "R (omega x c)", "omega x c"),
    "position": ("the position", "R c", "c"),
}


def of_other_point(name: str) -> Iterator[tuple[str, Callable[[System, State], Array]]]:
    """Ways to make this quantity, of the states given; none of the attitude or of omega."""
    what, *terms = BETWEEN.get(name, ("",))
    for term in terms:
        for sign, points in POINTS.items():

            def made(
                system: System, state: State, sign: float = sign, turned: bool = term is terms[0]
            ) -> Array:
                return np.asarray(
                    getattr(state, name) + sign * _between(name, system, state, turned)
                )

            shift = f"{term} is {'added' if sign > 0.0 else 'taken off'}"
            yield f"with {what} {points}: {shift}", made


def _between(name: str, system: System, state: State, turned: bool) -> Array:
    """(n, 3): from the origin to the centre of mass, in m; or of their velocities, in m/s."""
    center = np.broadcast_to(system.body.center_of_mass, state.angular_velocity.shape)
    arm = center if name == "position" else cross(state.angular_velocity, center)
    return np.asarray(rotate(state.orientation, arm) if turned else arm)
