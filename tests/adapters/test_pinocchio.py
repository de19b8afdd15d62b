"""The reference's schemes over Pinocchio's ABA, and the shapes that they request."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pinocchio
import pytest
from mujoco_cases import EPS, at, norm, states, system

from omegadot.adapters.looped import LOOPED
from omegadot.adapters.pinocchio.adapter import PREFIX, PinocchioAdapter
from omegadot.adapters.pinocchio.joint import PinocchioJoint
from omegadot.adapters.pinocchio.model import build_model
from omegadot.reference_impl.coordinates import to_coordinates
from omegadot.reference_impl.momentum import angular_momentum
from omegadot.reference_impl.motion import forward_dynamics
from omegadot.reference_impl.one_body.body_motion import body_motion
from omegadot.reference_impl.schemes import SCHEMES, Motion
from omegadot.reference_impl.system import Body, State, System

T_HANDLE = System((Body(np.array(1.0), np.zeros(3), np.diag([1.0, 2.0, 3.0])),))


def aba(of: System) -> PinocchioAdapter:
    adapter = PinocchioAdapter()
    adapter.load(of)
    return adapter


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
