"""The angular momentum is turned and keeps its length: in one step, and in four substeps."""

from __future__ import annotations

import numpy as np
import pytest
from reference_cases import DAMPED, DRIVEN, EPS, FREE, TOP, one_step, start, system, turned

from omegadot.reference_impl.cross_product import cross
from omegadot.reference_impl.energy import total_energy
from omegadot.reference_impl.inertia import moving_inertia
from omegadot.reference_impl.loads import torque as torque_at
from omegadot.reference_impl.momentum import angular_momentum
from omegadot.reference_impl.rotations import (
    attitude_angle,
    exp_quaternion,
    normalize,
    quaternion_product,
    rotate,
    rotate_inverse,
)
from omegadot.reference_impl.schemes import SCHEMES
from omegadot.reference_impl.stepping import step_body
from omegadot.reference_impl.system import Array, State, System

RESCALED = SCHEMES["semi-implicit-euler-rescaled-momentum"]
SUBSTEPS = SCHEMES["semi-implicit-euler-rescaled-momentum-four-substeps"]
PLAIN = SCHEMES["semi-implicit-euler"]
BEGIN = ([1.0, 2.0, -1.5], [1, 2, 3, 4])
few_systems = pytest.mark.parametrize(
    "on", [FREE, DRIVEN, DAMPED, TOP], ids=["free", "driven", "damped", "top"]
)


def norm(vector: Array) -> Array:
    return np.linalg.norm(vector, axis=-1)


def by_hand(on: System, w: Array, h: float) -> Array:
    """``I⁻¹ (L - h ω × L) |L| / |L - h ω × L|``."""
    inertia = moving_inertia(on)
    momentum = inertia @ w
    after = momentum - h * cross(w, momentum)
    found: Array = np.linalg.solve(inertia, after * norm(momentum) / norm(after))
    return found


def push_at(on: System, state: State) -> Array:
    found: Array = np.linalg.solve(moving_inertia(on), torque_at(on, state))
    return found


def near(on: System, found: State, w: Array, q: Array) -> None:
    """Some sixty roundings in a step, magnified by the inertia's condition number."""
    bound = 64 * EPS * np.linalg.cond(moving_inertia(on))
    assert norm(found.angular_velocity - w) <= bound * norm(w)
    assert attitude_angle(found.orientation, q) <= bound


@few_systems
def test_one_step_is_that_of_the_formula(on: System) -> None:
    """Caught: |L| taken after the torque, a length of omega kept, a torque that is turned too."""
    begin, h = start(*BEGIN, on=on), 0.2
    w = by_hand(on, begin.angular_velocity, h) + h * push_at(on, begin)
    near(
        on,
        one_step(RESCALED, on, begin, h),
        w,
        quaternion_product(begin.orientation, exp_quaternion(h * w)),
    )


@few_systems
def test_substeps_hold_the_push_in_world_axes_and_turn_straight(on: System) -> None:
    """Caught: a push that stays in body axes, or comes last; a torque held; exponentials."""
    begin, part = start(*BEGIN, on=on), 0.05
    q, w = begin.orientation, begin.angular_velocity
    held = rotate(q, push_at(on, begin))
    for _ in range(4):
        w = by_hand(on, w + part * rotate_inverse(q, held), part)
        q = normalize(quaternion_product(q, np.array([1.0, *(0.5 * part * w)])))
    near(on, one_step(SUBSTEPS, on, begin, 4 * part), w, q)


def test_a_body_falls_by_four_substeps() -> None:
    """``x₁ = x₀ + h v₀ + 5/8 h² g``, where one step has ``h² g``."""
    on, h = system([1.0, 2.0, 2.5], gravity=(0, 1, -9.81)), 0.1
    begin = start(*BEGIN, velocity=(1, 2, 3))
    for scheme, share in ((RESCALED, 1.0), (SUBSTEPS, 0.625)):
        end = one_step(scheme, on, begin, h)
        moved = h * begin.linear_velocity + share * h * h * on.load.gravity
        np.testing.assert_allclose(end.position - begin.position, moved, rtol=64 * EPS)
        fallen = begin.linear_velocity + h * on.load.gravity
        np.testing.assert_allclose(end.linear_velocity, fallen, rtol=64 * EPS)


