"""What Exudyn's solvers step, and what of Exudyn is not as a reader may expect."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from mujoco_cases import EPS, PIVOT, at, norm, states, system

from omegadot.adapters.exudyn.adapter import ExudynAdapter
from omegadot.adapters.exudyn.axes import Axes
from omegadot.adapters.exudyn.integrators import PLANS
from omegadot.adapters.exudyn.joint import ExudynJoint
from omegadot.adapters.exudyn.model import ExudynModel
from omegadot.adapters.exudyn.nodes import NODES
from omegadot.adapters.exudyn.two_axes import is_exchanged
from omegadot.gates.bounds.scales import body_scale, omega_dot_bound, torque_size
from omegadot.reference_impl.kinematics import at_point, place_on_pivot
from omegadot.reference_impl.motion import forward_dynamics
from omegadot.reference_impl.rotations import attitude_angle, exp_quaternion, turn_in_body
from omegadot.reference_impl.schemes import SCHEMES
from omegadot.reference_impl.stepping import step_body
from omegadot.reference_impl.system import Acceleration, Array, Body, Load, State, System

pytest.importorskip("exudyn")

STEP, STEPS = 0.01, 20
# A step of a dozen operations, of rates that a step may double: the runs last 0.2 s.
SAME = 64 * EPS * STEPS
NO_TURN = np.array([1.0, 0.0, 0.0, 0.0])


def exudyn(of: System, setup: Any = "physics") -> ExudynAdapter:
    adapter = ExudynAdapter(setup)
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


@pytest.mark.parametrize("load", ["none", "all"])
def test_rk44_is_the_method_of_munthe_kaas(load: str) -> None:
    of = system("full", load)
    start, scheme = a_start(of), SCHEMES["munthe-kaas-rk4"]
    _, expected = step_body(scheme, of, start, STEP, STEPS, STEPS, coordinates="origin-world")
    found = exudyn(of).run(start, "RK44", STEP, STEPS, STEPS).state[-1]
    assert apart(found, expected[-1]) <= SAME


def moved(of: System, state: State, spin: Array, velocity: Array, h: float) -> State:
    """A step of the origin's place and of the attitude, by these velocities of the origin."""
    origin = at_point(state, -of.body.center_of_mass)
    q = turn_in_body(state.orientation, spin, h)
    return State(q, spin, origin.position + h * velocity, velocity)


@pytest.mark.parametrize("load", ["none", "all"])
def test_explicit_euler_turns_by_the_omega_before(load: str) -> None:
    of = system("full", load)
    start = a_start(of)
    origin = at_point(start, -of.body.center_of_mass)
    place = moved(of, start, start.angular_velocity, origin.linear_velocity, STEP)
    spin = start.angular_velocity + STEP * forward_dynamics(of, start).angular
    found = exudyn(of).run(start, "ExplicitEuler", STEP, 1, 1).state[-1]
    assert attitude_angle(found.orientation, place.orientation) <= SAME
    assert norm(found.angular_velocity - spin) <= SAME
    assert norm(at_point(found, -of.body.center_of_mass).position - place.position) <= SAME


def test_velocity_verlet_takes_omega_dot_of_half_a_step_before() -> None:
    """So that it is of order 1 where forces depend on velocities, as the gyroscopic torque does."""
    of = system("full", center=np.zeros(3))
    start = a_start(of)
    first = start.angular_velocity + 0.5 * STEP * forward_dynamics(of, start).angular
    turned = turn_in_body(start.orientation, first, STEP)
    half = State(turned, first, start.position, start.linear_velocity)
    spin = first + 0.5 * STEP * forward_dynamics(of, half).angular
    found = exudyn(of).run(start, "VelocityVerlet", STEP, 1, 1).state[-1]
    assert norm(found.angular_velocity - spin) <= SAME
    assert attitude_angle(found.orientation, turned) <= SAME


@pytest.mark.parametrize("name", sorted(set(PLANS) - {"RK44-Rxyz"}))
def test_axes_that_are_exchanged_change_rounding_alone(name: str) -> None:
    """Three angles are left out: they are other coordinates there, with other errors."""
    of = system("full", "all")
    start, plan = a_start(of), PLANS[name]
    accuracy = None if plan.fixed else 1e-9
    one, other = (exudyn(of, setup) for setup in ("physics", "as-shipped"))
    other._axes = Axes(turned=False)
    other._setup = "physics"
    other.load(of)
    found = [a.run(start, name, STEP, STEPS, STEPS, accuracy).state[-1] for a in (one, other)]
    # an estimate of the error takes coordinates one by one
    assert apart(*found) <= (SAME if plan.fixed and plan.explicit else 1e-9)


