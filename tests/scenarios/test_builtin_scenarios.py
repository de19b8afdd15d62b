"""Every built-in is what its title states: axes, spins, units and budgets."""

from __future__ import annotations

import math
from decimal import Decimal
from fractions import Fraction

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.integrate import solve_ivp

from omegadot.scenarios import Scenario, builtin_names, load_builtin
from omegadot.scenarios.solids import mass, mean_squares

NAMES = {
    *("t-handle", "symmetric-top", "symmetric-top-oblate", "free-bar"),
    *("heavy-top", "sleeping-top-stable", "sleeping-top-unstable"),
    *("principal-spin-minor", "principal-spin-middle", "principal-spin-major", "sphere"),
    *("damped-tumble", "driven-body", "driven-world", "offset-com", "full-tensor", "thin-bar"),
    *("nesc-checkcase-2", "gazebo-simple-box", "gazebo-complex-box", "van-zon-schofield"),
}
EPS = np.finfo(float).eps
Array = NDArray[np.float64]


def rotation(q: tuple[float, ...] | Array) -> Array:
    """world_R_body, from the quaternion's two products written out."""
    w, x, y, z = np.asarray(q) / np.linalg.norm(q)
    left = np.array([[w, -x, -y, -z], [x, w, -z, y], [y, z, w, -x], [z, -y, x, w]])
    right = np.array([[w, x, y, z], [-x, w, -z, y], [-y, z, w, -x], [-z, -y, x, w]])
    return (left @ right)[1:, 1:]


def mass_and_inertia(scenario: Scenario) -> tuple[float, Array]:
    """About the centre of mass, or about the pivot where there is one."""
    body = scenario.body
    if not body.part:
        assert body.mass is not None
        arm = np.array(body.center_of_mass) - np.array(scenario.load.pivot or body.center_of_mass)
        about_com = np.array(body.inertia)
        return body.mass, about_com + body.mass * (arm @ arm * np.eye(3) - np.outer(arm, arm))
    masses = np.array([mass(part) for part in body.part])
    center = masses @ np.array([part.position for part in body.part]) / masses.sum()
    inertia = np.zeros((3, 3))
    for part, m in zip(body.part, masses, strict=True):
        turn, d = rotation(part.orientation), np.array(part.position) - center
        second = turn @ np.diag(mean_squares(part)) @ turn.T + np.outer(d, d)
        inertia += m * (np.trace(second) * np.eye(3) - second)
    return float(masses.sum()), inertia


def trajectory(scenario: Scenario) -> tuple[Array, Array]:
    """Quaternions (n, 4) and angular velocities (n, 3) by a solver that is not the project's."""
    m, inertia = mass_and_inertia(scenario)
    load, arm = scenario.load, np.zeros(3)
    if load.pivot is not None:
        arm = np.array(scenario.body.center_of_mass) - np.array(load.pivot)

    def rate(_: float, y: Array) -> Array:
        q, omega = y[:4], y[4:]
        torque = np.cross(arm, m * rotation(q).T @ np.array(load.gravity)) - load.damping * omega
        omega_dot = np.linalg.solve(inertia, torque - np.cross(omega, inertia @ omega))
        q_dot = np.array([-q[1:] @ omega, *(q[0] * omega + np.cross(q[1:], omega))]) / 2
        return np.array([*q_dot, *omega_dot])

    start = [*scenario.initial.orientation, *scenario.initial.angular_velocity]
    times = np.linspace(0, scenario.run.duration, 401)
    solved = solve_ivp(rate, times[[0, -1]], start, "DOP853", times, rtol=1e-10, atol=1e-12)
    return solved.y[:4].T, solved.y[4:].T


def test_the_builtins_are_these() -> None:
    assert set(builtin_names()) == NAMES
    assert list(builtin_names()) == sorted(NAMES)


@pytest.mark.parametrize("name", sorted(NAMES))
def test_it_states_what_it_is_and_keeps_the_budget(name: str) -> None:
    scenario = load_builtin(name)
    assert scenario.name == name
    assert scenario.title != name
    assert scenario.shows is not None
    assert scenario.shows.endswith(".")
    assert scenario.source
    run = scenario.run
    h, half, quarter = (Fraction(str(step)) for step in run.timesteps)
    assert (half, quarter) == (h / 2, h / 4), "an order is read off a ratio of two"
    duration, sample = Fraction(str(run.duration)), Fraction(str(run.sample))
    assert (duration / sample).denominator == 1
    assert (sample / h).denominator == 1, "a sample stands at a step of every run"
    assert 100 <= duration / sample <= 200
    assert 400 <= duration / quarter <= 2000
    speed = float(np.linalg.norm(scenario.initial.angular_velocity))
    assert speed * run.timesteps[0] <= 0.2, "the coarsest step is inside the asymptotic range"


