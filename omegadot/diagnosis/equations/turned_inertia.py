"""The inertia turned wrongly between body and world, by an engine that solves in world axes.

There the inertia about what stays is ``R I R^T``. An engine with ``J`` in its place solves
``omega-dot = R^T J^-1 (R tau - R omega x J R omega)``. Vectors are turned, not the tensor: of a
thin body a tensor that is turned and inverted is known less well than what it is applied to.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator

import numpy as np

from omegadot.diagnosis.equations.evidence import Evidence
from omegadot.diagnosis.equations.operators.operands import loads, turned
from omegadot.reference_impl.cross_product import cross
from omegadot.reference_impl.inertia import moving_inertia
from omegadot.reference_impl.rotations import rotate, rotate_inverse
from omegadot.reference_impl.symmetric import apply, inverse
from omegadot.reference_impl.system import Acceleration, Array

Made = Callable[[Evidence], Acceleration]
# J in the place of R I R^T: what turns a vector of the world before I is applied, and after.
# R (+1), R^T (-1) or nothing (0).
IN_WORLD = {"R^T I R": (1, -1), "I, not turned": (0, 0), "R I": (0, 1), "I R^T": (-1, 0)}


def turned_inertias() -> Iterator[tuple[str, Made]]:
    """Each as a cause and the accelerations it makes."""
    for text, ways in IN_WORLD.items():
        wrong = f"the inertia in world axes is {text}, where R I R^T was due"
        yield wrong, _made(*ways, solve=True, spin=True)
        yield f"where omega-dot is solved for, {wrong}", _made(*ways, solve=True, spin=False)
        yield f"in the gyroscopic term, {wrong}", _made(*ways, solve=False, spin=True)


def _made(before: int, after: int, solve: bool, spin: bool) -> Made:
    def there(e: Evidence) -> Acceleration:
        inertia = np.asarray(moving_inertia(e.system), dtype=float)
        q, w = e.states.orientation, e.states.angular_velocity

        def other(vector: Array) -> Array:
            """R^T J R of a vector in body axes."""
            inner = _turned(q, _turned(q, vector, 1), before)
            return _turned(q, _turned(q, apply(inertia, inner), after), -1)

        def solved(vector: Array) -> Array:
            """R^T J^-1 R of a vector in body axes."""
            inner = _turned(q, _turned(q, vector, 1), -after)
            return _turned(q, _turned(q, apply(inverse(inertia), inner), -before), -1)

        # not I omega-dot, which has the rounding of what was solved for
        torque = loads(e.system, e.states) - cross(w, other(w) if spin else apply(inertia, w))
        return turned(e, solved(torque) if solve else apply(inverse(inertia), torque))

    return there


def _turned(q: Array, vector: Array, way: int) -> Array:
    if way == 0:
        return vector
    return rotate(q, vector) if way > 0 else rotate_inverse(q, vector)
