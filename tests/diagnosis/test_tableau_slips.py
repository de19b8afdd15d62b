"""One coefficient of a Runge-Kutta method with a wrong sign, or in another's place."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np
import pytest
from test_short_steps import own_run

from omegadot.diagnosis.reported.run import ReportedRun
from omegadot.diagnosis.stepping.explicit_schemes import TABLEAUS, scheme_named
from omegadot.diagnosis.stepping.on_quaternion import Rows, on_quaternion
from omegadot.diagnosis.stepping.slips.other_schemes import slips_of
from omegadot.diagnosis.stepping.slips.slips import OF_SCHEME
from omegadot.reference_impl.schemes import Motion
from omegadot.reference_impl.system import Array

NAME = "Kutta's 3/8 method on the quaternion"
_, ROWS, WEIGHTS = TABLEAUS["Kutta's 3/8 method"]


def run_of(rows: Rows, weights: Sequence[float], name: str = NAME) -> ReportedRun:
    """A run of the scheme with this name, but by another tableau."""
    run = own_run("heavy-top").until(8)
    guess = replace(run, integrator=replace(run.integrator, scheme=name), is_declared=False)
    guess = replace(guess, own=guess.stepped())
    made = replace(scheme_named(name), step=on_quaternion(rows, weights))
    return replace(guess, state=guess.stepped(made))


def named(rows: Rows, weights: Sequence[float], name: str = NAME) -> list[str]:
    run = run_of(rows, weights, name)
    return [text for one in OF_SCHEME for text in slips_of(run, one)]


@pytest.mark.parametrize(
    ("row", "text"),
    [
        ((1 / 3, 1.0), "the first slope has the wrong sign in its third stage"),
        ((1.0, -1 / 3), "the coefficients of its first and second slopes are swapped in its third"),
    ],
)
def test_a_slip_in_the_3_8_rule_is_named(row: Sequence[float], text: str) -> None:
    """Caught: the order that the steps lose, and no more."""
    (found,) = named((*ROWS[:2], row, ROWS[3]), WEIGHTS)
    assert found.startswith(f"it is stepped by {NAME}, but {text}")


def test_a_slip_in_a_method_of_two_stages_is_named() -> None:
    for name, a, text in (
        ("Heun's method", -1.0, "the first slope has the wrong sign in its second stage"),
        ("the explicit midpoint method", 1.0, "its second stage is taken at the whole step"),
    ):
        whole = f"{name} on the quaternion"
        assert named(((), (a,)), TABLEAUS[name][2], whole) == [
            f"it is stepped by {whole}, but {text}"
        ]


def test_a_sound_method_and_other_coefficients_have_no_slip() -> None:
    """A fourth stage at nine tenths of the step is no sign and no place."""
    assert named(ROWS, WEIGHTS) == []
    other = (*ROWS[:3], tuple(0.9 * a for a in ROWS[3]))
    assert named(other, WEIGHTS) == []
    assert named(((), (0.7,)), (0.5, 0.5), "Heun's method on the quaternion") == []
    assert np.isfinite(run_of(other, WEIGHTS).state.angular_velocity).all()


def by_vector_part(q: Array) -> Array:
    left = 1.0 - np.sum(q[..., 1:] ** 2, axis=-1, keepdims=True)
    return np.concatenate((np.copysign(np.sqrt(left), q[..., :1]), q[..., 1:]), axis=-1)


UNIT: dict[str, tuple[Callable[[Array], Array], str]] = {
    "vector-part": (by_vector_part, "the quaternion's scalar part is made of its vector part"),
    "square": (
        lambda q: q / np.sum(q * q, axis=-1, keepdims=True),
        "the quaternion is divided by the square of its length",
    ),
    "sound": (lambda q: q / np.linalg.norm(q, axis=-1, keepdims=True), ""),
    "third": (lambda q: q / np.linalg.norm(q, axis=-1, keepdims=True) ** (1 / 3), ""),
}


@pytest.mark.parametrize("case", UNIT)
@pytest.mark.parametrize("name", ["rk4-quaternion", "Heun's method on the quaternion"])
def test_how_a_quaternion_is_made_unit_is_named(name: str, case: str) -> None:
    """Caught: "the attitude alone is wrong in the run", of a root for a division."""
    change, text = UNIT[case]

    def step(motion: Motion, q: Array, v: Array, h: float | Array) -> tuple[Array, Array]:
        def acceleration(at: Array, speed: Array) -> Array:
            return motion.acceleration(motion.normalize(at), speed)

        loose = replace(motion, normalize=lambda at: at, acceleration=acceleration)
        q, v = scheme_named(name).step(loose, q, v, h)
        return np.concatenate((q[..., :-4], change(q[..., -4:])), axis=-1), v

    run = run_of(*TABLEAUS["Heun's method"][1:], "Heun's method on the quaternion")
    guess = replace(run, integrator=replace(run.integrator, scheme=name), is_declared=False)
    guess = replace(guess, own=guess.stepped())
    made = replace(guess, state=guess.stepped(replace(scheme_named(name), step=step)))
    found = slips_of(made, name)
    assert [one.partition(", but ")[2].startswith(text) for one in found] == [True] * bool(text)
