"""MuJoCo's midpoint steps of 3.7 to 3.10: against their equations, solved by repetition."""

from __future__ import annotations

import numpy as np
import pytest
from reference_cases import EPS, one_step, rows, start, system, turned
from scipy.spatial.transform import Rotation

from omegadot.reference_impl.coordinates import to_coordinates
from omegadot.reference_impl.cross_product import skew
from omegadot.reference_impl.energy import total_energy
from omegadot.reference_impl.rotations import rotation_matrix
from omegadot.reference_impl.schemes import SCHEMES
from omegadot.reference_impl.stepping import step_body
from omegadot.reference_impl.system import Array, System

FROZEN, BODY_AXES = SCHEMES["frozen-torque-midpoint"], SCHEMES["body-axes-midpoint"]
H = 0.05
LOADS = {
    "free": {},
    "falls": {"gravity": (0, 1, -9)},
    "damped": {"gravity": (0, 1, -9), "damping": 0.3},
    "driven": {"gravity": (0, 1, -9), "torque_body": (1, 0, 2), "torque_world": (0, 2, 1)},
}
INITIAL = start([1.0, 2.0, -3.0], [1, 2, 3, 4], (1, 2, 3), (0.5, -1, 2))
few_loads = pytest.mark.parametrize("load", LOADS)


def body(load: str, center: tuple[float, float, float] = (0, 0, 0)) -> System:
    return system(turned([1, 2, 2.5]), mass=1.5, center=center, **LOADS[load])


def mean_velocity(on: System) -> Array:
    """ω_m by plain repetition; torque and damping are those of the step's start."""
    w0, inertia, load = INITIAL.angular_velocity, on.body.inertia, on.load
    torque = load.torque_body - load.damping * w0
    torque = torque + rotation_matrix(INITIAL.orientation).T @ load.torque_world
    w = w0
    for _ in range(60):  # each leaves at most h/2 |ω| (1 + condition) < 0.35 of the gap
        w = w0 + H / 2 * np.linalg.solve(inertia, torque - np.cross(w, inertia @ w))
    return w


def bound(on: System) -> float:
    """The equations' rounding: of ω, of size four, by the inertia's condition."""
    return float(64 * EPS * np.linalg.cond(on.body.inertia) * 4)


@few_loads
def test_the_gyroscopic_term_alone_is_at_the_middle(load: str) -> None:
    on = body(load)
    mean = mean_velocity(on)
    for scheme in (FROZEN, BODY_AXES):
        end = one_step(scheme, on, INITIAL, H)
        w = 2 * mean - INITIAL.angular_velocity
        assert np.max(np.abs(end.angular_velocity - w)) <= bound(on)
        turn = Rotation.from_rotvec(H * mean).as_matrix()
        R = rotation_matrix(INITIAL.orientation) @ turn
        assert np.max(np.abs(rotation_matrix(end.orientation) - R)) <= bound(on)


@few_loads
def test_the_centre_of_mass_steps_by_semi_implicit_euler(load: str) -> None:
    on = body(load)
    end = one_step(FROZEN, on, INITIAL, H)
    v = INITIAL.linear_velocity + H * on.load.gravity
    assert np.max(np.abs(end.linear_velocity - v)) <= 8 * EPS * 4
    assert np.max(np.abs(end.position - INITIAL.position - H * v)) <= 8 * EPS * 4


@few_loads
def test_body_axes_step_the_momentum_of_the_offset_centre_of_mass(load: str) -> None:
    # in body axes: u1 - u0 = h (R0ᵀ g - ω_m × (u0 + u1)/2), u of the centre of mass
    center = (0.1, -0.2, 0.3)
    on = body(load, center)
    end = one_step(BODY_AXES, on, INITIAL, H, "origin-world")
    mean, R0 = mean_velocity(on), rotation_matrix(INITIAL.orientation)
    half = skew(H / 2 * mean)
    right = (np.eye(3) - half) @ R0.T @ INITIAL.linear_velocity + H * R0.T @ on.load.gravity
    R1 = R0 @ Rotation.from_rotvec(H * mean).as_matrix()
    v = R1 @ np.linalg.solve(np.eye(3) + half, right)
    assert np.max(np.abs(end.linear_velocity - v)) <= bound(on)
    (p0, u0), (p1, u1) = (
        (q[:3], v[:3]) for q, v in (to_coordinates(on, s, "origin-world") for s in (INITIAL, end))
    )
    assert np.max(np.abs(p1 - p0 - H * (u0 + u1) / 2)) <= 8 * EPS * 4


def test_a_steady_velocity_is_turned_by_the_cube_of_the_step() -> None:
    # by h ω - 2 atan(h ω / 2) a step: MuJoCo's own departure, which no other scheme has
    on = system([1.0, 2.0, 2.5])
    spinning = start([0.0, 0.0, 2.0], velocity=(1, 0, 0))
    found = one_step(BODY_AXES, on, spinning, H).linear_velocity
    angle = 2 * H - 2 * np.arctan(H)
    assert np.max(np.abs(found - [np.cos(angle), np.sin(angle), 0])) <= 8 * EPS
    assert angle == pytest.approx((2 * H) ** 3 / 12, rel=(2 * H) ** 2)


@pytest.mark.parametrize("dt", [0.001, 0.05])
def test_a_free_body_keeps_its_kinetic_energy(dt: float) -> None:
    on, steps = system(turned([1.0, 2.0, 2.5])), 500
    initial = start([1.0, 2.0, -1.5], [1, 2, 3, 4])
    _, states = step_body(FROZEN, on, initial, dt, steps, 50)
    energy = total_energy(on, states)
    # each step rounds ω some sixteen times, and by the inertia's condition in what changes it
    step = (16 + dt * np.linalg.norm(initial.angular_velocity) * 2.5) * EPS
    assert np.max(np.abs(energy / energy[0] - 1)) <= steps * step


def test_a_step_that_does_not_settle_is_not_a_number() -> None:
    on = system([1.0, 2.0, 20.0], damping=0.1)
    w = np.array([[1000.0, 2000.0, -1500.0], [1.0, 2.0, -1.5]])
    both = start(w, [[1, 0, 0, 0], [1, 0, 0, 0]])
    _, states = step_body(FROZEN, on, both, np.array([9.0, 0.01]), 3, 1)
    assert np.all(np.isnan(rows(states, (-1, 0)).angular_velocity))
    assert np.all(np.isfinite(rows(states, (-1, 1)).angular_velocity))
