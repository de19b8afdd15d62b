"""What Rapier steps, free and on a joint, and what of it is not as a reader may expect."""

from __future__ import annotations

import subprocess
import sys
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from mujoco_cases import GRAVITY, INERTIAS, OFFSET, PIVOT, at, norm, parts, states, system

from omegadot.adapters.protocol import Adapter, UnsupportedError
from omegadot.adapters.rapier3d.adapter import RapierAdapter
from omegadot.adapters.rapier3d.model import quaternion_of
from omegadot.reference_impl.inertia import moving_inertia
from omegadot.reference_impl.kinematics import place_on_pivot
from omegadot.reference_impl.loads import torque
from omegadot.reference_impl.motion import forward_dynamics
from omegadot.reference_impl.rotations import attitude_angle, normalize, rotate, rotate_inverse
from omegadot.reference_impl.schemes import SCHEMES
from omegadot.reference_impl.solutions.growth import growth_along
from omegadot.reference_impl.stepping import step_body
from omegadot.reference_impl.symmetric import apply
from omegadot.reference_impl.system import Acceleration, Array, Body, Load, State, System

rapier = pytest.importorskip("rapier3d")

STEP = 0.01
SINGLE = float(np.finfo(np.float32).eps)
FEW = 64  # roundings in a row of about twenty operations on three components
TURNED = State(np.array([1.0, 0.0, 0.0, 0.0]), np.array([0.4, 2.0, -0.7]), *np.zeros((2, 3)))
SPHERE = System((Body(np.array(1.0), np.zeros(3), np.eye(3)),), Load())
FREE = ("none", "gravity", "torque_body", "torque_world")
PIVOTED = ("pivot", "pivot_gravity", "pivot_damping", "pivot_all")
HALF_TURN = np.array([1e-9, 0.6, 0.0, 0.8])


def made(of: System, setup: Any = "physics") -> RapierAdapter:
    adapter = RapierAdapter(setup)
    adapter.load(of)
    return adapter


def a_start(of: System, seed: int = 4) -> State:
    return place_on_pivot(of, at(states(1, seed=seed, far=1.0, fast=2.0), 0))


def spun(*omega: float) -> State:
    return replace(TURNED, angular_velocity=np.array(omega))


def misses(of: System, found: State, own: State, times: Array, steps: int) -> Array:
    """Largest errors of a run (n,), in what rounding allows it: more than 1 is another scheme.

    Each substep rounds the state, and what it leaves grows with the motion.
    """
    rate = float(np.max(norm(own.angular_velocity)))
    lost = FEW * SINGLE * np.maximum(times / times[-1] * steps, 1)
    grown = lost * growth_along(of, times, own, rate)
    arm = float(norm(OFFSET) + norm(PIVOT))
    far, speed = (float(np.max(norm(part))) for part in (own.position, own.linear_velocity))
    return np.max(
        [
            attitude_angle(found.orientation, own.orientation) / grown,
            norm(found.angular_velocity - own.angular_velocity) / (grown * rate),
            norm(found.position - own.position) / (grown * (far + arm)),
            norm(found.linear_velocity - own.linear_velocity) / (grown * (speed + arm * rate)),
        ],
        axis=0,
    )


@pytest.mark.parametrize("inertia", ["diagonal", "full", "flat_turned"])
@pytest.mark.parametrize("load", FREE)
def test_a_free_body_is_stepped_by_the_scheme_that_is_declared(inertia: str, load: str) -> None:
    of, steps = system(inertia, load), 400 if load in ("none", "gravity") else 100
    adapter, start = made(of), a_start(of)
    scheme = SCHEMES[adapter.description.integrators[0].scheme or ""]
    found = adapter.run(start, "step", STEP, steps, 10).state
    times, own = step_body(scheme, of, start, STEP, steps, 10)
    assert np.all(misses(of, found, own, times, 4 * steps) <= 1)
    away = step_body(SCHEMES["semi-implicit-euler"], of, start, STEP, steps, 10)[1]
    assert np.any(misses(of, found, away, times, 4 * steps) > 1)


