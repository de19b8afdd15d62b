"""Attitudes that go wrong on the way in: of whole states, or in the torques of loads alone."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace
from functools import partial
from itertools import product

import numpy as np

from omegadot.diagnosis.equations.evidence import Evidence
from omegadot.diagnosis.equations.operators.operands import pushed
from omegadot.diagnosis.models.euler_angles import Misread
from omegadot.diagnosis.models.passed_attitudes import passed_attitudes
from omegadot.reference_impl.kinematics import place_on_pivot
from omegadot.reference_impl.loads import gravity_torque, torque
from omegadot.reference_impl.motion import forward_dynamics
from omegadot.reference_impl.rotations import conjugate, rotate_inverse
from omegadot.reference_impl.system import Acceleration, Array, State, System

Made = Callable[[Evidence], Acceleration]


Loads = Callable[[System, State], Array]


def _in_world(system: System, states: State) -> Array:
    return rotate_inverse(states.orientation, system.load.torque_world)


# Loads that are turned into the body, N m in body axes.
LOADS: dict[str, Loads] = {
    "in the torques of the loads": torque,
    "in the torque in world axes": _in_world,
    "in the torque of gravity": gravity_torque,
}
# Angles of one order of axes, put together in the opposite order.
REVERSED = [Misread(one, one[::-1], (2, 1, 0), np.ones(3)) for one in ("ZYX", "XYZ")]


def other_attitudes() -> Iterator[tuple[str, Made]]:
    """Each as text, and the accelerations that it makes."""
    changes: dict[str, Callable[[Array], Array]] = {
        one.text: one.made for one in next(passed_attitudes())
    }
    changes |= {one.text: one.attitudes for one in REVERSED}
    for text, change in changes.items():
        yield f"on the way in, {text}", partial(_of_state, change)
    # of a whole state these are among the misreadings
    changes["the rotation looks transposed: the quaternion is conjugated"] = conjugate
    changes["the quaternion is read as (x, y, z, w)"] = lambda q: np.roll(q, 1, axis=-1)
    for (where, loads), (text, change) in product(LOADS.items(), changes.items()):
        yield f"{where}, {text}", partial(_of_loads, change, loads)


def in_loads(text: str) -> str:
    """What becomes of the attitude in some loads, of a text that is of these; "" of any other."""
    where, _, change = text.partition(", ")
    return change if where in LOADS else ""


def _of_state(change: Callable[[Array], Array], e: Evidence) -> Acceleration:
    other = replace(e.states, orientation=change(e.states.orientation))
    return forward_dynamics(e.system, place_on_pivot(e.system, other))


def _of_loads(change: Callable[[Array], Array], loads: Loads, e: Evidence) -> Acceleration:
    other = replace(e.states, orientation=change(e.states.orientation))
    return pushed(e, loads(e.system, other) - loads(e.system, e.states))
