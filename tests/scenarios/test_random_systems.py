"""Random systems: the same of a seed, every two traits together, and numbers that can be run.

What these tests catch: a draw that leaves a pair of traits out, or a decade; one that depends on
what was drawn before; numbers that no file can hold, or that no engine can be judged on.
"""

from dataclasses import replace
from itertools import combinations, product

import numpy as np
import pytest

from omegadot.reference_impl.from_scenario import initial_state_of, system_of
from omegadot.reference_impl.solutions.exact_solution import exact_solution
from omegadot.scenarios import ScenarioError, random_systems, scenario, scenario_of
from omegadot.scenarios.pairs import covering_rows
from omegadot.scenarios.random_systems import random_names, random_scenario
from omegadot.scenarios.random_traits import BLOCK, TRAITS, drawn

SEEDS = range(6)


def test_a_system_is_that_of_its_seed_and_number() -> None:
    last = random_scenario(3, 30)
    first = [random_scenario(3, index) for index in range(2)]
    assert (random_scenario(3, 30), random_scenario(3, 0)) == (last, first[0])
    assert scenario("random-3-30") == last
    assert random_names(3, 2) == [one.name for one in first]
    different = {one.body for one in (*first, last, random_scenario(4, 0), random_scenario(3, 24))}
    assert len(different) == 5


@pytest.mark.parametrize("seed", SEEDS)
def test_every_two_traits_occur_together_in_a_block(seed: int) -> None:
    for start in (0, BLOCK):
        rows = [drawn(seed, start + index).traits for index in range(BLOCK)]
        for one, other in combinations(TRAITS, 2):
            seen = {(row[one], row[other]) for row in rows}
            assert seen == set(product(TRAITS[one], TRAITS[other])), (one, other)


def test_rows_that_are_too_few_are_refused() -> None:
    choices = {"a": "xyz", "b": "xyz"}
    rows = covering_rows(choices, 9, np.random.default_rng(0))
    assert len({tuple(row.values()) for row in rows}) == 9
    with pytest.raises(ValueError, match="no 8 rows"):
        covering_rows(choices, 8, np.random.default_rng(0))


@pytest.mark.parametrize("seed", SEEDS)
def test_magnitudes_reach_what_engines_limit(seed: int) -> None:
    found = [random_scenario(seed, index) for index in range(BLOCK)]
    rates = [float(np.linalg.norm(one.initial.angular_velocity)) for one in found]
    speeds = [float(np.linalg.norm(one.initial.linear_velocity)) for one in found]
    masses = [one.body.mass for one in found if one.body.mass]
    steps = [one.run.duration / min(one.run.timesteps) for one in found]
    assert min(rates) == 0.0
    assert sum(0.0 < rate < 0.05 for rate in rates) >= 3
    assert max(rates) > 500.0
    assert max(speeds) > 300.0
    assert min(masses) < 1e-2
    assert max(masses) > 3000.0
    held = [one.body.mass for one in found if one.load.pivot is not None]
    assert max(held) > 1e5  # there a mass acts on the turning
    assert min(held) < 1e-3
    hanging = [
        one.body.mass
        for one in found
        if one.load.pivot and one.load.pivot != one.body.center_of_mass and any(one.load.gravity)
    ]
    assert max(hanging) > 9e4
    places = [float(np.linalg.norm(one.initial.position)) for one in found]
    assert max(places) > 1e6
    # whole numbers of nanoseconds would hide a clock that has no others
    parts = np.array([max(one.run.timesteps) for one in found]) * 1e9
    assert np.mean(np.abs(parts - np.round(parts)) > 1e-3) > 0.3
    assert max(steps) > 999
    assert sum(one.load.damping > 1.0 for one in found) >= 2
    torques = np.array([torque.value for one in found for torque in one.load.torque])
    assert (torques > 0.25).any(0).all()
    assert (torques < -0.25).any(0).all()
    assert {np.sign(one.initial.orientation[0]) for one in found} >= {-1.0, 1.0}
    assert sum(float(np.float32(mass)) == mass for mass in masses) <= 1