@pytest.mark.parametrize("scheme", [RESCALED, SUBSTEPS], ids=lambda scheme: scheme.name)
@pytest.mark.parametrize("dt", [0.01, 1.0])
def test_the_length_of_the_momentum_is_kept(scheme: object, dt: float) -> None:
    """At any step, where Euler's step lets it grow without bound."""
    on, begin, steps = system(turned([1.0, 2.0, 2.5])), start(*BEGIN), 500
    size = {
        one.name: norm(angular_momentum(on, step_body(one, on, begin, dt, steps, 1)[1]))
        for one in (RESCALED, SUBSTEPS, PLAIN)
    }
    kept = size[scheme.name]  # type: ignore[attr-defined]
    # each (sub)step rounds momenta some sixteen times, and the length adds that up
    assert np.max(np.abs(kept / kept[0] - 1)) <= 4 * steps * 16 * EPS
    assert not np.max(size[PLAIN.name]) <= size[PLAIN.name][0] * (1 + 1e-3)


@pytest.mark.parametrize("moments", [(1.0, 1.0, 1.8), (1.0, 1.0, 0.4)], ids=["flat", "long"])
def test_energy_drifts_as_derived(moments: tuple[float, ...]) -> None:
    """``dE/dt = h/2 (n·I⁻¹ n - 2 E |n|²/|L|²)``, n = ω × L: a flat body gains, a long one loses."""
    on, begin, h = system(moments), start(*BEGIN), 1e-4
    w, inertia = begin.angular_velocity, np.array(moments)
    momentum, energy = inertia * w, 0.5 * float(np.sum(inertia * w * w))
    n = cross(w, momentum)
    rate = h / 2 * (np.sum(n * n / inertia) - 2 * energy * np.sum(n * n) / np.sum(momentum**2))
    _, states = step_body(RESCALED, on, begin, h, 100, 100)
    found = total_energy(on, states)
    # what is left out is of the next order in the turn of 100 steps, below 0.05 rad
    assert (found[-1] - found[0]) / (100 * h) == pytest.approx(rate, rel=0.05)
    assert rate > 0 if moments[2] > 1 else rate < 0


@pytest.mark.parametrize("scheme", [RESCALED, SUBSTEPS], ids=lambda scheme: scheme.name)
def test_a_body_at_rest_is_set_in_motion_by_torque_alone(scheme: object) -> None:
    """A momentum of no length has none to keep, alone or among other lanes."""
    still, one = np.zeros(3), np.array([1.0, 0, 0, 0])
    on = system([1.0, 2.0, 2.5], torque_body=[1.0, -2.0, 0.5])
    alone = one_step(scheme, on, start(still), 0.1)  # type: ignore[arg-type]
    lanes = State(
        np.stack([one, one]),
        np.stack([still, np.array(BEGIN[0])]),
        np.zeros((2, 3)),
        np.zeros((2, 3)),
    )
    both = one_step(scheme, on, lanes, 0.1)  # type: ignore[arg-type]
    if scheme is RESCALED:
        expected = 0.1 * on.load.torque_body / np.array([1.0, 2.0, 2.5])
        np.testing.assert_allclose(alone.angular_velocity, expected, rtol=16 * EPS)
    np.testing.assert_allclose(both.angular_velocity[0], alone.angular_velocity, rtol=64 * EPS)
    rest = one_step(scheme, system([1.0, 2.0, 2.5]), start(still), 0.1)  # type: ignore[arg-type]
    assert np.array_equal(rest.angular_velocity, still)
    assert np.array_equal(rest.orientation, one)


def test_a_sphere_is_stepped_as_by_semi_implicit_euler() -> None:
    """It has no gyroscopic term."""
    on, begin = system([2.0, 2.0, 2.0], torque_world=[1.0, 0.0, 2.0]), start(*BEGIN)
    one, other = (one_step(scheme, on, begin, 0.1) for scheme in (RESCALED, PLAIN))
    near(on, one, other.angular_velocity, other.orientation)
