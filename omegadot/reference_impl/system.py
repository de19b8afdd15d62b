"""What moves: bodies, the loads on them, and the state they are in.

Every array broadcasts over leading axes, so one body and a million take the same code.
SI units. Quaternions are ``(w, x, y, z)``, unit, world-from-body.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.floating]


def _zeros3() -> Array:
    return np.zeros(3)


@dataclass(frozen=True)
class Body:
    """One rigid body.

    mass: (...) kg.  center_of_mass: (..., 3) m, from the body origin, body axes.
    inertia: (..., 3, 3) kg m^2, about the centre of mass, body axes.
    """

    mass: Array
    center_of_mass: Array
    inertia: Array


@dataclass(frozen=True)
class Load:
    """What acts on the body besides its own inertia.

    gravity: (..., 3) m/s^2, world.  pivot: (..., 3) m from the body origin in body axes, the point
    held fixed at the world origin, or None for a free body.  damping: (...) N m s/rad, the torque
    is ``-damping * omega``.  torque_body and torque_world: (..., 3) N m, constant in those axes.
    """

    gravity: Array = field(default_factory=_zeros3)
    pivot: Array | None = None
    damping: Array = field(default_factory=lambda: np.zeros(()))
    torque_body: Array = field(default_factory=_zeros3)
    torque_world: Array = field(default_factory=_zeros3)


@dataclass(frozen=True)
class System:
    """The bodies and their load. One body today; chains and trees will have more."""

    bodies: tuple[Body, ...]
    load: Load = field(default_factory=Load)

    @property
    def body(self) -> Body:
        """The only body. Raises ValueError when there is more than one."""
        if len(self.bodies) != 1:
            raise ValueError(f"the system has {len(self.bodies)} bodies, one was expected")
        return self.bodies[0]


@dataclass(frozen=True)
class State:
    """Where a body is and how it moves.

    orientation: (..., 4) unit quaternion, world_R_body.  angular_velocity: (..., 3) rad/s, body
    frame.  position and linear_velocity: (..., 3) m and m/s, of the centre of mass, world frame.
    """

    orientation: Array
    angular_velocity: Array
    position: Array
    linear_velocity: Array

    def __getitem__(self, places: Any) -> State:
        """The states at these places of the leading axes."""
        return State(*(values[places] for values in vars(self).values()))


@dataclass(frozen=True)
class Acceleration:
    """angular: (..., 3) rad/s^2, omega-dot in the body frame.
    linear: (..., 3) m/s^2, of the centre of mass, world frame.
    """

    angular: Array
    linear: Array

    def __getitem__(self, places: Any) -> Acceleration:
        """Those at these places of the leading axes."""
        return Acceleration(self.angular[places], self.linear[places])