def turn_lost(setup: Any) -> float:
    """The error of an attitude after a turn of 1e-6 rad, in parts of it."""
    of = System((Body(np.array(1.0), np.zeros(3), np.eye(3)),), Load())
    spin = np.array([1.0, 2.0, 2.0]) / 3
    start = State(NO_TURN, spin, np.zeros(3), np.zeros(3))
    found = exudyn(of, setup).run(start, "RK44", 1e-6, 1, 1).state[-1]
    return float(attitude_angle(found.orientation, exp_quaternion(1e-6 * spin))) / 1e-6


def test_a_turn_near_none_loses_its_digits_in_the_axes_as_shipped() -> None:
    """The angle comes from its cosine, which is 1 - 5e-13 there, and known to eps."""
    assert turn_lost("physics") <= 64 * EPS / 1e-6
    assert turn_lost("as-shipped") > 1e-6


def test_explicit_solvers_turn_a_pivoted_body_as_a_free_one() -> None:
    """As their page has it: they are for systems without constraints."""
    of, free = system("full", "pivot_gravity"), system("full", "gravity")
    start = a_start(of)
    found = exudyn(of).run(start, "ExplicitEuler", STEP, 1, 1).state[-1]
    rate = (found.angular_velocity - start.angular_velocity) / STEP
    assert norm(rate - forward_dynamics(free, start).angular) <= SAME / STEP
    assert norm(rate - forward_dynamics(of, start).angular) > 1.0


