"""DART's stepper against the reference's, and what its versions and defaults must not spoil."""

from __future__ import annotations

import dartpy
import numpy as np
import pytest
from mujoco_cases import EPS, OFFSET, at, norm, states, system

from omegadot.adapters.dart.adapter import DartAdapter
from omegadot.adapters.dart.model import SWITCHED_OFF
from omegadot.adapters.protocol import Trajectory
from omegadot.reference_impl.inertia import moving_inertia
from omegadot.reference_impl.kinematics import place_on_pivot
from omegadot.reference_impl.momentum import angular_momentum
from omegadot.reference_impl.motion import forward_dynamics
from omegadot.reference_impl.rotations import attitude_angle, rotate_inverse
from omegadot.reference_impl.schemes import SCHEMES
from omegadot.reference_impl.stepping import step_body
from omegadot.reference_impl.system import Acceleration, Array, Body, State, System

CENTRED = np.zeros(3)
SCHEME = SCHEMES["semi-implicit-euler-short-turns"]
T_HANDLE = System((Body(np.array(1.0), np.zeros(3), np.diag([1.0, 2.0, 3.0])),))
WHOLE = np.array([1.0, 0.0, 0.0, 0.0])


def dart(of: System, setup: str = "physics") -> DartAdapter:
    adapter = DartAdapter(setup=setup)  # type: ignore[arg-type]
    adapter.load(of)
    return adapter


def spinning(omega: list[float], of: System = T_HANDLE) -> State:
    return place_on_pivot(of, State(WHOLE, np.array(omega), np.zeros(3), np.zeros(3)))


def growth(of: System, start: State, time: float) -> float:
    """How far a change may grow: ω̇ is quadratic in ω, ``|∂ω̇/∂ω| <= 2 cond(I) |ω|``.

    |ω| itself may grow by cond(I) at constant energy; the attitude follows ω.
    """
    moments = np.linalg.eigvalsh(moving_inertia(of))
    rate = 2 * moments[-1] / moments[0] * float(norm(start.angular_velocity))
    return float(np.exp(rate * time)) * (1 + time)


def held(of: System, start: State, timestep: float, steps: int) -> tuple[Trajectory, State]:
    found = dart(of).run(start, "semi-implicit", timestep, steps, 5)
    _, expected = step_body(SCHEME, of, start, timestep, steps, 5)
    return found, expected


@pytest.mark.parametrize("load", ["none", "gravity", "damping", "torque_body", "torque_world"])
@pytest.mark.parametrize("inertia", ["diagonal", "full"])
def test_steps_of_a_free_body_are_semi_implicit_euler(load: str, inertia: str) -> None:
    of = system(inertia, load, CENTRED)
    start = at(states(1, seed=11, far=1.0, fast=2.0), 0)
    found, expected = held(of, start, 0.005, 40)
    allowed = 64 * EPS * 40 * growth(of, start, 0.2)
    assert np.max(attitude_angle(found.state.orientation, expected.orientation)) <= allowed
    for one, other in (
        (found.state.angular_velocity, expected.angular_velocity),
        (found.state.position, expected.position),
        (found.state.linear_velocity, expected.linear_velocity),
    ):
        assert np.max(norm(one - other)) <= allowed * np.max(norm(other))


@pytest.mark.parametrize("load", ["pivot", "pivot_gravity", "pivot_damping", "pivot_all"])
def test_steps_of_a_pivoted_body_are_semi_implicit_euler(load: str) -> None:
    of = system("full", load)
    start = place_on_pivot(of, at(states(1, seed=12), 0))
    found, expected = held(of, start, 0.005, 40)
    allowed = 64 * EPS * 40 * growth(of, start, 0.2)
    assert np.max(attitude_angle(found.state.orientation, expected.orientation)) <= allowed
    moved = norm(found.state.angular_velocity - expected.angular_velocity)
    assert np.max(moved) <= allowed * np.max(norm(expected.angular_velocity))
    assert np.max(norm(found.state.position - expected.position)) <= allowed


@pytest.mark.parametrize("load", ["none", "gravity", "all"])
def test_with_the_centre_of_mass_off_the_origin_the_origin_is_stepped(load: str) -> None:
    of = system("full", load, OFFSET)
    start = at(states(1, seed=13, far=1.0, fast=2.0), 0)
    found = dart(of).run(start, "semi-implicit", 0.005, 40, 5).state
    _, expected = step_body(SCHEME, of, start, 0.005, 40, 5, "origin-world")
    allowed = 64 * EPS * 40 * growth(of, start, 0.2)
    assert np.max(attitude_angle(found.orientation, expected.orientation)) <= allowed
    speed = np.max(norm(expected.linear_velocity)) + np.max(norm(expected.angular_velocity))
    assert np.max(norm(found.linear_velocity - expected.linear_velocity)) <= allowed * speed
    assert np.max(norm(found.position - expected.position)) <= allowed * speed


