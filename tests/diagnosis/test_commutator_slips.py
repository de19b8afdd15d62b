"""Wrong commutators in a Lie-group step, and stages that turn wrongly; and silence."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from test_over_runs import CASES, kept

from omegadot.adapters.protocol import Integrator
from omegadot.diagnosis.stepping.kept_run import SchemeOf
from omegadot.diagnosis.stepping.over_runs import causes_over_runs
from omegadot.reference_impl.rotations import exp_quaternion, quaternion_product
from omegadot.reference_impl.schemes import SCHEMES, Motion
from omegadot.reference_impl.schemes.motion import Velocity
from omegadot.reference_impl.schemes.runge_kutta import step_in_exponential
from omegadot.reference_impl.schemes.scheme import CHANNELS
from omegadot.reference_impl.system import Array, System


def rate_with(once: float, twice: float) -> Velocity:
    def rate(u: Array, v: Array) -> Array:
        r, w = u[..., -3:], v[..., -3:]
        more = np.cross(r, w)
        turned = w + once * more + twice * np.cross(r, more)
        return np.concatenate((v[..., :-3], turned), axis=-1)

    return rate


def from_left(motion: Motion) -> Motion:
    def retract(q: Array, u: Array) -> Array:
        turned = quaternion_product(exp_quaternion(u[..., -3:]), q[..., -4:])
        return np.concatenate((motion.retract(q, u)[..., :-4], turned), axis=-1)

    return replace(motion, retract=retract)


def causes(rate: Velocity, declared: str | None = "lie-rk4", left: bool = False) -> list[str]:
    def step(
        system: System, motion: Motion, q: Array, v: Array, h: float, n: int
    ) -> tuple[Array, Array]:
        return step_in_exponential(from_left(motion) if left else motion, rate, q, v, h)

    plans = ((0.2, 1), (0.05, 3))
    runs = [kept(one, step, h, every) for one in CASES for h, every in plans]
    by = SchemeOf(SCHEMES["lie-rk4"], "com-world")
    runs = [replace(run, fails=not bool(np.all(run.sound(by)))) for run in runs]
    return causes_over_runs(Integrator("own", declared, dict.fromkeys(CHANNELS, 4)), runs)


@pytest.mark.parametrize("declared", ["lie-rk4", None])
@pytest.mark.parametrize(
    ("factors", "text"),
    [
        (
            (-0.5, 1 / 12),
            "its first commutator has the wrong sign: u' = v - 1/2 [u, v] + 1/12 [u, [u, v]]",
        ),
        ((0.5, 1 / 6), "its second commutator is doubled: u' = v + 1/2 [u, v] + 1/6 [u, [u, v]]"),
        ((0.5, 0.0), "its second commutator is missing: u' = v + 1/2 [u, v]"),
        ((0.3, 1 / 12), "its first commutator has another factor: u' = v + 0.3 [u, v] + 1/12 [u,"),
        ((-0.5, 1 / 6), "it has the differential of the exponential where its inverse is due"),
    ],
)
def test_a_wrong_commutator_is_named(
    factors: tuple[float, float], text: str, declared: str | None
) -> None:
    """Caught: an attitude of order 2 that is said to be no more than that."""
    (found,) = causes(rate_with(*factors), declared)
    assert found.startswith(f"it is stepped by lie-rk4, but {text}")


def test_turns_from_the_left_are_named() -> None:
    (found,) = causes(rate_with(0.5, 1 / 12), left=True)
    assert found.endswith(
        "but the turns of its stages and of the step are multiplied from the left"
    )


def test_a_rate_that_no_factor_makes_is_not_named() -> None:
    def rate(u: Array, v: Array) -> Array:
        return rate_with(0.5, 1 / 12)(u, v) + 0.01 * u

    assert not any("commutator" in text for text in causes(rate))


def test_the_scheme_itself_has_no_cause() -> None:
    assert causes(rate_with(0.5, 1 / 12)) == []
