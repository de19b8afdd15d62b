"""What SAPIEN steps, and what of SAPIEN is not as a reader may expect."""

from __future__ import annotations

import subprocess
import sys
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from mujoco_cases import GRAVITY, INERTIAS, LOADS, at, norm, parts, states, system

from omegadot.adapters.protocol import Adapter, UnsupportedError
from omegadot.adapters.sapien import stepping
from omegadot.adapters.sapien.adapter import SapienAdapter
from omegadot.reference_impl.cross_product import cross
from omegadot.reference_impl.rotations import (
    attitude_angle,
    conjugate,
    exp_quaternion,
    quaternion_product,
    rotate,
)
from omegadot.reference_impl.schemes import SCHEMES
from omegadot.reference_impl.solutions.growth import growth_along
from omegadot.reference_impl.stepping import step_body
from omegadot.reference_impl.system import Acceleration, Body, Load, State, System

pytest.importorskip("sapien")

STEP, STEPS = 0.01, 20
SINGLE = float(np.finfo(np.float32).eps)
FEW = 64  # roundings in a row of about twenty operations on three components
NO_TURN = np.array([1.0, 0.0, 0.0, 0.0])
TURNED = State(NO_TURN, np.array([0.4, 2.0, -0.7]), np.zeros(3), np.zeros(3))
SPHERE = System((Body(np.array(1.0), np.zeros(3), np.eye(3)),), Load())


def sapien(of: System, setup: Any = "physics") -> SapienAdapter:
    adapter = SapienAdapter(setup)
    adapter.load(of)
    return adapter


def a_start(seed: int = 4) -> State:
    return at(states(1, seed=seed, far=1.0, fast=2.0), 0)


def ended(of: System, start: State, setup: Any = "physics", h: float = STEP, n: int = 1) -> State:
    found: State = sapien(of, setup).run(start, "step", h, n, n).state[-1]
    return found


def spun(*omega: float) -> State:
    return replace(TURNED, angular_velocity=np.array(omega))


@pytest.mark.parametrize("inertia", ["diagonal", "full", "flat_turned"])
@pytest.mark.parametrize("load", ["none", "gravity"])
def test_a_step_is_the_scheme_that_is_declared(inertia: str, load: str) -> None:
    """Over 1000 steps, as far as single precision lets a run be followed."""
    of, start, steps = system(inertia, load), a_start(), 1000
    adapter = sapien(of)
    (integrator,) = adapter.description.integrators
    found = adapter.run(start, "step", STEP, steps, 10).state
    scheme = SCHEMES[integrator.scheme or ""]
    times, own = step_body(scheme, of, start, STEP, steps, 10)
    rate = float(np.max(norm(own.angular_velocity)))
    # each step rounds the state, and what it leaves grows with the motion
    lost = FEW * SINGLE * np.maximum(times / STEP, 1)
    grown = lost * growth_along(of, times, own, rate)
    assert np.all(norm(found.angular_velocity - own.angular_velocity) <= grown * rate)
    assert np.all(attitude_angle(found.orientation, own.orientation) <= grown)
    speed = float(np.max(norm(own.linear_velocity)))
    assert np.all(norm(found.linear_velocity - own.linear_velocity) <= lost * speed)
    far = float(np.max(norm(own.position)) + norm(of.body.center_of_mass))
    assert np.all(norm(found.position - own.position) <= lost * far)
    away = step_body(SCHEMES["semi-implicit-euler"], of, start, STEP, steps, 10)[1]
    assert np.any(attitude_angle(found.orientation, away.orientation) > grown)


