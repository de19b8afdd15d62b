"""What PyBullet steps, and what of PyBullet is not as a reader may expect."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from mujoco_cases import EPS, INERTIAS, LOADS, OFFSET, PIVOT, at, norm, states, system
from test_conformance import FEW

from omegadot.adapters.protocol import Adapter, UnsupportedError
from omegadot.adapters.pybullet import stepping
from omegadot.adapters.pybullet.adapter import PyBulletAdapter
from omegadot.adapters.pybullet.joint import PyBulletJoint
from omegadot.reference_impl.cross_product import cross
from omegadot.reference_impl.kinematics import place_on_pivot
from omegadot.reference_impl.motion import inverse_dynamics
from omegadot.reference_impl.rotations import attitude_angle, exp_quaternion, rotate_inverse
from omegadot.reference_impl.schemes import SCHEMES
from omegadot.reference_impl.stepping import step_body
from omegadot.reference_impl.system import Acceleration, Array, Body, Load, State, System

pytest.importorskip("pybullet")

STEP, STEPS = 0.01, 20
# A step of a dozen operations, of rates that a step may double: the runs last 0.2 s.
SAME = 64 * EPS * STEPS
NO_TURN = np.array([1.0, 0.0, 0.0, 0.0])
FREE = ("none", "gravity", "torque_body", "torque_world")
PIVOTED = ("pivot", "pivot_gravity", "pivot_damping", "pivot_all")


def pybullet(of: System, setup: Any = "physics") -> PyBulletAdapter:
    adapter = PyBulletAdapter(setup)
    adapter.load(of)
    return adapter


def a_start(of: System) -> State:
    return at(place_on_pivot(of, states(1, seed=0, far=1.0, fast=2.0)), 0)


def apart(one: State, other: State) -> float:
    """The largest distance between two states, of parts of the size of one."""
    pairs = [(one.position, other.position), (one.linear_velocity, other.linear_velocity)]
    pairs.append((one.angular_velocity, other.angular_velocity))
    sizes = [float(norm(a - b) / max(1.0, float(norm(b)))) for a, b in pairs]
    return max(float(attitude_angle(one.orientation, other.orientation)), *sizes)


def stepped(of: System, scheme: str, steps: int = STEPS) -> State:
    found: State = step_body(SCHEMES[scheme], of, a_start(of), STEP, steps, steps)[1][-1]
    return found


def ended(of: System, kind: str, setup: Any = "physics", steps: int = STEPS) -> State:
    found: State = pybullet(of, setup).run(a_start(of), kind, STEP, steps, steps).state[-1]
    return found


@pytest.mark.parametrize("inertia", ["diagonal", "full", "flat_turned"])
@pytest.mark.parametrize("load", [*FREE, *PIVOTED])
def test_a_multibody_is_semi_implicit_euler(inertia: str, load: str) -> None:
    of = system(inertia, load)
    assert apart(ended(of, "multibody"), stepped(of, "semi-implicit-euler")) <= SAME


@pytest.mark.parametrize("inertia", ["diagonal", "full", "flat_turned"])
@pytest.mark.parametrize("load", ["none", "gravity"])
def test_maximal_coordinates_are_linearly_implicit_euler(inertia: str, load: str) -> None:
    of = system(inertia, load)
    assert apart(ended(of, "maximal"), stepped(of, "linearly-implicit-euler")) <= SAME


def crossed(v: Array) -> Array:
    """The matrix of ``v x``."""
    return np.stack([cross(v, axis) for axis in np.eye(3)], axis=1)


@pytest.mark.parametrize("load", ["torque_body", "torque_world"])
def test_maximal_coordinates_do_not_solve_for_a_torque(load: str) -> None:
    """Also caught: a world that begins with the inertia in world axes of another attitude."""
    of = system("full", load)
    start, inertia = a_start(of), np.array(of.body.inertia)
    w = start.angular_velocity
    torque = of.load.torque_body + rotate_inverse(start.orientation, of.load.torque_world)
    jacobian = inertia + STEP * (crossed(w) @ inertia - crossed(inertia @ w))
    turned = w - np.linalg.solve(jacobian, STEP * cross(w, inertia @ w))
    expected = turned + STEP * np.linalg.solve(inertia, torque)
    assert norm(ended(of, "maximal", steps=1).angular_velocity - expected) <= SAME
    implicit = stepped(of, "linearly-implicit-euler", 1).angular_velocity
    assert norm(implicit - expected) > 1e-6
    stale = ended(of, "maximal", "as-shipped", 1).angular_velocity
    assert norm(stale - expected) > 1e-3


def test_a_scheme_is_declared_of_maximal_coordinates_without_torque_alone() -> None:
    for load, scheme in (("gravity", "linearly-implicit-euler"), ("torque_body", None)):
        own = pybullet(system(load=load)).description.integrators
        assert [i.scheme for i in own] == ["semi-implicit-euler", scheme]


def test_a_torque_in_the_axes_of_a_link_is_in_those_of_a_step_before() -> None:
    """As shipped, and but for the first step: the link's axes in the world follow a step late."""
    of = system("full", "pivot")
    of = replace(of, load=replace(of.load, torque_body=np.array([1.0, 2.0, 3.0])))
    adapter, expected = pybullet(of, "as-shipped"), stepped(of, "semi-implicit-euler")
    joint = adapter._loaded()
    joint.model._without_damping()
    late = stepping._steps(adapter._engine, joint, a_start(of), STEP, [0, STEPS], looking=False)[0]
    assert apart(joint.states(late)[-1], expected) > 1e-3
    assert apart(ended(of, "multibody"), expected) <= SAME


