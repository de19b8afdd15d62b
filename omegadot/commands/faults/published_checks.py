"""The published checks: MuJoCo's, DART's, Drake's and Newton's of a free body."""

from __future__ import annotations

import numpy as np
from numpy.random import Generator

from omegadot.adapters.protocol import Adapter, Integrator
from omegadot.commands.faults.published import NONE, Published, attitude, free_body, see
from omegadot.gates.bounds.scales import EPS, norm
from omegadot.reference_impl.cross_product import cross
from omegadot.reference_impl.motion import forward_dynamics
from omegadot.reference_impl.rotations import (
    attitude_angle,
    exp_quaternion,
    quaternion_product,
    rotate,
    rotate_inverse,
    rotation_matrix,
)
from omegadot.reference_impl.solutions.exact_solution import exact_states
from omegadot.reference_impl.system import Array, State

EULERS = ("semi-implicit-euler", "semi-implicit-euler-short-turns")
FOURTH = ("rk4-quaternion", "munthe-kaas-rk4", "lie-rk4")


def _within(value: Array, bound: float) -> bool:
    """Whether all of it is; NaN is not."""
    return bool(np.all(np.abs(value) < bound))


def _box_axes() -> Array:
    """Turns by 10, 20 and 30 degrees about x, y and z of the body."""
    turns = np.deg2rad(np.diag([10.0, 20.0, 30.0]))
    x, y, z = (exp_quaternion(turn) for turn in turns)
    return rotation_matrix(quaternion_product(quaternion_product(x, y), z))


def mujoco_free_body(adapter: Adapter, integrator: Integrator, random: Generator) -> bool:
    """Energy never above ``1 + 1e-9`` of its start nor below 0.7, momentum within 0.05."""
    w, axes = np.array([1.0, 2.0, 3.0]), _box_axes()
    box = np.diag([0.13, 0.10, 0.05]) / 3  # half-sizes 0.1, 0.2, 0.3 m, 1 kg
    turned = free_body(1.0, axes @ box @ axes.T, np.array([0.03, 0.02, 0.01]))
    for system in (free_body(1.0, box), turned):
        q = attitude(random)
        v = rotate(q, cross(w, system.body.center_of_mass))  # the body's origin is at rest
        seen = see(adapter, system, State(q, w, NONE, v), integrator, 0.01, 500)
        energy, moment = seen.energy / seen.energy[0], seen.angular
        keeps = bool(np.all(energy < 1 + 1e-9)) and energy[-1] > 0.7
        if not (keeps and norm(moment[-1] - moment[0]) < 0.05):
            return True
    return False


def _dart_conserves(adapter: Adapter, integrator: Integrator, random: Generator) -> bool:
    spin, slide = np.array([0.5, -0.3, 0.4]), np.array([0.6, -0.4, 0.2])
    system = free_body(2.0, np.diag([0.1, 0.2, 0.3]))
    for w, v in ((0 * spin, slide), (spin, 0 * slide), (spin, slide)):
        q, x = attitude(random), random.uniform(-1.0, 1.0, 3)
        initial = State(q, rotate_inverse(q, w), x, v)
        seen = see(adapter, system, initial, integrator, 1e-4, 500)
        energy, linear = seen.energy, seen.linear
        about_origin = seen.angular + cross(seen.trajectory.state.position, linear)
        moment = np.concatenate([about_origin, linear], axis=-1)
        keeps = _within((energy - energy[0]) / max(1.0, energy[0]), 1e-3)
        if not (keeps and _within((moment - moment[0]) / max(1.0, norm(moment[0])), 1e-3)):
            return False
    return True


def _dart_sphere_turns_evenly(adapter: Adapter, integrator: Integrator, random: Generator) -> bool:
    w, v = np.array([0.4, -0.3, 0.25]), np.array([0.5, -0.4, 0.2])
    system, q, x = free_body(2.0, 0.2 * np.eye(3)), attitude(random), random.uniform(-1.0, 1.0, 3)
    seen = see(adapter, system, State(q, rotate_inverse(q, w), x, v), integrator, 1e-3, 1000)
    last = State(*(values[-1] for values in vars(seen.trajectory.state).values()))
    expected = rotation_matrix(quaternion_product(exp_quaternion(w), q))
    return (
        _within(rotate(last.orientation, last.angular_velocity) - w, 1e-10)
        and _within(last.linear_velocity - v, 1e-10)
        and _within(rotation_matrix(last.orientation) - expected, 1e-7)
        and _within(last.position - x - v, 1e-7)
        and _within((seen.energy[-1] - seen.energy[0]) / max(1.0, seen.energy[0]), 1e-6)
    )


def dart_free_joint(adapter: Adapter, integrator: Integrator, random: Generator) -> bool:
    """Energy and momentum within 1e-3 over 0.05 s; a sphere's twist within 1e-10 over 1 s."""
    how = (adapter, integrator, random)
    return not (_dart_conserves(*how) and _dart_sphere_turns_evenly(*how))


