"""MuJoCo's model, coordinates and dynamics against the reference's equations."""

from __future__ import annotations

import os
import subprocess
import sys

import mujoco
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from mujoco_cases import (
    EPS,
    INERTIAS,
    LOADS,
    OFFSET,
    at,
    norm,
    parts,
    states,
    system,
    tensor,
)

from omegadot.adapters.mujoco.adapter import MujocoAdapter
from omegadot.adapters.mujoco.model import (
    _nearest_to_identity,
    apply_setup,
    principal_frame,
    without_windows,
)
from omegadot.adapters.protocol import Adapter, UnsupportedError
from omegadot.reference_impl.inertia import lever, moving_inertia
from omegadot.reference_impl.kinematics import place_on_pivot
from omegadot.reference_impl.loads import torque
from omegadot.reference_impl.motion import forward_dynamics, inverse_dynamics
from omegadot.reference_impl.rotations import rotation_matrix
from omegadot.reference_impl.symmetric import apply
from omegadot.reference_impl.system import Array, Body, Load, State, System

SEEDS = st.integers(0, 2**32 - 1)


def loaded(of: System) -> MujocoAdapter:
    adapter = MujocoAdapter()
    adapter.load(of)
    return adapter


def test_satisfies_the_protocol() -> None:
    assert isinstance(MujocoAdapter(), Adapter)


def test_importing_the_adapter_leaves_mujoco_alone() -> None:
    code = "import sys, omegadot.adapters.mujoco.adapter; sys.exit('mujoco' in sys.modules)"
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0


def test_no_window_is_imported_with_it() -> None:
    """Caught: a worker that starts processes in search of a library of windows."""
    code = (
        "import os, sys; from omegadot.adapters.mujoco.model import import_mujoco; import_mujoco();"
        "sys.exit('glfw' in sys.modules or 'MUJOCO_GL' in os.environ)"
    )
    without = {name: text for name, text in os.environ.items() if name != "MUJOCO_GL"}
    assert subprocess.run([sys.executable, "-c", code], env=without, check=False).returncode == 0