@pytest.mark.parametrize("load", ["pivot", "pivot_gravity", "pivot_damping"])
@pytest.mark.parametrize("inertia", ["diagonal", "full"])
def test_a_step_of_a_pivoted_body_is_four_of_linearly_implicit_euler(
    inertia: str, load: str
) -> None:
    """All that acts is solved for, damping as well. No scheme is declared: see the next test."""
    of, steps, h = system(inertia, load), 20, 4 * STEP
    adapter, start = made(of), a_start(of)
    assert adapter.description.integrators[0].scheme is None
    found = adapter.run(start, "step", h, steps, 5).state
    euler = SCHEMES["linearly-implicit-euler"]
    times, own = step_body(euler, of, start, h / 4, 4 * steps, 20)
    assert np.all(misses(of, found, own, times, 4 * steps) <= 1)
    other = step_body(SCHEMES["semi-implicit-euler"], of, start, h / 4, 4 * steps, 20)[1]
    longer = step_body(euler, of, start, h, steps, 5)[1]
    for away in (other, longer):
        assert np.any(misses(of, found, away, times, 4 * steps) > 1)


def top_on_joint(
    moments: Any, center: Any, gravity: Any, omega: Any, h: float, turn: Any = (0.0, 0.0, 0.0)
) -> Any:
    """By Rapier's interface: a top of 1 kg, pivoted at its origin, after one substep of h s."""
    world = rapier.PhysicsWorld(gravity)
    world.integration_parameters.num_solver_iterations = 1
    world.integration_parameters.dt = h
    inertia = rapier.MassProperties(center, 1.0, moments)
    made_of = rapier.RigidBody.dynamic().additional_mass_properties(inertia).can_sleep(False)
    top = world.add_body(made_of)
    world.rigid_bodies[top].recompute_mass_properties_from_colliders(world.colliders)
    fixed = world.add_body(rapier.RigidBody.fixed())
    joint = world.multibody_joints.insert(fixed, top, rapier.SphericalJoint.builder().build())
    multibody, _ = world.multibody_joints.get(joint)
    multibody.forward_kinematics(world.rigid_bodies, True)
    multibody.set_damping([0.0] * 3)
    multibody.apply_displacements([*turn])
    multibody.forward_kinematics(world.rigid_bodies)
    multibody.update_rigid_bodies(world.rigid_bodies, True)
    multibody.set_generalized_velocity(omega)
    world.step()
    return multibody, quaternion_of(world.rigid_bodies[top].rotation)


@pytest.mark.parametrize("spin", [-0.7, 0.7])
def test_the_implicit_step_is_left_out_where_it_adds_energy(spin: float) -> None:
    """Caught: a scheme declared of pivoted bodies, which some of their steps are not."""
    center = np.array([0.0, 0.0, 0.6])
    load = Load(np.array([0.0, 4.0, 0.0]), np.zeros(3))
    of = System((Body(np.array(1.0), center, np.diag([1.0, 2.0, 3.0])),), load)
    start = place_on_pivot(of, spun(0.0, spin, 0.0))
    h, steps = 0.5, {}
    for scheme in ("linearly-implicit-euler", "semi-implicit-euler"):
        ended = step_body(SCHEMES[scheme], of, start, h, 1, 1)[1][-1]
        steps[scheme] = rotate(ended.orientation, ended.angular_velocity)
    turning, _ = top_on_joint(
        (1.0, 2.0, 3.0), (0.0, 0.0, 0.6), (0.0, 4.0, 0.0), [0.0, spin, 0.0], h
    )
    found = np.array(turning.generalized_velocity())
    apart = {scheme: float(norm(found - own)) for scheme, own in steps.items()}
    assert apart["semi-implicit-euler"] <= FEW * SINGLE * norm(found), apart
    assert apart["linearly-implicit-euler"] > 0.01