@pytest.mark.parametrize("load", ["none", "pivot"])
@pytest.mark.parametrize("angle", [9e-4, 1e-4])
def test_turns_below_a_thousandth_are_off_by_the_third_order_at_most(
    load: str, angle: float
) -> None:
    of = system("full", load, CENTRED)
    start = place_on_pivot(of, at(states(1, seed=14, far=1.0, fast=0.0), 0))
    timestep = angle / float(norm(start.angular_velocity))
    found = dart(of).run(start, "semi-implicit", timestep, 20, 1).state
    step = at(step_body(SCHEME, of, found, timestep, 1, 1)[1], -1)
    off = attitude_angle(step.orientation[:-1], found.orientation[1:])
    turned = norm(step.angular_velocity[:-1]) * timestep
    assert np.all(off <= turned**3 / 6 * (1 + turned) + 64 * EPS)
    assert np.max(norm(step.angular_velocity[:-1] - found.angular_velocity[1:])) <= 64 * EPS * 5


def test_a_slow_body_is_not_put_to_sleep() -> None:
    start = spinning([0.004, 0.003, 0.002])
    found = dart(T_HANDLE).run(start, "semi-implicit", 0.01, 300, 100).state
    energy = 0.5 * np.sum(found.angular_velocity**2 * [1.0, 2.0, 3.0], axis=-1)
    assert np.all(np.abs(energy / energy[0] - 1) <= 1e-3)
    angles = attitude_angle(WHOLE, found.orientation)
    assert np.allclose(angles, norm(start.angular_velocity) * np.array([0, 1, 2, 3]), rtol=0.01)


def test_what_spoils_physics_is_off_and_named() -> None:
    adapter = dart(T_HANDLE)
    assert adapter.description.switched_off == SWITCHED_OFF
    assert dart(T_HANDLE, "as-shipped").description.switched_off == ()
    world = adapter._loaded().model.world
    if hasattr(world, "getDeactivationOptions"):
        assert not world.getDeactivationOptions().mEnabled
        shipped = dart(T_HANDLE, "as-shipped")._loaded().model.world
        assert shipped.getDeactivationOptions().mEnabled
    assert not adapter._loaded().model.joint.areLimitsEnforced()
    assert adapter.description.version == dartpy.__version__


def test_as_shipped_answers_like_physics() -> None:
    of = system("full", "all")
    many = states(5, seed=15, fast=2.0)
    shipped, physics = dart(of, "as-shipped"), dart(of)
    one, other = shipped.forward_dynamics(many), physics.forward_dynamics(many)
    assert np.allclose(one.angular, other.angular, rtol=1e-12, atol=1e-12)


@pytest.mark.parametrize("load", ["none", "pivot"])
def test_a_state_too_large_to_square_is_not_finite(load: str) -> None:
    of = system(load=load)
    start = place_on_pivot(of, State(WHOLE, np.full(3, 1e200), np.zeros(3), np.zeros(3)))
    found = dart(of).run(start, "semi-implicit", 0.001, 6, 2).state
    assert np.all(np.isnan(found.angular_velocity))
    assert np.all(np.isnan(found.orientation))


def test_dynamics_of_a_state_that_is_not_finite_are_nan() -> None:
    of = system()
    many = states(2, seed=16)
    many.angular_velocity[0, 1] = np.nan
    found = dart(of).forward_dynamics(many)
    assert np.all(np.isnan(found.angular[0]))
    assert np.all(np.isfinite(found.angular[1]))
    torque = dart(of).inverse_dynamics(many, found)
    assert np.all(np.isnan(torque[0]))
    assert np.all(np.isfinite(torque[1]))


def test_the_force_of_inverse_dynamics_is_newtons() -> None:
    """``F = m (a - g)``: the joint acceleration set is, in all versions, the one requested."""
    of = system("full", "all")
    many, adapter = states(10, seed=17, fast=2.0), dart(of)
    wanted = np.random.default_rng(18).normal(size=(10, 2, 3))
    for n in range(10):
        adapter.set_state(at(many, n))
        force = adapter._loaded().wrench(at(many, n), Acceleration(*wanted[n]))[3:]
        expected = of.body.mass * (wanted[n, 1] - of.load.gravity)
        expected = rotate_inverse(at(many, n).orientation, expected)
        assert norm(force - expected) <= 1e-13 * (norm(expected) + 50)


def test_nothing_runs_before_a_system_is_loaded() -> None:
    with pytest.raises(RuntimeError, match="load"):
        DartAdapter().get_state()


def momentum_drift(found: State) -> float:
    size: Array = norm(angular_momentum(T_HANDLE, found))
    return float(size[-1] / size[0] - 1)


def test_the_flip_at_a_millisecond_drifts_as_first_order_does() -> None:
    """|H| grows by 2.3e-3 in 20 s: three equal first-order loops are not independent."""
    start = spinning([0.01, 2.0, 0.01])
    found = dart(T_HANDLE).run(start, "semi-implicit", 0.001, 20_000, 500).state
    assert momentum_drift(found) == pytest.approx(2.3e-3, abs=0.05e-3)
    omega_dot = dart(T_HANDLE).forward_dynamics(found).angular
    expected = forward_dynamics(T_HANDLE, found).angular
    largest = np.max(norm(expected))
    assert np.max(norm(omega_dot - expected)) <= 3e-15 * largest