@pytest.mark.parametrize("timestep", [STEP, 10 * STEP])
def test_torque_pushes_omega_before_its_momentum_is_turned(timestep: float) -> None:
    """``w = w0 + h I^-1 t``, ``L1 = (L - h w x L) |L| / |L - h w x L|``, then the rotation.

    Caught: a torque in the wrong axes, a tensor that is not turned, torque after the turn.
    """
    torque, own = np.array([0.3, -0.2, 0.5]), np.array([-0.4, 0.1, 0.2])
    of = replace(system("full"), load=Load(GRAVITY, torque_world=torque, torque_body=own))
    steps = STEPS if timestep == STEP else 2  # long ones soon magnify what rounding leaves
    start, inertia = a_start(3), of.body.inertia
    found = ended(of, start, h=timestep, n=steps)
    q, w, p, v = parts(start)
    for _ in range(steps):
        w = w + timestep * np.linalg.solve(inertia, own + rotate(conjugate(q), torque))
        momentum = inertia @ w
        turned = momentum - timestep * cross(w, momentum)
        w = np.linalg.solve(inertia, turned * norm(momentum) / norm(turned))
        v = v + timestep * GRAVITY
        p = p + timestep * v
        q = quaternion_product(q, exp_quaternion(timestep * w))
    # each step rounds states of a few units, and a system without growth adds that up
    bound = FEW * SINGLE * steps
    assert norm(found.angular_velocity - w) <= bound * norm(w)
    assert attitude_angle(found.orientation, q) <= bound
    assert norm(found.position - p) <= bound * (norm(p) + norm(of.body.center_of_mass))
    assert norm(found.linear_velocity - v) <= bound * norm(v)


def test_a_scheme_is_declared_without_torque_and_damping_alone() -> None:
    declared = {
        (setup, load): sapien(system(load=load), setup).description.integrators[0].scheme
        for setup in ("physics", "as-shipped")
        for load in ("gravity", "torque_body", "torque_world")
    }
    rescaled = "semi-implicit-euler-rescaled-momentum"
    assert {key: scheme for key, scheme in declared.items() if scheme} == {
        ("physics", "gravity"): rescaled
    }


def test_a_turn_in_bare_numbers_is_that_of_the_reference() -> None:
    many = states(20, seed=2)
    for row in range(20):
        q, v = at(many, row).orientation, at(many, row).angular_velocity
        found = np.array(stepping.turned(q.tolist(), v.tolist()))
        assert norm(found - rotate(q, v)) <= FEW * np.finfo(float).eps * norm(v)


@pytest.mark.parametrize("inertia", sorted(INERTIAS))
def test_the_model_reads_back(inertia: str) -> None:
    of = system(inertia)
    (found,) = sapien(of).model()
    size = float(np.max(np.abs(of.body.inertia)))
    far = float(norm(of.body.center_of_mass))
    assert abs(found.mass - of.body.mass) <= 4 * SINGLE * of.body.mass
    assert norm(found.center_of_mass - of.body.center_of_mass) <= 4 * SINGLE * far
    assert np.max(np.abs(found.inertia - of.body.inertia)) <= FEW * SINGLE * size


def test_states_come_back_as_they_went_in() -> None:
    of, many = system(), states(10, seed=1, far=3.0, fast=5.0)
    adapter, far = sapien(of), norm(of.body.center_of_mass)
    for row in range(10):
        given = at(many, row)
        adapter.set_state(given)
        found = adapter.get_state()
        assert attitude_angle(found.orientation, given.orientation) <= FEW * SINGLE
        for one, other in zip(parts(found)[1:], parts(given)[1:], strict=True):
            assert norm(one - other) <= FEW * SINGLE * (norm(other) + far)


def test_a_run_does_not_depend_on_earlier_calls_and_logs_what_is_asked() -> None:
    """Caught: the gravity of another scene, which SAPIEN sets for all that are made later."""
    of, start = system("full", "torque_body"), a_start()
    adapter = sapien(of)
    before = adapter.run(start, "step", STEP, 7, 3)
    sapien(system("full", "gravity")).run(a_start(5), "step", 0.003, 3, 1)
    adapter.set_state(a_start(6))
    after = adapter.run(start, "step", STEP, 7, 3)
    assert np.array_equal(before.time, np.array([0, 3, 6, 7]) * STEP)
    every = adapter.run(start, "step", STEP, 7, 1).state
    for one, other, each in zip(parts(before.state), parts(after.state), parts(every), strict=True):
        assert np.array_equal(one, other)
        assert np.array_equal(one, each[[0, 3, 6, 7]])
    assert np.array_equal(adapter.run(start, "step", STEP, 0, 1).time, [0.0])


