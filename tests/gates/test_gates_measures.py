"""Distances between motions and the rounding that they may show, worked out by hand."""

from dataclasses import replace

import numpy as np
import pytest

from omegadot.gates.bounds.measures import INVARIANT_CHANNELS, TRAJECTORY_UNITS, Yardstick
from omegadot.gates.bounds.scales import EPS, angular_size
from omegadot.reference_impl.kinematics import place_on_pivot
from omegadot.reference_impl.motion import forward_dynamics
from omegadot.reference_impl.system import Array, Body, Load, State, System

TIMES = np.array([0.0, 1.0, 4.0])
TENSOR = np.diag([1.0, 2.0, 2.5])
BODY = Body(np.array(2.0), np.zeros(3), TENSOR)
OFFSET = replace(BODY, center_of_mass=np.array([0.0, 0.0, 0.5]))
GRAVITY = np.array([0.0, 0.0, -3.0])
DOWN = System((BODY,), Load(gravity=GRAVITY))


def rows(w: object, x: object = (0, 0, 0), v: object = (0, 0, 0)) -> State:
    """Three states; the last has these, the ones before half of them."""
    part = np.array([0.5, 0.5, 1.0])[:, None]
    q = np.tile([1.0, 0.0, 0.0, 0.0], (3, 1))
    return State(q, *(part * np.array(values, float) for values in (w, x, v)))


STATES = rows((0, 0, 2.0), (0, 3.0, 0), (3.0, 0, 4.0))


def test_the_sizes_of_a_motion() -> None:
    yardstick = Yardstick(DOWN, TIMES, STATES)
    assert (yardstick.rate, yardstick.speed, yardstick.reach) == (2.0, 5.0, 3.0)
    assert yardstick.gravity == 3.0
    found = forward_dynamics(DOWN, STATES)
    assert yardstick.acceleration == np.max(angular_size(DOWN, STATES, found))
    assert yardstick.sizes == pytest.approx(
        {"energy": 0.5 * 2 * 25 + 0.5 * 2.5 * 4, "angular_momentum": 5.0, "linear_momentum": 10.0}
    )


def test_a_scheme_may_step_the_angular_momentum() -> None:
    """One part of J omega turns omega by |J omega| / (lambda rate) = 5 / (1 * 2) of it.

    About the world's origin that of the place is m |x| |v| / (lambda rate) = 2 * 3 * 5 / (1 * 2).
    """
    yardstick = Yardstick(DOWN, TIMES, STATES)
    assert yardstick.per_rounding == 1.0
    assert yardstick.of_momentum().per_rounding == 2.5 + 15.0
    assert yardstick.with_eps(2.0**-23).per_rounding == 2.5


def test_a_scheme_may_keep_energy_and_momentum() -> None:
    """At omega = (1, 1, 0) the ellipsoids' normals are (1, 2, 0) and (1, 4, 0).

    Their angle has the sine 2 / sqrt(85).
    """
    system, turning = System((BODY,)), np.tile([1.0, 1.0, 0.0], (3, 1))
    nothing = np.zeros((3, 3))
    states = State(STATES.orientation, turning, nothing, nothing)
    yardstick, steps = Yardstick(system, TIMES, states), np.array([0.0, 10.0, 40.0])
    kept = yardstick.of_kept(turning, steps)
    plain = yardstick.round_off(0.0, steps, np.ones(3))["omega"]
    found = kept.round_off(0.0, steps, np.ones(3))["omega"]
    assert found / plain == pytest.approx(1.0 + np.sqrt(85.0) / 2.0)
    off = turning * (1.0 + 1e-9 * steps[:, None])
    assert yardstick.of_kept(off, steps) is yardstick


def test_a_lever_adds_to_speed_and_reach() -> None:
    yardstick = Yardstick(System((OFFSET,)), TIMES, STATES)
    assert (yardstick.speed, yardstick.reach) == (5.0 + 2.0 * 0.5, 3.0 + 0.5)


def test_a_body_that_starts_at_rest_is_measured_by_what_it_will_reach() -> None:
    system = System((BODY,), Load(torque_body=np.array([0.0, 0.0, 5.0])))
    still = rows((0, 0, 0))
    yardstick = Yardstick(system, TIMES, still)
    assert yardstick.rate == pytest.approx(yardstick.acceleration * 4.0)
    # J |omega_dot| + |tau| over the smallest moment
    assert yardstick.acceleration == pytest.approx((2.5 * 2.0 + 5.0) / 1.0)
    assert yardstick.sizes["energy"] == pytest.approx(0.5 * 1.0 * 40.0**2)
    assert yardstick.sizes["angular_momentum"] == pytest.approx(40.0)
    assert yardstick.sizes["linear_momentum"] == pytest.approx(2.0 * 40.0 * np.sqrt(5.5 / 2.0))