def test_t_handle_turns_over_three_times_about_its_intermediate_axis() -> None:
    scenario = load_builtin("t-handle")
    assert [part.shape for part in scenario.body.part] == ["cylinder", "cylinder"]
    _, inertia = mass_and_inertia(scenario)
    assert np.abs(inertia - np.diag(np.diag(inertia))).max() <= 4 * EPS * inertia.max()
    x, y, z = np.diag(inertia)
    assert x < z < y
    assert np.argmax(np.abs(scenario.initial.angular_velocity)) == 2
    _, omega = trajectory(scenario)
    flips = np.count_nonzero(np.diff(np.sign(omega[:, 2])))
    assert flips == 3


@pytest.mark.parametrize(("name", "sign"), [("symmetric-top", -1), ("symmetric-top-oblate", 1)])
def test_symmetric_tops_are_long_and_flat_and_precess_more_than_once(name: str, sign: int) -> None:
    scenario = load_builtin(name)
    x, y, z = np.diag(np.array(scenario.body.inertia))
    assert x == y
    assert np.sign(z - x) == sign
    rate = (z - x) / x * scenario.initial.angular_velocity[2]
    assert abs(rate) * scenario.run.duration > 2 * math.pi
    assert any(scenario.initial.angular_velocity[:2])


def test_free_bar_is_thrown_and_turns() -> None:
    scenario = load_builtin("free-bar")
    assert scenario.load.pivot is None
    assert scenario.load.gravity[2] < 0 < scenario.initial.linear_velocity[2]
    assert any(scenario.initial.angular_velocity)


@pytest.mark.parametrize(
    ("name", "side"), [("heavy-top", 1), ("sleeping-top-stable", 1), ("sleeping-top-unstable", -1)]
)
def test_tops_stand_on_their_side_of_the_critical_spin(name: str, side: int) -> None:
    scenario = load_builtin(name)
    m, about_pivot = mass_and_inertia(scenario)
    assert scenario.load.pivot is not None
    x, y, z = np.array(scenario.body.center_of_mass) - np.array(scenario.load.pivot)
    assert (x, y) == (0.0, 0.0)
    assert z > 0
    assert about_pivot[0, 0] == about_pivot[1, 1]
    g = -scenario.load.gravity[2]
    critical = math.sqrt(4 * m * g * z * about_pivot[0, 0]) / about_pivot[2, 2]
    ratio = scenario.initial.angular_velocity[2] / critical
    assert (ratio - 1) * side > 0
    if name != "heavy-top":
        assert abs(ratio - 1) <= 0.05, "just above or below: five per cent"


def test_the_slow_sleeping_top_falls_and_the_fast_one_does_not() -> None:
    for name, falls in (("sleeping-top-stable", False), ("sleeping-top-unstable", True)):
        orientations, _ = trajectory(load_builtin(name))
        tilt = np.array([math.acos(min(rotation(q)[2, 2], 1.0)) for q in orientations])
        assert tilt[0] == pytest.approx(0.01, rel=1e-9)
        # linear theory: the fast one wobbles by 1 / sqrt(1 - (critical / spin)^2) = 3.3 times its
        # start, the slow one grows by exp(0.84 t) until its tilt is of order one
        assert (tilt.max() > 0.3) == falls
        assert (tilt.max() < 0.034) != falls


@pytest.mark.parametrize(("name", "rank"), [("minor", 0), ("middle", 1), ("major", 2)])
def test_principal_spins_are_along_their_axis(name: str, rank: int) -> None:
    scenario = load_builtin(f"principal-spin-{name}")
    moments = np.diag(np.array(scenario.body.inertia))
    assert len(set(moments)) == 3
    (axis,) = np.flatnonzero(scenario.initial.angular_velocity)
    assert np.argsort(moments)[rank] == axis