def test_small_moments_lose_the_gyroscopic_term_in_maximal_coordinates() -> None:
    """The limit is on the determinant, 2.2e-16 kg^3 m^6, here 6e-6 kg m^2 cubed."""
    start = State(NO_TURN, np.array([1.0, 2.0, 3.0]), np.zeros(3), np.zeros(3))
    for size, kept in ((6.1e-6, True), (6.0e-6, False)):
        moments = size * np.array([0.8, 1.0, 1.25])
        of = System((Body(np.array(1.0), np.zeros(3), np.diag(moments)),), Load())
        found = pybullet(of).run(start, "maximal", STEP, 1, 1).state[-1].angular_velocity
        assert (norm(found - start.angular_velocity) > 1e-3) == kept


def test_as_shipped_a_multibody_loses_its_energy_and_maximal_coordinates_do_not() -> None:
    of = System((Body(np.array(1.0), np.zeros(3), np.eye(3)),), Load())
    start = State(NO_TURN, np.array([1.0, 0.0, 0.0]), np.zeros(3), np.zeros(3))
    spins = {
        (kind, setup): float(
            pybullet(of, setup).run(start, kind, STEP, 1, 1).state[-1].angular_velocity[0]
        )
        for kind in ("multibody", "maximal")
        for setup in ("physics", "as-shipped")
    }
    # k (1 + |omega|) omega, and 0.04 in single precision
    assert abs(1.0 - spins.pop(("multibody", "as-shipped")) - 0.08 * STEP) <= 0.08 * STEP * 2.0**-23
    assert all(abs(spin - 1.0) <= 4 * EPS for spin in spins.values())


def test_each_setting_is_mended_alone() -> None:
    """Of these angularDamping alone keeps the omega of a sphere."""
    of = System((Body(np.array(1.0), np.zeros(3), np.eye(3)),), Load())
    start = State(NO_TURN, np.array([1.0, 0.0, 0.0]), np.zeros(3), np.zeros(3))
    for own in pybullet(of, "as-shipped").description.settings:
        end = pybullet(of, f"as-shipped+{own}").run(start, "multibody", STEP, 1, 1).state[-1]
        kept = abs(float(end.angular_velocity[0]) - 1.0) <= 4 * EPS
        assert kept == (own == "angularDamping")