def test_what_is_not_finite_comes_back_as_nan() -> None:
    adapter, start = sapien(system()), a_start()
    for spin in (np.nan, 1e39):
        broken = replace(start, angular_velocity=np.array([1.0, spin, 0.0]))
        found = adapter.run(broken, "step", STEP, 4, 2).state
        assert np.all(np.isnan(found.angular_velocity[1:]))
    assert np.all(np.isfinite(adapter.run(start, "step", STEP, 4, 2).state.angular_velocity))


def test_what_is_not_there_is_refused() -> None:
    adapter = sapien(system())
    one = State(*(np.array(v)[None] for v in parts(a_start())))
    with pytest.raises(UnsupportedError, match="no integrator 'leap'"):
        adapter.run(a_start(), "leap", STEP, 1, 1)
    for load, reason in (("pivot", "no pivoted bodies"), ("damping", "no damping torque")):
        with pytest.raises(UnsupportedError, match=reason):
            sapien(system(load=load))
    with pytest.raises(UnsupportedError, match="omega-dot"):
        adapter.forward_dynamics(one)
    with pytest.raises(UnsupportedError, match="inverse dynamics"):
        adapter.inverse_dynamics(one, Acceleration(*np.zeros((2, 1, 3))))
    with pytest.raises(UnsupportedError, match="one body"):
        sapien(System((SPHERE.body, SPHERE.body), LOADS["none"]))


def test_as_shipped_omega_is_damped_and_has_its_gyroscopic_term() -> None:
    """``0.05 h`` of omega each step. The term is on: other bindings of PhysX have it off."""
    for setup, kept in (("as-shipped", 1 - 0.05 * STEP), ("physics", 1.0)):
        found = ended(SPHERE, TURNED, setup).angular_velocity
        assert norm(found - kept * TURNED.angular_velocity) <= FEW * SINGLE * norm(found)
    of = system("diagonal")
    end = ended(of, TURNED, "as-shipped")
    rate = cross(of.body.inertia @ TURNED.angular_velocity, TURNED.angular_velocity)
    turned = TURNED.angular_velocity + STEP * np.linalg.solve(of.body.inertia, rate)
    # what a step of order 1 leaves is of its square, and what damping takes is a twentieth
    plain = norm(turned - TURNED.angular_velocity)
    assert norm(end.angular_velocity - turned) <= 0.2 * plain


def test_each_setting_is_mended_alone() -> None:
    """Of these angular_damping alone keeps the omega of a sphere."""
    for own in sapien(SPHERE, "as-shipped").description.settings:
        found = ended(SPHERE, TURNED, f"as-shipped+{own}").angular_velocity
        kept = norm(found - TURNED.angular_velocity) <= FEW * SINGLE * norm(found)
        assert kept == (own == "angular_damping")


def test_as_shipped_omega_is_cut_to_100_rad_per_s() -> None:
    for setup, most in (("as-shipped", 100.0), ("physics", 200.0)):
        found = ended(SPHERE, spun(0.0, 0.0, 200.0), setup).angular_velocity
        assert abs(found[2] - most) <= FEW * SINGLE * most


def test_as_shipped_a_slow_body_is_put_to_sleep() -> None:
    """Caught: a body that has its omega, and does not turn."""
    for setup, moves in (("as-shipped", False), ("physics", True)):
        found = sapien(SPHERE, setup).run(spun(0.0, 0.0, 1e-3), "step", 0.02, 400, 200)
        assert bool(np.any(found.state.orientation[1] != found.state.orientation[2])) is moves


def test_importing_the_adapter_leaves_the_engine_alone() -> None:
    code = "import sys, omegadot.adapters.sapien.adapter; sys.exit('sapien' in sys.modules)"
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0


def test_it_describes_itself() -> None:
    own = SapienAdapter().description
    assert isinstance(SapienAdapter(), Adapter)
    assert own.precision == "float32"
    assert own.version
    assert own.licence
    assert own.switched_off
    assert not SapienAdapter("as-shipped").description.switched_off
    native = SapienAdapter().native()
    assert native["conventions"] == {
        "linear velocity frame": "world axes",
        "angular velocity frame": "world axes",
        "quaternion order": "w, x, y, z",
    }
    assert native["defaults"]["angular_damping"] == "0.05"
    assert native["defaults"]["linear_damping"] == "0"
    assert native["defaults"]["largest omega, rad/s"] == "100"
