"""What must not matter to a scheme: the frame, the names of the axes, the units, a steady wind."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from reference_cases import EPS, one_step, quaternions, rows, start, states, system, systems

from omegadot.reference_impl.kinematics import place_on_pivot
from omegadot.reference_impl.rotations import (
    attitude_angle,
    conjugate,
    exp_quaternion,
    quaternion_product,
    rotate,
    rotate_inverse,
    rotation_matrix,
)
from omegadot.reference_impl.schemes import SCHEMES
from omegadot.reference_impl.schemes.charted import TABLEAUS
from omegadot.reference_impl.schemes.tableaus import EULER
from omegadot.reference_impl.stepping import step_body
from omegadot.reference_impl.system import Array, Body, Load, State, System

pytestmark = pytest.mark.no_cover  # its lines are covered by others

few = settings(max_examples=6, derandomize=True, deadline=None)
every_scheme = pytest.mark.parametrize("name", sorted(SCHEMES))
# Angles and modified Rodrigues parameters are of axes: in others they are no linear function.
OF_AXES = {n for n in SCHEMES if n.endswith(("-roll-pitch-yaw", "-two-frames-xyz", "-mrp"))}
of_no_axes = pytest.mark.parametrize("name", sorted(set(SCHEMES) - OF_AXES))
STEPS, DT = 5, 2.0**-7


def run(name: str, on: System, initial: State, dt: float = DT) -> State:
    states = step_body(SCHEMES[name], on, place_on_pivot(on, initial), dt, STEPS, STEPS)[1]
    return rows(states, -1)


def rounding(on: System) -> float:
    """Some forty roundings a step, each magnified by at most the inertia's condition number.

    The inertia about the pivot counts, and loads and states of size three: |v|² is below 27 for
    the vectors drawn, and enters through ``ω × I ω`` and the weight's torque.
    """
    moments = np.linalg.eigvalsh(on.body.inertia)
    arm = 0 if on.load.pivot is None else 27 * 4 * float(on.body.mass)
    return float(40 * STEPS * EPS * 27 * (moments[2] + arm + 27) / moments[0])


@of_no_axes
@few
@given(systems(), states(), quaternions)
def test_a_turned_world_turns_the_motion(name: str, on: System, state: State, q: Array) -> None:
    body, load = on.body, on.load
    elsewhere = System(
        (body,),
        Load(
            rotate(q, load.gravity),
            load.pivot,
            load.damping,
            load.torque_body,
            rotate(q, load.torque_world),
        ),
    )
    moved = State(
        quaternion_product(q, state.orientation),
        state.angular_velocity,
        rotate(q, state.position),
        rotate(q, state.linear_velocity),
    )
    here, there = run(name, on, state), run(name, elsewhere, moved)
    bound = rounding(on)
    assert np.max(np.abs(here.angular_velocity - there.angular_velocity)) <= bound
    assert attitude_angle(quaternion_product(q, here.orientation), there.orientation) <= bound
    assert np.max(np.abs(rotate(q, here.position) - there.position)) <= bound
    assert np.max(np.abs(rotate(q, here.linear_velocity) - there.linear_velocity)) <= bound


@of_no_axes
@few
@given(systems(), states(), quaternions)
def test_other_body_axes_describe_the_same_motion(
    name: str, on: System, state: State, b: Array
) -> None:
    # new body axes: old_R_new = R(b); relabelled axes are among these turns
    body, load, R = on.body, on.load, rotation_matrix(b)
    inertia = R.T @ body.inertia @ R
    renamed = System(
        (Body(body.mass, rotate_inverse(b, body.center_of_mass), (inertia + inertia.T) / 2),),
        Load(
            load.gravity,
            None if load.pivot is None else rotate_inverse(b, load.pivot),
            load.damping,
            rotate_inverse(b, load.torque_body),
            load.torque_world,
        ),
    )
    same = State(
        quaternion_product(state.orientation, b),
        rotate_inverse(b, state.angular_velocity),
        state.position,
        state.linear_velocity,
    )
    here, there = run(name, on, state), run(name, renamed, same)
    bound = rounding(on)
    back = quaternion_product(there.orientation, conjugate(b))
    assert np.max(np.abs(here.angular_velocity - rotate(b, there.angular_velocity))) <= bound
    assert attitude_angle(here.orientation, back) <= bound
    assert np.max(np.abs(here.position - there.position)) <= bound


@pytest.mark.parametrize("name", sorted(OF_AXES))
def test_a_turned_world_is_another_step_where_numbers_are_of_its_axes(name: str) -> None:
    """Else these would be the same scheme as one that is left in the tests above."""
    on, state = system([1.0, 2.0, 2.5]), start([1.0, 2.0, -1.5], [4, 1, 1, 1])
    q = exp_quaternion(np.array([0.2, 0.1, -0.3]))
    moved = replace(state, orientation=quaternion_product(q, state.orientation))
    here, there = (run(name, on, one, 0.1) for one in (state, moved))
    apart = attitude_angle(quaternion_product(q, here.orientation), there.orientation)
    assert apart > 1e3 * rounding(on)


TURN_VELOCITIES = {"body-axes-midpoint", *(n for n in SCHEMES if n.endswith("-world-spatial"))}


@pytest.mark.parametrize("name", sorted(set(SCHEMES) - TURN_VELOCITIES))
@few
@given(systems(pivoted=False), states())
def test_a_steady_wind_carries_the_body_along(name: str, on: System, state: State) -> None:
    wind = np.array([0.5, -2.0, 1.25])
    carried = State(
        state.orientation,
        state.angular_velocity,
        state.position,
        state.linear_velocity + wind,
    )
    here, there = run(name, on, state), run(name, on, carried)
    assert np.array_equal(here.angular_velocity, there.angular_velocity)
    assert np.array_equal(here.orientation, there.orientation)
    bound = 8 * STEPS * EPS * 10
    assert np.max(np.abs(there.linear_velocity - here.linear_velocity - wind)) <= bound
    assert np.max(np.abs(there.position - here.position - STEPS * DT * wind)) <= bound


@every_scheme
@few
@given(systems(), states(), st.tuples(*[st.integers(-6, 6)] * 3))
def test_units_that_are_powers_of_two_change_no_digit(
    name: str, on: System, state: State, powers: tuple[int, int, int]
) -> None:
    # Exact: scaling by a power of two commutes with every rounding, so that a bare constant with
    # a unit hidden anywhere in a scheme shows.
    metre, second, kilogram = (2.0**p for p in powers)
    body, load = on.body, on.load
    moment, torque = kilogram * metre**2, kilogram * metre**2 / second**2
    scaled = System(
        (Body(kilogram * body.mass, metre * body.center_of_mass, moment * body.inertia),),
        Load(
            metre / second**2 * load.gravity,
            None if load.pivot is None else metre * load.pivot,
            moment / second * load.damping,
            torque * load.torque_body,
            torque * load.torque_world,
        ),
    )
    same = State(
        state.orientation,
        state.angular_velocity / second,
        metre * state.position,
        metre / second * state.linear_velocity,
    )
    if not np.any(state.angular_velocity):
        return  # at rest the Jacobian's differences take one rad/s, whatever the unit
    here, there = run(name, on, state), run(name, scaled, same, second * DT)
    assert np.array_equal(here.orientation, there.orientation)
    assert np.array_equal(here.angular_velocity, second * there.angular_velocity)
    assert np.array_equal(metre * here.position, there.position)
    assert np.array_equal(metre * here.linear_velocity, second * there.linear_velocity)


@few
@given(systems(), states())
def test_midpoint_runs_backwards(on: System, state: State) -> None:
    state = place_on_pivot(on, state)
    end = run("implicit-midpoint", on, state)
    back = run("implicit-midpoint", on, end, -DT)
    bound = rounding(on)
    assert attitude_angle(back.orientation, state.orientation) <= bound
    assert np.max(np.abs(back.angular_velocity - state.angular_velocity)) <= bound
    assert np.max(np.abs(back.position - state.position)) <= bound
    assert np.max(np.abs(back.linear_velocity - state.linear_velocity)) <= bound


@every_scheme
def test_a_steady_spin_is_exact_in_attitude_where_it_can_be(name: str) -> None:
    on = system([1.0, 2.0, 2.5])
    end = run(name, on, start([0.0, 3.0, 0.0]), 0.05)
    # three angles carry omega by a matrix of sines and cosines
    allowed = STEPS * 3.0 * EPS if name.endswith("-roll-pitch-yaw") else 0.0
    assert np.max(np.abs(end.angular_velocity - [0.0, 3.0, 0.0])) <= allowed
    turned = attitude_angle(end.orientation, exp_quaternion(np.array([0.0, 0.75, 0.0])))
    turn = 3.0 * 0.05
    # Cayley turns by 2 atan(x/2) in place of x, RK4 on the quaternion errs by (x/2)^5/120 in half
    # the angle, a step; exponentials do not err
    error = {
        "implicit-midpoint": turn**3 / 12,
        "semi-implicit-euler-rescaled-momentum-four-substeps": 4 * (turn / 4) ** 3 / 12,
        "rk4-quaternion": 2 * (turn / 2) ** 5 / 120,
    }
    assert turned <= STEPS * (1.05 * error.get(name, of_numbers(name, turn)) + 4 * EPS)


def of_numbers(name: str, turn: float) -> float:
    """The error of a step's turn about one axis, of a scheme on a chart of the attitude.

    Angles are linear in time there. A quaternion is ``exp(i t/2)``, and modified Rodrigues
    parameters are ``tan(t/4)``, of a turn t, which the methods step on lines of these two.
    """
    method = next((one for n, one in TABLEAUS.items() if name.startswith(f"{n}-")), EULER)
    if name.endswith(("-world-quaternion", "-world-spatial")):
        parts = np.array([1.0, 0.0])

        def turning(y: Array) -> Array:
            return 0.5 * np.array([-y[1], y[0]])

        end = method.step(turning, parts, turning(parts), turn)
        return abs(2 * float(np.arctan2(end[1], end[0])) - turn)
    if name.endswith("-mrp"):

        def growing(y: Array) -> Array:
            return 0.25 * (1 + y * y)

        starts = np.tan(turn * np.arange(STEPS) / 4)
        end = method.step(growing, starts, growing(starts), turn)
        return float(np.max(np.abs(4 * (np.arctan(end) - np.arctan(starts)) - turn)))
    return 0.0


@every_scheme
def test_extended_precision_is_kept(name: str) -> None:
    on = system([1.0, 2.0, 2.5])
    long = State(*(f.astype(np.longdouble) for f in vars(start([1.0, 2.0, 3.0])).values()))
    end = one_step(SCHEMES[name], on, long, np.longdouble("0.01"))
    assert all(field.dtype == np.longdouble for field in vars(end).values())
    short = one_step(SCHEMES[name], on, start([1.0, 2.0, 3.0]), 0.01)
    difference = np.abs(end.angular_velocity - short.angular_velocity)
    assert np.max(difference) <= 64 * EPS
    if np.finfo(np.longdouble).eps < EPS:
        assert np.any(difference > 0)