@pytest.mark.parametrize("inertia", ["diagonal", "full", "flat_turned"])
@pytest.mark.parametrize("load", PIVOTED)
def test_omega_dot_of_a_pivoted_body_is_the_equation(inertia: str, load: str) -> None:
    of = system(inertia, load)
    many = place_on_pivot(of, states(12, seed=2, fast=2.0))
    found, expected = made(of).forward_dynamics(many), forward_dynamics(of, many)
    own = moving_inertia(of)
    moments = np.linalg.eigvalsh(own)
    spin = many.angular_velocity
    turning = norm(spin) * norm(apply(own, spin)) + norm(np.broadcast_to(torque(of, many), (12, 3)))
    bound = FEW * SINGLE * moments[-1] / moments[0] * turning / moments[0]
    assert np.all(norm(found.angular - expected.angular) <= bound)
    arm = float(norm(OFFSET) + norm(PIVOT))
    rounded = FEW * SINGLE * arm * norm(spin) ** 2
    assert np.all(norm(found.linear - expected.linear) <= rounded + arm * bound)


@pytest.mark.parametrize(("ratio", "least", "most"), [(10, 0, 64), (1e3, 0, 1e3), (1e4, 64, 1e4)])
def test_thin_bodies_lose_the_square_of_the_ratio(ratio: float, least: float, most: float) -> None:
    """Roundings of ``cond(I) |ω|²`` by which ω̇ errs: few, if the inertia were not inverted twice.

    Caught: an exception that hides another fault of bodies that are not thin.
    """
    moments, none, worst = np.array([1 / ratio, 1.0, 1.0]), (0.0, 0.0, 0.0), 0.0
    drawn = np.random.default_rng(3).normal(size=(100, 2, 3)).astype(np.float32).astype(float)
    for turn, omega in drawn:
        body, given = top_on_joint(tuple(moments.tolist()), none, none, [*omega], 2.0**-100, turn)
        q = normalize(np.array(given))
        own = rotate_inverse(q, omega)
        expected = rotate(q, -np.cross(own, moments * own) / moments)
        error = norm(np.array(body.generalized_acceleration()) - expected) / float(omega @ omega)
        worst = max(worst, float(error) / SINGLE / ratio)
    assert least <= worst <= most


def test_omega_dot_is_offered_of_a_pivoted_body_alone() -> None:
    adapter, many = made(system()), states(2)
    assert "forward_dynamics" not in adapter.description.features
    with pytest.raises(UnsupportedError, match="free body"):
        adapter.forward_dynamics(many)
    with pytest.raises(UnsupportedError, match="inverse"):
        adapter.inverse_dynamics(many, Acceleration(np.zeros((2, 3)), np.zeros((2, 3))))
    assert "forward_dynamics" in made(system(load="pivot")).description.features


@pytest.mark.parametrize("inertia", sorted(INERTIAS))
@pytest.mark.parametrize("load", ["none", "pivot"])
def test_the_model_reads_back(inertia: str, load: str) -> None:
    of = system(inertia, load)
    (found,) = made(of).model()
    size, far = float(np.max(np.abs(of.body.inertia))), float(norm(OFFSET) + norm(PIVOT))
    assert abs(found.mass - of.body.mass) <= 4 * SINGLE * of.body.mass
    assert norm(found.center_of_mass - of.body.center_of_mass) <= 4 * SINGLE * far
    assert np.max(np.abs(found.inertia - of.body.inertia)) <= FEW * SINGLE * size


@pytest.mark.parametrize("load", ["none", "pivot"])
def test_states_come_back_as_they_went_in(load: str) -> None:
    of, far = system(load=load), float(norm(OFFSET) + norm(PIVOT))
    adapter, many = made(of), place_on_pivot(of, states(10, seed=1, far=3.0, fast=5.0))
    given = [at(many, row) for row in range(10)]
    given.append(place_on_pivot(of, replace(TURNED, orientation=HALF_TURN)))
    for one in given:
        adapter.set_state(one)
        found = adapter.get_state()
        assert attitude_angle(found.orientation, one.orientation) <= FEW * SINGLE
        spin = norm(one.angular_velocity)
        for value, own in zip(parts(found)[1:], parts(one)[1:], strict=True):
            assert norm(value - own) <= FEW * SINGLE * (norm(own) + far * (1 + spin))


