"""Defaults, normal forms and the exact edges of what is accepted."""

from __future__ import annotations

import copy
import math
import re
import tomllib
from itertools import pairwise
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from pydantic import TypeAdapter, ValidationError
from scenario_files import SOUND
from scipy.integrate import quad

from omegadot.scenarios import Scenario, ScenarioError, scenario_of
from omegadot.scenarios.parts import Part
from omegadot.scenarios.solids import mass, mean_squares, volume
from omegadot.scenarios.tensor import broken_triangle
from omegadot.scenarios.writing import to_toml


def changed(table: str, **values: Any) -> Scenario:
    """The sound scenario with other values in one of its tables."""
    data = copy.deepcopy(tomllib.loads(SOUND))
    data.setdefault(table, {}).update(values)
    return scenario_of(data, "test")


def of_parts(*parts: dict[str, Any]) -> Scenario:
    """The sound scenario with a body of parts."""
    return scenario_of({**tomllib.loads(SOUND), "body": {"part": list(parts)}}, "test")


def test_defaults_are_those_of_the_contract() -> None:
    scenario = scenario_of({**tomllib.loads(SOUND), "name": "b"}, "test")
    assert scenario.body.center_of_mass == (0.0, 0.0, 0.0)
    assert scenario.initial.orientation == (1.0, 0.0, 0.0, 0.0)
    assert scenario.initial.position == scenario.initial.linear_velocity == (0.0, 0.0, 0.0)
    assert scenario.load.gravity == (0.0, 0.0, 0.0)
    assert scenario.load.pivot is None
    assert scenario.load.damping == 0.0
    (torque,) = scenario.load.torque
    assert (torque.frame, torque.value) == ("body", (0.0, 0.0, 0.0))
    assert scenario.shows is None
    assert scenario.source is None
    untitled = {key: value for key, value in tomllib.loads(SOUND).items() if key != "title"}
    assert scenario_of(untitled, "test").title == "a-body"


def test_a_torque_is_a_table_or_one_in_each_frame() -> None:
    """Caught: a single torque that is written as a list, or two that depend on their order."""
    body = {"frame": "body", "value": [1.0, 2.0, 3.0]}
    world = {"frame": "world", "value": [0.0, 0.0, 4.0]}
    one, listed = changed("load", torque=body), changed("load", torque=[body])
    assert one == listed
    assert one.to_dict()["load"]["torque"] == body
    two = changed("load", torque=[world, body])
    assert two == changed("load", torque=(body, world))
    assert two.to_dict()["load"]["torque"] == [body, world]
    assert [one.frame for one in two.load.torque] == ["body", "world"]
    for found in (one, two):
        assert scenario_of(tomllib.loads(to_toml(found)), "again") == found
        assert scenario_of(found.to_dict(), "again") == found
    assert 'torque = { frame = "body", value = [1.0, 2.0, 3.0] }' in to_toml(one).splitlines()


def test_a_scenario_cannot_be_changed() -> None:
    scenario = changed("body")
    with pytest.raises(ValidationError, match="frozen"):
        scenario.name = "other"  # type: ignore[misc]
    with pytest.raises(ValidationError, match="frozen"):
        scenario.body.mass = 2.0  # type: ignore[misc]


def test_integers_become_floats_and_steps_keep_their_order() -> None:
    scenario = changed("run", duration=4, timesteps=[1, 2, 0.5], sample=1)
    assert scenario.run.timesteps == (1.0, 2.0, 0.5)
    assert all(type(step) is float for step in scenario.run.timesteps)


def test_a_step_may_be_the_whole_run() -> None:
    assert changed("run", timesteps=[1.0], sample=1.0).run.timesteps == (1.0,)


def test_a_pivot_may_be_at_the_centre_of_mass_and_leaves_the_place_out() -> None:
    scenario = changed("load", pivot=[0, 0, 0])
    assert scenario.load.pivot == (0.0, 0.0, 0.0)
    assert not {"position", "linear_velocity"} & set(scenario.to_dict()["initial"])


def test_a_text_of_several_lines_is_joined() -> None:
    data = {**tomllib.loads(SOUND), "shows": "one\n   two\n"}
    assert scenario_of(data, "test").shows == "one two"


