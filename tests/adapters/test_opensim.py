"""What OpenSim's integrators step, in its own coordinates, and what two charts of angles are for.

y = (q, u): q is three angles, the place of a free body and an unused number, u is omega and the
velocity of the body's origin, in the axes of the joint's frame. The rates are written out here.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from mujoco_cases import EPS, at, norm, states, system

from omegadot.adapters.opensim.adapter import OpenSimAdapter
from omegadot.adapters.opensim.charts import MOST, TURNED, WORLD, Chart
from omegadot.adapters.opensim.integrators import PLANS, SOLVES
from omegadot.adapters.opensim.joint import coordinates
from omegadot.adapters.opensim.joint import states as states_of
from omegadot.reference_impl.cross_product import cross
from omegadot.reference_impl.motion import forward_dynamics
from omegadot.reference_impl.rotations import (
    attitude_angle,
    exp_quaternion,
    quaternion_product,
    rotate,
)
from omegadot.reference_impl.system import Array, Body, Load, State, System

pytest.importorskip("opensim")

Rate = Callable[[Array], Array]
STEP, STEPS = 0.01, 20
# A step of a dozen operations, of rates that a step may double: the runs last 0.2 s.
SAME = 64 * EPS * STEPS
# Butcher's tableaux: rows of a, and b. Hairer, Norsett, Wanner, Solving Ordinary Differential
# Equations I (1993), II.1 and tables II.4.1 and II.5.1.
TABLEAUX: dict[str, tuple[list[list[float]], list[float]]] = {
    "ExplicitEuler": ([[]], [1]),
    "RungeKutta2": ([[], [1]], [1 / 2, 1 / 2]),
    "RungeKutta3": ([[], [1 / 2], [-1, 2]], [1 / 6, 2 / 3, 1 / 6]),
    "RungeKuttaMerson": (
        [[], [1 / 3], [1 / 6, 1 / 6], [1 / 8, 0, 3 / 8], [1 / 2, 0, -3 / 2, 2]],
        [1 / 6, 0, 0, 2 / 3, 1 / 6],
    ),
    "RungeKuttaFeldberg": (
        [
            *([], [1 / 4], [3 / 32, 9 / 32], [1932 / 2197, -7200 / 2197, 7296 / 2197]),
            [439 / 216, -8, 3680 / 513, -845 / 4104],
        ],
        [25 / 216, 0, 1408 / 2565, 2197 / 4104, -1 / 5],
    ),
}
free_and_pivoted = pytest.mark.parametrize("load", ["none", "all", "pivot_all"])


def opensim(of: System, setup: Any = "physics") -> OpenSimAdapter:
    adapter = OpenSimAdapter(setup)
    adapter.load(of)
    return adapter


def turning(angles: Array, w: Array) -> Array:
    """The rates of a, b, c in ``R = Rx(a) Ry(b) Rz(c)``, of omega in the frame's axes.

    ``omega = a' x + b' Rx y + c' Rx Ry z``. Complex angles are for derivatives of the rates.
    """
    a, b = angles[:2]
    last = (np.cos(a) * w[2] - np.sin(a) * w[1]) / np.cos(b)
    middle = np.cos(a) * w[1] + np.sin(a) * w[2]
    return np.array([w[0] - np.sin(b) * last, middle, last])


def rate_of(of: System, chart: Chart) -> Rate:
    """``y'``: the angles' rates by their own equation, and accelerations by (8)."""
    free, c = of.load.pivot is None, of.body.center_of_mass

    def rate(y: Array) -> Array:
        state = states_of(of, chart, y[None])[0]
        q, w = state.orientation, state.angular_velocity
        found = forward_dynamics(of, state)
        spin = chart.in_frame(rotate(q, found.angular))
        if not free:
            return np.concatenate((turning(y[:3], y[4:]), [0.0], spin))
        lift = rotate(q, cross(found.angular, c) + cross(w, cross(w, c)))
        moving = chart.in_frame(found.linear - lift)
        return np.concatenate((turning(y[:3], y[7:10]), y[10:], [0.0], spin, moving))

    return rate


def explicit(name: str, rate: Rate, y: Array, h: float) -> Array:
    rows, weights = TABLEAUX[name]
    slopes: list[Array] = []
    for row in rows:
        slopes.append(rate(y + h * sum((a * k for a, k in zip(row, slopes, strict=True)), 0 * y)))
    return y + h * sum((b * k for b, k in zip(weights, slopes, strict=True)), 0 * y)


def halves(rate: Rate, y: Array, h: float) -> Array:
    """``u1 = u + h u'(q, u)``, ``q1 = q + h N(q) u1``, twice with half the step."""
    places = 7 if len(y) == 13 else 4
    for _ in range(2):
        y = np.concatenate((y[:places], y[places:] + 0.5 * h * rate(y)[places:]))
        y = np.concatenate((y[:places] + 0.5 * h * rate(y)[:places], y[places:]))
    return y


