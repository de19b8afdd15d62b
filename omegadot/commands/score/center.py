"""From the motion of the body's origin to that of its centre of mass."""

from __future__ import annotations

import numpy as np

from omegadot.commands.score.table import Table, TraceError
from omegadot.reference_impl.cross_product import cross
from omegadot.reference_impl.rotations import normalize, rotate
from omegadot.reference_impl.system import Array, System


def to_center(
    table: Table,
    system: System,
    moved: dict[str, Array | None],
    orientation: Array | None,
    omega: Array | None,
) -> dict[str, Array | None]:
    """From the body's origin to its centre of mass: ``x + R c`` and ``v + R (omega x c)``."""
    c = system.body.center_of_mass
    position, velocity = moved["position"], moved["linear_velocity"]
    if not np.any(c):
        return moved
    needed = [orientation] if velocity is None else [orientation, omega]
    if position is None and velocity is None:
        return moved
    if orientation is None or any(part is None for part in needed):
        raise TraceError(
            f"{table.file}: it is the origin's position that is given, and the attitude or omega, "
            "which place the centre of mass, is not; map them too."
        )
    q = normalize(orientation)
    if position is not None:
        position = position + rotate(q, np.broadcast_to(c, position.shape))
    if velocity is not None and omega is not None:
        velocity = velocity + rotate(q, cross(omega, np.broadcast_to(c, omega.shape)))
    return {"position": position, "linear_velocity": velocity}