@settings(derandomize=True, max_examples=100, deadline=None)
@given(st.lists(st.floats(-1e50, 1e50), min_size=4, max_size=4))
def test_any_quaternion_but_zero_is_normalised_in_its_own_direction(q: list[float]) -> None:
    if not any(q):
        return
    unit = changed("initial", orientation=q).initial.orientation
    eps = np.finfo(float).eps
    # half an ulp a division, one for the norm it divides by, one for the norm taken here
    assert abs(math.hypot(*unit) - 1.0) <= 4 * eps
    largest = max(range(4), key=lambda i: abs(q[i]))
    for i in range(4):
        # the smallest floats have no relative precision: 4 times the smallest of them
        assert unit[i] == pytest.approx(q[i] / q[largest] * unit[largest], rel=8 * eps, abs=2e-323)
    assert math.copysign(1, unit[largest]) == math.copysign(1, q[largest])
    assert changed("initial", orientation=unit).initial.orientation == unit


@pytest.mark.parametrize(
    "moments",
    [
        [1, 2, 3],
        [0.3, 0.6, 0.9],  # 0.3 + 0.6 < 0.9 in doubles
        [0.1, 0.2, 0.3],
        [3, 1, 2],
        [1e-6, 1, 1],
        [1e-12, 1, 1],
        [1, 1, 1],
        [5e-48, 5e-48, 1e-49],
    ],
)
def test_flat_thin_and_tiny_bodies_are_bodies(moments: list[float]) -> None:
    scenario = changed("body", inertia=moments)
    assert np.array_equal(scenario.body.inertia, np.diag(moments))
    assert changed("body", inertia=np.diag(moments).tolist()) == scenario


@settings(derandomize=True, max_examples=100, deadline=None)
@given(
    st.lists(st.floats(-1, 1), min_size=3, max_size=3),
    st.sampled_from([(1.0, 2.0, 3.0), (1e-6, 1.0, 1.0), (0.3, 0.6, 0.9), (7.0, 7.0, 7.0)]),
)
def test_a_turned_tensor_is_accepted_and_made_symmetric(
    turn: list[float], moments: tuple[float, float, float]
) -> None:
    """Rounding of R diag(I) R^T alone breaks neither symmetry nor the triangle inequality."""
    x, y, z = turn
    skew = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    cayley = np.linalg.solve(np.eye(3) - skew, np.eye(3) + skew)
    tensor = cayley @ np.diag(moments) @ cayley.T
    kept = np.array(changed("body", inertia=tensor.tolist()).body.inertia)
    assert np.array_equal(kept, kept.T)
    assert np.abs(kept - tensor).max() <= 4 * np.finfo(float).eps * max(moments)


@pytest.mark.parametrize("excess", [1e-10, 1e-6, 1.0])
def test_the_triangle_inequality_is_held_to_twelve_digits(excess: float) -> None:
    """What a flat body may be off by once it is printed; see `broken_triangle`."""
    with pytest.raises(ScenarioError, match="greatest principal moment"):
        changed("body", inertia=[1.0, 2.0, 3.0 * (1 + excess)])


@settings(derandomize=True, max_examples=100, deadline=None)
@given(st.floats(1e-3, 1e3), st.floats(1e-3, 1e3), st.lists(st.floats(-1, 1), min_size=3))
def test_a_flat_body_printed_with_twelve_digits_is_a_body(
    x: float, y: float, turn: list[float]
) -> None:
    a, b, c = turn[:3]
    skew = np.array([[0, -c, b], [c, 0, -a], [-b, a, 0]])
    cayley = np.linalg.solve(np.eye(3) - skew, np.eye(3) + skew)
    for tensor in (np.diag([x, y, x + y]), cayley @ np.diag([x, y, x + y]) @ cayley.T):
        printed = [[float(f"{(tensor[i, j] + tensor[j, i]) / 2:.12g}") for j in range(3)]
                   for i in range(3)]  # fmt: skip
        changed("body", inertia=printed)


@pytest.mark.parametrize(
    ("moments", "shown"),
    [
        ([1.0, 2.0, 4.0], "4 > 3"),
        ([1.0, 2.1233, 3.1234], "3.1234 > 3.1233"),
        ([1.0, 2.0, 3.0 + 3e-10], "3.0000000003 > 3"),
    ],
)
def test_the_numbers_of_an_impossible_inertia_show_their_difference(
    moments: list[float], shown: str
) -> None:
    with pytest.raises(ScenarioError, match=re.escape(f"({shown}), as every body's is")):
        changed("body", inertia=moments)
    allowed = changed("body", inertia=moments, allow_impossible_inertia=True)
    assert broken_triangle(np.array(allowed.body.inertia)) == shown
    assert allowed.to_dict()["body"]["allow_impossible_inertia"] is True
    with pytest.raises(ScenarioError, match="give true or false"):
        changed("body", inertia=moments, allow_impossible_inertia=1)


