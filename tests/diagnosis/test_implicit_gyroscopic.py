"""Steps in which the gyroscopic term alone is implicit; and silence."""

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

EULER, LINEAR = "semi-implicit-euler", "linearly-implicit-euler"
# The new omega of I, omega, the torque without the gyroscopic term, h and d.
Step = Callable[[Array, Array, Array, float, float], Array]


def newton(i: Array, w: Array, t: Array, h: float, d: float) -> Array:
    matrix = i + h * (skew(w) @ i - skew(i @ w))
    return w + np.linalg.solve(i, h * t) - np.linalg.solve(matrix, h * skew(w) @ i @ w)


def torque_first(i: Array, w: Array, t: Array, h: float, d: float) -> Array:
    return newton(i, w + np.linalg.solve(i, h * t), np.zeros(3), h, d)


def to_the_end(i: Array, w: Array, t: Array, h: float, d: float) -> Array:
    new = w
    for _ in range(200):
        new = w - np.linalg.solve(i, h * skew(new) @ i @ new)
    return new + np.linalg.solve(i, h * t)


def undamped_matrix(i: Array, w: Array, t: Array, h: float, d: float) -> Array:
    matrix = i + h * (skew(w) @ i - skew(i @ w))
    return w + np.linalg.solve(matrix, h * (t - skew(w) @ i @ w))


def causes(new_omega: Step, name: str = EULER) -> list[str]:
    def step(
        system: System, motion: Motion, q: Array, v: Array, h: float, n: int
    ) -> tuple[Array, Array]:
        i, a, w = moving_inertia(system), np.array(motion.acceleration(q, v)), v[-3:]
        torque = i @ a[-3:] + skew(w) @ i @ w
        new = new_omega(i, w, torque, h, float(system.load.damping))
        v = np.concatenate((v[:-3] + h * a[:-3], new))
        return motion.retract(q, h * v), v

    runs = [kept(one, step, h, every) for one in CASES for h, every in ((0.05, 1), (0.02, 3))]
    by = SchemeOf(SCHEMES[name], "com-world")
    runs = [replace(run, fails=not bool(np.all(run.sound(by)))) for run in runs]
    return causes_over_runs(Integrator("own", name, dict.fromkeys(CHANNELS, 1)), runs)


@pytest.mark.parametrize(
    ("step", "name", "how"),
    [
        (newton, EULER, "by one Newton step from the omega of its start, and all torque is added"),
        (newton, LINEAR, "by one Newton step from the omega of its start, and all torque is added"),
        (torque_first, EULER, "by one Newton step from the omega that the torques have pushed"),
        (to_the_end, EULER, "solved for to the end, and all torque is added explicitly"),
        (undamped_matrix, EULER, "by one Newton step, in whose matrix there is no damping"),
    ],
)
def test_how_the_gyroscopic_term_is_implicit_is_named(step: Step, name: str, how: str) -> None:
    """Caught: silence where a game engine's gyroscopic step is declared as plain Euler."""
    (found,) = causes(step, name)
    assert f"it is stepped by {name}, but the gyroscopic term is taken implicitly, {how}" in found


def test_half_of_it_is_not_named() -> None:
    def half(i: Array, w: Array, t: Array, h: float, d: float) -> Array:
        matrix = i + 0.5 * h * (skew(w) @ i - skew(i @ w))
        return w + np.linalg.solve(i, h * t) - np.linalg.solve(matrix, h * skew(w) @ i @ w)

    assert not any("implicitly" in text for text in causes(half))


def test_a_sound_scheme_has_no_cause() -> None:
    assert causes(lambda i, w, t, h, d: w + np.linalg.solve(i, h * (t - skew(w) @ i @ w))) == []
