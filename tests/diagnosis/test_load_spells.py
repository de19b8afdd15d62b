"""A load that stops or begins to act after a number of steps, a time, or a share of a run."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from test_load_times import Torque, causes, scaled
from test_over_runs import STEPS, Step

from omegadot.diagnosis.equations.operators.operands import gyroscopic
from omegadot.reference_impl.loads import applied_torque, damping_torque, gravity_torque
from omegadot.reference_impl.schemes import Motion
from omegadot.reference_impl.system import Array, System

PLANS = ((0.031, 1), (0.0173, 2), (0.009, 3))
Part = Callable[[int, float, float], float]


def by_number(torque: Torque, part: Part) -> Step:
    """A step with a part of a torque, by its number from 1 on, its time and the run's share."""
    steps = {h: every * STEPS for h, every in PLANS}

    def step(
        system: System, motion: Motion, q: Array, v: Array, h: float, n: int
    ) -> tuple[Array, Array]:
        acts = part(n + 1, n * h, n / steps[h])
        return scaled(torque, lambda full, h: acts)(system, motion, q, v, h, n)

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
        (lambda n, t, x: float(n <= 14), "acts in the first 14 steps of a run alone"),
        (lambda n, t, x: float(n > 17), "does not act in the first 17 steps of a run"),
        (lambda n, t, x: 2.0 if n > 14 else 1.0, "is scaled by 2 after the first 14 steps of a"),
        (lambda n, t, x: float(t < 0.3), "does not act from t = 0.297 to 0."),
        (lambda n, t, x: float(x < 0.6), "does not act after the first 59."),
    ],
)
def test_when_a_load_stops_or_begins_is_named(
    torque: Torque, what: str, part: Part, phrase: str
) -> None:
    """Caught: "every run is sound until" the samples at which it shows, other ones in each."""
    found = causes(by_number(torque, part), PLANS)
    assert len(found) == 1
    assert found[0].startswith(f"in the steps, {what} {phrase}")


@pytest.mark.parametrize("samples", [1, 3])
def test_a_load_that_stops_at_a_sample_is_named(samples: int) -> None:
    """Caught: no cause, as every run takes another number of steps to get there."""
    plans = ((0.031, 1), (0.0173, 4), (0.009, 2))  # with samples at other times in each
    until = {h: samples * every for h, every in plans}

    def step(
        system: System, motion: Motion, q: Array, v: Array, h: float, n: int
    ) -> tuple[Array, Array]:
        acts = float(n < until[h])
        return scaled(applied_torque, lambda full, h: acts)(system, motion, q, v, h, n)

    count = "first sample" if samples == 1 else "first 3 samples"
    (text,) = causes(step, plans)
    assert text.startswith("in the steps, either the applied torque does not act after the ")
    assert f" after the {count} of a run, however many steps lead there, or the applied" in text
    assert "% of a run" in text  # of which each has as many samples here


def test_a_load_that_stops_in_some_runs_alone_is_not_named() -> None:
    """Caught: a law of the runs in which it shows, which the sound ones would show as well."""
    step = by_number(applied_torque, lambda n, t, x: float(n <= 14 or t > 0.2))
    assert not any("first" in text for text in causes(step, PLANS))


def test_it_is_named_of_a_scheme_that_is_not_declared() -> None:
    """Caught: a sound first-order scheme that is taken for a slip in another."""
    until = by_number(applied_torque, lambda n, t, x: float(n <= 14))

    def step(
        system: System, motion: Motion, q: Array, v: Array, h: float, n: int
    ) -> tuple[Array, Array]:
        _, v = until(system, motion, q, v, h, n)
        return motion.normalize(q + h * motion.coordinate_rate(q, v)), v

    found = causes(step, PLANS, declared=False, scheme="semi-implicit Euler on the quaternion")
    assert found == ["in the steps, the applied torque acts in the first 14 steps of a run alone"]


def test_a_load_that_acts_now_and_then_has_no_last_step() -> None:
    step = by_number(applied_torque, lambda n, t, x: float(np.cos(n * n) > 0.0))
    assert causes(step, PLANS) == []
