"""A load that acts for another time of a step, or with an impulse that is held."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from test_over_runs import CASES, Step, euler, kept
from wrong_equations import BODY_TORQUE, GRAVITY, PIVOT, case

from omegadot.adapters.protocol import Integrator
from omegadot.diagnosis.equations.operators.operands import gyroscopic
from omegadot.diagnosis.stepping.explicit_schemes import scheme_named
from omegadot.diagnosis.stepping.kept_run import SchemeOf
from omegadot.diagnosis.stepping.over_runs import causes_over_runs
from omegadot.reference_impl.coordinates import from_coordinates
from omegadot.reference_impl.inertia import moving_inertia
from omegadot.reference_impl.loads import applied_torque, damping_torque, gravity_torque
from omegadot.reference_impl.schemes import Motion
from omegadot.reference_impl.schemes.scheme import CHANNELS
from omegadot.reference_impl.symmetric import apply, inverse
from omegadot.reference_impl.system import Array, State, System

Torque = Callable[[System, State], Array]
LOADED = (
    *CASES,
    case("damped-driven", {"damping": 0.2, "torque": BODY_TORQUE}, 1.1),
    case("top-damped", {"damping": 0.2, "gravity": GRAVITY, "pivot": PIVOT}, 0.7),
)
EULER = "semi-implicit-euler"
PLANS = ((0.031, 1), (0.02, 1), (0.013, 1), (0.009, 2), (0.005, 3))


def causes(
    step: Step,
    plans: tuple[tuple[float, int], ...] = PLANS,
    declared: bool = True,
    scheme: str = EULER,
) -> list[str]:
    """Of all loaded bodies, where runs fail that are not stepped as they should be."""
    by = SchemeOf(scheme_named(scheme), "com-world")
    runs = [kept(one, step, h, every) for one in LOADED for h, every in plans]
    runs = [replace(run, fails=not bool(np.all(run.sound(by)))) for run in runs]
    own = Integrator("own", EULER if declared else None, dict.fromkeys(CHANNELS, 1))
    return causes_over_runs(own, runs)


def scaled(torque: Torque, part: Callable[[Array, float], float]) -> Step:
    """A step with a part of a torque, by the torque and the step's length."""

    def step(
        system: System, motion: Motion, q: Array, v: Array, h: float, n: int
    ) -> tuple[Array, Array]:
        full = torque(system, from_coordinates(system, q, v, "com-world"))
        more = (part(full, h) - 1.0) * full
        return euler(motion, q, v, h, apply(inverse(moving_inertia(system)), more))

    return step


@pytest.mark.parametrize(
    ("torque", "what"),
    [
        (applied_torque, "the applied torque"),
        (damping_torque, "the damping"),
        (gravity_torque, "the torque of gravity"),
        (gyroscopic, "the gyroscopic term"),
    ],
)
@pytest.mark.parametrize(
    ("part", "phrase"),
    [
        (
            lambda t, h: min(1.0, 1.0 / 60.0 / h),
            "acts for 0.0166667 s (1/60 s) of each step where steps are longer than that",
        ),
        (
            lambda t, h: max(1.0, 0.017 / h),
            "acts for 0.017 s in each step where steps are shorter than that",
        ),
        (
            lambda t, h: 0.0 if h > 0.015 else 1.0,
            "does not act in steps of 0.02 s and longer, and not of 0.013 s and shorter",
        ),
        (
            lambda t, h: 0.25 if h < 0.015 else 1.0,
            "is scaled by 0.25 in steps of 0.013 s and shorter, and not of 0.02 s and longer",
        ),
    ],
)
def test_a_part_of_a_load_by_the_length_of_the_step_is_named(
    torque: Torque, what: str, part: Callable[[Array, float], float], phrase: str
) -> None:
    """Caught: no cause at all, since within one run the load is wrong by one factor."""
    assert causes(scaled(torque, part)) == [f"in the steps, {what} {phrase}"]


@pytest.mark.parametrize("declared", [True, False])
def test_an_impulse_that_is_held_is_named(declared: bool) -> None:
    """Caught: a time of each step, which is another for each torque."""

    def part(full: Array, h: float) -> float:
        size = float(np.linalg.norm(full))
        return min(1.0, 0.004 / (h * size)) if size else 1.0

    found = causes(scaled(applied_torque, part), PLANS, declared)
    text = "in the steps, the impulse of the applied torque in one step is held below 0.004 N m s"
    assert found == [text]


@pytest.mark.parametrize(
    "part",
    [
        lambda t, h: 0.5,  # which the equation shows
        lambda t, h: 1.0 - np.cos(90.0 * h),  # by no known law of the length
        lambda t, h: 1.0 if h == 0.013 else 0.5,  # of neither the longer nor the shorter ones
    ],
)
def test_a_part_by_no_law_of_the_length_is_not_named(
    part: Callable[[Array, float], float],
) -> None:
    assert causes(scaled(applied_torque, part)) == []