def test_a_choice_of_windows_is_the_users(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("MUJOCO_GL", "egl")
    with without_windows():
        assert os.environ["MUJOCO_GL"] == "egl"
    assert os.environ["MUJOCO_GL"] == "egl"


def test_description_names_engine_and_what_was_switched_off() -> None:
    found = MujocoAdapter().description
    assert (found.name, found.version) == ("mujoco", mujoco.__version__)
    assert (found.licence, found.precision) == ("Apache-2.0", "float64")
    assert any("damping in the Euler" in what for what in found.switched_off)
    assert any("diverges" in what for what in found.switched_off)
    assert {"free", "pivot", "inverse_dynamics", "offset_com"} <= found.features
    assert MujocoAdapter("as-shipped").description.switched_off == ()


def test_setups_set_the_flags_they_declare() -> None:
    physics, shipped = MujocoAdapter("physics"), MujocoAdapter("as-shipped")
    for adapter in (physics, shipped):
        adapter.load(system())
    default = mujoco.MjSpec().compile().opt
    assert shipped._model.opt.disableflags == default.disableflags
    assert shipped._model.opt.enableflags == default.enableflags
    off = physics._model.opt.disableflags
    for name in ("mjDSBL_AUTORESET", "mjDSBL_EULERDAMP", "mjDSBL_CONTACT", "mjDSBL_CONSTRAINT"):
        assert off & int(getattr(mujoco.mjtDisableBit, name))
    assert physics._model.opt.enableflags == 0


def test_physics_holds_off_what_a_version_might_turn_on() -> None:
    model = mujoco.MjSpec().compile()
    model.opt.enableflags = int(mujoco.mjtEnableBit.mjENBL_SLEEP)
    model.opt.density = model.opt.viscosity = 1.0
    apply_setup(mujoco, model, "physics")
    assert (model.opt.enableflags, model.opt.density, model.opt.viscosity) == (0, 0.0, 0.0)


# -- model


@pytest.mark.parametrize("inertia", INERTIAS)
@pytest.mark.parametrize("load", ["none", "pivot"])
def test_model_is_read_back_as_it_was_requested(inertia: str, load: str) -> None:
    requested = system(inertia, load)
    (found,) = loaded(requested).model()
    assert found.mass == requested.body.mass
    np.testing.assert_array_equal(found.center_of_mass, requested.body.center_of_mass)
    # principal axes in double precision: a product of three matrices, each good to a few eps
    bound = 16 * EPS * np.linalg.norm(requested.body.inertia, 2)
    assert np.abs(found.inertia - requested.body.inertia).max() <= bound


@given(SEEDS)
@settings(max_examples=50, derandomize=True, deadline=None)
def test_principal_frame_rebuilds_the_tensor(seed: int) -> None:
    moments = np.random.default_rng(seed).uniform(0.1, 1.0, 3)
    inertia = tensor((moments[0], moments[1], moments[2]), seed)
    found, q = principal_frame(inertia)
    axes = rotation_matrix(q)
    bound = 16 * EPS * np.linalg.norm(inertia, 2)
    assert np.abs(axes @ np.diag(found) @ axes.T - inertia).max() <= bound
    assert abs(norm(q) - 1) <= 2 * EPS


def test_principal_frame_leaves_a_diagonal_tensor_alone() -> None:
    moments, q = principal_frame(np.diag([3.0, 1.0, 2.0]))
    np.testing.assert_array_equal(moments, [3.0, 1.0, 2.0])
    np.testing.assert_array_equal(q, [1.0, 0.0, 0.0, 0.0])


@given(SEEDS)
@settings(max_examples=200, derandomize=True, deadline=None)
def test_axes_near_the_identity_are_a_rotation(seed: int) -> None:
    rng = np.random.default_rng(seed)
    mirrored = np.linalg.qr(rng.normal(size=(3, 3)))[0] * rng.choice([-1.0, 1.0], 3)
    axes = _nearest_to_identity(mirrored)
    assert np.linalg.det(axes) > 0
    assert np.trace(axes) > 1


def test_principal_frame_of_a_body_turned_by_half_a_turn_and_permuted() -> None:
    turn = np.array([[0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])
    inertia = turn @ np.diag([1.0, 2.0, 3.0]) @ turn.T
    moments, q = principal_frame(inertia)
    axes = rotation_matrix(q)
    np.testing.assert_allclose(axes @ np.diag(moments) @ axes.T, inertia, rtol=0, atol=16 * EPS)


def test_refuses_more_than_one_body() -> None:
    body = system().body
    with pytest.raises(UnsupportedError, match="one body, not 2"):
        MujocoAdapter().load(System((body, body)))


def test_a_refused_load_forgets_the_earlier_one() -> None:
    adapter, body = loaded(system(load="pivot_damping")), system().body
    with pytest.raises(UnsupportedError):
        adapter.load(System((body, body)))
    assert adapter._model is None
    assert adapter.description == MujocoAdapter().description


@pytest.mark.parametrize(("mass", "scale"), [(1.0, 1e-16), (1e-16, 1.0)])
def test_refuses_what_mujoco_would_clamp(mass: float, scale: float) -> None:
    body = Body(np.array(mass), np.zeros(3), np.eye(3) * scale)
    with pytest.raises(UnsupportedError, match="larger units"):
        MujocoAdapter().load(System((body,)))


# -- states


@given(SEEDS, st.sampled_from(["none", "pivot"]))
@settings(max_examples=50, derandomize=True, deadline=None)
def test_states_come_back(seed: int, load: str) -> None:
    of = system(load=load)
    adapter, requested = loaded(of), place_on_pivot(of, at(states(1, seed), 0))
    adapter.set_state(requested)
    found = adapter.get_state()
    reach = norm(requested.angular_velocity) * norm(OFFSET)
    sizes = (1.0, 1.0, 80.0 + norm(OFFSET), 50.0 + reach)
    for back, sent, size in zip(parts(found), parts(requested), sizes, strict=True):
        assert np.abs(back - sent).max() <= 8 * EPS * size


def test_setting_a_state_restarts_the_clock() -> None:
    adapter, many = loaded(system()), states(1)
    adapter.run(at(many, 0), "Euler", 0.1, 10, 1)
    adapter.set_state(at(many, 0))
    assert adapter._data.time == 0


def test_mujoco_sees_the_body_where_the_state_puts_it() -> None:
    """MuJoCo's own kinematics, not the adapter's, place the centre of mass and its velocity."""
    for load in ("none", "pivot"):
        of = system(load=load)
        adapter, requested = loaded(of), place_on_pivot(of, at(states(1), 0))
        adapter.set_state(requested)
        model, data = adapter._model, adapter._data
        mujoco.mj_forward(model, data)
        velocity = np.empty(6)
        kind = mujoco.mjtObj.mjOBJ_BODY  # MuJoCo's name for the inertial frame
        mujoco.mj_objectVelocity(model, data, kind, 1, velocity, 0)
        np.testing.assert_allclose(data.xipos[1], requested.position, rtol=0, atol=8 * EPS * 80)
        np.testing.assert_allclose(
            velocity[3:], requested.linear_velocity, rtol=0, atol=64 * EPS * (50 + 80)
        )
        world = rotation_matrix(requested.orientation) @ requested.angular_velocity
        np.testing.assert_allclose(velocity[:3], world, rtol=0, atol=64 * EPS * norm(world))


# -- dynamics


def torque_sizes(of: System, many: State) -> Array:
    """What τ is summed from at each state, N m, about the point MuJoCo's joint moves."""
    w, body = many.angular_velocity, of.body
    arm = norm(body.center_of_mass) if of.load.pivot is None else 0.0
    push = body.mass * (norm(many.linear_velocity) * norm(w) + norm(of.load.gravity))
    return norm(w) * norm(apply(moving_inertia(of), w)) + norm(torque(of, many)) + arm * push


def inertia_error(of: System, many: State) -> float:
    """eps times what MuJoCo's inertia is summed from, over the least moment.

    A free joint moves the body's origin, about which the inertia is larger by ``m c²``; the arm c
    is a difference of places in the world and off by eps times their size.
    """
    moments = np.linalg.eigvalsh(moving_inertia(of))
    summed = moments.max()
    if of.load.pivot is None:
        arm = norm(of.body.center_of_mass)
        summed += of.body.mass * arm * (arm + norm(many.position).max())
    return float(64 * EPS * summed / moments.min())


@pytest.mark.parametrize("far", [1.0, 80.0])
@pytest.mark.parametrize("load", LOADS)
@pytest.mark.parametrize("inertia", INERTIAS)
def test_omega_dot_is_the_equations(inertia: str, load: str, far: float) -> None:
    of = system(inertia, load)
    many = place_on_pivot(of, states(50, 3, far, far / 2))
    found, expected = loaded(of).forward_dynamics(many), forward_dynamics(of, many)
    bound = inertia_error(of, many)
    inverse = np.linalg.norm(np.linalg.inv(moving_inertia(of)), 2)
    angular = bound * inverse * torque_sizes(of, many)
    assert (norm(found.angular - expected.angular) <= angular).all()
    w, arm = norm(many.angular_velocity), norm(lever(of)) + norm(of.body.center_of_mass)
    sizes = arm * (norm(expected.angular) + w**2) + w * norm(many.linear_velocity)
    linear = arm * angular + 64 * EPS * (sizes + norm(of.load.gravity))
    assert (norm(found.linear - expected.linear) <= linear).all()


def test_omega_dot_is_good_to_1e_13_on_an_ordinary_body() -> None:
    of = system("full", "gravity")
    many = states(500, seed=5)
    w = many.angular_velocity
    error = norm(loaded(of).forward_dynamics(many).angular - forward_dynamics(of, many).angular)
    inverse = np.linalg.norm(np.linalg.inv(of.body.inertia), 2)
    assert (error <= 1e-13 * inverse * norm(w) * norm(apply(of.body.inertia, w))).all()


@pytest.mark.parametrize("load", LOADS)
@pytest.mark.parametrize("inertia", ["full", "thin_turned"])
def test_inverse_dynamics_is_the_equations(inertia: str, load: str) -> None:
    of = system(inertia, load)
    many = place_on_pivot(of, states(100, seed=4))
    acceleration = forward_dynamics(of, many)
    found = loaded(of).inverse_dynamics(many, acceleration)
    # the sums of `torque_sizes`, and the lever that is taken off again with the force
    arm, w = norm(of.body.center_of_mass), norm(many.angular_velocity)
    lift = arm * (norm(acceleration.angular) + w**2) + norm(acceleration.linear)
    place = arm + norm(many.position)
    sizes = torque_sizes(of, many) + of.body.mass * place * lift
    sizes += norm(apply(moving_inertia(of), acceleration.angular))
    error = norm(found - inverse_dynamics(of, many, acceleration))
    assert (error <= 64 * EPS * sizes).all()


def test_torques_act_in_their_own_axes() -> None:
    """A sphere turned by 90 degrees about z: world x is body -y."""
    quarter = np.array([[np.sqrt(0.5), 0.0, 0.0, np.sqrt(0.5)]])
    still = State(quarter, np.zeros((1, 3)), np.zeros((1, 3)), np.zeros((1, 3)))
    body = Body(np.array(1.0), np.zeros(3), np.eye(3))
    along_x = np.array([1.0, 0.0, 0.0])
    in_body = loaded(System((body,), Load(torque_body=along_x))).forward_dynamics(still)
    in_world = loaded(System((body,), Load(torque_world=along_x))).forward_dynamics(still)
    np.testing.assert_allclose(in_body.angular[0], [1, 0, 0], rtol=0, atol=4 * EPS)
    np.testing.assert_allclose(in_world.angular[0], [0, -1, 0], rtol=0, atol=4 * EPS)


@given(SEEDS)
@settings(max_examples=25, derandomize=True, deadline=None)
def test_omega_dot_does_not_depend_on_place_or_attitude(seed: int) -> None:
    """A free body without loads that depend on them: one ω, one ω̇."""
    of = system("full", center=np.zeros(3))
    many = states(8, seed)
    one = State(*(np.broadcast_to(v[:1], v.shape) for v in parts(many)))
    same = State(many.orientation, one.angular_velocity, many.position, many.linear_velocity)
    w_dot = loaded(of).forward_dynamics(same).angular
    inertia, w = of.body.inertia, one.angular_velocity[0]
    size = np.linalg.norm(np.linalg.inv(inertia), 2) * norm(w) * norm(inertia @ w)
    assert np.abs(w_dot - w_dot[0]).max() <= 64 * EPS * np.linalg.cond(inertia) * size


def test_forward_dynamics_is_continuous_time_after_any_run() -> None:
    """Under ``discrete`` qacc is a difference quotient, which must not leak in."""
    of = system("full", "pivot_damping")
    adapter, many = loaded(of), place_on_pivot(of, states(5))
    before = adapter.forward_dynamics(many).angular
    for integrator in adapter.description.integrators:
        adapter.run(at(many, 0), integrator.name, 0.1, 3, 1)
        np.testing.assert_array_equal(adapter.forward_dynamics(many).angular, before)
