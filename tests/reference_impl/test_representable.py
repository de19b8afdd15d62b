"""Motions beyond what double precision holds have no exact solution, and that is a sentence."""

from __future__ import annotations

import warnings
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from omegadot.reference_impl.from_scenario import initial_state_of, system_of
from omegadot.reference_impl.solutions.exact_solution import exact_solution
from omegadot.reference_impl.solutions.representable import UnrepresentableError
from omegadot.reference_impl.system import Array, State, System
from omegadot.scenarios import scenario

DOWN = [0.0, 0.0, -9.81]


def brick(spin: Any = (0.1, 3.0, 0.2), duration: float = 1.0, **load: Any) -> Any:
    """A scenario of a brick, with loads and a start of the test's own."""
    return scenario({
        "name": "brick",
        "title": "Brick",
        "body": {"mass": 1.0, "inertia": [1.0, 2.0, 3.0]},
        "initial": {"angular_velocity": list(spin)},
        "load": load,
        "run": {"duration": duration, "timesteps": [0.02], "sample": 0.02},
    })  # fmt: skip


def solved(made: Any) -> State:
    system, initial = system_of(made), initial_state_of(made)
    return exact_solution(system, initial, np.linspace(0.0, made.run.duration, 5)).state


@pytest.mark.parametrize(("made", "message"), [
    (brick([1e-160, 0.0, 1e-160]), "does not hold its square"),
    (brick([1e22, 0.0, 1e22]), "holds no digit of where it then points"),
    (brick([1e49, 0.0, 1e49]), "holds no digit of where it then points"),
    (brick(pivot=[1e8, 0.0, 0.0]), "does not hold the body's own"),
    (brick(pivot=[1e30, 1e30, 0.0], gravity=DOWN), "does not hold the body's own"),
    (brick(pivot=[1e-160, 0.0, 0.0], gravity=DOWN), "the lever to the pivot is 1e-160 m"),
    (brick(gravity=[0.0, 0.0, 1e-200]), r"gravity is 1e-200 m/s\^2"),
    (brick(gravity=[0.0, 0.0, 1e45], pivot=[0.5, 0.1, 0.0]), "its series would take"),
    (brick(damping=1e16), "its series would take"),
    (brick(damping=1e50), "leaves the range of numbers"),
    (brick(torque={"frame": "world", "value": [1e50, 1e50, 1e50]}), "its series would take"),
])  # fmt: skip
def test_what_doubles_cannot_hold_is_refused_without_a_warning(made: Any, message: str) -> None:
    """Caught: LinAlgError of a matrix of NaN, divisions by zero, endless series, warnings."""
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        with pytest.raises(UnrepresentableError, match=message):
            solved(made)


@pytest.mark.parametrize("made", [
    brick([1e-50, 0.0, 1e-50]),
    brick([1e12, 0.0, 1e12]),
    brick(gravity=[0.0, 0.0, 1e50]),
    brick(pivot=[1e-50, 0.0, 0.0], gravity=DOWN),
    brick(pivot=[1e5, 0.0, 0.0]),
    brick(damping=1e-300),
    brick(torque={"frame": "body", "value": [1e-300, 0.0, 0.0]}),
])  # fmt: skip
def test_what_doubles_hold_is_solved_however_large_or_small(made: Any) -> None:
    """Caught: a limit on the numbers of a scenario where their motion is well known."""
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        state = solved(made)
    assert all(np.all(np.isfinite(values)) for values in vars(state).values())


def test_the_limit_of_a_square_is_where_digits_are_lost() -> None:
    """From the definition: s^2 has all its digits down to tiny / eps, here 2^16 further up."""
    made = brick()
    system, start = system_of(made), initial_state_of(made)

    def outcome(size: float) -> str:
        moved: Array = np.array([size, 0.0, 0.0])
        try:
            exact_solution(system, replace(start, linear_velocity=moved), np.linspace(0, 1, 3))
        except UnrepresentableError as error:
            return str(error)
        return ""

    limit = 2.0**16 * np.sqrt(np.finfo(float).tiny / np.finfo(float).eps)
    assert outcome(1.01 * limit) == ""
    assert "square" in outcome(0.99 * limit)


def test_a_pivot_hides_the_moment_about_its_lever_from_one_over_eps_on() -> None:
    made = brick()
    system, start = system_of(made), initial_state_of(made)
    own, eps = 1.0, np.finfo(float).eps
    limit = np.sqrt(own / eps)

    def at(distance: float) -> System:
        pivot: Array = np.array([distance, 0.0, 0.0])
        return replace(system, load=replace(system.load, pivot=pivot))

    exact_solution(at(0.9 * limit), start, np.linspace(0, 1, 3))
    with pytest.raises(UnrepresentableError, match="about the pivot"):
        exact_solution(at(1.1 * limit), start, np.linspace(0, 1, 3))