def drake_free_body(adapter: Adapter, integrator: Integrator, random: Generator) -> bool:
    """The exact motion of a cylinder: 32 eps at the start, up to 1 by the end of 10 s."""
    system = free_body(1.0, np.diag([0.04, 0.04, 0.02]), gravity=np.array([0.0, 0.0, -9.81]))
    q, w = attitude(random), np.array([2.0, 4.0, 6.0])
    initial = State(q, w, np.array([1.0, 2.0, 3.0]), rotate(q, np.array([-4.2, 5.5, 6.1])))
    rate = float(norm(system.body.inertia @ w)) / 0.04
    h = 2 * np.pi / rate / 16
    seen = see(adapter, system, initial, integrator, h, int(10.0 / h))
    time, state = seen.trajectory.time, seen.trajectory.state
    if not np.all(np.isfinite(state.angular_velocity)):
        return True
    adapter.set_state(initial)
    first, at_start = _rows(initial), 32 * EPS
    exact, found = forward_dynamics(system, first), adapter.forward_dynamics(first)
    if not (
        _near(_rows(adapter.get_state()), first, np.array([at_start]))
        and _within(found.angular - exact.angular, 8 * at_start)
        and _within(found.linear - exact.linear, 8 * at_start)
    ):
        return True
    _, true = exact_states(system, initial, time) if len(time) else ("", state)
    tolerance = 1e-3 * (1.0 + 4 * 256 * time / 10.0)
    omega_dot = adapter.forward_dynamics(state).angular
    off = np.max(np.abs(omega_dot - forward_dynamics(system, true).angular), axis=-1)
    return not (_near(state, true, tolerance) and bool(np.all(off <= 8 * tolerance)))


def _rows(state: State) -> State:
    return State(*(values[None] for values in vars(state).values()))


def _near(state: State, true: State, tolerance: Array) -> bool:
    """Rotation, position and velocity within the tolerance by component, omega within twice it."""
    turned = rotation_matrix(state.orientation) - rotation_matrix(true.orientation)
    pairs = (
        (turned.reshape(len(turned), 9), 1.0),
        (state.angular_velocity - true.angular_velocity, 2.0),
        (state.position - true.position, 1.0),
        (state.linear_velocity - true.linear_velocity, 1.0),
    )
    return all(
        bool(np.all(np.max(np.abs(gap), axis=-1) <= factor * tolerance)) for gap, factor in pairs
    )


def newton_torque_free(adapter: Adapter, integrator: Integrator, random: Generator) -> bool:
    """Momentum within 0.5 % over 0.2 s, and the body turns by more than 0.1 rad."""
    system, q = free_body(1.0, np.diag([0.2, 0.5, 0.4])), attitude(random)
    seen = see(
        adapter, system, State(q, np.array([0.7, -0.5, 0.9]), NONE, NONE), integrator, 0.01, 20
    )
    moment, turned = seen.angular, seen.trajectory.state.orientation
    drift = float(norm(moment[-1] - moment[0]) / norm(moment[0]))
    return not (drift < 5e-3 and float(attitude_angle(turned[0], turned[-1])) > 0.1)


PUBLISHED = (
    Published(
        "MuJoCo",
        "energy below (1 + 1e-9) of its start at every step and above 0.7 at the end, |H| within "
        "0.05 kg m^2/s; a box of 1 kg, omega = (1, 2, 3), 500 steps of 0.01 s, implicitfast",
        "google-deepmind/mujoco test/engine/engine_forward_test.cc, FreeBodyConservation",
        frozenset(
            {"free", "asymmetric", "full-inertia", "offset", "torque-free", "tumbling", "fast"}
        ),
        ("linearly-implicit-euler",),
        mujoco_free_body,
    ),
    Published(
        "DART",
        "energy and momentum within 1e-3 over 500 steps of 1e-4 s, |omega| = 0.7; a sphere's twist "
        "within 1e-10, its pose within 1e-7, its energy within 1e-6 over 1000 steps of 1e-3 s",
        "dartsim/dart tests/integration/dynamics/test_joints.cpp, FreeJointEnergyConservation"
        "NoForces and FreeJointSphericalInertiaConstantWorldTwistLongHorizon",
        frozenset({"free", "asymmetric", "torque-free", "tumbling"}),
        EULERS,
        dart_free_joint,
    ),
    Published(
        "Drake",
        "state and accelerations within 32 and 256 eps at the start; then rotation, position and "
        "velocity within (1 + 1024 t/T) 1e-3, omega twice, accelerations 8 times that, T = 10 s; a "
        "cylinder of 0.04, 0.04 and 0.02 kg m^2, omega = (2, 4, 6), 16 steps a turn",
        "RobotLocomotion/drake multibody/benchmarks/free_body/test/multibody_plant_free_body_test"
        ".cc, testNumericalIntegration",
        frozenset({"free", "torque-free", "tumbling", "gravity", "fast", "order-4"}),
        FOURTH,
        drake_free_body,
    ),
    Published(
        "Newton",
        "momentum within 0.5 % over 20 steps of 0.01 s, and a turn of more than 0.1 rad; moments "
        "0.2, 0.5, 0.4, omega = (0.7, -0.5, 0.9)",
        "newton-physics/newton newton/tests/test_physics_verification.py, "
        "test_torque_free_precession",
        frozenset({"free", "asymmetric", "torque-free", "tumbling", "fast"}),
        EULERS,
        newton_torque_free,
    ),
)
