"""Iterations of an implicit step that end too early, seen between samples of several steps."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from test_over_runs import CASES, kept

from omegadot.diagnosis.stepping.kept_run import SchemeOf
from omegadot.diagnosis.stepping.turns.tolerances import tolerance_causes
from omegadot.reference_impl.schemes import SCHEMES, Motion
from omegadot.reference_impl.schemes.jacobian import acceleration_and_jacobian, solver_of_one_minus
from omegadot.reference_impl.system import Array, System

SCHEME = SCHEMES["implicit-midpoint"]
Ends = Callable[[Array, Array, int], bool]


def causes(ends: Ends, newton: bool = True, guess: bool = True) -> list[str]:
    """Of steps whose iterations end so, by the change, the velocity and the iteration's number."""

    def step(
        system: System, motion: Motion, q: Array, v: Array, h: float, n: int
    ) -> tuple[Array, Array]:
        a, jacobian = acceleration_and_jacobian(motion, q, v)
        solve = solver_of_one_minus(0.5 * h * jacobian) if newton else (lambda r: r)
        w = v + solve(0.5 * h * a) if guess else v
        for k in range(1, 51):
            place = motion.retract(q, 0.5 * motion.cayley(h * w))
            change = solve(v + 0.5 * h * motion.acceleration(place, w) - w)
            w = w + change
            if ends(change[motion.spin], w[motion.spin], k):
                break
        return motion.retract(q, motion.cayley(h * w)), 2 * w - v

    runs = [kept(one, step, h, 4) for one in CASES for h in (0.1, 0.03)]
    by = SchemeOf(SCHEME, "com-world")
    runs = [replace(run, fails=not bool(np.all(run.sound(by)))) for run in runs]
    return tolerance_causes(by, runs)


def size(vector: Array) -> float:
    return float(np.linalg.norm(vector))


@pytest.mark.parametrize(
    ("ends", "newton", "guess", "phrases"),
    [
        (
            lambda d, w, k: size(d) <= 1e-3 * size(w),
            True,
            True,
            ("simplified Newton iterations from the linearised step", "0.001 of itself"),
        ),
        (
            lambda d, w, k: size(d) <= 1e-5 * size(w),
            False,
            False,
            ("fixed-point iterations from the velocities of its start", "1e-5 of itself"),
        ),
        (
            lambda d, w, k: size(d) <= 1e-4,
            False,
            True,
            ("fixed-point iterations from the explicit step", "0.0001 rad/s"),
        ),
    ],
    ids=("newton", "relative", "absolute"),
)
def test_the_change_at_which_iterations_end_is_named(
    ends: Ends, newton: bool, guess: bool, phrases: tuple[str, ...]
) -> None:
    """Caught: silence, since no sample is one step after another."""
    (text,) = causes(ends, newton, guess)
    assert all(phrase in text for phrase in phrases), text


def test_as_many_iterations_in_every_step_are_no_limit() -> None:
    """Caught: a limit of the change where it is the number of iterations that ends them."""
    found = causes(lambda d, w, k: k == 3, newton=False, guess=False)
    assert all("3 fixed-point iterations" in text for text in found), found


def test_steps_that_are_off_otherwise_have_no_such_limit() -> None:
    assert causes(lambda d, w, k: size(d) <= 1e-14 * size(w)) == []

    def spoiled(d: Array, w: Array, k: int) -> bool:
        w *= 1.0 + 1e-6
        return k == 4

    assert causes(spoiled) == []
