"""What every adapter must do alike: states, read-back, dynamics, sampling, no memory, NaN."""

from __future__ import annotations

import subprocess
import sys
from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from mujoco_cases import (
    EPS,
    GRAVITY,
    INERTIAS,
    LOADS,
    OFFSET,
    PIVOT,
    at,
    norm,
    parts,
    states,
    system,
)

from omegadot.adapters.protocol import Adapter, UnsupportedError
from omegadot.adapters.registry import NODE, OURS, build_adapter, is_absent
from omegadot.reference_impl.inertia import lever, moving_inertia
from omegadot.reference_impl.kinematics import place_on_pivot
from omegadot.reference_impl.loads import gravity_torque, torque
from omegadot.reference_impl.motion import (
    center_of_mass_acceleration,
    forward_dynamics,
    inverse_dynamics,
)
from omegadot.reference_impl.rotations import attitude_angle
from omegadot.reference_impl.symmetric import apply
from omegadot.reference_impl.system import Acceleration, Array, Body, Load, State, System

# Those in Python that take every load; tests/adapters/test_node.py has the same of those that run
# through Node, test_basilisk.py, test_jaxsim.py and test_sapien.py of engines that take free bodies
# alone, test_pybullet.py of one without omega-dot, test_mjx.py of MJX in single precision, and
# test_rapier3d.py of one in single precision that has omega-dot of pivoted bodies alone.
APART = {"basilisk", "jaxsim", "jaxsim-float32", "mjx-float32", "pybullet", "rapier3d", "sapien"}
ENGINES = sorted(set(OURS) - set(NODE) - APART - set(filter(is_absent, OURS)))
FEW = 64  # roundings in a row of about twenty operations on three components
TENSORS = ("diagonal", "full", "flat_turned", "thin_turned")


@cache
def engine(name: str) -> Adapter:
    """One instance serves every test, so that a test sees what an earlier load left behind."""
    return build_adapter(OURS[name])


def loaded(name: str, of: System) -> Adapter:
    adapter = engine(name)
    adapter.load(of)
    return adapter


def torque_scale(of: System, many: State) -> Array:
    """Sizes of the torques that (8) adds up, (n,), translation's left out."""
    inertia = moving_inertia(of)
    gyroscopic = norm(many.angular_velocity) * norm(apply(inertia, many.angular_velocity))
    return gyroscopic + norm(np.broadcast_to(torque(of, many), many.angular_velocity.shape))


def translation_scale(of: System, many: State) -> Array:
    """Torques at the body origin that vanish in exact arithmetic alone, (n,).

    Spatial algebra at a moving point forms ``v × m v`` and ``c × (ω × m v)``.
    """
    if of.load.pivot is not None:
        return np.zeros(len(many.angular_velocity))
    speed, arm = norm(many.linear_velocity), float(norm(of.body.center_of_mass))
    spin = norm(many.angular_velocity)
    scale: Array = of.body.mass * (speed + spin * arm) * (speed + 2 * spin * arm)
    return scale


def angular_bound(of: System, many: State) -> Array:
    inertia = moving_inertia(of)
    moments = np.linalg.eigvalsh(inertia)
    faulty = moments[-1] / moments[0] * torque_scale(of, many) + translation_scale(of, many)
    bound: Array = FEW * EPS * faulty / moments[0]
    return bound


def linear_bound(of: System, many: State) -> Array:
    """g, the turning of v in body axes, and what ω̇'s own error does at the lever's end."""
    arm = float(norm(of.body.center_of_mass)) + float(norm(lever(of)))
    spin, speed = norm(many.angular_velocity), norm(many.linear_velocity)
    rounded = FEW * EPS * (norm(of.load.gravity) + spin * speed + arm * spin * spin)
    return rounded + arm * angular_bound(of, many)


def cases(count: int, of: System, seed: int, fast: float) -> State:
    return place_on_pivot(of, states(count, seed=seed, fast=fast))


