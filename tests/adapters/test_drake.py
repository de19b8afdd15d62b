"""What Drake's integrators step, in Drake's own coordinates, and what its joints do at their ends.

y = (q, v): a free body's q is (quaternion, place) and its v (omega, velocity) in world axes; a
pivoted one's are roll, pitch, yaw and omega in world axes. The rates are written out here.
"""

from __future__ import annotations

from collections.abc import Callable
from itertools import pairwise
from typing import Any

import numpy as np
import pytest
from mujoco_cases import EPS, at, norm, states, system

from omegadot.adapters.drake.adapter import DrakeAdapter
from omegadot.adapters.drake.integrators import FIXED, PLANS
from omegadot.adapters.drake.model import Stepping
from omegadot.adapters.drake.stepping import DrakeStepper
from omegadot.adapters.protocol import UnsupportedError
from omegadot.adapters.registry import OURS, build_adapter
from omegadot.gates.steps.accuracy import PER_STEP
from omegadot.reference_impl.cross_product import cross
from omegadot.reference_impl.motion import forward_dynamics
from omegadot.reference_impl.rotations import attitude_angle, quaternion_product, rotate
from omegadot.reference_impl.system import Array, Body, Load, State, System

pytest.importorskip("pydrake")

Rate = Callable[[Array], Array]
STEP, STEPS = 0.01, 20
# A step of a dozen operations, of rates that a step may double: the runs last 0.2 s.
SAME = 64 * EPS * STEPS
# Butcher's tableaux: rows of a, and b. Hairer, Norsett, Wanner, Solving Ordinary Differential
# Equations I (1993), II.1 and table II.5.2; Bogacki and Shampine, Appl. Math. Lett. 2 (1989) 321.
TABLEAUX: dict[str, tuple[list[list[float]], list[float]]] = {
    "explicit_euler": ([[]], [1]),
    "runge_kutta2": ([[], [1]], [1 / 2, 1 / 2]),
    "runge_kutta3-fixed": ([[], [1 / 2], [-1, 2]], [1 / 6, 2 / 3, 1 / 6]),
    "bogacki_shampine3-fixed": ([[], [1 / 2], [0, 3 / 4]], [2 / 9, 1 / 3, 4 / 9]),
    "runge_kutta5-fixed": (
        [
            *([], [1 / 5], [3 / 40, 9 / 40], [44 / 45, -56 / 15, 32 / 9]),
            [19372 / 6561, -25360 / 2187, 64448 / 6561, -212 / 729],
            [9017 / 3168, -355 / 33, 46732 / 5247, 49 / 176, -5103 / 18656],
        ],
        [35 / 384, 0, 500 / 1113, 125 / 192, -2187 / 6784, 11 / 84],
    ),
}
free_and_pivoted = pytest.mark.parametrize("load", ["none", "all", "pivot_all"])


def drake(of: System, setup: Any = "physics") -> DrakeAdapter:
    adapter = DrakeAdapter(setup)
    adapter.load(of)
    return adapter


def a_start() -> State:
    return at(states(1, seed=3, far=1.0, fast=2.0), 0)


def rate_of(of: System, adapter: DrakeAdapter) -> Rate:
    """``y'``: the coordinates' rates by their own equations, and accelerations by (8)."""
    joint = adapter._loaded()

    def of_free(y: Array) -> Array:
        state = joint.states(y[None])[0]
        q, w, c = state.orientation, state.angular_velocity, of.body.center_of_mass
        found = forward_dynamics(of, state)
        turning = 0.5 * quaternion_product(np.array([0.0, *y[7:10]]), y[:4])
        lift = rotate(q, cross(found.angular, c) + cross(w, cross(w, c)))
        return np.concatenate((turning, y[10:], rotate(q, found.angular), found.linear - lift))

    def of_angles(y: Array) -> Array:
        state = joint.states(y[None])[0]
        (_, pitch, yaw), (wx, wy, wz) = y[:3], y[3:]
        along, across = np.cos(yaw) * wx + np.sin(yaw) * wy, np.cos(yaw) * wy - np.sin(yaw) * wx
        turning = [along / np.cos(pitch), across, wz + np.tan(pitch) * along]
        spin = rotate(state.orientation, forward_dynamics(of, state).angular)
        return np.concatenate((turning, spin))

    return of_free if of.load.pivot is None else of_angles


