"""The schemes of flight simulators, recognised channel by channel, at steps as logs have them."""

import re

import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from score_line import BRICK, INERTIA, START, run_score, runge_kutta, slope, tumble, turns

from omegadot.commands.score.declared import KNOWN
from omegadot.reference_impl.flight.schemes import FLIGHT_SCHEMES
from omegadot.reference_impl.schemes import SCHEMES
from omegadot.reference_impl.stepping import step_body
from omegadot.reference_impl.system import Body, State, System

STEP, COUNT = 0.1, 100
MAPPED = ("--scenario", BRICK, "--rate-unit", "deg/s", "--timestep", str(STEP))
NAMES = "wx,wy,wz,qw,qx,qy,qz"


def written(path, times, states, names=NAMES):
    table = np.column_stack([times, np.rad2deg(states[:, :3]), states[:, 3:]])
    np.savetxt(path, table, "%.17g", ",", header=f"t,{names}", comments="")
    return path


@pytest.fixture
def score(tmp_path, capsys):
    def scored(times, states, *arguments, names=NAMES, mapped=MAPPED):
        trace, out = written(tmp_path / "trace.csv", times, states, names), tmp_path / "out"
        return run_score(capsys, trace, *mapped, "--out", out, "--format", "json", *arguments)

    return scored


def scheme_of(result):
    (line,) = [s for s in result.json["sentences"] if s.startswith("Scheme:")]
    return line


def unit(y):
    return np.concatenate((y[:3], y[3:] / np.linalg.norm(y[3:])))


def multistep(weights, step=STEP, count=COUNT):
    """Adams and Bashforth's, its past filled with the first rate, written out apart."""
    y, past, found = START, [], [START]
    for _ in range(count):
        past = [slope(0, y), *past][: len(weights)]
        known = past + [past[-1]] * (len(weights) - len(past))
        y = unit(y + step * sum(w * f for w, f in zip(weights, known, strict=True)))
        found.append(y)
    return np.array(found)


def angle_slope(_, y):
    """Yaw, pitch and roll of a body that turns from the world: Euler's kinematic equations."""
    w, (_, pitch, roll) = y[:3], y[3:]
    along = w[1] * np.sin(roll) + w[2] * np.cos(roll)
    turn = [along / np.cos(pitch), w[1] * np.cos(roll) - w[2] * np.sin(roll),
            w[0] + along * np.tan(pitch)]  # fmt: skip
    return np.concatenate((-np.cross(w, INERTIA * w) / INERTIA, turn))


def kutta_on_angles(step=STEP, count=COUNT):
    y = np.concatenate((START[:3], np.zeros(3)))
    found = [y]
    for _ in range(count):
        a = angle_slope(0, y)
        b = angle_slope(0, y + 0.5 * step * a)
        c = angle_slope(0, y + 0.5 * step * b)
        y = y + step / 6.0 * (a + 2 * b + 2 * c + angle_slope(0, y + step * c))
        found.append(y)
    found = np.array(found)
    turn = Rotation.from_euler("ZYX", found[:, 3:]).as_quat()
    return np.column_stack([found[:, :3], np.roll(turn, 1, axis=1)])


TIMES = STEP * np.arange(COUNT + 1)
MADE = {
    "explicit-euler": lambda: multistep([1.0]),
    "adams-bashforth-2": lambda: multistep([1.5, -0.5]),
    "adams-bashforth-3": lambda: multistep([23 / 12, -16 / 12, 5 / 12]),
    "rk4-euler-angles": kutta_on_angles,
}


@pytest.mark.parametrize("name", MADE)
def test_a_flight_scheme_is_recognised_and_may_be_declared(score, name):
    states = MADE[name]()
    found = score(TIMES, states)
    assert scheme_of(found).endswith(f"; it equals {name}.")
    assert {c["kind"] for c in found.json["channels"].values()} == {"explained"}
    assert {c["verdict"] for c in found.json["channels"].values()} == {"info"}
    declared = score(TIMES, states, "--integrator-scheme", name)
    assert declared.code == 0
    assert {c["verdict"] for c in declared.json["channels"].values()} == {"pass"}
    assert score(TIMES, states, "--integrator-scheme", "midpoint").code == 1


def test_omega_alone_names_the_scheme_too(score):
    states = multistep([1.5, -0.5])[:, :3]
    found = score(TIMES, states, names="wx,wy,wz")
    assert "equals adams-bashforth-2 and adams-bashforth-2-euler-angles" in scheme_of(found)
    # Of Euler's steps in omega alone the plainest is named first.
    euler = score(TIMES, multistep([1.0])[:, :3], names="wx,wy,wz")
    assert "equals explicit-euler and semi-implicit-euler" in scheme_of(euler)


def test_a_bad_channel_does_not_hide_the_scheme_of_another(score):
    states = runge_kutta(STEP, COUNT)
    states[:, 3:] = np.roll((Rotation.from_rotvec(0.01 * TIMES[:, None] ** 0.5 * [1, 1, 0])
                             * turns(states)).as_quat(), 1, axis=1)  # fmt: skip
    found = score(TIMES, states)
    assert "omega equals rk4-quaternion and" in scheme_of(found)
    assert "attitude equals none of the" in scheme_of(found)
    kinds = {channel: c["kind"] for channel, c in found.json["channels"].items()}
    assert kinds["omega"] == "explained"
    assert kinds["attitude"] == "beyond"
    declared = score(TIMES, states, "--integrator-scheme", "rk4-quaternion")
    assert declared.code == 1
    assert "but attitude diverges from it" in scheme_of(declared)
    assert declared.json["channels"]["omega"]["verdict"] == "pass"


