"""In which axes a body goes into Exudyn: its own, or these turned by 120 degrees.

Exudyn composes a rotation vector with a step's turn by quaternions, and takes the angle theta of
the result from its cosine: the rounding of theta is ``eps / theta``, so that near no turn at all
half of the digits are lost. A body that begins at no turn, as most do, would begin there. The turn
exchanges axes, so that no number is rounded.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from omegadot.reference_impl.rotations import quaternion_product
from omegadot.reference_impl.system import Array

# Body from node: x to z, y to x, z to y. In three angles x y z it is not singular, as its inverse.
EXCHANGE = np.array([0.5, -0.5, -0.5, -0.5])
BACK = np.array([0.5, 0.5, 0.5, 0.5])


@dataclass(frozen=True)
class Axes:
    """turned: whether they are exchanged. Vectors are (..., 3), tensors (3, 3)."""

    turned: bool

    @property
    def others(self) -> Axes:
        """The other axes of the two."""
        return Axes(not self.turned)

    def in_node(self, vector: Array) -> Array:
        """Components in the node's axes of a vector in the body's."""
        return np.roll(vector, 1, axis=-1) if self.turned else vector

    def in_body(self, vector: Array) -> Array:
        """Components in the body's axes of a vector in the node's."""
        return np.roll(vector, -1, axis=-1) if self.turned else vector

    def tensor_in_node(self, tensor: Array) -> Array:
        """Components in the node's axes of a tensor in the body's."""
        return np.roll(tensor, (1, 1), axis=(0, 1)) if self.turned else tensor

    def tensor_in_body(self, tensor: Array) -> Array:
        """Components in the body's axes of a tensor in the node's."""
        return np.roll(tensor, (-1, -1), axis=(0, 1)) if self.turned else tensor

    def of_node(self, q: Array) -> Array:
        """World from node, (..., 4), of world from body."""
        return quaternion_product(q, EXCHANGE) if self.turned else q

    def of_body(self, q: Array) -> Array:
        """World from body, (..., 4), of world from node."""
        return quaternion_product(q, BACK) if self.turned else q
