"""Runs that begin at another state than the one given, by one rule, and are sound from there."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from wrong_equations import BODY_TORQUE, GRAVITY, PIVOT, WORLD_TORQUE, case

from omegadot.adapters.protocol import Integrator
from omegadot.diagnosis.equations.across import Across
from omegadot.diagnosis.in_steps import StepCauses
from omegadot.diagnosis.kept_case import KeptCase
from omegadot.diagnosis.over_scenarios import OverScenarios
from omegadot.diagnosis.stepping.ends.starts import other_start
from omegadot.diagnosis.stepping.kept_run import KeptRun
from omegadot.diagnosis.stepping.vanishing.vanishing_steps import VanishingSteps, vanishing_steps
from omegadot.gates.case import Case, Sweep
from omegadot.gates.states.equation import random_states
from omegadot.gates.steps.probe import probe_at
from omegadot.reference_impl.kinematics import place_on_pivot
from omegadot.reference_impl.rotations import (
    conjugate,
    exp_quaternion,
    quaternion_product,
    rotate,
    rotation_matrix,
)
from omegadot.reference_impl.schemes import SCHEMES
from omegadot.reference_impl.schemes.scheme import CHANNELS
from omegadot.reference_impl.stepping import step_body
from omegadot.reference_impl.system import State

MADE = (
    case("free", {}),
    case("falling", {"gravity": GRAVITY}),
    case("driven", {"torque": BODY_TORQUE}),
    case("driven-in-world", {"torque": WORLD_TORQUE}),
    case("top", {"gravity": GRAVITY, "pivot": PIVOT}),
    case("top-driven", {"pivot": PIVOT, "torque": WORLD_TORQUE, "gravity": GRAVITY}),
)
# Every second one begins at a quaternion whose scalar part is negative.
CASES = tuple(
    replace(one, initial=replace(one.initial, orientation=one.initial.orientation * signs))
    for one, signs in zip(MADE, 3 * ([1.0, 1.0, 1.0, 1.0], [-1.0, 1.0, 1.0, 1.0]), strict=True)
)
SCHEME, H, STEPS = "semi-implicit-euler", 0.02, 12
Change = Callable[[State], State]


def steps_of(one: Case, start: Change) -> VanishingSteps:
    probe = probe_at(one.system, random_states(one, 12, [1]))
    begins = place_on_pivot(one.system, start(probe.states))
    lanes = [
        np.broadcast_to(f[:, None], (*probe.timesteps.shape, f.shape[-1]))
        for f in vars(begins).values()
    ]
    _, after = step_body(SCHEMES[SCHEME], one.system, State(*lanes), probe.timesteps, 1, 1)
    return vanishing_steps(one.system, probe, after[-1])


def run_of(one: Case, start: Change, reported: Change, log_given: bool) -> KeptRun:
    begins = place_on_pivot(one.system, start(one.initial))
    sweep = Sweep(H, STEPS, 1)
    state = reported(step_body(SCHEMES[SCHEME], one.system, begins, H, STEPS, 1)[1])
    if log_given:
        pairs = zip(vars(one.initial).values(), vars(state).values(), strict=True)
        state = State(*(np.concatenate((a[None], b[1:])) for a, b in pairs))
    bounds = {c: np.full(STEPS, 1e-11) for c in ("omega", "attitude", "velocity", "position")}
    return KeptRun(one.name, one.system, sweep, sweep.times, state, bounds, True)


def same(state: State) -> State:
    return state


def statement(start: Change, reported: Change = same, log_given: bool = False) -> str:
    integrator = Integrator("own", SCHEME, dict.fromkeys(CHANNELS, 1))
    steps = {one.name: steps_of(one, lambda s: reported(start(s))) for one in CASES}
    given = {one.name: one.initial for one in CASES}
    kept = [run_of(one, start, reported, log_given) for one in CASES]
    found = other_start(integrator, steps, given, kept)
    return "" if found is None else found.statement


def by_atan(state: State) -> State:
    """The yaw is atan for atan2: half a turn about the world's z where R_xx < 0."""
    turn = np.array([0.0, 0.0, 0.0, 1.0])
    other = quaternion_product(np.broadcast_to(turn, state.orientation.shape), state.orientation)
    behind = rotation_matrix(state.orientation)[..., 0, 0] < 0.0
    return replace(state, orientation=np.where(behind[..., None], other, state.orientation))


def turned(state: State) -> State:
    more = exp_quaternion(np.array([0.0, -0.5 * np.pi, 0.0]))
    whole = np.broadcast_to(more, state.orientation.shape)
    return replace(state, orientation=quaternion_product(state.orientation, whole))


def conjugated_in_part(state: State) -> State:
    """Conjugated, where the quaternion's y is negative."""
    other = np.where(state.orientation[..., 2:3] < 0.0, conjugate(state.orientation), 1.0)
    other = np.where(state.orientation[..., 2:3] < 0.0, other, state.orientation)
    return replace(state, orientation=other)


def velocity_of_origin(sign: float) -> Change:
    """R (omega x c) more, or less: of the one of two points taken for that of the other."""

    def start(state: State) -> State:
        center = np.broadcast_to(CASES[0].system.body.center_of_mass, state.angular_velocity.shape)
        between = rotate(state.orientation, np.cross(state.angular_velocity, center))
        return replace(state, linear_velocity=state.linear_velocity + sign * between)

    return start


def place_of_origin(sign: float) -> Change:
    """R c more, or less."""

    def start(state: State) -> State:
        center = np.broadcast_to(CASES[0].system.body.center_of_mass, state.angular_velocity.shape)
        return replace(state, position=state.position + sign * rotate(state.orientation, center))

    return start


