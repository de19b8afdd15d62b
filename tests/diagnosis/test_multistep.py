"""Steps by the rates of several samples, with other numbers or places than their formula's."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray
from test_over_runs import CASES, Step, kept

from omegadot.adapters.protocol import Integrator
from omegadot.diagnosis.stepping.over_runs import causes_over_runs
from omegadot.diagnosis.stepping.slips.multistep import MOST_BACK, Steps, formula_of
from omegadot.diagnosis.stepping.slips.multistep_slips import order_of
from omegadot.reference_impl.schemes import Motion
from omegadot.reference_impl.schemes.scheme import CHANNELS
from omegadot.reference_impl.system import Array, System

AB2, AB3 = (1.5, -0.5), (23 / 12, -16 / 12, 5 / 12)


def adams(b: tuple[float, ...], turned: tuple[float, ...] | None, quaternion: bool) -> Step:
    """By these rates; explicit Euler's first steps. turned: of the attitude, None by the new ones.

    quaternion: the attitude on the quaternion, made unit, or by the exponential.
    """
    before = list[tuple[Array, Array]]()

    def summed(b: tuple[float, ...], k: int) -> Array:
        known = b if len(before) == len(b) else (1.0,)
        return np.asarray(sum(c * f[k] for c, f in zip(known, before[::-1], strict=False)))

    def step(
        system: System, motion: Motion, q: Array, v: Array, h: float, n: int
    ) -> tuple[Array, Array]:
        before[:] = [] if n == 0 else before[-len(b) + 1 :]
        moved = motion.coordinate_rate(q, v) if quaternion else v
        before.append((moved.copy(), np.array(motion.acceleration(q, v))))
        after = v + h * summed(b, 1)
        by = after if turned is None else summed(turned, 0)
        return (motion.normalize(q + h * by) if quaternion else motion.retract(q, h * by)), after

    return step


def causes(step: Step, order: int, scheme: str | None = None, bend: float = 0.0) -> list[str]:
    runs = [kept(one, step, h, 1) for one in CASES for h in (0.04, 0.02)]
    bent = [replace(run.state, angular_velocity=_bent(run.state, bend)) for run in runs]
    runs = [replace(run, state=state) for run, state in zip(runs, bent, strict=True)]
    return causes_over_runs(Integrator("own", scheme, dict.fromkeys(CHANNELS, order)), runs)


def _bent(state: object, by: float) -> NDArray[np.float64]:
    w: NDArray[np.float64] = state.angular_velocity  # type: ignore[attr-defined]
    return w * (1.0 + by * np.sin(np.arange(len(w)))[:, None] ** 2)


@pytest.mark.parametrize(
    ("b", "order", "text"),
    [
        (
            (1.5, 0.0, -0.5),
            2,
            "each step is h (3/2 f_n - 1/2 f_(n-2)), where Adams-Bashforth 2 has "
            "h (3/2 f_n - 1/2 f_(n-1))",
        ),
        (
            (23 / 12, -15 / 12, 4 / 12),
            3,
            "each step is h (23/12 f_n - 5/4 f_(n-1) + 1/3 f_(n-2)), where Adams-Bashforth 3 has "
            "h (23/12 f_n - 4/3 f_(n-1) + 5/12 f_(n-2))",
        ),
        ((1.4, -0.4), 2, "each step is h (7/5 f_n - 2/5 f_(n-1)): of order 1"),
        (
            AB2,
            3,
            "each step is h (3/2 f_n - 1/2 f_(n-1)), which is Adams-Bashforth 2: of order 2, not 3",
        ),
    ],
)
@pytest.mark.parametrize("quaternion", [True, False])
def test_the_formula_is_named(
    b: tuple[float, ...], order: int, text: str, quaternion: bool
) -> None:
    """Caught: a lower order as all that is known, or an old rate taken for another equation's."""
    assert causes(adams(b, b, quaternion), order) == [text]


def test_another_formula_of_the_attitude_is_named() -> None:
    (text,) = causes(adams(AB2, None, quaternion=False), 2)
    assert text == (
        "omega moves in each step by h (3/2 f_n - 1/2 f_(n-1)), "
        "the attitude by h times its new velocities: of order 1, not 2"
    )


def test_a_formula_that_is_not_declared_is_named() -> None:
    (text,) = causes(adams((1.4, -0.4), (1.4, -0.4), False), 1, "semi-implicit-euler")
    assert text.endswith(": of order 1, though semi-implicit-euler is declared")


@pytest.mark.parametrize(("b", "order"), [(AB2, 2), (AB3, 3)])
def test_a_formula_of_the_declared_order_has_no_cause(b: tuple[float, ...], order: int) -> None:
    assert causes(adams(b, b, quaternion=True), order) == []


def test_steps_that_no_formula_makes_are_not_named() -> None:
    """Caught: numbers that come near, beyond what rounding leaves."""
    found = causes(adams((1.5, 0.0, -0.5), (1.5, 0.0, -0.5), True), 2, bend=1e-10)
    assert not any("f_n" in text for text in found)


def test_the_order_of_a_formula_is_that_of_its_moments() -> None:
    wrong = (1.5, 0.0, -0.5, 0.0, 0.0)
    assert [order_of((*b, 0.0, 0.0)) for b in ((*AB2, 0.0), AB3, (0.9, 0.0, 0.0))] == [2, 3, 0]
    assert order_of(wrong) == 1


def test_rates_that_hardly_change_are_no_error_of_the_search() -> None:
    """Caught: a singular matrix of numbers in single precision, after which no cause is sought."""
    count = 40
    rates = np.ones((count, MOST_BACK + 1, 3))
    rates += 1e-9 * np.random.default_rng(2).standard_normal(rates.shape)
    changes = 0.1 + 1e-8 * np.sin(np.arange(3.0 * count)).reshape(count, 3)
    assert formula_of([Steps(changes, rates, np.full(count, 1e-12))]) is None