@pytest.mark.parametrize("load", ["torque_body", "pivot_all"])
def test_a_run_does_not_depend_on_earlier_calls_and_logs_what_is_asked(load: str) -> None:
    of = system("full", load)
    adapter, start = made(of), a_start(of)
    before = adapter.run(start, "step", STEP, 7, 3)
    adapter.run(a_start(of, 5), "step", 0.003, 3, 1)
    adapter.set_state(a_start(of, 6))
    after = adapter.run(start, "step", STEP, 7, 3)
    assert np.array_equal(before.time, np.array([0, 3, 6, 7]) * STEP)
    every = adapter.run(start, "step", STEP, 7, 1).state
    for one, other, each in zip(parts(before.state), parts(after.state), parts(every), strict=True):
        assert np.array_equal(one, other)
        assert np.array_equal(one, each[[0, 3, 6, 7]])
    assert np.array_equal(adapter.run(start, "step", STEP, 0, 1).time, [0.0])


@pytest.mark.parametrize("load", ["none", "pivot"])
def test_what_is_not_finite_comes_back_as_nan(load: str) -> None:
    """Caught: the place that Rapier puts such a body back to, where it stands still."""
    of = system(load=load)
    adapter, start = made(of), a_start(of)
    for spin in (np.nan, 1e39, 1e30):
        broken = replace(start, angular_velocity=np.array([1.0, spin, 2.0]))
        found = adapter.run(broken, "step", STEP, 4, 2).state
        assert np.all(np.isnan(found.angular_velocity[1:])), spin
    sound = adapter.run(start, "step", STEP, 4, 2).state
    assert np.all(np.isfinite(sound.angular_velocity))


def test_what_is_not_there_is_refused() -> None:
    with pytest.raises(UnsupportedError, match="damping"):
        made(system(load="damping"))
    of = system()
    with pytest.raises(UnsupportedError, match="no-such"):
        made(of).run(a_start(of), "no-such", STEP, 4, 2)
    with pytest.raises(UnsupportedError, match="one body"):
        made(System((SPHERE.body, SPHERE.body)))


def test_as_shipped_a_joint_is_damped_by_a_tenth() -> None:
    """0.1 N m s, whatever the body: of a sphere of 1 kg m^2 it takes ``exp(-0.1 t)``."""
    of = replace(SPHERE, load=Load(pivot=np.zeros(3)))
    for setup, lost in (("as-shipped", 0.1), ("physics", 0.0), ("as-shipped+set_damping", 0.0)):
        found = made(of, setup).run(spun(0.0, 0.0, 1.0), "step", STEP, 100, 100).state[-1]
        kept = (1 + lost * STEP / 4) ** -400.0  # an implicit step, four a step
        assert abs(found.angular_velocity[2] - kept) <= 400 * FEW * SINGLE


def test_damping_of_the_system_is_the_joints_under_every_setup() -> None:
    of = replace(SPHERE, load=Load(pivot=np.zeros(3), damping=np.array(0.5)))
    shipped, ours = (
        made(of, setup).run(spun(0.0, 0.0, 1.0), "step", STEP, 50, 50).state.angular_velocity
        for setup in ("as-shipped", "physics")
    )
    assert np.array_equal(shipped, ours)


