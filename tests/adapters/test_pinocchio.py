"""The reference's schemes over Pinocchio's ABA, and the shapes that they request."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pinocchio
import pytest
from mujoco_cases import EPS, at, norm, states, system

from omegadot.adapters.pinocchio.adapter import LOOPED, PREFIX, PinocchioAdapter
from omegadot.adapters.pinocchio.joint import PinocchioJoint
from omegadot.adapters.pinocchio.model import build_model
from omegadot.adapters.protocol import UnsupportedError
from omegadot.reference_impl.coordinates import to_coordinates
from omegadot.reference_impl.inertia import moving_inertia
from omegadot.reference_impl.kinematics import place_on_pivot
from omegadot.reference_impl.momentum import angular_momentum
from omegadot.reference_impl.motion import forward_dynamics
from omegadot.reference_impl.one_body.body_motion import body_motion
from omegadot.reference_impl.rotations import attitude_angle, rotate_inverse
from omegadot.reference_impl.schemes import SCHEMES, Motion
from omegadot.reference_impl.stepping import step_body
from omegadot.reference_impl.system import Body, State, System

T_HANDLE = System((Body(np.array(1.0), np.zeros(3), np.diag([1.0, 2.0, 3.0])),))


def aba(of: System) -> PinocchioAdapter:
    adapter = PinocchioAdapter()
    adapter.load(of)
    return adapter


def growth(of: System, start: State, time: float) -> float:
    """How far a change may grow: ω̇ is quadratic in ω, ``|∂ω̇/∂ω| <= 2 cond(I) |ω|``."""
    moments = np.linalg.eigvalsh(moving_inertia(of))
    rate = 2 * moments[-1] / moments[0] * float(norm(start.angular_velocity))
    return float(np.exp(rate * time)) * (1 + time)


def test_every_scheme_is_an_integrator_named_for_what_it_is() -> None:
    reported = PinocchioAdapter().description
    assert {i.name: i.scheme for i in reported.integrators} == {
        PREFIX + name: name for name in LOOPED
    }
    assert all(i.orders == SCHEMES[str(i.scheme)].orders for i in reported.integrators)
    assert reported.version == pinocchio.__version__
    assert reported.switched_off == ()


@pytest.mark.parametrize("scheme", LOOPED)
@pytest.mark.parametrize("load", ["none", "all", "pivot_all"])
def test_loops_over_aba_are_the_references_loops(scheme: str, load: str) -> None:
    of = system("full", load)
    start = place_on_pivot(of, at(states(1, seed=21, far=1.0, fast=2.0), 0))
    found = aba(of).run(start, PREFIX + scheme, 0.005, 40, 5).state
    _, expected = step_body(SCHEMES[scheme], of, start, 0.005, 40, 5, "body-spatial")
    # a step evaluates at most some twenty accelerations, and each errs by a few roundings
    allowed = 64 * EPS * 40 * 20 * growth(of, start, 0.2)
    assert np.max(attitude_angle(found.orientation, expected.orientation)) <= allowed
    for one, other in (
        (found.angular_velocity, expected.angular_velocity),
        (found.position, expected.position),
        (found.linear_velocity, expected.linear_velocity),
    ):
        assert np.max(norm(one - other)) <= allowed * np.max(norm(other))


@pytest.mark.parametrize("scheme", LOOPED)
def test_the_very_same_scheme_steps_the_reference_a_pendulum_and_pinocchio(scheme: str) -> None:
    """Pinocchio's coordinates are the reference's but for the order of the quaternion."""
    of, stepped = system("full", "all"), SCHEMES[scheme]
    start = at(states(1, seed=28, far=1.0, fast=2.0), 0)
    joint = PinocchioJoint(pinocchio, of, build_model(pinocchio, of))
    q, v = to_coordinates(of, start, "body-spatial")
    own = stepped.step(body_motion(of, "body-spatial"), q, v, 0.005)
    found = stepped.step(joint.motion, *joint.coordinates(start), 0.005)
    order = [0, 1, 2, 6, 3, 4, 5]
    assert np.max(np.abs(found[0][order] - own[0])) <= 64 * EPS * np.max(np.abs(own[0]))
    assert np.max(np.abs(found[1] - own[1])) <= 20 * 64 * EPS * np.max(np.abs(own[1]))
    angle, speed = stepped.step(Motion(lambda q, v: -np.sin(q)), np.ones(1), np.zeros(1), 0.005)
    fall = -0.005 * np.sin(1.0)
    assert speed == pytest.approx(fall, rel=0.005)
    assert angle - 1.0 == pytest.approx(0.005 * fall, rel=0.6)


@pytest.mark.parametrize("load", ["all", "pivot_all"])
def test_states_are_answered_one_by_one(load: str) -> None:
    of = system("full", load)
    many = place_on_pivot(of, states(6, seed=22, fast=2.0))
    adapter = aba(of)
    flat = adapter.forward_dynamics(many)
    single = adapter.forward_dynamics(State(*(values[4:5] for values in vars(many).values())))
    assert np.array_equal(single.angular[0], flat.angular[4])
    assert np.array_equal(single.linear[0], flat.linear[4])


def test_an_answer_is_not_overwritten_by_the_next() -> None:
    adapter, many = aba(system("full", "all")), states(2, seed=23, fast=2.0)
    one, other = (State(*(v[n : n + 1] for v in vars(many).values())) for n in range(2))
    first = adapter.forward_dynamics(one)
    kept = replace(first, angular=first.angular.copy(), linear=first.linear.copy())
    adapter.forward_dynamics(other)
    assert np.array_equal(first.angular, kept.angular)
    assert np.array_equal(first.linear, kept.linear)


def test_the_force_of_rnea_is_newtons() -> None:
    """``F = m (a - g)``: the spatial acceleration that RNEA is given is the one requested."""
    of = system("full", "all")
    many, joint = (
        states(10, seed=26, fast=2.0),
        PinocchioJoint(pinocchio, of, build_model(pinocchio, of)),
    )
    wanted = np.random.default_rng(27).normal(size=(10, 2, 3))
    for n in range(10):
        force = joint.wrench(at(many, n), *wanted[n])[:3]
        expected = of.body.mass * (wanted[n, 1] - of.load.gravity)
        expected = rotate_inverse(at(many, n).orientation, expected)
        assert norm(force - expected) <= 1e-13 * (norm(expected) + 50)


def test_rounding_does_not_grow_with_the_distance_from_the_origin() -> None:
    """ABA in the world's frame would lose (m d^2 / I) eps; at 1e5 m that is a part in a million."""
    of = system("full", "none")
    many = states(20, seed=24, far=1e5, fast=0.0)
    found, expected = aba(of).forward_dynamics(many).angular, forward_dynamics(of, many).angular
    assert np.max(norm(found - expected)) <= 1e-13 * np.max(norm(expected))