def taken_by(adapter: Adapter, start: State) -> list[str]:
    """The integrators that take this motion of the loaded system; the first one always does."""
    found = []
    for integrator in adapter.description.integrators:
        try:
            adapter.run(start, integrator.name, 0.01, 1, 1)
        except UnsupportedError:
            assert found, integrator.name
        else:
            found.append(integrator.name)
    return found


@pytest.mark.parametrize("name", ENGINES)
def test_answers_the_protocol_and_describes_itself(name: str) -> None:
    adapter = engine(name)
    reported = adapter.description
    assert isinstance(adapter, Adapter)
    assert reported.name == name
    assert reported.version
    assert reported.licence
    assert reported.integrators
    assert {"free", "pivot", "forward_dynamics"} <= reported.features
    assert len({i.name for i in reported.integrators}) == len(reported.integrators)


PACKAGES = {
    "pinocchio": "pinocchio",
    "dart": "dartpy",
    "mujoco": "mujoco",
    "drake": "pydrake",
    "exudyn": "exudyn",
    "opensim": "opensim",
    "mjx": "jax",
    "idyntree": "idyntree",
    "biorbd": "biorbd",
}


@pytest.mark.parametrize(
    ("name", "package"), [(name, PACKAGES[name]) for name in PACKAGES if name in ENGINES]
)
def test_importing_an_adapter_leaves_its_engine_alone(name: str, package: str) -> None:
    module = OURS[name].partition(":")[0]
    code = f"import sys, {module}; sys.exit({package!r} in sys.modules)"
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0


@pytest.mark.parametrize("name", ENGINES)
@pytest.mark.parametrize("inertia", sorted(INERTIAS))
@pytest.mark.parametrize("load", ["none", "pivot"])
def test_the_model_reads_back(name: str, inertia: str, load: str) -> None:
    requested = system(inertia, load)
    (found,) = loaded(name, requested).model()
    size = float(np.max(np.abs(requested.body.inertia)))
    assert found.mass == requested.body.mass
    far = norm(OFFSET) + norm(PIVOT)
    assert np.max(np.abs(found.center_of_mass - requested.body.center_of_mass)) <= 4 * EPS * far
    assert np.max(np.abs(found.inertia - requested.body.inertia)) <= FEW * EPS * size


@pytest.mark.parametrize("name", ENGINES)
@pytest.mark.parametrize("load", ["none", "pivot"])
def test_states_come_back_as_they_went_in(name: str, load: str) -> None:
    of = system(load=load)
    adapter, many = loaded(name, of), cases(20, of, 1, fast=50.0)
    for row in range(20):
        given = at(many, row)
        adapter.set_state(given)
        found = adapter.get_state()
        reach = norm(given.position) + norm(OFFSET) + norm(PIVOT)
        lift = norm(given.angular_velocity) * (norm(OFFSET) + norm(PIVOT))
        assert attitude_angle(found.orientation, given.orientation) <= FEW * EPS
        assert norm(found.angular_velocity - given.angular_velocity) <= FEW * EPS * norm(
            given.angular_velocity
        )
        assert norm(found.position - given.position) <= FEW * EPS * reach
        moved = norm(found.linear_velocity - given.linear_velocity)
        assert moved <= FEW * EPS * (norm(given.linear_velocity) + lift)


@pytest.mark.parametrize("name", ENGINES)
def test_a_pivoted_body_takes_attitude_and_spin_alone(name: str) -> None:
    of = system(load="pivot_all")
    adapter, elsewhere = loaded(name, of), at(states(1, seed=17), 0)
    adapter.set_state(elsewhere)
    found, expected = adapter.get_state(), place_on_pivot(of, elsewhere)
    arm = norm(OFFSET) + norm(PIVOT)
    assert norm(found.position - expected.position) <= FEW * EPS * arm
    spin = norm(elsewhere.angular_velocity)
    assert norm(found.linear_velocity - expected.linear_velocity) <= FEW * EPS * arm * spin