def test_sphere_is_alike_about_all_axes() -> None:
    _, inertia = mass_and_inertia(load_builtin("sphere"))
    assert np.array_equal(inertia, inertia[0, 0] * np.eye(3))


def test_damped_tumble_goes_over_to_the_axis_of_greatest_inertia() -> None:
    scenario = load_builtin("damped-tumble")
    assert np.argmax(np.diag(np.array(scenario.body.inertia))) == 2
    _, omega = trajectory(scenario)
    share = np.abs(omega[:, 2]) / np.linalg.norm(omega, axis=1)
    assert share[0] < 0.5
    assert share[-1] > 0.95
    assert np.all(np.diff(np.linalg.norm(omega @ np.array(scenario.body.inertia), axis=1)) < 0)


@pytest.mark.parametrize("frame", ["body", "world"])
def test_driven_bodies_have_their_torque_in_their_axes(frame: str) -> None:
    (torque,) = load_builtin(f"driven-{frame}").load.torque
    assert torque.frame == frame
    assert all(torque.value)


def test_offset_com_lies_off_every_axis_in_gravity() -> None:
    scenario = load_builtin("offset-com")
    assert scenario.body.center_of_mass is not None
    assert all(scenario.body.center_of_mass)
    assert scenario.load.gravity[2] < 0


@pytest.mark.parametrize(
    ("name", "moments", "ratio"),
    [("full-tensor", (2, 3, 4), 2), ("thin-bar", (1e-6, 1, 1.0000005), 1e6)],
)
def test_turned_tensors_have_the_moments_of_their_source(
    name: str, moments: tuple[float, ...], ratio: float
) -> None:
    inertia = np.array(load_builtin(name).body.inertia)
    turn = rotation((1.0, 2.0, 2.0, 4.0))
    # nine rounded entries of size up to the largest moment, and two products of three terms
    bound = 16 * EPS * max(moments)
    assert np.abs(inertia - turn @ np.diag(moments) @ turn.T).max() <= bound
    small, middle, large = np.linalg.eigvalsh(inertia)
    assert small + middle >= large
    # the smallest moment is known to the bound only
    assert large / small == pytest.approx(ratio, rel=max(1e-6, 2 * bound / small))
    assert np.all(np.abs(inertia) > 0)


def test_nesc_brick_is_converted_exactly() -> None:
    """NASA/TM-2015-218675 gives slug ft^2, slug and deg/s; lbf and ft are exact in SI units."""
    scenario = load_builtin("nesc-checkcase-2")
    lbf, ft = Decimal("4.4482216152605"), Decimal("0.3048")
    moments = [Decimal(i) * lbf * ft for i in ("0.001894220", "0.006211019", "0.007194665")]
    assert np.diag(np.array(scenario.body.inertia)).tolist() == [float(i) for i in moments]
    assert scenario.body.mass == float(Decimal("0.155404754") * lbf / ft)
    pi = Decimal("3.14159265358979323846264338328")
    rates = tuple(float(rate * pi / 180) for rate in (10, 20, 30))
    assert scenario.initial.angular_velocity == rates
    assert scenario.run.duration == 30.0
    assert not any(scenario.load.gravity)


@pytest.mark.parametrize(
    ("name", "spin"), [("simple", (0.5, 0.0, 0.0)), ("complex", (0.1, 5.0, 0.1))]
)
def test_gazebo_boxes_are_those_of_the_benchmark(name: str, spin: tuple[float, ...]) -> None:
    scenario = load_builtin(f"gazebo-{name}-box")
    m, inertia = mass_and_inertia(scenario)
    assert m == 10.0
    x, y, z = 0.1, 0.4, 0.9
    moments = 10 / 12 * np.array([y * y + z * z, x * x + z * z, x * x + y * y])
    assert np.abs(np.diag(inertia) - moments).max() <= 8 * EPS * moments.max()
    assert scenario.initial.angular_velocity == spin
    assert scenario.initial.linear_velocity == (-2.0, 2.0, 8.0)
    assert scenario.load.gravity == (0.0, 0.0, -9.8)
    assert scenario.run.duration == 10.0


def test_van_zon_schofield_is_the_published_body() -> None:
    scenario = load_builtin("van-zon-schofield")
    assert np.array_equal(scenario.body.inertia, np.diag([10.0, 20.0, 26.0]))
    assert scenario.initial.angular_velocity == (1.0, 15.0, 1.0)
