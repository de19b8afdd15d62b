"""Which steps are logged, at what times, and what a run that diverges leaves."""

from __future__ import annotations

import numpy as np
import pytest
from reference_cases import TOP, one_step, rows, start, system

from omegadot.reference_impl.kinematics import place_on_pivot
from omegadot.reference_impl.schemes import SCHEMES
from omegadot.reference_impl.stepping import kept_steps, step_body

EULER = SCHEMES["semi-implicit-euler"]
FREE = system([1.0, 2.0, 2.5])


@pytest.mark.parametrize(
    ("steps", "every", "expected"),
    [
        (0, 1, [0]),
        (4, 1, [0, 1, 2, 3, 4]),
        (10, 4, [0, 4, 8, 10]),
        (8, 4, [0, 4, 8]),
        (3, 9, [0, 3]),
    ],
)
def test_kept_steps(steps: int, every: int, expected: list[int]) -> None:
    assert kept_steps(steps, every) == expected


@pytest.mark.parametrize(("steps", "every"), [(-1, 1), (5, 0)])
def test_impossible_steps_are_refused(steps: int, every: int) -> None:
    with pytest.raises(ValueError, match=f"steps is {steps} and every is {every}"):
        kept_steps(steps, every)


def test_logged_states_are_those_of_single_steps_at_products_of_dt() -> None:
    initial = start([1.0, 2.0, 3.0])
    times, states = step_body(EULER, FREE, initial, 0.1, 7, 3)
    assert np.array_equal(times, np.array([0, 3, 6, 7]) * 0.1)
    state, row = initial, 0
    for n in range(8):
        if n in (0, 3, 6, 7):
            assert np.array_equal(states.orientation[row], state.orientation)
            assert np.array_equal(states.angular_velocity[row], state.angular_velocity)
            row += 1
        state = one_step(EULER, FREE, state, 0.1)


def test_pivoted_bodies_are_logged_on_their_pivot() -> None:
    initial = start([1.0, 2.0, 3.0], on=TOP)
    _, states = step_body(EULER, TOP, initial, 0.01, 10, 2)
    placed = place_on_pivot(TOP, states)
    assert np.array_equal(states.position, placed.position)
    assert np.array_equal(states.linear_velocity, placed.linear_velocity)


def test_a_run_that_diverges_goes_on_without_warnings() -> None:
    # RuntimeWarnings are errors here
    initial = start([[1e3, 2e3, -3e3], [0.1, 0.2, 0.3]], [[1, 0, 0, 0], [1, 0, 0, 0]])
    for scheme in SCHEMES.values():
        _, states = step_body(scheme, FREE, initial, 100.0, 40, 40)
        assert states.angular_velocity.shape == (2, 2, 3)
    _, states = step_body(EULER, FREE, initial, 100.0, 40, 40)
    assert not np.all(np.isfinite(rows(states, (-1, 0)).angular_velocity))