def test_as_shipped_a_motor_stops_a_pivoted_body() -> None:
    sphere = Body(np.array(1.0), np.zeros(3), np.eye(3))
    of, spin = System((sphere,), Load(pivot=np.zeros(3))), np.array([1.0, 0.0, 0.0])
    start = State(NO_TURN, spin, np.zeros(3), np.zeros(3))
    for setup, expected in (("physics", spin), ("as-shipped", np.zeros(3))):
        found = pybullet(of, setup).run(start, "multibody", STEP, 1, 1).state[-1]
        assert norm(found.angular_velocity - expected) <= FEW * EPS


def test_as_shipped_velocities_of_a_multibody_are_cut_to_100() -> None:
    of = System((Body(np.array(1.0), np.zeros(3), np.eye(3)),), Load())
    fast = np.array([150.0, 0.0, 0.0])
    start = State(NO_TURN, fast, np.zeros(3), fast)
    for setup, expected in (("physics", 150.0), ("as-shipped", 100.0)):
        end = pybullet(of, setup).run(start, "multibody", 0.001, 1, 1).state[-1]
        found = end.angular_velocity[0], end.linear_velocity[0]
        assert np.allclose(found, expected, rtol=FEW * EPS, atol=0)


@pytest.mark.parametrize("kind", ["multibody", "maximal"])
def test_a_turn_of_45_degrees_in_a_step_is_refused(kind: str) -> None:
    of = System((Body(np.array(1.0), np.zeros(3), np.diag([1.0, 2.0, 2.8])),), Load())
    limit = np.pi / 4 / STEP
    for part, refused in ((0.999, False), (1.001, True)):
        start = State(NO_TURN, np.array([part * limit, 0.0, 0.0]), np.zeros(3), np.zeros(3))
        adapter = pybullet(of)
        if refused:
            with pytest.raises(UnsupportedError, match="beyond 45 degrees in a step"):
                adapter.run(start, kind, STEP, 3, 3)
        else:
            found = adapter.run(start, kind, STEP, 1, 1).state[-1]
            exact = exp_quaternion(STEP * start.angular_velocity)
            assert attitude_angle(found.orientation, exact) <= FEW * EPS


@pytest.mark.parametrize("inertia", sorted(INERTIAS))
@pytest.mark.parametrize("load", ["none", "pivot"])
def test_the_model_reads_back(inertia: str, load: str) -> None:
    of = system(inertia, load)
    (found,) = pybullet(of).model()
    size = float(np.max(np.abs(of.body.inertia)))
    assert found.mass == of.body.mass
    assert norm(found.center_of_mass - of.body.center_of_mass) <= 4 * EPS * (
        norm(OFFSET) + norm(PIVOT)
    )
    assert np.max(np.abs(found.inertia - of.body.inertia)) <= FEW * EPS * size


@pytest.mark.parametrize("load", ["none", "pivot"])
def test_states_come_back_as_they_went_in(load: str) -> None:
    of = system(load=load)
    adapter, many = pybullet(of), place_on_pivot(of, states(20, seed=1))
    for row in range(20):
        adapter.set_state(at(many, row))
        assert apart(adapter.get_state(), at(many, row)) <= FEW * EPS


def test_inverse_dynamics_is_the_equation() -> None:
    for load in FREE:
        of, many = system("full", load), states(12, seed=4, fast=2.0)
        wanted = Acceleration(*np.random.default_rng(5).normal(size=(2, 12, 3)))
        found = pybullet(of).inverse_dynamics(many, wanted)
        expected = inverse_dynamics(of, many, wanted)
        assert np.all(norm(found - expected) <= FEW * EPS * np.maximum(1.0, norm(expected)))


