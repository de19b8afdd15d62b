"""Causes of a trace that diverges: the mistake that it was made with, or silence."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from score_line import (
    BRICK,
    INERTIA,
    START,
    run_score,
    runge_kutta,
    slope,
    tumble,
    write_brick,
)

from omegadot.commands.score.causes import _solved, mistakes
from omegadot.commands.score.score import case_given

NAMES = "t,wx,wy,wz,qw,qx,qy,qz"
TIMES = 0.1 * np.arange(101)
OTHERS = "others that make the same motion"


@pytest.fixture
def causes(tmp_path, capsys):
    def found(scenario, times, states, *arguments):
        trace = tmp_path / "trace.csv"
        table = np.column_stack([times, states])
        head = ",".join(NAMES.split(",")[: table.shape[1]])
        np.savetxt(trace, table, "%.12g", ",", header=head, comments="")
        options = ("--scenario", scenario, "--out", tmp_path / "out", "--format", "json")
        result = run_score(capsys, trace, *options, *arguments)
        assert result.code == 0, result.err
        return result.json["causes"]

    return found


def brick_with(change):
    """The brick's motion with another slope, by an integrator of high order."""
    solved = solve_ivp(change, (0.0, 10.0), START, "DOP853", TIMES, rtol=1e-12, atol=1e-14)
    return solved.y.T


def no_gyroscopic(t, y):
    return np.concatenate((np.zeros(3), slope(t, y)[3:]))


def wrong_sign(t, y):
    found = slope(t, y)
    return np.concatenate((-found[:3], found[3:]))


def permuted(t, y):
    other = INERTIA[[1, 0, 2]]
    w = y[:3]
    return np.concatenate((-np.cross(w, other * w) / other, slope(t, y)[3:]))


OF_A_BRICK = {
    "the gyroscopic term is missing": no_gyroscopic,
    "the gyroscopic term has the wrong sign": wrong_sign,
    "in the dynamics, the inertia's axes are permuted: x, y, z hold what belongs to y, x, z": (
        permuted
    ),
}


@pytest.mark.parametrize("cause", OF_A_BRICK)
@pytest.mark.parametrize("columns", [4, 8])
def test_a_mistake_of_the_equation_is_named(causes, cause, columns):
    states = brick_with(OF_A_BRICK[cause])
    if cause == "the gyroscopic term is missing" and columns == 4:
        return  # a constant omega: the gyroscopic term is not what is seen alone
    (found,) = causes(BRICK, TIMES, states[:, : columns - 1])
    # without a torque no motion tells a body of equal moments from a missing gyroscopic term
    several = "either " * (cause == "the gyroscopic term is missing")
    assert found.startswith(several + cause)
    assert bool(several) or found == cause


SCENARIOS = ("heavy-top", "damped-tumble", "driven-body", "driven-world", "full-tensor")


@pytest.mark.parametrize("scenario", SCENARIOS)
def test_every_mistake_is_named_or_nothing_is(causes, scenario):
    """A named cause is the mistake that was made, or one of several that make the same motion."""
    case = case_given(scenario)
    times = np.linspace(0.0, min(4.0, case.scenario.run.duration), 61)
    named = 0
    all_of_them = list(mistakes(case.system, case.initial))
    for mistake in all_of_them[:: max(1, len(all_of_them) // 6)]:
        state = _solved(mistake, times)
        states = np.column_stack([state.angular_velocity, state.orientation])
        found = causes(scenario, times, states)
        if found and (found[0].startswith("either ") or OTHERS in found[0]):
            assert mistake.statement in found[0] or OTHERS in found[0]
        else:
            assert found in ([], [mistake.statement]), mistake.statement
        named += bool(found)
    assert named >= 3


SOUND = {
    "a scheme's error": lambda: runge_kutta(0.1, 100),
    "noise": lambda: tumble(TIMES) + 1e-3 * np.random.default_rng(1).standard_normal((101, 7)),
    "another gain": lambda: tumble(TIMES) * np.array([1.01, 1.01, 1.01, 1, 1, 1, 1]),
    "late": lambda: tumble(np.clip(TIMES - 0.01, 0.0, None)),
}


@pytest.mark.parametrize("kind", SOUND)
def test_no_cause_is_named_of_what_is_none_of_these(causes, kind):
    states = SOUND[kind]()
    states[:, 3:] /= np.linalg.norm(states[:, 3:], axis=1, keepdims=True)
    assert causes(BRICK, TIMES, states) == []


def test_the_cause_is_a_sentence_too(tmp_path, capsys):
    trace = write_brick(tmp_path / "trace.csv", TIMES, brick_with(wrong_sign))
    options = ("--scenario", BRICK, "--column", "w=p,q,r", "--rate-unit", "deg/s")
    result = run_score(capsys, trace, *options, "--angle-unit", "deg", "--out", tmp_path / "out")
    assert "Likeliest cause: the gyroscopic term has the wrong sign." in result.out


def scaled(t, y):
    w = y[:3]
    return np.concatenate((-0.9 * np.cross(w, INERTIA * w) / INERTIA, slope(t, y)[3:]))


def test_a_term_with_a_number_is_found_between_the_samples(causes):
    (cause,) = causes("nesc-checkcase-2", TIMES, brick_with(scaled), "--rate-unit", "rad/s")
    assert "the gyroscopic term is scaled by 0.9" in cause