@pytest.mark.parametrize("name", ENGINES)
@pytest.mark.parametrize("angle", [0.0, 1e-9, 1e-5, 5e-4, 9.9e-4, np.pi - 1e-6, np.pi])
@pytest.mark.parametrize("load", ["none", "pivot"])
def test_attitudes_near_none_and_half_a_turn_come_back(name: str, angle: float, load: str) -> None:
    of = system(load=load)
    q = np.array([np.cos(angle / 2), *(np.sin(angle / 2) * np.array([2.0, -1.0, 2.0]) / 3)])
    given = place_on_pivot(of, State(q, np.array([1.0, 2.0, 3.0]), np.zeros(3), np.zeros(3)))
    adapter = loaded(name, of)
    adapter.set_state(given)
    assert attitude_angle(adapter.get_state().orientation, q) <= FEW * EPS


@pytest.mark.parametrize("name", ENGINES)
@pytest.mark.parametrize("inertia", TENSORS)
@pytest.mark.parametrize("load", sorted(LOADS))
@pytest.mark.parametrize("fast", [0.0, 50.0])
def test_forward_dynamics_is_the_equation(name: str, inertia: str, load: str, fast: float) -> None:
    of = system(inertia, load)
    many = cases(12, of, 2, fast)
    found, expected = loaded(name, of).forward_dynamics(many), forward_dynamics(of, many)
    assert np.all(norm(found.angular - expected.angular) <= angular_bound(of, many))
    assert np.all(norm(found.linear - expected.linear) <= linear_bound(of, many))


@pytest.mark.parametrize("name", ENGINES)
@pytest.mark.parametrize("load", ["none", "all", "pivot_all"])
def test_omega_dot_of_an_ordinary_body_is_right_to_few_ulps(name: str, load: str) -> None:
    of = system("full", load)
    many = cases(50, of, 3, fast=0.0)
    found, expected = loaded(name, of).forward_dynamics(many), forward_dynamics(of, many)
    least = np.linalg.eigvalsh(moving_inertia(of))[0]
    assert np.all(norm(found.angular - expected.angular) <= 1e-14 * torque_scale(of, many) / least)


@pytest.mark.parametrize("name", ENGINES)
@pytest.mark.parametrize("inertia", TENSORS)
@pytest.mark.parametrize("load", sorted(LOADS))
def test_inverse_dynamics_is_the_equation(name: str, inertia: str, load: str) -> None:
    of = system(inertia, load)
    many = cases(12, of, 4, fast=2.0)
    rng = np.random.default_rng(5)
    angular = 10 * rng.normal(size=(12, 3))
    linear: Array = 10 * rng.normal(size=(12, 3))
    if of.load.pivot is not None:
        linear = center_of_mass_acceleration(of, many, angular)
    wanted = Acceleration(angular, linear)
    found, expected = (
        loaded(name, of).inverse_dynamics(many, wanted),
        inverse_dynamics(of, many, wanted),
    )
    most = np.linalg.eigvalsh(moving_inertia(of))[-1]
    arm = norm(OFFSET) + norm(PIVOT)
    felt = norm(linear) + norm(of.load.gravity) + arm * norm(angular)
    scale = torque_scale(of, many) + most * norm(angular) + norm(gravity_torque(of, many))
    scale = scale + translation_scale(of, many) + of.body.mass * arm * felt
    assert np.all(norm(found - expected) <= FEW * EPS * scale)


