"""The inertia in world axes is another than ``R I R^T``: in the whole equation, or in a part."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from test_causes import causes_over
from wrong_equations import CASES

from omegadot.reference_impl.cross_product import cross
from omegadot.reference_impl.inertia import moving_inertia
from omegadot.reference_impl.loads import applied_torque, damping_torque, gravity_torque
from omegadot.reference_impl.motion import center_of_mass_acceleration
from omegadot.reference_impl.rotations import rotate, rotate_inverse, rotation_matrix
from omegadot.reference_impl.symmetric import apply
from omegadot.reference_impl.system import Acceleration, Array, State, System

FEW = CASES[::4]
IN_WORLD: dict[str, Callable[[Array, Array, Array], Array]] = {
    "R^T I R": lambda r, t, i: t @ i @ r,
    "I, not turned": lambda r, t, i: i + 0.0 * r,
    "R I": lambda r, t, i: r @ i,
    "I R^T": lambda r, t, i: i @ t,
}


@pytest.mark.parametrize("where", ["", "where omega-dot is solved for", "in the gyroscopic term"])
@pytest.mark.parametrize("name", IN_WORLD)
def test_an_inertia_that_is_turned_wrongly_is_named(name: str, where: str) -> None:
    """Built from matrices in world axes, as an engine that solves there has it."""

    def found(system: System, states: State) -> Acceleration:
        inertia, q = moving_inertia(system), states.orientation
        r = rotation_matrix(q)
        t = np.swapaxes(r, -1, -2)
        wrong, right = IN_WORLD[name](r, t, inertia), r @ inertia @ t
        spin = right if "solved" in where else wrong
        solve = right if "gyroscopic" in where else wrong
        w = rotate(q, states.angular_velocity)
        parts = (applied_torque, damping_torque, gravity_torque)
        torque = rotate(q, sum(part(system, states) for part in parts) + 0.0 * w)
        rest = torque - cross(w, apply(spin, w))
        angular = rotate_inverse(q, np.linalg.solve(solve, rest[..., None])[..., 0])
        if system.load.pivot is None:
            return Acceleration(angular, 0.0 * w + system.load.gravity)
        return Acceleration(angular, center_of_mass_acceleration(system, states, angular))

    causes = causes_over(found, FEW)
    due = f"the inertia in world axes is {name}, where R I R^T was due"
    assert set(causes.values()) == {f"{where}, {due}" if where else due}
    assert len(causes) == len(FEW)