@pytest.mark.parametrize("index", range(BLOCK))
def test_a_system_can_be_written_solved_and_resolved(index: int) -> None:
    drawn_one = random_scenario(1, index)
    assert scenario_of(drawn_one.to_dict(), "again") == drawn_one
    system, start, steps = system_of(drawn_one), initial_state_of(drawn_one), drawn_one.run
    found = exact_solution(system, start, np.linspace(0.0, steps.duration, 50))
    rate = np.max(np.linalg.norm(found.state.angular_velocity, axis=-1))
    assert rate * steps.timesteps[0] < (1.9 if drawn(1, index).steady else 1.5)
    assert np.max(found.floor.attitude) < 1e-8
    components = np.abs(drawn_one.initial.angular_velocity)
    assert (
        not components.any()
        or drawn(1, index).steady
        or len({float(f"{part:.1g}") for part in components}) >= 2
    )


@pytest.mark.parametrize("seed", SEEDS)
def test_two_bodies_of_a_block_turn_far_and_steadily(seed: int) -> None:
    found = [random_scenario(seed, n) for n in range(BLOCK) if drawn(seed, n).steady]
    assert [[torque.value for torque in one.load.torque] for one in found] == [[(0.0,) * 3]] * 2
    moments = [np.unique(np.diag(one.body.inertia)) for one in found]
    assert sorted(map(len, moments)) == [1, 3]
    for one in found:
        omega, tensor = np.array(one.initial.angular_velocity), np.array(one.body.inertia)
        rate = float(np.linalg.norm(omega))
        assert np.linalg.norm(np.cross(omega, tensor @ omega)) <= 1e-15 * rate**2 * np.max(tensor)
        sphere = len(np.unique(np.diag(tensor))) == 1
        # where some engines cap a turn
        assert max(one.run.timesteps) * rate > (np.pi / 2 if sphere else np.pi / 4)


@pytest.mark.parametrize("seed", range(10))
def test_some_of_a_block_have_a_torque_in_each_frame(seed: int) -> None:
    """Caught: a block where an engine that is wrong only where both are given passes."""
    for start in (0, BLOCK):
        found = [random_scenario(seed, start + index) for index in range(BLOCK)]
        both = [one for one in found if len(one.load.torque) == 2]
        driven = [one for one in found if any(one.load.torque[0].value)]
        assert 4 <= len(both) <= len(driven) / 3
        assert {one.load.pivot is None for one in both} == {True, False}
        for one in both:
            first, second = (np.array(torque.value) for torque in one.load.torque)
            assert np.min(np.abs(first - second)) > 0.05 * np.max(np.abs(first))
            assert one.shows is not None
            assert "torque body and world" in one.shows


def test_a_second_torque_changes_nothing_else(monkeypatch: pytest.MonkeyPatch) -> None:
    """Caught: one that is drawn, so that all that is drawn after it changes."""
    held, driven = random_scenario(0, 5), random_scenario(0, 8)
    assert (held.body.mass, held.run.duration) == (11862.83, 0.09867795795)
    assert held.initial.angular_velocity == (-118.551, 189.853, 78.324)
    assert [one.value for one in driven.load.torque] == [(2.68415e-11, -8.1065e-11, 4.32366e-11)]
    found = [random_scenario(0, index).to_dict() for index in range(BLOCK)]
    monkeypatch.setattr(random_systems, "drawn", lambda *one: replace(drawn(*one), both=False))
    for index, one in enumerate(found):
        other = random_scenario(0, index).to_dict()
        if drawn(0, index).both:
            single, pair = other["load"].pop("torque"), one["load"].pop("torque")
            del one["shows"], other["shows"]
            (half,) = (torque["value"] for torque in pair if torque["frame"] == single["frame"])
            np.testing.assert_allclose(half, 0.5 * np.array(single["value"]), rtol=1e-5)
            assert sum(np.linalg.norm(torque["value"]) for torque in pair) == pytest.approx(
                np.linalg.norm(single["value"]), rel=1e-5
            )
        assert one == other


@pytest.mark.parametrize(
    "name", ["random-0", "random-00-1", "random-0-1-2", "random--1-0", "random-0-1000000"]
)
def test_other_names_are_no_random_systems(name: str) -> None:
    with pytest.raises(ScenarioError, match="neither a built-in scenario nor a file"):
        scenario(name)