def test_a_scheme_that_leaves_next_to_nothing_is_the_nearest(score):
    states = multistep([1.5, -0.5])
    states[:, :3] *= 1.0 + 1e-9 * np.arange(COUNT + 1)[:, None]
    line = scheme_of(score(TIMES, states))
    assert "omega is nearest to adams-bashforth-2, which leaves" in line
    assert "deg/s" in line
    assert "attitude equals adams-bashforth-2" in line


def test_schemes_are_sought_at_many_steps_or_it_is_said_that_they_are_not(score, monkeypatch):
    from omegadot.commands.score import steps

    states = multistep([1.5, -0.5])
    fine = ("--timestep", str(STEP / 200))  # 20 000 steps of what the trace did not take
    assert f"none of the {len(KNOWN)}" in scheme_of(score(TIMES, states, *fine))
    monkeypatch.setattr(steps, "MOST_STEPS_OF_ALL", 10)
    assert "not sought, the trace has 100 steps" in scheme_of(score(TIMES, states))
    monkeypatch.setattr(steps, "MOST_STEPS_OF_ALL", 100)
    line = scheme_of(score(TIMES, runge_kutta(STEP, COUNT)[:, :3], names="wx,wy,wz"))
    assert "not sought to the end" in line
    assert "rk4-quaternion" in line


def stamps(kind):
    if kind == "accumulated":
        return np.concatenate(([0.0], np.cumsum(np.full(100 * COUNT, STEP / 100))))[::100]
    return TIMES.astype(np.float32).astype(float) if kind == "single" else TIMES


@pytest.mark.parametrize(
    ("kind", "sentence", "most"),
    [
        ("exact", "", 0.0),
        ("accumulated", "off whole steps", 1e-10),
        ("single", "single precision", 5e-7),
    ],
)
def test_stamps_near_whole_steps_are_accepted_with_what_they_leave_open(
    score, kind, sentence, most
):
    states = runge_kutta(STEP, COUNT)
    found = score(stamps(kind), states)
    assert "it equals rk4-quaternion" in scheme_of(found)
    assert sum(sentence in line for line in found.json["sentences"]) == (
        1 if sentence else len(found.json["sentences"])
    )
    opened = found.json["channels"]["omega"]["bound"]
    fastest = 0.5  # rad/s^2, omega-dot of the brick at most
    assert opened < 1e-13 + fastest * most
    # A perfect trace is within its digits only where its stamps' openness counts.
    perfect = score(stamps(kind), tumble(TIMES)).json["channels"]["omega"]
    assert perfect["max"] <= perfect["bound"] + 1e-11  # to which `tumble` is exact


def test_what_a_declared_scheme_leaves_has_its_unit(score):
    """Caught: "0.0011 is left", of a relative error as of an angle in rad."""
    times = STEP * np.arange(COUNT + 1)
    result = score(times, tumble(times), "--integrator-scheme", "explicit-euler")
    assert result.code == 1
    notes = {name: one["note"] for name, one in result.json["channels"].items()}
    assert re.match(r"not explained by explicit-euler: \S+ relative is left", notes["omega"])
    assert re.match(r"not explained by explicit-euler: \S+ rad is left", notes["attitude"])
    assert "omega and attitude equal none of the" in scheme_of(result)


def test_every_scheme_has_one_name():
    assert not set(SCHEMES) & set(FLIGHT_SCHEMES)
    assert set(KNOWN) == {*SCHEMES, *FLIGHT_SCHEMES}


@pytest.mark.parametrize("sequence", ["ZYX", "XYZ", "ZXZ"])
def test_angles_of_any_sequence_converge_to_the_exact_motion(sequence):
    from omegadot.commands.score.score import case_given
    from omegadot.reference_impl.flight.euler_angles import Angles
    from omegadot.reference_impl.flight.schemes import step_flight

    case = case_given(BRICK)
    system, start = case.system, case.initial
    tilt = np.array([0.8, 0.4, 0.2, 0.4])
    scheme = FLIGHT_SCHEMES["rk4-euler-angles"]
    errors = []
    for steps in (25, 50):
        chart = Angles(sequence, tilt, np.array([0.6, 0.0, 0.8, 0.0]))
        state = step_flight(scheme, system, start, 1.0 / steps, steps, steps, chart)
        exact = tumble(np.array([1.0]))[0]
        errors.append(
            min(np.linalg.norm(state.orientation[-1] - sign * exact[3:]) for sign in (1.0, -1.0))
        )
    assert errors[1] < 1e-5
    assert 3.0 < np.log2(errors[0] / errors[1]) < 5.0


def test_a_trace_in_an_engines_own_coordinates_is_recognised_where_no_usual_scheme_is_it(score):
    """As Basilisk steps: of a pitch through half a turn, so that sigma changes to its shadow."""
    scheme, of = SCHEMES["heun-mrp"], System((Body(np.array(1.0), np.zeros(3), np.diag(INERTIA)),))
    start = State(START[3:], START[:3], np.zeros(3), np.zeros(3))
    _, states = step_body(scheme, of, start, STEP, COUNT, 1)
    table = np.concatenate((states.angular_velocity, states.orientation), axis=-1)
    assert "it equals heun-mrp" in scheme_of(score(TIMES, table))
