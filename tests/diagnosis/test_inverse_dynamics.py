"""Torques of inverse dynamics by an equation that is wrong, as forward dynamics may have it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from wrong_equations import CASES, gyroscopic

from omegadot.diagnosis.case_causes import CaseCauses
from omegadot.diagnosis.over_scenarios import EngineOverScenarios
from omegadot.gates.case import Case
from omegadot.gates.rows import Row
from omegadot.gates.states.equation import EvaluationStates, random_acceleration, random_states
from omegadot.harness.drive import CaseResult
from omegadot.reference_impl.cross_product import cross
from omegadot.reference_impl.inertia import lever, moving_inertia
from omegadot.reference_impl.loads import gravity_torque
from omegadot.reference_impl.motion import forward_dynamics, inverse_dynamics
from omegadot.reference_impl.rotations import rotate
from omegadot.reference_impl.system import Acceleration, Array, State, System
from omegadot.workers.harness_end.process import Answer

More = Callable[[System, State, Acceleration], Array]  # N m, than the right torque
FEW = (CASES[0], CASES[4], CASES[-1])
TOPS = tuple(one for one in CASES if one.system.load.pivot is not None)
FAILS = [Row("equation", "torque", "residual", 1.0, "1", 1e-9, "fail")]


def named(more: More, cases: tuple[Case, ...]) -> dict[str, list[str]]:
    """What is named on every scenario of an engine that is right but for these torques."""
    engine, every, none = EngineOverScenarios(), dict[str, CaseCauses](), None
    truth: Any = none  # of a trajectory, where there is one
    for one in cases:
        x = random_states(one, 60, [1])
        requested = random_acceleration(one.system, x, [2])
        torque = inverse_dynamics(one.system, x, requested) + more(one.system, x, requested)
        result = CaseResult(
            forward=Answer("ok", result=vars(forward_dynamics(one.system, x))),
            inverse=Answer("ok", result={"torque": torque}),
        )
        states = EvaluationStates(x, x, requested)
        every[one.name] = CaseCauses(engine, one, truth, states, result, FAILS, ())
    return {name: causes.sentences(None) for name, causes in every.items()}


def as_free(s: System, x: State, a: Acceleration) -> Array:
    free = replace(s, load=replace(s.load, pivot=None))
    return inverse_dynamics(free, x, a) - inverse_dynamics(s, x, a)


def test_a_pivot_that_is_not_seen_is_named() -> None:
    """Caught: "the inertia about the centre of mass" of a body without gravity, else nothing."""
    found = named(as_free, tuple(one for one in TOPS if np.any(one.system.load.gravity)))
    text = (
        "inverse dynamics take the body for a free one: with the inertia about its centre of mass, "
        "without gravity"
    )
    assert found
    assert all(texts == [text] for texts in found.values()), found


def with_rate_first(s: System, x: State, a: Acceleration) -> Array:
    momentum = x.angular_velocity @ np.asarray(moving_inertia(s)).T
    return cross(a.angular, momentum) - gyroscopic(s, x)


def with_rate_last(s: System, x: State, a: Acceleration) -> Array:
    change = a.angular @ np.asarray(moving_inertia(s)).T
    return cross(x.angular_velocity, change) - gyroscopic(s, x)


@pytest.mark.parametrize(
    ("more", "term"),
    [(with_rate_first, "omega-dot x I omega"), (with_rate_last, "omega x I omega-dot")],
)
def test_omega_dot_in_the_place_of_an_omega_is_named(more: More, term: str) -> None:
    """Caught: the two taken for one another, or omega x I omega in their place left in."""
    due = [f"inverse dynamics have {term} for the gyroscopic term"]
    assert named(more, FEW) == {one.name: due for one in FEW}


def about_origin(s: System, x: State, a: Acceleration) -> Array:
    c, w = np.asarray(s.body.center_of_mass), x.angular_velocity
    more = s.body.mass * (c @ c * np.eye(3) - np.outer(c, c))
    return np.asarray(a.angular @ more.T + cross(w, w @ more.T))


def test_the_inertia_about_the_origin_is_named() -> None:
    due = ["inverse dynamics use the inertia about the body's origin"]
    free = tuple(one for one in FEW if one.system.load.pivot is None)
    assert named(about_origin, free) == {one.name: due for one in free}


def gravity_turned(s: System, x: State, _: Acceleration) -> Array:
    torque = gravity_torque(s, x)  # inverse dynamics take it from what the joint gives
    return torque - rotate(x.orientation, torque)


def gyroscopic_turned(s: System, x: State, _: Acceleration) -> Array:
    return rotate(x.orientation, gyroscopic(s, x)) - gyroscopic(s, x)


def gyroscopic_swapped(s: System, x: State, _: Acceleration) -> Array:
    term = gyroscopic(s, x)
    return term[:, [1, 0, 2]] - term


TERMS: dict[str, tuple[More, str]] = {
    "gravity": (gravity_turned, "the torque of gravity is turned by R"),
    "gyroscopic": (gyroscopic_turned, "the gyroscopic term is turned by R"),
    "swapped": (
        gyroscopic_swapped,
        "the components of the gyroscopic term are others: x, y, z hold y, x, z",
    ),
}


@pytest.mark.parametrize("name", TERMS)
def test_a_term_that_is_wrong_as_in_forward_dynamics_is_named(name: str) -> None:
    """Caught: the difference with the other sign, which no wrong term makes."""
    more, text = TERMS[name]
    falling = {one.name for one in TOPS if np.any(one.system.load.gravity)}
    cases = TOPS if name == "gravity" else FEW
    shown = falling if name == "gravity" else {one.name for one in FEW}
    due = [f"in inverse dynamics, {text}"]
    assert len(shown) > 1
    assert named(more, cases) == {c.name: due if c.name in shown else [] for c in cases}


def test_what_is_wrong_on_one_scenario_alone_names_no_term() -> None:
    """Each of two tops has its own: what fits the one is contradicted by the other."""

    def own(s: System, x: State, a: Acceleration) -> Array:
        heavy = float(s.body.mass) > 1.8
        return gravity_turned(s, x, a) if heavy else 0.7 * gyroscopic_turned(s, x, a)

    assert set(map(tuple, named(own, (TOPS[0], TOPS[1])).values())) == {()}


def about_centre(s: System, x: State, _: Acceleration) -> Array:
    moved, w = moving_inertia(s) - s.body.inertia, x.angular_velocity
    return np.asarray(-cross(w, w @ np.asarray(moved).T))


def test_an_equation_with_one_thing_wrong_is_named_on_all_scenarios() -> None:
    """Caught: "the gyroscopic term scaled by 1.8", which fits one symmetric top alone."""
    text = "the gyroscopic term is formed with the inertia about the centre of mass"
    found = named(about_centre, TOPS)
    assert len({one.name for one in TOPS if found[one.name]}) > 1
    for one in found.values():
        assert not one or one[0].startswith(f"in inverse dynamics, {text}")


def test_a_torque_that_is_not_finite_is_stated() -> None:
    """Caught: an error in the search for causes."""

    def lost(_: System, x: State, __: Acceleration) -> Array:
        first = np.arange(len(x.angular_velocity))[:, None] == 0
        return np.where(first, np.nan, 0.0 * x.angular_velocity)

    due = ["the torque of inverse dynamics is not finite at 1 of 60 states"]
    assert set(map(tuple, named(lost, FEW).values())) == {tuple(due)}


def at_mean_omega(s: System, x: State, _: Acceleration) -> Array:
    w = x.angular_velocity
    mean = np.mean(w, axis=0) + 0.0 * w
    return gyroscopic(s, replace(x, angular_velocity=mean)) - gyroscopic(s, x)


def at_first_omega(s: System, x: State, _: Acceleration) -> Array:
    w = x.angular_velocity
    return gyroscopic(s, replace(x, angular_velocity=w[:1] + 0.0 * w)) - gyroscopic(s, x)


def at_omega_before(s: System, x: State, _: Acceleration) -> Array:
    w = x.angular_velocity
    before = replace(x, angular_velocity=np.concatenate((w[:1], w[:-1])))
    return gyroscopic(s, before) - gyroscopic(s, x)


def with_mean_momentum(s: System, x: State, _: Acceleration) -> Array:
    w = x.angular_velocity
    mean = np.mean(w, axis=0) @ np.asarray(moving_inertia(s)) + 0.0 * w
    return np.asarray(cross(w, mean) - gyroscopic(s, x))


MEAN = "is the mean over those that are requested together"
BATCHES: dict[str, tuple[More, str]] = {
    "mean omega": (at_mean_omega, f"omega in the gyroscopic term {MEAN}"),
    "mean momentum": (with_mean_momentum, f"I omega in the gyroscopic term {MEAN}"),
    "first omega": (
        at_first_omega,
        "the gyroscopic term is that of the first state among those that are requested together",
    ),
    "omega before": (
        at_omega_before,
        "the gyroscopic term is that of the state before (the first has its own) among those that "
        "are requested together",
    ),
}


@pytest.mark.parametrize("name", BATCHES)
def test_what_is_taken_of_the_whole_batch_is_named(name: str) -> None:
    """Caught: no cause, where every state has the mean of all."""
    more, text = BATCHES[name]
    assert named(more, FEW) == {one.name: [f"in inverse dynamics, {text}"] for one in FEW}


def test_a_triangle_of_the_inertia_is_named_on_free_and_pivoted_bodies() -> None:
    """Caught: two texts of one mistake, one of each kind of body, neither of which is of all."""

    def upper(s: System, x: State, a: Acceleration) -> Array:
        inertia = np.asarray(moving_inertia(s))
        return a.angular @ (np.triu(inertia) - inertia).T

    found = named(upper, CASES)
    text = (
        "in inverse dynamics, where it multiplies omega-dot, of what stays, the lower triangle of "
        "the inertia is zero"
    )
    assert all(texts == [text] for texts in found.values()), found
    free = named(upper, tuple(one for one in CASES if one.system.load.pivot is None))
    assert all(texts == [text.replace("of what stays, ", "")] for texts in free.values()), free


@pytest.mark.parametrize(
    ("other", "text"),
    [
        (lambda q, t, n: rotate(q, t + n), "in world axes, in place of body axes"),
        (lambda q, t, n: -t - n, "with the wrong sign"),
    ],
    ids=["world", "sign"],
)
def test_another_acceleration_of_the_centre_of_mass_is_named(other: Any, text: str) -> None:
    """In the sum of the turning and of r x m (a - g), as a pivot is done by the centre of mass."""

    def more(s: System, x: State, a: Acceleration) -> Array:
        if s.load.pivot is None:
            return np.zeros_like(x.angular_velocity)
        arm, w = lever(s), x.angular_velocity
        tangential, inward = cross(a.angular, arm), cross(w, cross(w, arm))
        off = other(x.orientation, tangential, inward) - tangential - inward
        return np.asarray(cross(arm, float(s.body.mass) * off))

    found = named(more, TOPS)
    due = f"inverse dynamics have the acceleration of the centre of mass {text}"
    assert all(texts == [due] for texts in found.values()), found