@pytest.mark.parametrize("name", ENGINES)
def test_no_call_leaves_anything_for_the_next(name: str) -> None:
    adapter, plain = engine(name), system()
    many = cases(3, plain, 6, fast=2.0)
    adapter.load(plain)
    before = adapter.forward_dynamics(many)
    adapter.inverse_dynamics(many, Acceleration(np.ones((3, 3)), np.ones((3, 3))))
    between = adapter.forward_dynamics(many)
    assert np.array_equal(before.angular, between.angular)
    adapter.load(system("thin", "pivot_all"))
    adapter.forward_dynamics(many)
    adapter.load(plain)
    after = adapter.forward_dynamics(many)
    assert np.array_equal(before.angular, after.angular)
    assert np.array_equal(before.linear, after.linear)


@pytest.mark.parametrize("name", ENGINES)
@pytest.mark.parametrize("load", ["all", "pivot_all"])
def test_a_run_does_not_depend_on_earlier_calls(name: str, load: str) -> None:
    of = system(load=load)
    adapter, many = loaded(name, of), cases(2, of, 7, fast=2.0)
    names = taken_by(adapter, at(many, 0))
    before = adapter.run(at(many, 0), names[0], 0.01, 5, 2)
    adapter.inverse_dynamics(many, adapter.forward_dynamics(many))
    adapter.set_state(at(many, 1))
    for other in taken_by(adapter, at(many, 1)):
        adapter.run(at(many, 1), other, 0.003, 3, 1)
    after = adapter.run(at(many, 0), names[0], 0.01, 5, 2)
    for first, second in zip(parts(before.state), parts(after.state), strict=True):
        assert np.array_equal(first, second)


@pytest.mark.parametrize("name", ENGINES)
def test_a_run_logs_the_start_each_kth_step_and_the_last(name: str) -> None:
    of = system(load="all")
    adapter, start = loaded(name, of), at(cases(1, of, 8, fast=2.0), 0)
    for integrator in taken_by(adapter, start):
        none = adapter.run(start, integrator, 0.01, 0, 1)
        assert np.array_equal(none.time, [0.0])
        every = adapter.run(start, integrator, 0.01, 7, 1)
        third = adapter.run(start, integrator, 0.01, 7, 3)
        assert np.array_equal(third.time, np.array([0, 3, 6, 7]) * 0.01)
        for first, second in zip(parts(every.state), parts(third.state), strict=True):
            assert len(second) == 4
            # the exact solution's own steps depend on the times that are requested
            assert np.max(np.abs(first[[0, 3, 6, 7]] - second)) <= 1e-13 * np.max(np.abs(first))
        assert attitude_angle(third.state.orientation[0], start.orientation) <= FEW * EPS
        for given, found in zip(parts(start)[1:], parts(third.state)[1:], strict=True):
            assert norm(found[0] - given) <= FEW * EPS * (norm(given) + 10)


@pytest.mark.parametrize("name", ENGINES)
@pytest.mark.parametrize("load", ["none", "pivot"])
def test_nan_comes_back_as_nan(name: str, load: str) -> None:
    of = system(load=load)
    adapter, start = loaded(name, of), at(cases(1, of, 9, fast=2.0), 0)
    broken = replace(start, angular_velocity=np.array([1.0, np.nan, 0.0]))
    for integrator in taken_by(adapter, start):
        found = adapter.run(broken, integrator, 0.01, 4, 2)
        assert np.all(np.isnan(found.state.angular_velocity[1:]).any(axis=-1)), integrator
    sound = adapter.run(start, integrator, 0.01, 4, 2)
    assert np.all(np.isfinite(sound.state.angular_velocity))


@pytest.mark.parametrize("name", ENGINES)
def test_what_is_not_there_is_refused(name: str) -> None:
    of = system()
    adapter, start = loaded(name, of), at(cases(1, of, 10, fast=2.0), 0)
    with pytest.raises(UnsupportedError, match="no-such"):
        adapter.run(start, "no-such", 0.01, 4, 2)
    body = Body(np.array(1.0), np.zeros(3), np.eye(3))
    with pytest.raises(UnsupportedError, match="bod"):
        adapter.load(System((body, body), Load(gravity=GRAVITY)))