SLICES: list[tuple[dict[str, Any], Any]] = [
    ({"shape": "box", "size": [0.3, 0.5, 0.7]}, lambda z: (0.3 * 0.5, 0.35)),
    ({"shape": "cylinder", "radius": 0.4, "length": 1.2}, lambda z: (math.pi * 0.16, 0.6)),
    ({"shape": "sphere", "radius": 0.5}, lambda z: (math.pi * (0.25 - z * z), 0.5)),
    (
        {"shape": "ellipsoid", "semi_axes": [0.2, 0.3, 0.5]},
        lambda z: (math.pi * 0.06 * (1 - z * z / 0.25), 0.5),
    ),
    (
        {"shape": "capsule", "radius": 0.4, "length": 1.2},
        lambda z: (math.pi * (0.16 - max(abs(z) - 0.6, 0.0) ** 2), 1.0),
    ),
]


@pytest.mark.parametrize(("sizes", "area"), SLICES, ids=lambda item: str(item)[:20])
def test_volume_and_mean_squares_are_integrals_over_slices(
    sizes: dict[str, Any], area: Any
) -> None:
    part: Part = TypeAdapter(Part).validate_python({**sizes, "density": 2.0})
    half = area(0.0)[1]

    def over_slices(weight: Any) -> float:
        # halves of the capsule's and the solid's own ends apart, so that quad meets no kink
        ends = sorted({-half, -min(half, 0.6), 0.0, min(half, 0.6), half})
        return sum(quad(weight, a, b, epsabs=0, epsrel=1e-13)[0] for a, b in pairwise(ends))

    assert volume(part) == pytest.approx(over_slices(lambda z: area(z)[0]), rel=1e-12)
    assert mass(part) == pytest.approx(2 * volume(part), rel=1e-15)
    x2, y2, z2 = mean_squares(part)
    along = over_slices(lambda z: z * z * area(z)[0]) / volume(part)
    assert z2 == pytest.approx(along, rel=1e-12)
    if part.shape in ("cylinder", "sphere", "capsule"):  # a disc of area A has mean x^2 of A / 4 pi
        across = over_slices(lambda z: area(z)[0] ** 2 / (4 * math.pi)) / volume(part)
        assert (x2, y2) == pytest.approx((across, across), rel=1e-12)
    if part.shape in ("box", "ellipsoid"):  # the same shape with its axes exchanged
        key = "size" if part.shape == "box" else "semi_axes"
        exchanged = {**sizes, key: sizes[key][::-1], "density": 2.0}
        assert mean_squares(TypeAdapter(Part).validate_python(exchanged)) == (z2, y2, x2)


def test_a_point_has_mass_and_no_size() -> None:
    point: Part = TypeAdapter(Part).validate_python({"shape": "point", "mass": 2})
    assert (mass(point), volume(point), mean_squares(point)) == (2.0, 0.0, (0.0, 0.0, 0.0))


def test_points_make_a_body_once_they_leave_the_line() -> None:
    line = [{"shape": "point", "mass": 1, "position": [k, 2 * k, 0.5 * k]} for k in range(3)]
    with pytest.raises(ScenarioError, match="on one line"):
        of_parts(*line)
    assert len(of_parts(*line, {"shape": "point", "mass": 1, "position": [0, 1, 0]}).body.part) == 4


@pytest.mark.parametrize("far", [0.0, 1.0, 1e6])
def test_a_line_is_seen_as_one_wherever_it_lies(far: float) -> None:
    """Rounding of the positions must not pass for a thickness."""
    direction = np.array([0.1, 0.7, -0.3])
    places = [(far + k * direction).tolist() for k in (0.1, 0.2, 0.7)]
    points = [{"shape": "point", "mass": 0.3, "position": place} for place in places]
    with pytest.raises(ScenarioError, match="on one line"):
        of_parts(*points)


def test_a_thin_wire_is_a_body_in_any_attitude() -> None:
    wire = {"shape": "cylinder", "radius": 1e-5, "length": 1.0, "density": 7800.0}
    for orientation in ([1, 0, 0, 0], [1, 2, 3, 4]):
        body = of_parts({**wire, "orientation": orientation}).body
        assert body.mass is body.inertia is body.center_of_mass is None
