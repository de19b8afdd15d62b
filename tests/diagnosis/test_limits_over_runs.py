"""Limits that hold the state in every step, by one number in the runs of all scenarios."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from test_over_runs import kept
from wrong_equations import CASES

from omegadot.adapters.protocol import Integrator
from omegadot.diagnosis.stepping.kept_run import SchemeOf
from omegadot.diagnosis.stepping.over_runs import causes_over_runs
from omegadot.reference_impl.schemes import SCHEMES, Motion
from omegadot.reference_impl.schemes.scheme import CHANNELS
from omegadot.reference_impl.system import Array, System

EULER = "semi-implicit-euler"
Change = Callable[[System, Array], Array]


def causes(hold: Change, first: bool = False, plans: tuple[float, ...] = (0.05, 0.02)) -> list[str]:
    """Of a step that brings the velocities within a limit, before the place moves or after."""

    def step(
        system: System, motion: Motion, q: Array, v: Array, h: float, n: int
    ) -> tuple[Array, Array]:
        new = v + h * motion.acceleration(q, v)
        held = hold(system, new)
        return motion.retract(q, h * (held if first else new)), held

    by = SchemeOf(SCHEMES[EULER], "com-world")
    runs = [kept(one, step, h, 1 + (h < 0.03)) for one in CASES for h in plans]
    runs = [replace(run, fails=not bool(np.all(run.sound(by)))) for run in runs]
    return causes_over_runs(Integrator("own", EULER, dict.fromkeys(CHANNELS, 1)), runs)


def linear(change: Callable[[Array], Array]) -> Change:
    """Of the linear velocity, which on a pivot follows from the turning."""

    def hold(system: System, v: Array) -> Array:
        return np.concatenate((change(v[:-3]) if len(v) > 3 else v[:-3], v[-3:]))

    return hold


def turning(change: Callable[[Array], Array], of: Callable[[System], bool]) -> Change:
    def hold(system: System, v: Array) -> Array:
        return np.concatenate((v[:-3], change(v[-3:]) if of(system) else v[-3:]))

    return hold


def within(most: float) -> Callable[[Array], Array]:
    return lambda x: x * min(1.0, most / float(np.linalg.norm(x)))


def is_free(system: System) -> bool:
    return system.load.pivot is None


@pytest.mark.parametrize("first", [False, True])
@pytest.mark.parametrize(
    ("hold", "text"),
    [
        (
            linear(lambda v: np.maximum(v, [-np.inf, -np.inf, -1.5])),
            "the linear velocity along z is held above -1.5 m/s",
        ),
        (linear(within(3.3)), "the linear velocity is held below 3.3 m/s"),
        (
            linear(lambda v: np.clip(v, -3.2, 3.2)),
            "each component of the linear velocity is held within 3.2 m/s",
        ),
        (
            linear(lambda v: np.clip(v, [-1.5, -np.inf, -np.inf], [1.5, np.inf, np.inf])),
            "the linear velocity along x is held within 1.5 m/s either way",
        ),
        (turning(within(2.25), lambda s: True), "omega is held below 2.25 rad/s"),
        (
            turning(within(2.25), is_free),
            "omega is held below 2.25 rad/s, but only where the body is free",
        ),
    ],
)
def test_one_limit_is_named_over_all_runs(hold: Change, text: str, first: bool) -> None:
    """Caught: of a component's limit, that of the size by another number in each scenario."""
    assert causes(hold, first) == [text]


def test_a_limit_that_is_another_in_each_scenario_is_not_one() -> None:
    def hold(system: System, v: Array) -> Array:
        return linear(within(3.0 + 0.1 * float(system.body.mass)))(system, v)

    assert not any("is held" in text for text in causes(hold))


def test_a_body_that_comes_to_rest_is_not_held_at_zero() -> None:
    """Each of its numbers is at the least that it comes to, and stays there."""
    still = turning(lambda w: np.where(np.linalg.norm(w) < 2.1, 0.0 * w, w), lambda s: True)
    assert not any("is held" in text for text in causes(still))


def test_a_pitch_that_is_held_is_named() -> None:
    """Caught: "the run is wrong once", of each time that a body comes near the vertical."""
    most = 0.6

    def step(
        system: System, motion: Motion, q: Array, v: Array, h: float, n: int
    ) -> tuple[Array, Array]:
        v = v + h * motion.acceleration(q, v)
        q = motion.retract(q, h * v)
        turn = Rotation.from_quat(np.roll(q[-4:], -1))
        yaw, pitch, roll = turn.as_euler("ZYX")
        if abs(pitch) > most:
            held = Rotation.from_euler("ZYX", [yaw, np.clip(pitch, -most, most), roll])
            q = np.concatenate((q[:-4], np.roll(held.as_quat(), 1)))
        return q, v

    by = SchemeOf(SCHEMES[EULER], "com-world")
    runs = [kept(one, step, h, 1) for one in CASES for h in (0.05, 0.02)]
    runs = [replace(run, fails=not bool(np.all(run.sound(by)))) for run in runs]
    found = causes_over_runs(Integrator("own", EULER, dict.fromkeys(CHANNELS, 1)), runs)
    assert found == ["the pitch of R_z(yaw) R_y(pitch) R_x(roll) is held within 0.6 rad either way"]
