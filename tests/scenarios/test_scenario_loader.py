"""Names, paths and dicts lead to the same scenario, and garbage to a ScenarioError."""

from __future__ import annotations

import json
import pickle
import subprocess
import sys
import tomllib
from collections.abc import Callable
from pathlib import Path

import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from scenario_files import SOUND, with_line, write

from omegadot.scenarios import (
    Scenario,
    ScenarioError,
    builtin_names,
    load_builtin,
    load_scenario,
    scenario,
    scenario_of,
)

NUMBER = st.floats(-1e3, 1e3)
VECTOR = st.lists(NUMBER, min_size=3, max_size=3)
POSITIVE = st.floats(1e-3, 1e3)
SCALAR = st.none() | st.booleans() | st.integers() | st.floats() | st.text(max_size=20) | st.dates()
ANYTHING = st.recursive(
    SCALAR,
    lambda inner: st.lists(inner, max_size=4) | st.dictionaries(st.text(max_size=8), inner),
    max_leaves=8,
)
SOLID = st.one_of(
    st.fixed_dictionaries(
        {"shape": st.just("box"), "size": st.lists(POSITIVE, min_size=3, max_size=3)}
    ),
    st.fixed_dictionaries(
        {"shape": st.sampled_from(["cylinder", "capsule"]), "radius": POSITIVE, "length": POSITIVE}
    ),
    st.fixed_dictionaries({"shape": st.just("sphere"), "radius": POSITIVE}),
)


def outcome(load: Callable[[], Scenario]) -> str:
    """The loaded scenario's name, or the sentence; any other exception goes through."""
    try:
        return load().name
    except ScenarioError as error:
        return str(error)


@st.composite
def sound_dicts(draw: st.DrawFn) -> dict[str, object]:
    """A valid scenario: any principal moments of three positive second moments, or a solid."""
    a, b, c = (draw(POSITIVE) for _ in range(3))
    solid = {**draw(SOLID), draw(st.sampled_from(["mass", "density"])): draw(POSITIVE)}
    whole = {"mass": draw(POSITIVE), "inertia": [b + c, a + c, a + b]}
    orientation = [*draw(VECTOR), draw(st.floats(1e-3, 1.0))]
    pivot = {"pivot": draw(VECTOR)} if draw(st.booleans()) else {}
    place = {} if pivot else {"position": draw(VECTOR)}
    frames = draw(st.sampled_from([["body"], ["world"], ["body", "world"], ["world", "body"]]))
    torques = [{"frame": frame, "value": draw(VECTOR)} for frame in frames]
    torque = torques if len(torques) > 1 else torques[0]
    return {
        "schema": 1,
        "name": "a-body",
        "body": draw(st.sampled_from([whole, {"part": [solid]}])),
        "initial": {"angular_velocity": draw(VECTOR), "orientation": orientation, **place},
        "load": {"gravity": draw(VECTOR), "torque": torque, **pivot},
        "run": {"duration": draw(st.floats(1.0, 9.0)), "timesteps": [0.5, 0.25], "sample": 0.5},
    }


@settings(derandomize=True, max_examples=100, deadline=None)
@given(sound_dicts())
def test_a_scenario_survives_json(data: dict[str, object]) -> None:
    scenario = scenario_of(data, "drawn")
    again = scenario_of(json.loads(json.dumps(scenario.to_dict())), "again")
    assert again == scenario
    assert hash(again) == hash(scenario)


@pytest.mark.parametrize("name", builtin_names())
def test_every_builtin_survives_json_and_pickle(name: str) -> None:
    scenario = load_builtin(name)
    assert scenario_of(json.loads(json.dumps(scenario.to_dict())), name) == scenario
    assert pickle.loads(pickle.dumps(scenario)) == scenario


@settings(derandomize=True, max_examples=150, deadline=None)
@given(st.data())
def test_anything_in_any_place_is_a_scenario_or_a_sentence(data: st.DataObject) -> None:
    table = tomllib.loads(SOUND)
    home = data.draw(st.sampled_from([table, table["body"], table["initial"], table["run"]]))
    key = data.draw(
        st.sampled_from([*home, "load", "part", "pivot", "torque"]) | st.text(max_size=9)
    )
    home[key] = data.draw(ANYTHING)
    assert outcome(lambda: scenario_of(table, "drawn")).isprintable()


@settings(derandomize=True, max_examples=150, deadline=None)
@given(st.binary(max_size=200) | st.text(max_size=200).map(str.encode), st.integers(0, len(SOUND)))
def test_garbage_in_a_file_is_a_scenario_or_a_sentence(
    tmp_path_factory: pytest.TempPathFactory, garbage: bytes, place: int
) -> None:
    sound = SOUND.encode()
    path = write(tmp_path_factory.getbasetemp(), sound[:place] + garbage + sound[place:])
    assert outcome(lambda: load_scenario(path)).isprintable()


@settings(derandomize=True, max_examples=150, deadline=None)
@given(st.text(max_size=30))
def test_no_name_leads_out_of_the_builtins(name: str) -> None:
    assume(name not in builtin_names())
    for find in (load_builtin, scenario):
        with pytest.raises(ScenarioError) as caught:
            find(name)
        assert str(caught.value).isprintable()


def test_a_builtin_goes_before_a_file_of_its_name(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    write(tmp_path, SOUND, "sphere")
    write(tmp_path, SOUND, "mine")
    assert scenario("sphere").name == "sphere"
    assert scenario("./sphere").name == "a-body"
    assert scenario("mine").name == "a-body"


@pytest.mark.parametrize(
    ("requested", "near"),
    [("t-handel", "t-handle"), ("T-HANDLE", "t-handle"), ("fulltensor", "full-tensor")],
)
def test_a_mistyped_builtin_is_offered_the_nearest(requested: str, near: str) -> None:
    for find in (load_builtin, scenario):
        with pytest.raises(ScenarioError, match=f"write {near} if"):
            find(requested)


def test_a_name_like_no_builtin_gets_advice() -> None:
    with pytest.raises(
        ScenarioError, match="'zzz' is neither a built-in scenario nor a file; give"
    ):
        scenario("zzz")
    with pytest.raises(ScenarioError, match=r"zzz\.toml is missing"):
        scenario("zzz.toml")


def test_markup_and_other_alphabets_are_plain_text(tmp_path: Path) -> None:
    text = with_line('title = "A body"', 'title = "<script>alert(1)</script> ω̇ 零"')
    assert load_scenario(write(tmp_path, text)).title == "<script>alert(1)</script> ω̇ 零"


def test_editors_of_all_systems(tmp_path: Path) -> None:
    windows = b"\xef\xbb\xbf" + SOUND.replace("\n", "\r\n").encode()
    assert load_scenario(write(tmp_path, windows)) == load_scenario(
        write(tmp_path, SOUND, "b.toml")
    )


def test_importing_the_room_brings_in_nothing_heavy() -> None:
    heavy = "{'scipy', 'polars', 'mujoco', 'pinocchio', 'dartpy', 'plotly'}"
    code = f"import omegadot.scenarios, sys; sys.exit(str({heavy} & set(sys.modules)) != 'set()')"
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0