def explicit(name: str, rate: Rate, y: Array) -> Array:
    rows, weights = TABLEAUX[name]
    slopes: list[Array] = []
    for row in rows:
        slopes.append(
            rate(y + STEP * sum((a * k for a, k in zip(row, slopes, strict=True)), 0 * y))
        )
    return y + STEP * sum((b * k for b, k in zip(weights, slopes, strict=True)), 0 * y)


def semi_explicit(rate: Rate, y: Array) -> Array:
    """``v1 = v + h v'(q, v)``, ``q1 = q + h N(q) v1``."""
    places = 7 if len(y) == 13 else 3
    faster = np.concatenate((y[:places], y[places:] + STEP * rate(y)[places:]))
    return np.concatenate((y[:places] + STEP * rate(faster)[:places], faster[places:]))


def apart(one: State, other: State) -> float:
    """The largest distance between two states, of parts of the size of one."""
    pairs = [(one.position, other.position), (one.linear_velocity, other.linear_velocity)]
    pairs.append((one.angular_velocity, other.angular_velocity))
    sizes = [float(norm(a - b) / max(1.0, float(norm(b)))) for a, b in pairs]
    return max(float(attitude_angle(one.orientation, other.orientation)), *sizes)


@free_and_pivoted
@pytest.mark.parametrize("name", [*TABLEAUX, "semi_explicit_euler", "discrete-tamsi"])
def test_explicit_integrators_step_the_schemes_that_they_are_named_for(
    name: str, load: str
) -> None:
    of, start = system("full", load), a_start()
    adapter = drake(of)
    rate, y = rate_of(of, adapter), adapter._loaded().coordinates(start)
    for _ in range(STEPS):
        y = explicit(name, rate, y) if name in TABLEAUX else semi_explicit(rate, y)
    found = adapter.run(start, name, STEP, STEPS, STEPS).state[-1]
    assert apart(found, adapter._loaded().states(y[None])[0]) <= SAME


def test_the_default_approximation_alone_takes_damping_implicitly() -> None:
    """``(M + h D) v1 = M v + h F``: a sphere's omega is divided by ``1 + h d / I`` at each step."""
    body = Body(np.array(1.0), np.zeros(3), 0.5 * np.eye(3))
    of = System((body,), Load(damping=np.array(0.3)))
    start = State(np.array([1.0, 0, 0, 0]), np.array([1.0, 2.0, 3.0]), np.zeros(3), np.zeros(3))
    factors = {"discrete": 1 / (1 + STEP * 0.6), "discrete-tamsi": 1 - STEP * 0.6}
    for name, factor in factors.items():
        found = drake(of).run(start, name, STEP, 1, 1).state[-1]
        assert norm(found.angular_velocity - factor * start.angular_velocity) <= 16 * EPS * 4


@free_and_pivoted
@pytest.mark.parametrize("name", ["implicit_euler", "velocity_implicit_euler"])
def test_implicit_euler_goes_on_from_two_half_steps(name: str, load: str) -> None:
    """As Radau IIA with one stage, which is implicit Euler, does in twice as many steps."""
    adapter, start = drake(system("full", load)), a_start()
    found = adapter.run(start, name + FIXED, STEP, 10, 10).state[-1]
    halved = adapter.run(start, "radau1" + FIXED, STEP / 2, 20, 20).state[-1]
    whole = adapter.run(start, "radau1" + FIXED, STEP, 10, 10).state[-1]
    # an iteration ends where its last change, in parts of the coordinates, is about the accuracy
    assert apart(found, halved) <= 20 * PLANS[name + FIXED].solves
    assert apart(found, whole) > 1e-3


def test_a_pitch_of_a_right_angle_is_refused_with_the_reason() -> None:
    """Steps of 9 degrees of pitch alone: the last one is as long as the singularity is away."""
    of = System(
        (Body(np.array(1.0), np.zeros(3), np.diag([1.0, 2.0, 3.0])),), Load(pivot=np.zeros(3))
    )
    turning = np.array([0.0, np.pi / 2, 0.0])
    start = State(np.array([1.0, 0, 0, 0]), turning, np.zeros(3), np.zeros(3))
    adapter = drake(of)
    assert np.all(np.isfinite(adapter.run(start, "discrete", 0.1, 8, 8).state.orientation))
    for name in ("discrete", "runge_kutta3-fixed", "runge_kutta5"):
        with pytest.raises(UnsupportedError, match="roll, pitch and yaw"):
            adapter.run(start, name, 0.1, 12, 12, 1e-3)


