"""Attitudes that go wrong on the way in: of whole states, or in the torques of loads alone."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace
from functools import partial

import numpy as np

from omegadot.diagnosis.equations.evidence import Evidence
from omegadot.diagnosis.equations.operators.operands import pushed
from omegadot.diagnosis.models.passed_attitudes import passed_attitudes
from omegadot.reference_impl.kinematics import place_on_pivot
from omegadot.reference_impl.loads import torque
from omegadot.reference_impl.motion import forward_dynamics
from omegadot.reference_impl.rotations import conjugate
from omegadot.reference_impl.system import Acceleration, Array

Made = Callable[[Evidence], Acceleration]


def other_attitudes() -> Iterator[tuple[str, Made]]:
    """Each as text, and the accelerations that it makes."""
    changes: dict[str, Callable[[Array], Array]] = {
        one.text: one.made for one in next(passed_attitudes())
    }
    for text, change in changes.items():
        yield f"on the way in, {text}", partial(_of_state, change)
    # of a whole state these are among the misreadings
    changes["the rotation looks transposed: the quaternion is conjugated"] = conjugate
    changes["the quaternion is read as (x, y, z, w)"] = lambda q: np.roll(q, 1, axis=-1)
    for text, change in changes.items():
        yield f"in the torques of the loads, {text}", partial(_of_loads, change)


def _of_state(change: Callable[[Array], Array], e: Evidence) -> Acceleration:
    other = replace(e.states, orientation=change(e.states.orientation))
    return forward_dynamics(e.system, place_on_pivot(e.system, other))


def _of_loads(change: Callable[[Array], Array], e: Evidence) -> Acceleration:
    other = replace(e.states, orientation=change(e.states.orientation))
    return pushed(e, torque(e.system, other) - torque(e.system, e.states))
