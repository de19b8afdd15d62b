"""A condition that a cause implies is not stated after it."""

from __future__ import annotations

import pytest

from omegadot.diagnosis.experiments.conditioned import conditioned

ACTS = "the damping that acts is 1 N m s/rad, where 4.27249e6 was requested"
LIMITED = "the damping is limited to 1 N m s/rad"
DAMPED = "the body is damped"


@pytest.mark.parametrize(
    ("cause", "condition"),
    [
        (ACTS, DAMPED),
        ("in the steps, " + ACTS, DAMPED),
        ("the damping that acts in the steps is 1 N m s/rad, where 5 was requested", DAMPED),
        ("the damping is missing", DAMPED),
        (LIMITED, DAMPED),
        (LIMITED, "the damping is above a limit between 0.825055 and 1.08469 N m s/rad"),
        ("the mass is held above 2 kg", "the mass is below a limit between 1.9 and 2.1 kg"),
    ],
)
def test_a_condition_that_the_cause_implies_is_left_out(cause: str, condition: str) -> None:
    """Caught: a wrong damping, ``but only where the body is damped``."""
    assert conditioned(cause, condition) == cause


@pytest.mark.parametrize(
    ("cause", "condition"),
    [
        (ACTS, "the damping is above a limit between 0.98241 and 1.04487 N m s/rad"),
        (ACTS, "the body is pivoted"),
        (LIMITED, "the damping is above a limit between 2 and 3 N m s/rad"),
        (LIMITED, "the mass is above a limit between 0.8 and 1.2 kg"),
        ("the damping is 1 N m s/rad, whatever was requested", DAMPED),
        ("a damping of 1 N m s/rad acts that was not requested", DAMPED),
        ("the damping is that of the system loaded before", DAMPED),
        ("the damping is held above 0.1 N m s/rad", DAMPED),
        ("the gyroscopic term is missing", DAMPED),
    ],
)
def test_a_condition_that_says_more_is_kept(cause: str, condition: str) -> None:
    """Caught: what an engine has of its own, or a limit elsewhere, without its condition."""
    assert conditioned(cause, condition) == f"{cause}, but only where {condition}"
