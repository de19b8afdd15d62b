"""Which extended type is used, and that truth does not depend on it."""

from __future__ import annotations

from collections.abc import Iterator
from decimal import Decimal, localcontext

import numpy as np
import pytest
from reference_cases import EPS, start, turned

from omegadot.reference_impl.arithmetic import precision
from omegadot.reference_impl.arithmetic.precision import (
    DOUBLE_DOUBLE,
    LONG_DOUBLE,
    VARIABLE,
    extended,
    extended_type,
    from_decimals,
    in_doubles,
    to_double,
)
from omegadot.reference_impl.from_scenario import initial_state_of, system_of
from omegadot.reference_impl.motion import forward_dynamics, inverse_dynamics
from omegadot.reference_impl.solutions.exact_solution import ExactSolution, exact_solution
from omegadot.reference_impl.solutions.series import solve_series
from omegadot.reference_impl.symmetric import inverse
from omegadot.reference_impl.system import Acceleration, Body, Load, State, System
from omegadot.scenarios import builtin_names, load_builtin

BY_SERIES = [
    name
    for name in builtin_names()
    if exact_solution(
        system_of(load_builtin(name)), initial_state_of(load_builtin(name)), np.array([0.0])
    ).source
    == "series"
]


def test_the_type_is_long_double_where_it_is_long_enough(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv(VARIABLE, raising=False)
    for eps, name in ((2.0**-52, DOUBLE_DOUBLE), (2.0**-63, LONG_DOUBLE), (2.0**-112, LONG_DOUBLE)):
        monkeypatch.setattr(precision, "LONG_EPS", eps)
        assert extended_type() == name
    monkeypatch.setenv(VARIABLE, DOUBLE_DOUBLE)
    assert extended_type() == DOUBLE_DOUBLE
    monkeypatch.setenv(VARIABLE, "quad")
    with pytest.raises(ValueError, match=r"OMEGADOT_EXTENDED is 'quad'; set it to 'double-double'"):
        extended_type()


def test_decimals_keep_more_than_a_double(extended_type_of_truth: str) -> None:
    with localcontext() as context:
        context.prec = 60
        third = Decimal(1) / 3
        found = from_decimals([third, -2 * third, Decimal(0)])
    assert np.max(np.abs(to_double(found * 3.0 - [1.0, -2.0, 0.0]))) <= 4 * precision.LEAST_EPS


def random_case(seed: int) -> tuple[System, State]:
    """A body of any shape under all loads at once, pivoted for odd seeds."""
    rng = np.random.default_rng([10, seed])
    squares = 10.0 ** rng.uniform(-1.5, 0, 3)
    moments = squares.sum() - squares
    body = Body(np.array(rng.uniform(0.5, 2.0)), rng.normal(size=3) / 4, turned(moments))
    load = Load(
        gravity=rng.normal(size=3),
        pivot=rng.normal(size=3) / 4 if seed % 2 else None,
        damping=np.array(rng.uniform(0.0, 0.2)),
        torque_body=rng.normal(size=3) / 4,
        torque_world=rng.normal(size=3) / 4,
    )
    system = System((body,), load)
    return system, start(rng.normal(size=3), rng.normal(size=4), on=system)


def in_both(monkeypatch: pytest.MonkeyPatch) -> Iterator[str]:
    """The two types' names, each in force while it is at hand."""
    for forced in ("", DOUBLE_DOUBLE):
        monkeypatch.setenv(VARIABLE, forced)
        yield extended_type()


def test_truth_and_floor_of_built_ins_do_not_depend_on_the_type(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    assert BY_SERIES
    for name in BY_SERIES:
        scenario = load_builtin(name)
        system, initial = system_of(scenario), initial_state_of(scenario)
        times = np.linspace(0, scenario.run.duration, 21)
        _agree([exact_solution(system, initial, times) for _ in in_both(monkeypatch)])


@pytest.mark.parametrize("seed", range(4))
def test_truth_and_floor_of_random_systems_do_not_depend_on_the_type(
    seed: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    system, initial = random_case(seed)
    times = np.linspace(0, 3, 21)
    _agree([exact_solution(system, initial, times) for _ in in_both(monkeypatch)])


def _agree(found: list[ExactSolution]) -> None:
    """Truth to a hundredth of its floor and its own rounding; the floor to its first digits.

    Those are eps^(1/3): the floor is taken by central differences, which err by eps^(2/3) and more.
    """
    one, other = found
    off = {
        "angular_velocity": np.linalg.norm(
            one.state.angular_velocity - other.state.angular_velocity, axis=-1
        ),
        "attitude": np.linalg.norm(one.state.orientation - other.state.orientation, axis=-1),
    }
    speed = np.linalg.norm(one.state.angular_velocity, axis=-1)
    rounding = {"angular_velocity": EPS * speed, "attitude": EPS}
    for name, gap in off.items():
        floor = getattr(one.floor, name)
        assert np.all(gap <= 0.01 * floor + rounding[name])
        assert np.all(np.abs(getattr(other.floor, name) / floor - 1) <= EPS ** (1 / 3))


def test_dynamics_do_not_depend_on_the_type(monkeypatch: pytest.MonkeyPatch) -> None:
    """Nor do the figures of the equation gate: the truth has spare digits in either."""
    for seed in range(8):
        system, initial = random_case(seed)
        wanted = Acceleration(np.array([1.0, -2.0, 0.5]), np.array([0.3, 0.1, 2.0]))
        found = []
        for _ in in_both(monkeypatch):
            long, state = extended(system), extended(initial)
            moved = in_doubles(forward_dynamics(long, state))
            torque = to_double(inverse_dynamics(long, state, extended(wanted)))
            found.append((moved.angular, moved.linear, torque))
        for one, other in zip(*found, strict=True):
            assert np.max(np.abs(one - other)) <= EPS * np.max(np.abs(one))


def test_double_double_is_the_better_of_the_two(monkeypatch: pytest.MonkeyPatch) -> None:
    """The inverse of a tensor of condition 1e6 loses nothing in double, forced or not."""
    matrix = turned([1e-6, 1.0, 1.0])
    monkeypatch.setenv(VARIABLE, DOUBLE_DOUBLE)
    found = inverse(extended(System((Body(matrix, matrix, matrix),))).body.inertia)
    left = to_double(found @ matrix - np.eye(3))
    assert np.max(np.abs(left)) <= 1e6 * 2.0**-100
    assert inverse(matrix).dtype == float


def test_strong_damping_stays_in_a_doubles_range(monkeypatch: pytest.MonkeyPatch) -> None:
    """ω decays 1e9 times as fast as the body turns: the coefficients grow as powers of that."""
    system = System(
        (Body(np.array(1.0), np.zeros(3), np.diag([1.0, 2.0, 2.5])),), Load(damping=np.array(1e9))
    )
    initial = start([1.0, 2.0, 3.0])
    states = [solve_series(system, initial, np.array([1e-8])) for _ in in_both(monkeypatch)]
    moments = np.array([1.0, 2.0, 2.5])
    decayed = initial.angular_velocity * np.exp(-10.0 / moments)
    for state in states:
        assert np.max(np.abs(state.angular_velocity - decayed)) <= 1e-7 * np.max(decayed)
    gap = np.abs(states[0].angular_velocity - states[1].angular_velocity)
    assert np.max(gap) <= 4 * EPS * np.max(decayed)
