"""In whose axes an engine keeps a vector, found from what the engine makes of one it is given."""

from __future__ import annotations

import numpy as np

from omegadot.reference_impl.system import Array
from omegadot.written import written

# A third of a turn about (1, 1, 1): x goes to y, so the two answers cannot be mistaken.
TURNED = np.array([[0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])
TURNED_QUATERNION = (0.5, 0.5, 0.5, 0.5)  # w x y z, or any other order
GIVEN = np.array([1.0, 0.0, 0.0])


def axes_observed(seen_in_world: Array) -> str:
    """Whose axes ``GIVEN`` was taken in by a body at ``TURNED``, of what is seen of it in world.

    Some roundings are granted; anything else is reported as it is.
    """
    close = 64 * np.finfo(float).eps
    if np.all(np.abs(seen_in_world - GIVEN) <= close):
        return "world axes"
    if np.all(np.abs(seen_in_world - TURNED @ GIVEN) <= close):
        return "body axes"
    return f"neither body nor world axes: (1, 0, 0) is seen as {described(seen_in_world)}"


def described(value: object) -> str:
    """A setting as text that is the same wherever the setting is the same."""
    array = np.asarray(value)
    if array.ndim:
        return f"({', '.join(described(item) for item in array.ravel())})"
    return written(array.item(), 12) if array.dtype.kind == "f" else str(array.item())