def test_rounding_leaves_the_pivot_of_a_heavy_body_where_it_is(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Equations of the size of one are no pivots of a solver beside forces of 3e5 kg."""
    heavy = Body(np.array(305991.51), np.zeros(3), np.diag([1272.9316, 1272.9316, 1904.222]))
    pivot = np.array([-0.0094898, -0.0385959, -0.0314486])
    of = System((heavy,), Load(pivot=pivot, torque_world=np.array([0.0, -0.02, 0.0])))
    many = place_on_pivot(of, states(40, seed=3, fast=0.01))

    def moving() -> float:
        joint = exudyn(of)._joint
        found = []
        for row in range(40):
            joint.forward(at(many, row))
            held = joint.model.mbs.systemData.GetODE2Coordinates_tt()[:3]
            found.append(float(norm(np.array(held))))
        return max(found)

    assert moving() == 0.0
    monkeypatch.setattr(ExudynModel, "_constraint_factor", lambda _: 1.0)
    assert moving() > 0.0


def test_a_small_body_on_a_pivot_keeps_every_digit_of_omega_dot() -> None:
    """Caught: a dense solver, which begins with the forces and reaches most of the bound."""
    small = Body(np.array(5.46e-4), np.array([2.8e-4, 4.0e-4, 1.6e-4]), np.diag([1.4e-9] * 3))
    pivot = np.array([-1.4e-4, 4.6e-4, -3.3e-4])
    of = System((small,), Load(pivot=pivot, gravity=np.array([0.0, 4600.0, 0.0])))
    many = place_on_pivot(of, states(100, seed=4, fast=900.0))
    true, found = forward_dynamics(of, many), exudyn(of).forward_dynamics(many)
    apart = norm(found.angular - true.angular) * body_scale(of).largest
    assert np.max(apart / torque_size(of, many, true)) <= 0.2 * omega_dot_bound(of, EPS)


class OnASphericalJoint(ExudynModel):
    """A body on a joint away from its node, which is at the body's origin."""

    def _loads(self, driven: bool) -> None:
        items, mbs = self._items, self.mbs
        ground = mbs.AddObject(items.ObjectGround())
        points = ((ground, np.zeros(3)), (self.body, PIVOT))
        markers = [
            mbs.AddMarker(items.MarkerBodyPosition(bodyNumber=body, localPosition=place.tolist()))
            for body, place in points
        ]
        mbs.AddObject(items.ObjectJointSpherical(markerNumbers=markers))


def test_a_spherical_joint_has_wrong_accelerations_at_the_start() -> None:
    """At rest and at no turn they are right: a difference quotient has some eight digits."""
    of, free = system("full", "pivot"), system("full")
    engine = exudyn(free)._engine
    model = OnASphericalJoint(engine, free, "rotation-vector", Axes(turned=False))
    joint = ExudynJoint(engine, model, model)

    def off(q: Array, spin: Array) -> float:
        state = place_on_pivot(of, State(q, spin, np.zeros(3), np.zeros(3)))
        expected = forward_dynamics(of, state).angular
        return float(norm(joint.forward(state)[0] - expected))

    spin, turned = np.array([1.0, 2.0, 3.0]), exp_quaternion(np.array([0.5, -1.0, 1.0]))
    assert off(turned, np.zeros(3)) <= SAME
    assert off(NO_TURN, spin) <= 1e-6
    assert off(turned, spin) > 1e-2


def test_tolerances_with_signs_are_no_tolerances() -> None:
    """At x = -1 and equal tolerances the scale of an error is zero, and no step is rejected."""
    of = System((Body(np.array(1.0), np.zeros(3), np.diag([1.0, 2.0, 2.8])),), Load())
    place = np.array([-1.0, 0.0, 0.0])
    start = State(NO_TURN, np.array([1.0, 2.0, 3.0]), place, np.zeros(3))
    ends = [
        [exudyn(of, setup).run(start, "ODE23", 0.5, 1, 1, t).state[-1] for t in (1e-3, 1e-9)]
        for setup in ("physics", "as-shipped")
    ]
    assert apart(*ends[0]) > 1e-6
    assert apart(*ends[1]) == 0.0


def through_the_singularity(setup: Any, steps: int) -> tuple[float, float]:
    """Errors in rad and of omega after turns that go by the singularity at 0.003 rad, unchanged."""
    turning = np.array([0.003, 1.0, 0.0])
    start = State(NO_TURN, turning, np.zeros(3), np.zeros(3))
    sphere = System((Body(np.array(1.0), np.zeros(3), np.eye(3)),), Load())
    found = exudyn(sphere, setup).run(start, "RK44-Rxyz", 20.0 / steps, steps, steps).state[-1]
    off = attitude_angle(found.orientation, exp_quaternion(20.0 * turning))
    return float(off), float(norm(found.angular_velocity - turning))


def test_angles_take_other_axes_before_their_singularity() -> None:
    """Of order 4: half the step has a sixteenth of the error. In one axes there is no order."""
    coarse, fine = through_the_singularity("physics", 400), through_the_singularity("physics", 800)
    for one, half in zip(coarse, fine, strict=True):
        assert half < 1e-8
        assert 2**3.5 < one / half < 2**4.5
    assert np.isnan(through_the_singularity("as-shipped", 800)).all()


def test_a_run_in_two_axes_changes_them_both_ways_and_keeps_every_step() -> None:
    about_z = State(NO_TURN, np.array([0.0, 0.0, 1.0]), np.zeros(3), np.zeros(3))
    sphere = System((Body(np.array(1.0), np.zeros(3), np.eye(3)),), Load())
    found = exudyn(sphere).run(about_z, "RK44-Rxyz", 0.05, 130, 1)
    turns = 0.05 * np.arange(131)[:, None] * about_z.angular_velocity
    assert np.all(attitude_angle(found.state.orientation, exp_quaternion(turns)) <= 1e-6)
    exchanged = is_exchanged(found.state.orientation)
    assert np.count_nonzero(np.diff(exchanged)) == 4


@pytest.mark.parametrize("kind", sorted(NODES))
def test_coordinates_of_every_node_come_back(kind: Any) -> None:
    many = states(20, seed=1, far=1.0, fast=2.0)
    for row in range(20):
        state = at(many, row)
        given, rates = NODES[kind].given(state.orientation, state.angular_velocity)
        q, w = NODES[kind].read(given[None], rates[None])
        far = 1 / abs(np.cos(given[1])) if kind == "rxyz" else 1.0
        assert attitude_angle(q[0], state.orientation) <= 64 * EPS * far
        assert norm(w[0] - state.angular_velocity) <= 64 * EPS * far * norm(state.angular_velocity)


def test_a_run_that_overflows_ends_in_nan() -> None:
    fast = State(NO_TURN, np.full(3, 1e200), np.zeros(3), np.zeros(3))
    adapter = exudyn(system("full"))
    for name, plan in PLANS.items():
        found = adapter.run(fast, name, 1.0, 2, 1, None if plan.fixed else 1e-3).state
        assert not np.all(np.isfinite(found.angular_velocity[-1])), name


def test_it_describes_itself() -> None:
    own = ExudynAdapter().description
    assert {i.knob for i in own.integrators} == {"timestep", "accuracy", "fixed-accuracy"}
    assert all(i.note for i in own.integrators)
    assert own.switched_off
    assert not ExudynAdapter("as-shipped").description.switched_off
    native = ExudynAdapter().native()
    assert native["conventions"]["rotation vector's rate"] == "omega in body axes"
    assert native["defaults"]["timeIntegration generalizedAlpha.spectralRadius"] == "0.9"


def test_inverse_dynamics_leaves_gravity_out_and_damping_in() -> None:
    of, plain = system("full", "pivot_all"), system("full", "pivot_gravity")
    start = at(states(1, seed=2, fast=2.0), 0)
    one = State(*(np.array(v)[None] for v in vars(place_on_pivot(of, start)).values()))
    wanted = Acceleration(np.ones((1, 3)), np.zeros((1, 3)))
    loaded = exudyn(of).inverse_dynamics(one, wanted)
    assert np.array_equal(loaded, exudyn(plain).inverse_dynamics(one, wanted))
