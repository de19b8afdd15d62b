"""What an attitude goes through between two steps, where it is rebuilt wrongly."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from test_over_runs import CASES, STEPS, Step, euler, kept

from omegadot.diagnosis.models.passed_attitudes import passed_attitudes
from omegadot.diagnosis.stepping.kept_run import KeptRun, SchemeOf
from omegadot.diagnosis.stepping.turns.between_steps import between_steps, passes_between
from omegadot.reference_impl.coordinates import from_coordinates
from omegadot.reference_impl.rotations import exp_quaternion
from omegadot.reference_impl.schemes import SCHEMES, Motion
from omegadot.reference_impl.system import Array, System

BY = SchemeOf(SCHEMES["semi-implicit-euler"], "com-world")
Rebuild = Callable[[Array, int], Array]
INVERSE = (
    "between steps the quaternion's scalar is rebuilt from its vector part, without its sign: "
    "where it would be negative the attitude becomes the inverse"
)


def passing(rebuild: Rebuild) -> Step:
    def step(
        system: System, motion: Motion, q: Array, v: Array, h: float, n: int
    ) -> tuple[Array, Array]:
        q, v = euler(motion, q, v, h, np.zeros(3))
        return np.concatenate((q[:-4], rebuild(q[-4:], n))), v

    return step


def runs_of(rebuild: Rebuild) -> list[KeptRun]:
    plans = ((0.08, 1), (0.05, 2))
    runs = [kept(one, passing(rebuild), h, every) for one in CASES for h, every in plans]
    return [replace(run, fails=not run.sound(BY).all()) for run in runs]


def dropped(q: Array, n: int) -> Array:
    return np.append(np.sqrt(max(0.0, 1.0 - q[1:] @ q[1:])), q[1:])


def by_acos(q: Array, n: int) -> Array:
    axis = q[1:] / np.linalg.norm(q[1:])
    return exp_quaternion(2.0 * np.arccos(min(1.0, abs(float(q[0])))) * axis)


def by_asin(q: Array, n: int) -> Array:
    size = float(np.linalg.norm(q[1:]))
    return exp_quaternion(np.arcsin(np.clip(2.0 * q[0] * size, -1.0, 1.0)) * q[1:] / size)


def second_dropped(q: Array, n: int) -> Array:
    left = np.sqrt(max(0.0, 1.0 - q[0] ** 2 - q[1] ** 2 - q[3] ** 2))
    return np.array([q[0], q[1], left, q[3]])


def roll_by_atan(q: Array, n: int) -> Array:
    w, x, y, z = q
    pitch = np.arcsin(2.0 * (w * y - x * z))
    roll = np.arctan((2.0 * (y * z + w * x)) / (1.0 - 2.0 * (x * x + y * y)))
    yaw = np.arctan2(2.0 * (x * y + w * z), 1.0 - 2.0 * (y * y + z * z))
    (cr, cp, cy), (sr, sp, sy) = (f(0.5 * np.array([roll, pitch, yaw])) for f in (np.cos, np.sin))
    vector = (sr * cp * cy - cr * sp * sy, cr * sp * cy + sr * cp * sy, cr * cp * sy - sr * sp * cy)
    return np.array([cr * cp * cy + sr * sp * sy, *vector])


@pytest.mark.parametrize(
    ("rebuild", "text"),
    [
        (dropped, INVERSE),
        (by_acos, INVERSE),
        (by_asin, "the angle by asin, which is a quarter turn at most"),
        (second_dropped, "quaternion's y is rebuilt from the other components, without its sign"),
        (roll_by_atan, "as R_z(a) R_y(b) R_x(c), where c is taken by atan, without its quadrant"),
    ],
)
def test_an_attitude_rebuilt_wrongly_is_named(rebuild: Rebuild, text: str) -> None:
    """Caught: "the run is sound until t = 0.54 s", "the attitude alone is wrong in the run"."""
    (found,) = between_steps(BY, runs_of(rebuild))
    assert text in found
    assert passes_between(found, BY, runs_of(rebuild)[0])


def test_the_sign_of_the_whole_quaternion_makes_no_difference() -> None:
    runs = runs_of(lambda q, n: -q if q[1] < 0.0 else q)
    assert not any(run.fails for run in runs)
    assert between_steps(BY, runs) == []


def test_an_attitude_that_is_inverted_once_is_not_rebuilt() -> None:
    """Caught: a cause that makes the interval that is wrong, and not those that are right."""
    runs = runs_of(lambda q, n: q * [1.0, -1.0, -1.0, -1.0] if n % 11 == 7 else q)
    assert any(run.fails for run in runs)
    assert between_steps(BY, runs) == []


def test_of_a_turn_from_minus_q_that_is_another_the_cause_is_the_same() -> None:
    """A half turn, whose scalar is zero, is on the other side in the run from -q."""
    one = CASES[0]
    start = replace(one.initial, orientation=-np.array([0.0, 0.6, 0.0, 0.8]))
    run = kept(replace(one, initial=start), passing(dropped), 0.05, 1)
    assert passes_between(INVERSE, BY, run)
    plain = kept(replace(one, initial=start), passing(lambda q, n: q), 0.05, 1)
    assert not passes_between(INVERSE, BY, plain)


def test_all_are_attitudes_after_rounding_too() -> None:
    q = from_coordinates(CASES[0].system, *np.zeros((2, 1, 7)), "com-world").orientation
    q = np.random.default_rng(1).normal(size=(STEPS, 4)) + 0.0 * q
    q /= np.linalg.norm(q, axis=-1, keepdims=True)
    for one in (one for group in passed_attitudes() for one in group):
        assert np.allclose(np.linalg.norm(one.made(q), axis=-1), 1.0, atol=1e-12), one.text
        assert np.allclose(one.made(q), one.rounded(q, 1.0), atol=1e-12), one.text
