"""Growth against the matrix exponential of a steady spin, and the bound it is there for."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from reference_cases import DAMPED, DRIVEN, EPS, TOP, in_long_double, rows, start, system
from scipy.linalg import expm

from omegadot.reference_impl.cross_product import skew
from omegadot.reference_impl.rotations import turn_in_body
from omegadot.reference_impl.schemes import SCHEMES
from omegadot.reference_impl.solutions.growth import changes, growth_along
from omegadot.reference_impl.solutions.series import solve_series
from omegadot.reference_impl.stepping import step_body
from omegadot.reference_impl.system import Array, State, System


def changed(state: State, change: Array, rate: float) -> State:
    """The state moved by a small vector (..., 6) as `changes` measures it."""
    return replace(
        state,
        orientation=turn_in_body(state.orientation, change[..., :3], 1.0),
        angular_velocity=state.angular_velocity + rate * change[..., 3:],
    )


@pytest.mark.parametrize("axis", [0, 1, 2])
def test_growth_of_a_steady_spin_is_the_matrix_exponential(axis: int) -> None:
    # δθ' = δω - ω × δθ and δω' = A δω with constant A: unstable about the middle axis alone
    moments, rate = np.array([1.0, 2.0, 2.5]), 3.0
    w = rate * np.eye(3)[axis]
    inertia = np.diag(moments)
    gyroscopic = -np.linalg.inv(inertia) @ (skew(w) @ inertia - skew(inertia @ w))
    generator = np.block([[-skew(w), rate * np.eye(3)], [np.zeros((3, 3)), gyroscopic]])
    times = np.linspace(0, 6, 61)
    norms = [np.linalg.norm(expm(generator * t), 2) for t in times]
    expected = np.maximum.accumulate(norms)  # the flow is steady: the supremum is over spans
    found = growth_along(
        system(moments), times, solve_series(system(moments), start(w), times), rate
    )
    # Runge-Kutta at a tenth of a radian a step: (1/10)^5 / 120 of error in each of 10 |ω| t steps
    assert np.max(np.abs(found / expected - 1)) <= 1e-5 / 120 * 10 * 3.0 * 6 * 6
    assert found[0] == 1.0
    assert (found[-1] > 1e3) == (axis == 1)


@pytest.mark.parametrize("on", [TOP, DRIVEN, DAMPED], ids=["top", "driven", "damped"])
def test_growth_is_the_largest_over_all_starts(on: System) -> None:
    # each tangent map by itself, from the exact motion of twelve neighbours of each start
    rate, delta = 3.0, 1e-6
    times = np.linspace(0, 2, 9)
    states = solve_series(on, start([0.5, rate, 1.0], [1, 2, 3, 4], on=on), times)
    expected = np.ones(len(times))
    axes = delta * np.concatenate((np.eye(6), -np.eye(6)))
    for s in range(len(times) - 1):
        w = np.broadcast_to(states.angular_velocity[s], (12, 3))
        here = State(states.orientation[s], w, np.zeros((12, 3)), np.zeros((12, 3)))
        ends = solve_series(on, changed(here, axes, rate), times[s + 1 :] - times[s])
        plus, minus = (
            rows(ends, (slice(None), slice(0, 6))),
            rows(ends, (slice(None), slice(6, 12))),
        )
        maps = np.swapaxes(changes(minus, plus, rate), -1, -2) / (2 * delta)
        expected[s + 1 :] = np.maximum(expected[s + 1 :], np.linalg.norm(maps, 2, axis=(-1, -2)))
    found = growth_along(on, times, states, rate)
    # a start is chosen by its sum of squares, which is within the root of six of the norm
    assert np.all(found <= expected * (1 + 1e-4))
    assert np.all(found >= expected / np.sqrt(6) * (1 - 1e-4))
    assert np.allclose(found[1], expected[1], rtol=1e-4)


def test_growth_beyond_the_square_root_of_eps_is_found() -> None:
    # Past the separatrix twice: a flip from 1e-7 amplifies by up to 1e14, beyond any difference
    # of two runs. The logarithm grows by lambda t while the body lingers at the saddle.
    on, rate = system([1.0, 2.0, 2.5]), 3.0
    times = np.linspace(0, 40, 401)
    states = solve_series(on, start([1e-7, rate, 1e-7]), times)
    found = growth_along(on, times, states, rate)
    lingering = np.flatnonzero(states.angular_velocity[:, 1] < -0.999 * rate)
    first, last = lingering[0], lingering[-1]
    slope = rate * np.sqrt((2.5 - 2.0) * (2.0 - 1.0) / (1.0 * 2.5))
    local = growth_along(on, times[first:last], rows(states, slice(first, last)), rate)
    span = times[last - 1] - times[first]
    # the bound keeps to exp(slope t) within the constant of the saddle's skewed directions
    assert abs(np.log(local[-1]) - slope * span) <= 3.0
    assert found[-1] >= local[-1] > 1e9


@pytest.mark.parametrize("on", [system([1.0, 2.0, 2.5]), TOP, DRIVEN, DAMPED])
@pytest.mark.parametrize("scheme", ["semi-implicit-euler", "lie-rk4", "implicit-midpoint"])
def test_rounding_stays_within_its_bound(scheme: str, on: System) -> None:
    """The same run in double and in long double: the difference is rounding and nothing else."""
    rate, dt, steps = 3.0, 0.01, 400
    initial = start([0.01, rate, 0.01], on=on)
    times, double = step_body(SCHEMES[scheme], on, initial, dt, steps, 20)
    long = replace(on, bodies=(in_long_double(on.body),), load=in_long_double(on.load))
    _, spared = step_body(
        SCHEMES[scheme],
        long,
        in_long_double(initial),
        np.longdouble(dt),
        steps,
        20,
    )
    error = np.linalg.norm(changes(double, spared, rate).astype(float), axis=-1)
    growth = growth_along(on, times, double, rate)
    n = times / dt
    # c: some thirty roundings of the attitude and of ω in a step
    assert np.all(error <= 32 * EPS * (n + 1) * growth)


def test_growth_is_infinite_where_a_run_has_diverged() -> None:
    on, times = system([1.0, 2.0, 2.5]), np.linspace(0, 1, 11)
    states = solve_series(on, start([1, 2, 3]), times)
    w = states.angular_velocity.copy()
    w[7:] = np.nan
    found = growth_along(on, times, replace(states, angular_velocity=w), 3.0)
    assert np.all(np.isfinite(found[:7]))
    assert np.all(np.isinf(found[7:]))
    single = growth_along(on, times[:1], rows(states, slice(0, 1)), 3.0)
    assert np.array_equal(single, [1.0])


def test_state_may_diverge_at_once() -> None:
    nowhere = np.full((3, 3), np.nan)
    states = State(np.full((3, 4), np.nan), nowhere, nowhere, nowhere)
    assert np.all(np.isinf(growth_along(system([1, 2, 2.5]), np.arange(3.0), states, 1.0)))


def test_growth_that_cannot_be_followed_is_infinite() -> None:
    """A damping that stops the body in far less than the time between two samples."""
    stiff = replace(DAMPED, load=replace(DAMPED.load, damping=np.array(1e7)))
    times = np.linspace(0, 1, 5)
    one = start((0.3, 0.1, -0.2))
    still = State(*(np.repeat(values[None], 5, axis=0) for values in vars(one).values()))
    found = growth_along(stiff, times, still, 1.0)
    assert found[0] == 1.0
    assert np.all(found[1:] == np.inf)


def test_growth_that_leaves_the_range_of_doubles_is_infinite() -> None:
    """Caught: a product of maps that overflows, of which no singular value can be found."""
    moments, rate = np.array([1.0, 2.0, 2.5]), 3.0
    times = np.arange(0.0, 600.0)
    angles = rate * times / 2
    turned = np.stack((np.cos(angles), 0 * angles, np.sin(angles), 0 * angles), axis=-1)
    spun = np.broadcast_to([0.0, rate, 0.0], (600, 3))
    states = State(turned, spun, np.zeros((600, 3)), np.zeros((600, 3)))
    found = growth_along(system(moments), times, states, rate)
    assert found[100] > 1e50  # exp(1.34 t), 1.34 = 3 sqrt(0.2)
    assert found[-1] == np.inf
    assert np.all(found[1:] >= found[:-1])
