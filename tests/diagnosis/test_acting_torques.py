"""Torques in both frames at once that are limited, and the law that is named for both."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from wrong_equations import BODY_TORQUE, CASES, GRAVITY, PIVOT, case, under, with_torque

from omegadot.diagnosis.equations.acting_torques import acting_torques
from omegadot.diagnosis.equations.evidence import Evidence, of_forward_dynamics
from omegadot.gates.states.equation import random_states
from omegadot.reference_impl.loads import applied_torque
from omegadot.reference_impl.system import Array

LARGE = {"frame": "world", "value": [2.0e6, -3.0e5, -0.3]}
EVERY = (
    *CASES,
    case("thrown", {"torque": LARGE}),
    case("thrown-top", {"torque": LARGE, "gravity": GRAVITY, "pivot": PIVOT}, 4.0),
    case("pushed", {"torque": BODY_TORQUE | {"value": [0.1, 0.2, -0.3]}, "damping": 0.7}),
)
ORDINARY = tuple(one for one in EVERY if not one.name.startswith("thrown"))


def _evidence(made: Callable[[Array], Array]) -> list[Evidence]:
    engine = under(
        torque_body=lambda s: made(s.load.torque_body),
        torque_world=lambda s: made(s.load.torque_world),
    )
    found = []
    for one in EVERY:
        x = random_states(one, 40, [1])
        found.append(of_forward_dynamics(one.system, x, engine(one.system, x)))
    return found


def _of_a_size(torque: Array) -> Array:
    size = float(np.linalg.norm(torque))
    return torque * min(1.0, 0.5 / size) if size else torque


LAWS: dict[str, Callable[[Array], Array]] = {
    "each component of an applied torque is held above -0.25 N m": lambda t: np.maximum(t, -0.25),
    "each component of an applied torque is limited to 0.3 N m": lambda t: np.minimum(t, 0.3),
    "is limited to 0.35 N m either way": lambda t: np.clip(t, -0.35, 0.35),
    "the size of an applied torque is limited to 0.5 N m": _of_a_size,
    "has other axes: x, y, z hold y, z, x of what": lambda t: np.roll(t, -1),
}


@pytest.mark.parametrize("law", LAWS)
def test_one_law_of_the_torques_in_both_frames_is_named(law: str) -> None:
    """Caught: a limit taken from a torque of 1e6 N m, which is known to no more than its digits."""
    found = acting_torques(_evidence(LAWS[law]))
    assert law in found
    assert found.endswith(", in body axes and in world axes alike")


def test_a_torque_where_none_was_requested_is_of_another_cause() -> None:
    assert acting_torques(_evidence(lambda torque: torque + 0.1)) == ""


def test_torques_that_no_law_makes_are_not_named() -> None:
    assert acting_torques(_evidence(lambda torque: torque + torque**2)) == ""


def _of_the_sum(made: Callable[[Array], Array]) -> list[Evidence]:
    """Of an engine that adds both torques up in body axes, and makes something of the sum."""
    found = []
    for one in ORDINARY:
        x = random_states(one, 40, [1])
        torque = applied_torque(one.system, x)
        engine = with_torque(one.system, x, made(torque) - torque)
        found.append(of_forward_dynamics(one.system, x, engine))
    return found


@pytest.mark.parametrize(
    ("law", "made"),
    [
        ("is limited to 0.35 N m either way", lambda t: np.clip(t, -0.35, 0.35)),
        ("is held above -0.25 N m", lambda t: np.maximum(t, -0.25)),
    ],
)
def test_a_limit_of_both_torques_together_is_named(
    law: str, made: Callable[[Array], Array]
) -> None:
    """Caught: silence, as no other torque of either frame makes what the sum is cut to."""
    found = acting_torques(_of_the_sum(made))
    assert found == f"each component of the applied torque, in body axes, {law}"


def test_a_sum_that_is_no_limit_is_not_named() -> None:
    assert acting_torques(_of_the_sum(lambda torque: torque + torque**2)) == ""
