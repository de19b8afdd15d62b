"""An implicit midpoint step that turns by another increment than inside its equation; silence."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from test_over_runs import CASES, kept

from omegadot.adapters.protocol import Integrator
from omegadot.diagnosis.stepping.kept_run import SchemeOf
from omegadot.diagnosis.stepping.over_runs import causes_over_runs
from omegadot.reference_impl.rotations import exp_quaternion, normalize, quaternion_product
from omegadot.reference_impl.schemes import SCHEMES, Motion
from omegadot.reference_impl.schemes.scheme import CHANNELS
from omegadot.reference_impl.system import Array, System

MIDPOINT = "implicit-midpoint"
Turn = Callable[[Array], Array]  # of h omega_m, a unit quaternion


def exact(u: Array) -> Array:
    return exp_quaternion(u)


def cayley(u: Array) -> Array:
    return normalize(np.concatenate(([1.0], 0.5 * u)))


def half_of_cayley(u: Array) -> Array:
    """The unit quaternion of half the turn is the mean of none and all of it."""
    return normalize(cayley(u) + np.array([1.0, 0.0, 0.0, 0.0]))


def causes(middle: Turn, end: Turn, declared: bool = True) -> list[str]:
    """Its equation is solved by fixed-point iteration, to rounding."""

    def step(
        system: System, motion: Motion, q: Array, v: Array, h: float, n: int
    ) -> tuple[Array, Array]:
        def moved(mean: Array, turn: Array, part: float) -> Array:
            place = motion.retract(q, part * h * mean)[:-4]
            return np.concatenate((place, quaternion_product(q[-4:], turn)))

        mean = v
        for _ in range(60):
            at = moved(mean, middle(h * mean[-3:]), 0.5)
            mean = v + 0.5 * h * motion.acceleration(at, mean)
        return moved(mean, end(h * mean[-3:]), 1.0), 2.0 * mean - v

    runs = [kept(one, step, *plan) for one in CASES for plan in ((0.05, 1), (0.02, 2))]
    by = SchemeOf(SCHEMES[MIDPOINT], "com-world")
    runs = [replace(run, fails=not bool(np.all(run.sound(by)))) for run in runs]
    own = Integrator("own", MIDPOINT if declared else None, dict.fromkeys(CHANNELS, 2))
    return causes_over_runs(own, runs)


@pytest.mark.parametrize(
    ("middle", "end", "inside", "last"),
    [
        (half_of_cayley, exact, "half of Cayley's turn", "the exponential"),
        (lambda u: exact(0.5 * u), cayley, "the exponential of half the", "Cayley's transform"),
        (lambda u: cayley(0.5 * u), cayley, "Cayley's transform of half", "Cayley's transform"),
        (lambda u: exact(0.5 * u), exact, "the exponential of half the", "the exponential"),
    ],
)
def test_the_turns_at_the_middle_and_at_the_end_are_named(
    middle: Turn, end: Turn, inside: str, last: str
) -> None:
    """Caught: an attitude that is off, of a step that does not keep the momentum."""
    (text,) = causes(middle, end)
    assert f"the attitude turns by {last} of the increment at the end of a step" in text
    assert f"and by {inside}" in text


def test_another_turn_of_no_declared_scheme_is_no_mistake() -> None:
    assert causes(lambda u: exact(0.5 * u), exact, declared=False) == []


def test_the_scheme_and_turns_that_are_neither_have_no_cause() -> None:
    assert causes(half_of_cayley, cayley) == []
    assert causes(half_of_cayley, lambda u: exact(1.001 * u)) == []
