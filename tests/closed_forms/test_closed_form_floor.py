"""The resolvable floor: what the rounding of inputs does, no less and not much more."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np
import pytest
from closed_form_cases import FREE, TOPS, Case, constants_for, flip_period
from closed_form_errors import EPS

from omegadot.reference_impl.closed_forms import closed_form_of, floor
from omegadot.reference_impl.rotations import attitude_angle
from omegadot.reference_impl.system import State, System

TIMES = np.linspace(-3.0, 9.0, 25)


def _named(name: str) -> Case:
    return next(case for case in FREE + TOPS if case.name == name)


def _next_doubles(case: Case) -> Iterator[tuple[System, State]]:
    """The problem with one number of it replaced by the next double, number by number."""
    system, initial = case.system, case.initial
    for i in range(3):
        for j in range(i + 1):
            inertia = system.body.inertia.copy()
            if inertia[i, j] != 0:
                inertia[i, j] = inertia[j, i] = np.nextafter(inertia[i, j], np.inf)
                yield replace(system, bodies=(replace(system.body, inertia=inertia),)), initial
    for name in ("angular_velocity", "orientation"):
        for i, x in enumerate(getattr(initial, name)):
            if x != 0:
                moved = getattr(initial, name).copy()
                moved[i] = np.nextafter(x, np.inf)
                yield system, replace(initial, **{name: moved})


@pytest.mark.parametrize(
    "name", ["about-least", "order-231", "near-middle", "full-tensor", "moderate-nome", "sphere"]
)
def test_floor_is_the_sum_of_roundings(name: str) -> None:
    """Every single rounding stays below it; all of them, doubled, and a few eps reach it.

    The next double is half an eps to one eps away, hence the factor of two.
    """
    case = _named(name)
    exactly = closed_form_of(case.system, case.initial)(TIMES)
    resolvable = floor(case.system, case.initial, TIMES)
    speeds, angles = [], []
    for system, initial in _next_doubles(case):
        other = closed_form_of(system, initial)(TIMES)
        gap = other.angular_velocity - exactly.angular_velocity
        speeds.append(np.linalg.norm(gap, axis=-1))
        angles.append(attitude_angle(exactly.orientation, other.orientation))
    noise = 16 * EPS  # of the evaluations that are compared
    size = np.linalg.norm(exactly.angular_velocity, axis=-1)
    count = len(speeds)
    assert np.all(np.max(speeds, 0) <= resolvable.angular_velocity + noise * size)
    assert np.all(np.max(angles, 0) <= resolvable.attitude + noise)
    assert np.all(resolvable.angular_velocity <= 2 * np.sum(speeds, 0) + count * noise * size)
    assert np.all(resolvable.attitude <= 2 * np.sum(angles, 0) + count * noise)


def test_floor_grows_with_the_periods() -> None:
    """A relative eps of the spin is one of the clock: at a flip ω is off by ``eps t |dω/dt|``.

    And however large it is, it never exceeds what the motion can span, once for every number.
    """
    case = _named("near-middle")
    c = constants_for(case)
    first = float(-c.start / c.rate)
    flips = np.arange(first + flip_period(case), 300.0, flip_period(case))
    step = 1e-5
    motion = closed_form_of(case.system, case.initial)
    rate = np.linalg.norm(
        motion(flips + step).angular_velocity - motion(flips - step).angular_velocity, axis=-1
    ) / (2 * step)
    resolvable = floor(case.system, case.initial, flips).angular_velocity
    assert np.all(resolvable >= 0.5 * EPS * flips * rate)
    span = 2 * np.linalg.norm(motion(TIMES).angular_velocity, axis=-1).max()
    assert np.all(resolvable <= 10 * span)


def test_floor_is_large_where_a_rounding_crosses_the_separatrix() -> None:
    """On the separatrix a rounding decides whether the body flips again: nothing is resolvable."""
    case = _named("separatrix")
    resolvable = floor(case.system, case.initial, np.linspace(0.0, 120.0, 241)).angular_velocity
    assert resolvable[0] < 16 * EPS * np.linalg.norm(case.omega)
    assert resolvable.max() > np.linalg.norm(case.omega)


def test_floor_at_the_start_is_that_of_the_numbers() -> None:
    for case in (_named("about-least"), _named("top")):
        start = floor(case.system, case.initial, np.zeros(1))
        size = np.linalg.norm(case.omega)
        assert 0.5 * EPS * size <= start.angular_velocity[0] <= 16 * EPS * size
        assert EPS <= start.attitude[0] <= 32 * EPS
