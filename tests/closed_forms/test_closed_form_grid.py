"""Evenly spaced times take a short way; it must lead to where the long one does."""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest
from closed_form_cases import FREE, TOPS, Case
from closed_form_errors import EPS

from omegadot.reference_impl.closed_forms import closed_form_of
from omegadot.reference_impl.closed_forms.times import chunks
from omegadot.reference_impl.rotations import attitude_angle
from omegadot.reference_impl.system import Array

pytestmark = pytest.mark.no_cover  # its lines are covered by others

COUNT = 9000
NAMES = [
    *("about-greatest", "near-middle", "moderate-nome", "order-321-back", "full-tensor"),
    *("separatrix", "prolate", "oblate", "in-the-equator", "sphere", "top", "sleeping-unstable"),
]
CASES = [case for case in FREE + TOPS if case.name in NAMES]


def _on_grid(times: Array) -> list[bool]:
    return [part.grid is not None for _, part in chunks(times, 4096)]


def _agree(case: Case, times: Array) -> None:
    """All times at once, and in an order that no grid fits, to the rounding of both ways."""
    motion = closed_form_of(case.system, case.initial)
    assert motion is not None
    mixed = np.random.default_rng(1).permutation(times.size)
    assert not any(_on_grid(times[mixed]))
    even, single = motion(times), motion(times[mixed])
    # each way is good to 16 eps of attitude and 4 eps of the greatest ω: test_closed_form_truth
    angle = attitude_angle(even.orientation[mixed], single.orientation)
    assert np.max(angle) <= 2 * 16 * EPS
    gap = np.linalg.norm(even.angular_velocity[mixed] - single.angular_velocity, axis=-1)
    greatest = np.max(np.linalg.norm(even.angular_velocity, axis=-1))
    assert np.max(gap) <= 2 * 4 * EPS * greatest


@pytest.mark.parametrize("case", CASES, ids=lambda case: case.name)
@pytest.mark.parametrize(("start", "end"), [(0.0, 700.0), (0.0, -700.0), (500.0, 513.0)])
def test_even_times(case: Case, start: float, end: float) -> None:
    """Catches what a grid may lose: the rounding of the times, a row, the phase at time zero."""
    times = np.linspace(start, end, COUNT)
    assert all(_on_grid(times)[:2])
    _agree(case, times)


@pytest.mark.parametrize("off", [1e-13, 1e-10, 1e-7, 1e-3])
@pytest.mark.parametrize("name", ["about-greatest", "oblate"])
def test_times_that_are_nearly_even(name: str, off: float) -> None:
    """Every time a little off, but for the ends of the rows that are looked at first."""
    times = np.linspace(0.0, 700.0, COUNT)
    moved = times + off * np.random.default_rng(2).uniform(-1.0, 1.0, COUNT)
    for kept in (0, 511):
        moved[kept::512] = times[kept::512]
    assert all(_on_grid(moved)[:2])
    _agree(next(case for case in FREE if case.name == name), moved)


@pytest.mark.parametrize(
    "times",
    [
        np.linspace(-3.0, 3.0, COUNT),  # a row with zero inside, whose differences are not exact
        np.linspace(0.0, 9.0, COUNT) ** 2,
        np.linspace(0.0, 9.0, 4000),
        np.zeros(0),
    ],
    ids=["across-zero", "squares", "few", "none"],
)
def test_times_that_make_no_grid(times: Array) -> None:
    assert not any(_on_grid(times))
    motion = closed_form_of(FREE[0].system, FREE[0].initial)
    assert motion is not None
    assert motion(times).orientation.shape == (times.size, 4)


def test_one_motion_in_several_threads() -> None:
    """The arrays that are kept between calls belong to one thread each."""
    case = next(case for case in FREE if case.name == "moderate-nome")
    motion = closed_form_of(case.system, case.initial)
    assert motion is not None
    grids = [np.linspace(0.0, 10.0 + k, 20_000) for k in range(8)]
    alone = [motion(times).angular_velocity for times in grids]
    with ThreadPoolExecutor(4) as pool:
        together = list(pool.map(lambda times: motion(times).angular_velocity, grids))
    for first, second in zip(alone, together, strict=True):
        np.testing.assert_array_equal(first, second)