def test_what_is_not_there_is_refused() -> None:
    free, held = system(), system(load="pivot")
    start = a_start(free)
    with pytest.raises(UnsupportedError, match="no-such"):
        pybullet(free).run(start, "no-such", STEP, 1, 1)
    with pytest.raises(UnsupportedError, match="its omega alone"):
        pybullet(system(load="damping"))
    with pytest.raises(UnsupportedError, match="maximal"):
        pybullet(held).run(a_start(held), "maximal", STEP, 1, 1)
    one = State(*(np.array(v)[None] for v in vars(a_start(held)).values()))
    with pytest.raises(UnsupportedError, match="pivoted"):
        pybullet(held).inverse_dynamics(one, Acceleration(*np.zeros((2, 1, 3))))
    with pytest.raises(UnsupportedError, match="omega-dot"):
        pybullet(free).forward_dynamics(one)
    with pytest.raises(UnsupportedError, match="one body"):
        pybullet(System((free.body, free.body), LOADS["none"]))


@pytest.mark.parametrize("kind", ["multibody", "maximal"])
def test_a_run_does_not_depend_on_earlier_calls_and_logs_what_is_asked(kind: str) -> None:
    of = system("full", "torque_body")
    adapter, start = pybullet(of), a_start(of)
    before = adapter.run(start, kind, STEP, 7, 3)
    adapter.run(at(states(1, seed=3), 0), "maximal", 0.003, 3, 1)
    adapter.set_state(at(states(1, seed=4), 0))
    after = adapter.run(start, kind, STEP, 7, 3)
    assert np.array_equal(before.time, np.array([0, 3, 6, 7]) * STEP)
    for one, other in zip(vars(before.state).values(), vars(after.state).values(), strict=True):
        assert np.array_equal(one, other)
    assert apart(before.state[0], start) <= FEW * EPS
    assert np.array_equal(adapter.run(start, kind, STEP, 0, 1).time, [0.0])


@pytest.mark.parametrize("kind", ["multibody", "maximal"])
@pytest.mark.parametrize("spin", [np.nan, 1e200])
def test_what_is_not_finite_comes_back_as_nan(kind: str, spin: float) -> None:
    broken = State(NO_TURN, np.array([1.0, spin, 0.0]), np.zeros(3), np.zeros(3))
    adapter = pybullet(system())
    found = adapter.run(broken, kind, STEP, 4, 2).state
    assert np.all(np.isnan(found.angular_velocity[1:]).any(axis=-1))
    assert np.all(np.isfinite(adapter.run(a_start(system()), kind, STEP, 4, 2).state.position))


def test_a_look_at_every_step_is_taken_where_a_turn_may_be_cut(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    looks: list[bool] = []
    steps = stepping._steps

    def noted(*arguments: Any, looking: bool) -> Any:
        looks.append(looking)
        return steps(*arguments, looking=looking)

    monkeypatch.setattr(stepping, "_steps", noted)
    of = system("full")
    for step, expected in ((1e-3, [False]), (0.1, [False, True])):
        looks.clear()
        pybullet(of).run(a_start(of), "multibody", step, 2, 2)
        assert looks == expected


def test_it_describes_itself() -> None:
    own = PyBulletAdapter().description
    assert isinstance(PyBulletAdapter(), Adapter)
    assert {i.name for i in own.integrators} == {"multibody", "maximal"}
    assert own.version
    assert own.licence
    assert own.switched_off
    assert not PyBulletAdapter("as-shipped").description.switched_off
    native = PyBulletAdapter().native()
    assert native["conventions"]["quaternion order"] == "x, y, z, w"
    assert native["conventions"]["multibody angular velocity frame"] == "world axes"
    assert native["conventions"]["maximal linear velocity frame"] == "world axes"
    assert native["defaults"]["physics engine numSolverIterations"] == "50"


def test_worlds_are_given_back() -> None:
    """PyBullet has room for a thousand; no engine of this file has kept one."""
    numbers = {PyBulletAdapter()._clients["multibody"] for _ in range(3)}
    assert len(numbers) <= 2
    assert isinstance(pybullet(system())._loaded(), PyBulletJoint)