def test_a_body_that_never_moves_turns_once_in_its_time() -> None:
    assert Yardstick(System((BODY,)), TIMES, rows((0, 0, 0))).rate == 1.0 / 4.0


@pytest.mark.parametrize(
    ("channel", "field", "change", "expected"),
    [
        ("omega", "angular_velocity", [3e-3, 0, 4e-3], 5e-3 / 2.0),
        ("attitude", "orientation", [0, 1e-3, 0, 0], 2e-3),
        ("position", "position", [3e-3, 0, 4e-3], 5e-3),
        ("energy", "position", [0, 0, 1e-3], 2 * 3 * 1e-3 / 30.0),
        ("energy", "linear_velocity", [0, 0, 1e-3], 2 * 4e-3 / 30.0),
        ("angular_momentum", "angular_velocity", [0, 1e-3, 0], 2e-3 / 5.0),
        ("linear_momentum", "linear_velocity", [0, 1e-3, 0], 2e-3 / 10.0),
    ],
)
def test_distances(channel: str, field: str, change: list[float], expected: float) -> None:
    yardstick = Yardstick(DOWN, TIMES, STATES)
    moved = replace(STATES, **{field: getattr(STATES, field) + np.array(change)})
    for one, other in ((moved, STATES), (STATES, moved)):
        gap = yardstick.distance(channel, one, other)
        assert gap.shape == (3,)
        assert gap[2] == pytest.approx(expected, rel=1e-3)
    np.testing.assert_array_equal(yardstick.distance(channel, STATES, STATES), 0.0)


def test_what_overflows_is_infinitely_far() -> None:
    yardstick = Yardstick(DOWN, TIMES, STATES)
    far = replace(STATES, angular_velocity=1e300 * STATES.angular_velocity)
    for channel in ("omega", "energy"):
        assert not np.any(np.isfinite(yardstick.distance(channel, far, STATES)))


STEPS, GROWTH = np.array([0.0, 10.0, 40.0]), np.array([1.0, 2.0, 8.0])


def bounds(system: System, states: State) -> tuple[Yardstick, dict[str, Array], Array, Array]:
    yardstick = Yardstick(system, TIMES, states)
    found = yardstick.round_off(0.1, STEPS, GROWTH)
    assert set(found) == {*TRAJECTORY_UNITS, *INVARIANT_CHANNELS}
    amount = 16 * EPS * (STEPS + 1)
    theta = amount * (1 + 0.1 * yardstick.acceleration / yardstick.rate) * GROWTH
    return yardstick, found, amount, theta


def test_rounding_grows_with_steps_and_growth() -> None:
    _, found, amount, theta = bounds(DOWN, STATES)
    speed = amount * (5.0 + 3.0 * 0.1 * STEPS)
    speed += 5.0 * theta * np.minimum(1.0, 0.1 * 2.0**2 * 0.1 * STEPS)
    # A lever between two places 3 m off is accelerated by |omega|^2 = 1, 1, 4 rad^2/s^2 of itself.
    speed += 16 * EPS * 3.0 * (np.array([0.0, 1.0, 13.0]) + 0.1 * 4.0)
    reach = amount * 3.0 + 0.1 * STEPS * speed
    close = {"rtol": 8 * EPS}
    np.testing.assert_allclose(found["omega"], theta, **close)
    np.testing.assert_allclose(found["attitude"], theta, **close)
    np.testing.assert_allclose(found["position"], reach, **close)
    turning = 2 * 2.5 * 2.0 * theta * (1 + theta)
    energy = (turning * 2.0 + 2.0 * (5.0 + speed) * speed + 2.0 * 3.0 * reach) / 30.0
    np.testing.assert_allclose(found["energy"], energy, **close)
    np.testing.assert_allclose(found["angular_momentum"], turning / 5.0, **close)
    np.testing.assert_allclose(found["linear_momentum"], 2.0 * speed / 10.0, **close)


def test_a_pivoted_bodys_velocity_counts_as_it_is_reported() -> None:
    system = System((OFFSET,), Load(pivot=np.array([0.4, 0.0, 0.0])))
    states = place_on_pivot(system, STATES)
    yardstick = Yardstick(system, TIMES, states)
    other = replace(states, linear_velocity=1.01 * states.linear_velocity)
    found = yardstick.distance("linear_momentum", other, states)
    sizes = np.linalg.norm(states.linear_velocity, axis=-1)
    np.testing.assert_allclose(found, 0.01 * sizes / np.max(sizes), rtol=1e-12)


