"""What goes into one torque, rounded to single precision there alone."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from test_causes import causes_over
from wrong_equations import CASES, GRAVITY, PIVOT, WORLD_TORQUE, case, with_torque

from omegadot.reference_impl.cross_product import cross
from omegadot.reference_impl.inertia import lever, moving_inertia
from omegadot.reference_impl.loads import applied_torque, gravity_torque, weight
from omegadot.reference_impl.rotations import rotate_inverse, rotation_matrix
from omegadot.reference_impl.symmetric import apply
from omegadot.reference_impl.system import Acceleration, Array, State, System

TOPS = tuple(
    case(f"top-{k}", {"gravity": GRAVITY, "pivot": [PIVOT[0], PIVOT[1], 0.1 * k]}, 1.1 + k)
    for k in range(3)
)
DRIVEN = (CASES[6], case("driven-more", {"torque": WORLD_TORQUE}, 3.3))
Torque = Callable[[System, State], Array]


def single(values: Array) -> Array:
    return np.asarray(values).astype(np.float32).astype(float)


def into_body(states: State, vector: Array) -> Array:
    return np.asarray(vector @ single(rotation_matrix(states.orientation)))


def weighed(system: System, states: State) -> Array:
    if system.load.pivot is None:
        return 0.0 * states.angular_velocity
    return cross(lever(system), into_body(states, weight(system))) - gravity_torque(system, states)


def twisted(system: System, states: State) -> Array:
    torque = into_body(states, system.load.torque_world) + system.load.torque_body
    return torque - applied_torque(system, states)


def by_arm(system: System, states: State) -> Array:
    down = rotate_inverse(states.orientation, weight(system))
    return cross(single(lever(system)), down) - gravity_torque(system, states)


def turned_weight(system: System, states: State) -> Array:
    down = single(rotate_inverse(states.orientation, weight(system)))
    return cross(lever(system), down) - gravity_torque(system, states)


def momentum(system: System, states: State) -> Array:
    w = states.angular_velocity
    whole = apply(moving_inertia(system), w)
    return cross(w, whole - single(whole))


ROUNDED = {
    "matrix": (
        lambda s, x: weighed(s, x) + twisted(s, x),
        (*TOPS, *DRIVEN),
        "the rotation matrix in all loads",
    ),
    "matrix-of-weight": (weighed, (*TOPS, *DRIVEN), "the rotation matrix in the torque of gravity"),
    "matrix-of-torque": (
        twisted,
        (*TOPS, *DRIVEN),
        "the rotation matrix in the torque in world axes",
    ),
    "lever": (by_arm, TOPS, "the lever in the torque of gravity"),
    "weight": (turned_weight, TOPS, "the weight, taken to body axes,"),
    "momentum": (momentum, CASES[:4], "I omega in the gyroscopic term"),
}


@pytest.mark.parametrize("name", ROUNDED)
def test_what_is_rounded_on_its_way_into_a_torque_is_named(name: str) -> None:
    """Caught: the torque itself rounded, and "none is known" of a matrix in single precision."""
    more, cases, what = ROUNDED[name]

    def found(system: System, states: State) -> Acceleration:
        return with_torque(system, states, more(system, states))

    causes = causes_over(found, cases)
    assert causes
    expected = f"{what} is rounded to single precision"
    assert all(expected in text for text in causes.values()), causes