def test_only_its_own_names_are_integrators() -> None:
    start = at(states(1, seed=25), 0)
    with pytest.raises(UnsupportedError, match="semi-implicit-euler"):
        aba(system()).run(start, "semi-implicit-euler", 0.01, 2, 1)


def test_nothing_runs_before_a_system_is_loaded() -> None:
    with pytest.raises(RuntimeError, match="load"):
        PinocchioAdapter().get_state()


def test_the_flip_at_a_millisecond_drifts_as_first_order_does() -> None:
    """|H| grows by 2.3e-3 in 20 s: three equal first-order loops are one."""
    start = State(np.array([1.0, 0, 0, 0]), np.array([0.01, 2.0, 0.01]), np.zeros(3), np.zeros(3))
    adapter = aba(T_HANDLE)
    found = adapter.run(start, "aba+semi-implicit-euler", 0.001, 20_000, 500).state
    size = norm(angular_momentum(T_HANDLE, found))
    assert size[-1] / size[0] - 1 == pytest.approx(2.3e-3, abs=0.05e-3)
    expected = forward_dynamics(T_HANDLE, found).angular
    omega_dot = adapter.forward_dynamics(found).angular
    assert np.max(norm(omega_dot - expected)) <= 3e-15 * np.max(norm(expected))


def test_derivatives_do_not_lose_digits_far_from_the_origin() -> None:
    """Pinocchio adds ``m |x|^2`` to the inertia there; 1e6 m away eleven digits would be gone."""
    of, start = system("full"), at(states(1, seed=26), 0)
    far = replace(start, position=np.array([1e6, -2e6, 3e6]))
    name, step = PREFIX + "linearly-implicit-euler", (0.01, 1, 1)
    near, away = (aba(of).run(one, name, *step).state[-1] for one in (start, far))
    np.testing.assert_allclose(away.angular_velocity, near.angular_velocity, rtol=64 * EPS)