def verlet(rate: Rate, y: Array, h: float) -> Array:
    """``q1 = q + h q' + h^2/2 q''``, ``u1 = u + h/2 (u'(q, u) + u'(q1, u1))``."""
    places = 7 if len(y) == 13 else 4
    first, q, u = rate(y), y[:places], y[places:]
    twice = np.zeros(places)
    along, tiny = np.concatenate((first[:3], first[places : places + 3])), 1e-100
    spun = turning(q[:3] + 1j * tiny * along[:3], u[:3] + 1j * tiny * along[3:])
    twice[:3] = spun.imag / tiny
    twice[3 : places - 1] = first[places + 3 :]
    q1, u1 = q + h * first[:places] + 0.5 * h * h * twice, u + h * first[places:]
    for _ in range(20):
        u1 = u + 0.5 * h * (first[places:] + rate(np.concatenate((q1, u1)))[places:])
    return np.concatenate((q1, u1))


def apart(one: State, other: State) -> float:
    """The largest distance between two states, of parts of the size of one."""
    pairs = [(one.position, other.position), (one.linear_velocity, other.linear_velocity)]
    pairs.append((one.angular_velocity, other.angular_velocity))
    sizes = [float(norm(a - b) / max(1.0, float(norm(b)))) for a, b in pairs]
    return max(float(attitude_angle(one.orientation, other.orientation)), *sizes)


def near_the_other_chart() -> State:
    """A start in the world's frame from where a run of 0.2 s needs the turned one."""
    start = at(states(1, seed=3, far=1.0, fast=2.0), 0)
    tilted = exp_quaternion(np.array([0.0, np.arcsin(MOST) - 0.05, 0.0]))
    return State(tilted, np.array([0.5, 2.0, 1.0]), start.position, start.linear_velocity)


@free_and_pivoted
@pytest.mark.parametrize("name", [*TABLEAUX, "SemiExplicitEuler2", "Verlet"])
def test_fixed_steps_are_those_of_the_method_on_the_angles(name: str, load: str) -> None:
    of, start = system("full", load), near_the_other_chart()
    chart, used = WORLD, {WORLD}
    y = coordinates(of, chart, start)
    for _ in range(STEPS):
        rate = rate_of(of, chart)
        if name in TABLEAUX:
            y = explicit(name, rate, y, STEP)
        else:
            y = {"Verlet": verlet, "SemiExplicitEuler2": halves}[name](rate, y, STEP)
        if not chart.is_apt(y[0], y[1]):
            there = states_of(of, chart, y[None])[0]
            chart = TURNED if chart is WORLD else WORLD
            used.add(chart)
            y = coordinates(of, chart, there)
    found = opensim(of).run(start, f"{name}-fixed", STEP, STEPS, STEPS).state[-1]
    # rounds of Verlet end where their last change, in parts of u, is about the accuracy
    assert apart(found, states_of(of, chart, y[None])[0]) <= SAME + (
        STEPS * SOLVES if name == "Verlet" else 0.0
    )
    assert used == {WORLD, TURNED}


def test_every_fixed_integrator_is_written_out_here() -> None:
    fixed = {name.removesuffix("-fixed") for name, plan in PLANS.items() if plan.fixed}
    assert fixed == {*TABLEAUX, "SemiExplicitEuler2", "Verlet"}


@pytest.mark.parametrize("chart", [WORLD, TURNED])
def test_angles_and_quaternions_are_inverse_even_at_the_singularity(chart: Chart) -> None:
    away = np.array([0.0, 1e-300, 1e-20, 1e-16, 1e-12, 1e-8, 1e-4, 0.1, 1.0])
    rng = np.random.default_rng(0)
    for sign in (1, -1):
        for middle in sign * (0.5 * np.pi - away):
            angles = np.array([rng.uniform(-3, 3), middle, rng.uniform(-3, 3)])
            q = chart.quaternions_of(angles[None])[0]
            again = chart.quaternions_of(chart.angles_of(q)[None])[0]
            assert attitude_angle(q, again) <= 32 * EPS


def test_of_two_charts_the_attitude_alone_decides_and_one_is_far_from_singular() -> None:
    """The other's is so where z is along its own frame's x-axis: never at the same attitude."""
    for q in states(2000, seed=5).orientation:
        apt = [c for c in (WORLD, TURNED) if c.is_apt(*c.angles_of(q)[:2])]
        assert len(apt) == 1
        assert abs(np.sin(apt[0].angles_of(q)[1])) <= max(MOST, (1 - MOST**2) ** 0.5) + 8 * EPS