def unsigned(state: State) -> State:
    """The scalar part of the quaternion by its size."""
    w = np.abs(state.orientation[..., :1])
    return replace(state, orientation=np.concatenate((w, state.orientation[..., 1:]), axis=-1))


@pytest.mark.parametrize("log_given", [False, True])
@pytest.mark.parametrize(
    ("start", "text"),
    [
        (by_atan, "turned by half a turn about the world's z axis, but only where R_xx < 0"),
        (turned, "turned by a quarter of a turn about minus the body's y axis"),
        (
            conjugated_in_part,
            "with the quaternion conjugated, but only where the quaternion's y is negative",
        ),
        (
            lambda s: replace(s, linear_velocity=s.linear_velocity[..., [0, 2, 1]]),
            "with y and z of the linear velocity swapped",
        ),
        (
            lambda s: replace(s, orientation=s.orientation[..., [0, 1, 3, 2]]),
            "with y and z of the quaternion swapped",
        ),
        (
            unsigned,
            "with the quaternion's scalar part without its sign",
        ),
        (
            velocity_of_origin(1.0),
            "with the linear velocity of the centre of mass taken for that of the body's origin: "
            "R (omega x c) is added",
        ),
        (
            velocity_of_origin(-1.0),
            "with the linear velocity of the body's origin in place of that of the centre of mass: "
            "R (omega x c) is taken off",
        ),
        (
            place_of_origin(1.0),
            "with the position of the centre of mass taken for that of the body's origin: "
            "R c is added",
        ),
        (
            place_of_origin(-1.0),
            "with the position of the body's origin in place of that of the centre of mass: "
            "R c is taken off",
        ),
        (
            lambda s: replace(s, linear_velocity=rotate(s.orientation, s.linear_velocity)),
            "with the linear velocity turned by R",
        ),
        (
            lambda s: replace(
                s, angular_velocity=rotate(conjugate(s.orientation), s.angular_velocity)
            ),
            "with omega turned by R^T",
        ),
        (lambda s: replace(s, angular_velocity=-s.angular_velocity), "with omega reversed"),
        (
            lambda s: replace(s, angular_velocity=np.pi / 180 * s.angular_velocity),
            "with omega scaled by 0.0174533 (pi/180)",
        ),
        (
            lambda s: replace(
                s, linear_velocity=0.0 * s.position, orientation=conjugate(s.orientation)
            ),
            "with the quaternion conjugated and with the linear velocity zero",
        ),
    ],
)
def test_the_rule_by_which_runs_begin_elsewhere_is_named(
    start: Change, text: str, log_given: bool
) -> None:
    """Caught: "some 3 rad from the one given", and axes of a velocity reported otherwise."""
    assert statement(start, log_given=log_given) == f"a run begins {text}, and is sound from there"


def test_samples_that_are_reported_so_are_no_other_start() -> None:
    """Caught: a start named of what is done to every sample of a run."""

    def swapped(state: State) -> State:
        return replace(state, linear_velocity=state.linear_velocity[..., [0, 2, 1]])

    assert statement(same, swapped) == ""
    assert statement(same, by_atan) == ""
    assert statement(same, velocity_of_origin(1.0)) == ""
    assert statement(same) == ""


def test_a_start_by_no_known_rule_is_not_named() -> None:
    def mixed(state: State) -> State:
        w, v = state.angular_velocity, rotate(state.orientation, state.angular_velocity)
        return replace(state, angular_velocity=w + 0.3 * np.sin(v))

    assert statement(mixed) == ""


def test_what_begins_elsewhere_from_minus_q_alone_is_of_the_same_rule() -> None:
    """Caught: "the sign of the first quaternion changes the run", where its rule is known."""
    integrator = Integrator("own", SCHEME, dict.fromkeys(CHANNELS, 1))
    steps = {one.name: steps_of(one, unsigned) for one in CASES}
    given = {one.name: one.initial for one in CASES}
    kept = [run_of(one, unsigned, same, log_given=False) for one in CASES]
    found = other_start(integrator, steps, given, kept)
    assert found is not None
    one = next(one for one in CASES if one.initial.orientation[0] > 0.0)
    negated = replace(one.initial, orientation=-one.initial.orientation)
    other = replace(one, initial=negated)
    assert found.makes(run_of(other, unsigned, same, log_given=True), negated)
    assert not found.makes(run_of(other, same, same, log_given=True), negated)


def unsigned(state: State) -> State:
    q = state.orientation
    return replace(state, orientation=np.concatenate((np.abs(q[..., :1]), q[..., 1:]), axis=-1))


@pytest.mark.parametrize(
    ("start", "reported", "text"),
    [(unsigned, same, "a run begins with"), (same, unsigned, "is reported without its sign")],
)
def test_a_sign_that_starts_lose_is_in_later_samples(
    start: Change, reported: Change, text: str
) -> None:
    """Caught: of a scheme that is not known, a start without the sign that is called a report."""
    one = CASES[1]
    steps = steps_of(one, lambda s: reported(start(s)))
    over = OverScenarios()
    through_none = np.array([-0.01, -0.1, 0.7, -0.4])  # of which the scalar part falls
    state = replace(one.initial, orientation=through_none / np.linalg.norm(through_none))
    over.runs.kept.append(run_of(replace(one, initial=state), start, reported, False))
    integrator = Integrator("own", None, dict.fromkeys(CHANNELS, 1))
    kept = KeptCase(one.name, integrator, "", None, False, False, steps)
    (found,) = StepCauses(Across(), over, kept, list).jumped(steps)
    assert "the quaternion's scalar part" in found
    assert text in found
