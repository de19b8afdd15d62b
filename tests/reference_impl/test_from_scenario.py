"""From a scenario's keys to the system and the state, for every built-in and by hand."""

from __future__ import annotations

import numpy as np
import pytest
from reference_cases import EPS

from omegadot.reference_impl.from_scenario import initial_state_of, system_of
from omegadot.reference_impl.kinematics import place_on_pivot
from omegadot.scenarios import Scenario, builtin_names, load_builtin, scenario_of


def scenario(
    body: dict[str, object], load: dict[str, object] | None = None, **initial: object
) -> Scenario:
    data = {
        "schema": 1,
        "name": "by-hand",
        "body": body,
        "initial": {"angular_velocity": [1.0, 2.0, 3.0], **initial},
        "load": load or {},
        "run": {"duration": 1.0, "timesteps": [0.1], "sample": 0.1},
    }
    return scenario_of(data, "by-hand.toml")


PLAIN = {"mass": 2.0, "inertia": [1.0, 2.0, 2.5], "center_of_mass": [0.1, 0.2, 0.3]}


@pytest.mark.parametrize("name", builtin_names())
def test_every_built_in_is_a_system_with_a_state(name: str) -> None:
    found = load_builtin(name)
    on, initial = system_of(found), initial_state_of(found)
    assert on.body.inertia.shape == (3, 3)
    assert np.all(np.linalg.eigvalsh(on.body.inertia) > 0)
    assert np.array_equal(initial.angular_velocity, found.initial.angular_velocity)
    assert abs(np.linalg.norm(initial.orientation) - 1) <= 2 * EPS
    placed = place_on_pivot(on, initial)
    assert np.array_equal(initial.position, placed.position)
    if found.load.pivot is None:
        assert np.array_equal(initial.position, found.initial.position)
        assert np.array_equal(initial.linear_velocity, found.initial.linear_velocity)


def test_numbers_go_where_they_belong() -> None:
    found = scenario(
        PLAIN,
        {
            "gravity": [0.0, 0.0, -9.81],
            "damping": 0.5,
            "torque": {"frame": "body", "value": [1.0, 2.0, 3.0]},
        },
        orientation=[2.0, 0.0, 0.0, 0.0],
        position=[4.0, 5.0, 6.0],
        linear_velocity=[7.0, 8.0, 9.0],
    )
    on, initial = system_of(found), initial_state_of(found)
    assert on.body.mass == 2.0
    assert np.array_equal(on.body.inertia, np.diag([1.0, 2.0, 2.5]))
    assert np.array_equal(on.body.center_of_mass, [0.1, 0.2, 0.3])
    assert np.array_equal(on.load.gravity, [0.0, 0.0, -9.81])
    assert on.load.pivot is None
    assert on.load.damping == 0.5
    assert np.array_equal(on.load.torque_body, [1.0, 2.0, 3.0])
    assert not np.any(on.load.torque_world)
    assert np.array_equal(initial.orientation, [1.0, 0.0, 0.0, 0.0])
    assert np.array_equal(initial.position, [4.0, 5.0, 6.0])
    assert np.array_equal(initial.linear_velocity, [7.0, 8.0, 9.0])


def test_torque_in_world_axes_and_a_pivot() -> None:
    found = scenario(
        PLAIN, {"pivot": [0.1, 0.2, 0.0], "torque": {"frame": "world", "value": [1.0, 2.0, 3.0]}}
    )
    on, initial = system_of(found), initial_state_of(found)
    assert np.array_equal(on.load.torque_world, [1.0, 2.0, 3.0])
    assert not np.any(on.load.torque_body)
    assert np.allclose(initial.position, [0.0, 0.0, 0.3], atol=EPS)
    assert np.allclose(initial.linear_velocity, np.cross([1, 2, 3], [0, 0, 0.3]), atol=4 * EPS)


def test_torques_in_both_axes_act_each_in_its_own() -> None:
    world, body = ({"frame": f, "value": v} for f, v in (("world", [0, 1, 4]), ("body", [1, 2, 3])))
    load = system_of(scenario(PLAIN, {"torque": [world, body]})).load
    assert np.array_equal(load.torque_body, [1.0, 2.0, 3.0])
    assert np.array_equal(load.torque_world, [0.0, 1.0, 4.0])


def test_parts_are_summed() -> None:
    # a T of two cylinders: 1 kg along z, 2 kg along x across its upper end
    stem = {"shape": "cylinder", "radius": 0.1, "length": 1.0, "mass": 1.0}
    bar = {
        "shape": "cylinder",
        "radius": 0.1,
        "length": 0.8,
        "mass": 2.0,
        "position": [0.0, 0.0, 0.6],
        "orientation": [np.sqrt(0.5), 0.0, np.sqrt(0.5), 0.0],
    }
    body = system_of(scenario({"part": [stem, bar]})).body
    assert body.mass == 3.0
    assert np.allclose(body.center_of_mass, [0.0, 0.0, 0.4], atol=4 * EPS)
    apart = 1.0 * 0.4**2 + 2.0 * 0.2**2
    x = (0.01 / 4 + 1 / 12) + 2 * 0.01 / 2 + apart
    y = (0.01 / 4 + 1 / 12) + 2 * (0.01 / 4 + 0.64 / 12) + apart
    z = 0.01 / 2 + 2 * (0.01 / 4 + 0.64 / 12)
    assert np.allclose(body.inertia, np.diag([x, y, z]), atol=16 * EPS)