def worst_of_a_tumble(setup: Any, steps: int) -> float:
    """The largest error in attitude, in rad, of a sphere whose z-axis misses the x-axis by 1 mrad.

    It turns about its y-axis by 1 rad/s, for 2 s.
    """
    of = System((Body(np.array(1.0), np.zeros(3), 0.4 * np.eye(3)),), Load())
    begun, spin = exp_quaternion(np.array([0.0, 0.0, 1e-3])), np.array([0.0, 1.0, 0.0])
    start = State(begun, spin, np.zeros(3), np.zeros(3))
    found = opensim(of, setup).run(start, "RungeKuttaMerson-fixed", 2.0 / steps, steps, 1)
    exact = quaternion_product(begun, exp_quaternion(np.outer(found.time, spin)))
    return float(np.max(attitude_angle(found.state.orientation, exact)))


def test_one_chart_alone_has_no_order_near_its_singularity_and_two_have() -> None:
    """Steps of 10 and 5 mrad are longer than the singularity is away."""
    one = [worst_of_a_tumble("as-shipped", steps) for steps in (200, 400)]
    two = [worst_of_a_tumble("physics", steps) for steps in (20, 40)]
    assert min(one) > 1e-3
    assert two[0] <= 0.1**4
    assert two[1] <= two[0] / 2**3.5


def test_a_run_that_overflows_ends_in_nan() -> None:
    fast = State(np.array([1.0, 0, 0, 0]), np.full(3, 1e200), np.zeros(3), np.zeros(3))
    adapter = opensim(system("full"))
    for name, plan in PLANS.items():
        found = adapter.run(fast, name, 1.0, 2, 1, None if plan.fixed else 1e-3).state
        assert not np.all(np.isfinite(found.angular_velocity[-1])), name


def test_it_describes_itself() -> None:
    own = OpenSimAdapter().description
    assert {i.knob for i in own.integrators} == {"timestep", "accuracy", "fixed-accuracy"}
    assert all(i.note for i in own.integrators)
    assert own.switched_off
    assert not OpenSimAdapter("as-shipped").description.switched_off
    native = OpenSimAdapter().native()
    assert native["conventions"] == {
        "FreeJoint speeds": "angular, linear",
        "FreeJoint angular velocity frame": "world axes",
        "FreeJoint linear velocity frame": "world axes",
        "BallJoint velocity frame": "world axes",
        "angles": "R = Rx Ry Rz",
    }
    assert native["defaults"]["Manager integrator"] == "RungeKuttaMerson"
    assert native["defaults"]["gravity"] == "(0, -9.80665, 0)"


def on_a_ball_joint(opensim: Any, damping: str) -> tuple[Any, Any, Any]:
    """A sphere of inertia 1 on a joint that is damped by 0.3 N m s: model, state and joint.

    The state is the model's, and is gone with it.
    """
    model, none = opensim.Model(), opensim.Vec3(0.0)
    model.setGravity(none)
    body = opensim.Body("body", 1.0, none, opensim.Inertia(1.0, 1.0, 1.0))
    model.addBody(body)
    joint = opensim.BallJoint("joint", model.getGround(), body)
    model.addJoint(joint)
    if damping == "bushing":
        bushing = opensim.BushingForce("bushing", model.getGround(), body)
        bushing.set_rotational_damping(opensim.Vec3(0.3))
        model.addForce(bushing)
    for n in range(3 if damping == "springs" else 0):
        spring = opensim.SpringGeneralizedForce(joint.get_coordinates(n).getName())
        spring.setName(f"spring_{n}")
        spring.setStiffness(0.0)
        spring.setRestLength(0.0)
        spring.setViscosity(0.3)
        model.addForce(spring)
    state = model.initSystem()
    y = np.zeros(state.getNY())
    y[:7] = 0.4, 1.0, 0.3, 0.0, 1.0, 2.0, 3.0
    state.setY(opensim.Vector.createFromMat(y))
    model.realizeAcceleration(state)
    return model, state, joint


def test_a_coordinates_speed_is_omega_and_a_bushing_damps_the_rates_of_angles() -> None:
    """Caught: damping by a bushing, which speeds up a turn about an axis at some attitudes."""
    engine, omega = OpenSimAdapter()._engine, np.array([1.0, 2.0, 3.0])
    sprung, state, joint = on_a_ball_joint(engine, "springs")
    speeds = [joint.get_coordinates(n).getSpeedValue(state) for n in range(3)]
    assert np.array_equal(speeds, omega)
    rates = state.getQDot().to_numpy()[:3]
    assert norm(rates - turning(np.array([0.4, 1.0, 0.3]), omega)) <= 64 * EPS * norm(rates)
    assert norm(rates - omega) > 1.0
    assert norm(state.getUDot().to_numpy() + 0.3 * omega) <= 64 * EPS
    held, damped, _ = on_a_ball_joint(engine, "bushing")
    assert damped.getUDot().to_numpy()[0] > 0.6
    del sprung, held
