"""A wrong series for the exponential of a step's turn, of small turns or of all; and silence."""

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

EULER = "semi-implicit-euler"
Exponential = Callable[[Array], Array]


def series(sine: Callable[[float], float], limit: float, cosine: float = -1 / 8) -> Exponential:
    def exponential(u: Array) -> Array:
        x = float(u @ u)
        if x >= limit**2:
            return exp_quaternion(u)
        return normalize(np.concatenate(([1.0 + cosine * x], sine(x) * u)))

    return exponential


def coarse(limit: float) -> Exponential:
    """By the second-order series where the turn is above a limit."""

    def exponential(u: Array) -> Array:
        if float(np.linalg.norm(u)) <= limit:
            return exp_quaternion(u)
        return normalize(np.concatenate(([1.0 - float(u @ u) / 8], 0.5 * u)))

    return exponential


def causes(exponential: Exponential, h: float = 0.05, every: int = 1) -> list[str]:
    def step(
        system: System, motion: Motion, q: Array, v: Array, h: float, n: int
    ) -> tuple[Array, Array]:
        v = v + h * motion.acceleration(q, v)
        turned = quaternion_product(q[-4:], exponential(h * v[-3:]))
        return np.concatenate((motion.retract(q, h * v)[:-4], turned)), v

    runs = [kept(one, step, k * h, every) for one in CASES for k in (1.0, 0.3)]
    by = SchemeOf(SCHEMES[EULER], "com-world")
    runs = [replace(run, fails=not bool(np.all(run.sound(by)))) for run in runs]
    return causes_over_runs(Integrator("own", EULER, dict.fromkeys(CHANNELS, 1)), runs)


@pytest.mark.parametrize(
    ("exponential", "phrase"),
    [
        (
            series(lambda x: 0.5 - x / 24, 0.1),
            "by a series for sin(x/2)/x with x^2/24 in place of x^2/48, where the turn is below",
        ),
        (
            series(lambda x: 0.5 + x / 48, 0.1),
            "for sin(x/2)/x with -x^2/48 in place of x^2/48, where the turn is below",
        ),
        (series(lambda x: 0.5, 0.1), "that ends before x^4/384 in cos(x/2) and x^2/48 in sin(x/2)"),
        (
            series(lambda x: 0.5 - x / 48 + x * x / 3840, 0.1, cosine=-1 / 4),
            "for cos(x/2) with x^2/4 in place of x^2/8, where the turn is below",
        ),
        (
            series(lambda x: 0.5 - x / 24, 10.0),
            "for sin(x/2)/x with x^2/24 in place of x^2/48",
        ),
    ],
)
def test_a_wrong_series_is_named_with_its_number(exponential: Exponential, phrase: str) -> None:
    """Caught: a wrong coefficient of small turns, named as an attitude that is off."""
    (text,) = causes(exponential)
    assert phrase in text
    if "below" in phrase:
        low, high = (float(one) for one in text.split(" between ")[1].split()[:3:2])
        assert low < 0.1 <= high
    else:
        assert "below" not in text or "ends before" in text


def test_a_series_of_larger_turns_alone_is_named_with_its_limit() -> None:
    """Caught: the limit as a fact of one scenario, beside a series that is said to be in all."""
    (text,) = causes(coarse(0.05))
    assert "ends before x^4/384 in cos(x/2) and x^2/48 in sin(x/2)/x, where the turn is" in text
    low, high = (float(one) for one in text.split(" above a limit between ")[1].split()[:3:2])
    assert low <= 0.05 <= high


def test_a_limit_shows_between_samples_of_several_steps() -> None:
    """Caught: silence where no sample is one step after another, or a limit that intervals cross
    taken for none."""
    (text,) = causes(series(lambda x: 0.5, 0.1, cosine=0.0), every=5)
    assert "ends before x^2/8 in cos(x/2) and x^2/48 in sin(x/2)/x, where the turn is" in text
    low, high = (float(one) for one in text.split(" between ")[1].split()[:3:2])
    assert low < 0.1 <= high


def test_a_limit_shows_where_the_turns_cross_it_between_samples() -> None:
    """Caught: silence where turns between two samples are on another side than theirs."""
    (text,) = causes(series(lambda x: 0.5, 0.04, cosine=0.0), h=0.02, every=20)
    assert "ends before x^2/8 in cos(x/2) and x^2/48 in sin(x/2)/x, where the turn is" in text
    low, high = (float(one) for one in text.split(" between ")[1].split()[:3:2])
    assert 0.039 < low < 0.04 <= high


def completed(limit: float) -> Exponential:
    """By the vector ``u/2`` and the scalar that makes it unit where the turn is below a limit."""

    def exponential(u: Array) -> Array:
        if float(np.linalg.norm(u)) >= limit:
            return exp_quaternion(u)
        return np.concatenate(([np.sqrt(1.0 - u @ u / 4)], 0.5 * u))

    return exponential


def test_a_vector_part_that_its_scalar_part_makes_unit_is_named() -> None:
    """Caught: a turn by ``2 asin(x/2)``, taken for one of another series."""
    (text,) = causes(completed(0.1))
    assert (
        "ends before x^2/48 in sin(x/2)/x, with the scalar part that makes it a unit one, where "
        "the turn is below a limit"
    ) in text


def rough(limit: float) -> Exponential:
    """By ``(1, u/2)`` made unit where the turn is above a limit."""

    def exponential(u: Array) -> Array:
        if float(np.linalg.norm(u)) <= limit:
            return exp_quaternion(u)
        return normalize(np.concatenate(([1.0], 0.5 * u)))

    return exponential


@pytest.mark.parametrize("name", ["lie-rk4", "implicit-midpoint"])
def test_a_limit_is_seen_in_steps_of_several_turns(name: str) -> None:
    """Caught: silence where the turns inside one step lie on both sides of the limit."""
    exponential, scheme = rough(0.05), SCHEMES[name]

    def step(
        system: System, motion: Motion, q: Array, v: Array, h: float, n: int
    ) -> tuple[Array, Array]:
        def retract(q: Array, u: Array) -> Array:
            turned = quaternion_product(q[-4:], exponential(u[-3:]))
            return np.concatenate((motion.retract(q, u)[:-4], turned))

        return scheme.step(replace(motion, retract=retract), q, v, h)

    runs = [kept(one, step, h, 1) for one in CASES for h in (0.05, 0.03, 0.015)]
    by = SchemeOf(scheme, "com-world")
    runs = [replace(run, fails=not bool(np.all(run.sound(by)))) for run in runs]
    own = Integrator("own", name, scheme.orders)
    (text,) = causes_over_runs(own, runs)
    assert "ends before x^2/8 in cos(x/2) and x^2/48 in sin(x/2)/x, where the turn is" in text
    low, high = (float(one) for one in text.split(" above a limit between ")[1].split()[:3:2])
    assert low <= 0.05 <= high


def test_turns_that_are_off_by_no_series_are_not_named() -> None:
    assert causes(lambda u: exp_quaternion((1.0 + 0.01 * np.sin(40.0 * u[0])) * u)) == []


def test_sound_turns_have_no_cause() -> None:
    assert causes(exp_quaternion) == []