def test_a_run_that_overflows_ends_in_nan_and_not_in_the_end_of_the_process() -> None:
    fast = State(np.array([1.0, 0, 0, 0]), np.full(3, 1e200), np.zeros(3), np.zeros(3))
    adapter = drake(system("full"))
    for name in PLANS:
        accuracy = None if PLANS[name].fixed else 1e-3
        found = adapter.run(fast, name, 1.0, 2, 1, accuracy).state
        assert not np.all(np.isfinite(found.angular_velocity[-1])), name


def symmetric_top(name: str, accuracy: float) -> tuple[Array, int]:
    """Where an error-controlled run of 0.25 s ends, and the steps that it took."""
    of = System((Body(np.array(1.0), np.zeros(3), np.diag([1.0, 1.0, 2.0])),), Load())
    spin = np.array([1.0, 0.0, 3.0])
    adapter = drake(of)
    first = State(np.array([1.0, 0, 0, 0]), spin, np.zeros(3), np.zeros(3))
    start = adapter._loaded().coordinates(first)
    stepper = DrakeStepper(adapter._engine, adapter._model(Stepping()), start)
    own = stepper.integrate(name, 0.25)
    own.set_target_accuracy(accuracy)
    rows, _ = stepper.run(np.array([0.25]))
    return rows[-1], own.get_num_steps_taken()


@pytest.mark.parametrize("name", ["implicit_euler", "velocity_implicit_euler", "radau1"])
def test_errors_and_steps_of_order_one_follow_the_root_of_the_accuracy(name: str) -> None:
    """So a finest accuracy is one of cost: a hundredth of it takes ten times the steps.

    A tenth and ten hold as the step vanishes; from 1e-5 on they hold within a factor of 1.5.
    """
    exact, _ = symmetric_top("runge_kutta5", 1e-13)
    runs = [symmetric_top(name, accuracy) for accuracy in (1e-5, 1e-7)]
    errors = [np.max(np.abs(end - exact)) for end, _ in runs]
    assert 10 / 1.5 <= errors[0] / errors[1] <= 15
    assert 10 / 1.5 <= runs[1][1] / runs[0][1] <= 15


def test_radau3_keeps_its_accuracy_and_follows_no_power_of_it() -> None:
    """Its steps follow ``t^(1/3)``. An estimate that keeps t leaves ``2 sqrt(13) t`` a step."""
    exact, _ = symmetric_top("runge_kutta5", 1e-13)
    accuracies = (1e-5, 1e-7, 1e-9)
    runs = [symmetric_top("radau3", accuracy) for accuracy in accuracies]
    errors = [float(np.max(np.abs(end - exact))) for end, _ in runs]
    steps = [taken for _, taken in runs]
    for accuracy, error, taken in zip(accuracies, errors, steps, strict=True):
        assert error <= PER_STEP * accuracy * taken
    for coarse, fine in pairwise(steps):
        assert 100 ** (1 / 3) / 1.5 <= fine / coarse <= 100 ** (1 / 3) * 1.5
    assert errors[0] / errors[1] < 100**0.5  # so that no finer accuracy shows an order


def test_it_describes_itself() -> None:
    own = DrakeAdapter().description
    assert {i.knob for i in own.integrators} == {"timestep", "accuracy", "fixed-accuracy"}
    assert all(i.note for i in own.integrators)
    assert own.switched_off
    assert not DrakeAdapter("as-shipped").description.switched_off
    native = DrakeAdapter().native()
    assert native["conventions"]["BallRpyJoint velocity frame"] == "world axes"
    assert native["defaults"]["Simulator accuracy"] == "0.0001"


@pytest.mark.parametrize("via", ["urdf", "mjcf"])
@pytest.mark.parametrize("load", ["all", "pivot_all"])
def test_a_body_that_it_read_moves_as_one_of_its_api(via: str, load: str) -> None:
    of, start, read = system("full", load), a_start(), build_adapter(OURS["drake"], "physics", via)
    read.load(of)
    for name in ("discrete", "runge_kutta3-fixed"):
        one = read.run(start, name, STEP, STEPS, STEPS).state[-1]
        assert apart(one, drake(of).run(start, name, STEP, STEPS, STEPS).state[-1]) <= 10 * SAME
