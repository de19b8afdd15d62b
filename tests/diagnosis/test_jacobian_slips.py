"""Linearly implicit steps with something wrong in the Jacobian; and silence."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from test_over_runs import CASES, kept

from omegadot.adapters.protocol import Integrator
from omegadot.diagnosis.stepping.kept_run import SchemeOf
from omegadot.diagnosis.stepping.over_runs import causes_over_runs
from omegadot.reference_impl.cross_product import skew
from omegadot.reference_impl.inertia import moving_inertia
from omegadot.reference_impl.schemes import SCHEMES, Motion
from omegadot.reference_impl.schemes.scheme import CHANNELS
from omegadot.reference_impl.system import Array, System

NAME = "linearly-implicit-euler"
Slope = Callable[[Array, Array, float], Array]  # d torque / d omega of I, omega and d


def slope(a: float = 1.0, b: float = 1.0, c: float = 1.0) -> Slope:
    return lambda i, w, d: a * skew(i @ w) - b * skew(w) @ i - c * d * np.eye(3)


def causes(wrong: Slope, ahead: float = 0.0, fewest: int = 1) -> list[str]:
    """ahead: of an explicit step, at the end of which the Jacobian is taken.

    fewest: steps between samples.
    """

    def step(
        system: System, motion: Motion, q: Array, v: Array, h: float, n: int
    ) -> tuple[Array, Array]:
        inertia, a = moving_inertia(system), np.array(motion.acceleration(q, v))
        at = (v + ahead * h * a)[-3:]
        matrix = inertia - h * wrong(inertia, at, float(system.load.damping))
        angular = np.linalg.solve(matrix, h * inertia @ a[-3:])
        v = v + np.concatenate((h * a[:-3], angular))
        return motion.retract(q, h * v), v

    plans = ((0.05, fewest), (0.02, 3))
    runs = [kept(one, step, h, every) for one in CASES for h, every in plans]
    by = SchemeOf(SCHEMES[NAME], "com-world")
    runs = [replace(run, fails=not bool(np.all(run.sound(by)))) for run in runs]
    return causes_over_runs(Integrator("own", NAME, dict.fromkeys(CHANNELS, 1)), runs)


@pytest.mark.parametrize(
    ("wrong", "text"),
    [
        (slope(a=-1.0), "in its Jacobian I^-1 [I omega]x has the wrong sign"),
        (slope(b=-1.0), "in its Jacobian -I^-1 [omega]x I has the wrong sign"),
        (slope(a=0.0), "in its Jacobian I^-1 [I omega]x is missing"),
        (slope(b=2.0), "in its Jacobian -I^-1 [omega]x I is doubled"),
        (slope(a=0.7), "in its Jacobian I^-1 [I omega]x has the factor 0.7"),
        (
            slope(a=-1.0, b=-1.0),
            "in its Jacobian the derivative of the gyroscopic term has the wrong sign",
        ),
        (slope(0.5, 0.5, 0.5), "its Jacobian is 1/2 times what it should be"),
        (
            lambda i, w, d: skew(i @ w) - i @ skew(w) - d * np.eye(3),
            "in its Jacobian -I^-1 [omega]x I has I on the other side",
        ),
        (
            lambda i, w, d: i @ np.linalg.solve(i, slope()(i, w, d)).T,
            "its Jacobian is transposed",
        ),
    ],
)
def test_what_is_wrong_in_the_jacobian_is_named(wrong: Slope, text: str) -> None:
    """Caught: a wrong Jacobian, that is of order 1 as the right one, taken for a limit."""
    assert causes(wrong) == [f"it is stepped by {NAME}, but {text}"]


def test_a_wrong_sign_is_named_where_no_run_keeps_every_step() -> None:
    """Caught: silence where no factor can be fitted to single steps."""
    (text,) = causes(slope(a=-1.0), fewest=2)
    assert text.endswith("in its Jacobian I^-1 [I omega]x has the wrong sign")


def test_a_jacobian_at_another_place_is_named() -> None:
    (text,) = causes(slope(), ahead=0.5)
    assert text.endswith("but its Jacobian is taken at the omega of half an explicit step on")


def test_a_matrix_of_no_known_kind_is_not_named() -> None:
    found = causes(lambda i, w, d: slope()(i, w, d) + 0.1 * float(w @ w) * np.eye(3))
    assert not any("Jacobian" in text for text in found)


def test_the_scheme_itself_has_no_cause() -> None:
    assert causes(slope()) == []