def test_rounding_of_a_pivoted_body_takes_its_lever_along() -> None:
    system = System((BODY,), Load(gravity=GRAVITY, pivot=np.array([0.0, 0.0, 0.5])))
    states = place_on_pivot(system, STATES)
    yardstick, found, amount, theta = bounds(system, states)
    speed = amount * (yardstick.speed + 3.0 * 0.1 * STEPS) + theta * 2.0 * 0.5
    speed += yardstick.speed * theta * np.minimum(1.0, 0.1 * yardstick.rate**2 * 0.1 * STEPS)
    reach = amount * yardstick.reach + 0.1 * STEPS * speed + theta * 0.5
    close = {"rtol": 16 * EPS}
    np.testing.assert_allclose(found["position"], reach, **close)
    np.testing.assert_allclose(
        found["linear_momentum"], 2.0 * speed / yardstick.sizes["linear_momentum"], **close
    )
    turning = 2 * yardstick.scale.largest * 2.0 * theta * (1 + theta)
    arm = 2.0 * (0.5 * speed + (yardstick.speed + speed) * reach)
    np.testing.assert_allclose(
        found["angular_momentum"], (turning + arm) / yardstick.sizes["angular_momentum"], **close
    )


@pytest.mark.parametrize("size", [1e-9, 1.0, 1e9])
def test_invariants_are_bounded_wherever_the_state_is(size: float) -> None:
    """Of a motion that has blown up, too: its energy goes with the square of what it is off by."""
    yardstick = Yardstick(DOWN, TIMES, STATES)
    theta, speed, reach = np.full(3, size), np.full(3, 7.0 * size), np.full(3, 5.0 * size)
    along = np.array([0.0, 0.0, 1.0])
    off = replace(
        STATES,
        angular_velocity=STATES.angular_velocity + size * yardstick.rate * along,
        linear_velocity=STATES.linear_velocity + 7.0 * size * along,
        position=STATES.position + 5.0 * size * along,
    )
    for channel, bound in yardstick.invariant_round_off(theta, speed, reach).items():
        assert np.all(yardstick.distance(channel, off, STATES) <= bound * (1.0 + 1e-6)), channel


def test_squares_that_overflow_have_no_bound() -> None:
    yardstick = Yardstick(DOWN, TIMES, STATES)
    steps, growth = np.array([0.0, 10.0, 40.0]), np.array([1.0, 1e200, 1e300])
    assert np.isinf(yardstick.round_off(0.1, steps, growth)["energy"][1:]).all()


def test_a_scheme_that_turns_by_more_than_half_a_turn_in_a_step_has_no_bound_from_there() -> None:
    """Caught: two sound charts of the rotation, of which the one is accused by the other."""
    yardstick = Yardstick(DOWN, TIMES, STATES)
    fast = rows((0, 0, 8.0))  # 4, 4, 8 rad/s, of which the last is beyond pi in 0.5 s
    assert np.isfinite(yardstick.faster(fast, 0.3)).all()
    assert np.isinf(yardstick.faster(fast, 0.5)).tolist() == [False, False, True]
    coarse = rows((0, 0, 2.0))  # as fast as the exact motion, which turns by 4 rad in 2 s
    assert np.isfinite(yardstick.faster(coarse, 2.0)).all()


def test_a_thin_bodys_own_rate_is_that_of_its_moments_and_of_no_lever() -> None:
    """Caught: a long lever, whose ``m L^2`` would excuse steps from the orders that they show."""
    system = System((OFFSET,), Load(gravity=GRAVITY))
    states = rows((0, 0, 2.0))
    least, most = np.linalg.eigvalsh(OFFSET.inertia)[[0, -1]]
    for body in (OFFSET, replace(OFFSET, center_of_mass=1e3 * OFFSET.center_of_mass)):
        yardstick = Yardstick(replace(system, bodies=(body,)), TIMES, states)
        expected = yardstick.rate * np.sqrt(most / least)
        assert yardstick.thin_rate == pytest.approx(expected, rel=1e-14)


def test_where_rounding_has_made_another_motion_of_a_diverging_run_there_is_no_bound() -> None:
    """Caught: a bound that the growth of small differences gives, where they are small no more."""
    yardstick = Yardstick(DOWN, TIMES, STATES)
    steps, growth = np.array([0.0, 10.0, 20.0, 30.0]), np.array([1.0, 1e3, 1e14, 1.0])
    kept = yardstick.round_off(0.1, steps, growth)
    assert kept["omega"][2] > 1.0
    lost = yardstick.round_off(0.1, steps, growth, np.array([1.0, 1.0, 1.1, 1.1]))
    for channel, bound in lost.items():
        assert np.isfinite(kept[channel]).all()  # of a run that goes no faster than the exact one
        assert np.isinf(bound).tolist() == [False, False, True, True]