def test_as_shipped_omega_is_cut_to_an_eighth_of_a_turn_in_a_step() -> None:
    """Of a free body; one on a joint is not cut."""
    fast = spun(0.0, 0.0, 100.0)
    for load, setup, left in (
        (Load(), "as-shipped", np.pi / 4 / STEP),
        (Load(), "as-shipped+allow_fast_rotation", 100.0),
        (Load(), "physics", 100.0),
        (Load(pivot=np.zeros(3)), "as-shipped+set_damping", 100.0),
    ):
        found = made(replace(SPHERE, load=load), setup).run(fast, "step", STEP, 1, 1).state[-1]
        assert abs(found.angular_velocity[2] - left) <= FEW * SINGLE * left


def test_as_shipped_a_body_goes_no_faster_than_400_m_per_s() -> None:
    fast = replace(TURNED, linear_velocity=np.array([1e3, 0.0, 0.0]))
    for setup, left in (
        ("as-shipped", 400.0),
        ("as-shipped+normalized_max_linear_velocity", 1e3),
        ("physics", 1e3),
    ):
        found = made(SPHERE, setup).run(fast, "step", STEP, 1, 1).state[-1]
        assert abs(found.linear_velocity[0] - left) <= FEW * SINGLE * left


@pytest.mark.parametrize("load", [Load(), Load(pivot=np.zeros(3))])
def test_as_shipped_slow_bodies_are_put_to_sleep(load: Load) -> None:
    """Below 0.5 rad/s, after half a second."""
    of, slow = replace(SPHERE, load=load), spun(0.0, 0.0, 0.1)
    for setup, moves in (("as-shipped", False), ("as-shipped+can_sleep", True), ("physics", True)):
        found = made(of, setup).run(slow, "step", 0.02, 400, 200).state.orientation
        assert bool(np.any(found[1] != found[2])) is moves


def test_a_rotation_is_not_made_of_its_quaternion() -> None:
    """By Rapier's own interface: it takes w first, and reads w last."""
    given = rapier.Rotation3(0.5, 0.5, 0.5, -0.5)
    assert quaternion_of(given) == (0.5, 0.5, 0.5, -0.5)
    assert given.quaternion == (0.5, 0.5, -0.5, 0.5)
    assert not rapier.Rotation3(*given.quaternion).bitwise_equal(given)


def test_gravity_turns_a_pivoted_body_about_its_pivot() -> None:
    """A pendulum at rest: ``ω̇ = (r × m g) / I``. Caught: a lever of the wrong sign."""
    of = System(
        (Body(np.array(2.0), np.array([0.0, 0.0, -0.5]), np.eye(3)),), Load(GRAVITY, np.zeros(3))
    )
    still = place_on_pivot(of, State(*(part[None] for part in parts(spun(0.0, 0.0, 0.0)))))
    found = made(of).forward_dynamics(still).angular[0]
    expected = np.linalg.solve(
        moving_inertia(of), np.cross([0.0, 0.0, -0.5], 2.0 * rotate(TURNED.orientation, GRAVITY))
    )
    assert norm(found - expected) <= FEW * SINGLE * norm(expected)


def test_importing_the_adapter_leaves_the_engine_alone() -> None:
    code = "import sys, omegadot.adapters.rapier3d.adapter; sys.exit('rapier3d' in sys.modules)"
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0


def test_it_describes_itself() -> None:
    own = RapierAdapter().description
    assert isinstance(RapierAdapter(), Adapter)
    assert own.precision == "float32"
    assert own.version
    assert own.licence
    assert len(own.switched_off) == len(own.settings)
    assert not RapierAdapter("as-shipped").description.switched_off
    native = RapierAdapter().native()
    assert native["conventions"] == {
        "linear velocity frame": "world axes",
        "angular velocity frame": "world axes",
        "quaternion order, given": "w, x, y, z",
        "quaternion order, read": "x, y, z, w",
        "spherical joint velocity frame": "world axes",
    }
    assert native["defaults"]["spherical joint damping, N m s"] == "(0.1, 0.1, 0.1)"
    assert native["defaults"]["angular_damping"] == "0"
    assert native["defaults"]["num_solver_iterations"] == "4"
    assert native["defaults"]["largest turn in a step, rad"] == "0.7854"
