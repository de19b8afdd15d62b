"""Bodies of MJCF files are those of MuJoCo's compiled model, and where it lacks files, certain."""

from __future__ import annotations

import math
import re
import sys
from pathlib import Path
from typing import Any

import mujoco
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from omegadot.adapters.mujoco import body_file
from omegadot.adapters.mujoco.adapter import MujocoAdapter
from omegadot.adapters.mujoco.body_file import bodies_of_mjcf, compiled, links_of
from omegadot.reference_impl.from_scenario import initial_state_of, system_of
from omegadot.scenarios import ScenarioError, load_builtin
from omegadot.scenarios.links.body_file import body_of_argument
from omegadot.scenarios.links.link import Link

FILES = {
    "radian.xml": '<mujoco><compiler angle="radian"/></mujoco>',
    "light.xml": '<mujoco><default><geom density="500"/></default></mujoco>',
    "ball.xml": '<mujoco><geom size=".1" pos="0 0 1"/></mujoco>',
    "seven.xml": '<mujoco><compiler settotalmass="7"/></mujoco>',
    "part.xml": '<mujoco><worldbody><body name="p"><geom size=".1 .2 .3" type="box"/></body>'
    "</worldbody></mujoco>",
    "again.xml": '<mujoco><include file="again.xml"/></mujoco>',
}
BOX = '<geom type="box" size=".1 .2 .3"/>'
INERTIAL = '<inertial pos="1 2 3" mass="2" diaginertia="1 2 2.5"/>'
MESH = '<geom type="mesh" mesh="m"/>'
ASSETS = '<asset><mesh name="m" file="none.stl"/></asset>'


def mjcf(inside: str, before: str = "", joint: str = "<freejoint/>") -> str:
    """A body called a."""
    return f'<mujoco>{before}<worldbody><body name="a">{joint}{inside}</body></worldbody></mujoco>'


def inertial(orientation: str) -> str:
    return INERTIAL.replace("<inertial", f"<inertial {orientation}")


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The current folder, with what the files below include."""
    for name, text in FILES.items():
        (tmp_path / name).write_text(text, encoding="utf-8")
    monkeypatch.chdir(tmp_path)
    return tmp_path


def bodies(text: str) -> dict[str, Any]:
    Path("it.xml").write_text(text, encoding="utf-8")
    return compiled("it.xml")


def in_process(path: Path, file: str) -> list[Link]:
    """As bodies_of_mjcf, without the second it takes to start a process."""
    return links_of(compiled(str(path)), file)


COMPILED = {
    "diagonal": mjcf(INERTIAL),
    "quat": mjcf(inertial('quat="1 2 -3 .5"')),
    "euler": mjcf(inertial('euler="30 40 -50"')),
    "eulerseq": mjcf(
        inertial('euler=".3 .4 -.5"'), '<compiler angle="radian" eulerseq="ZYx"/>'
    ),
    "axisangle": mjcf(inertial('axisangle="1 2 3 70"')),
    "xyaxes": mjcf(inertial('xyaxes="1 1 0 0 1 2"')),
    "zaxis": mjcf(inertial('zaxis="1 -1 .2"')),
    "full": mjcf('<inertial pos="0 0 1" mass="2" fullinertia="1 2 2.5 .1 -.2 .3"/>'),
    "geoms": mjcf(BOX + '<geom size=".2" mass="3" pos="1 0 0"/><geom size="1" mass="0"/>'),
    "fromto": mjcf('<geom type="capsule" size=".05" fromto="0 0 0 0 .1 -.4"/>'),
    "from geoms": mjcf(INERTIAL + BOX, '<compiler inertiafromgeom="true"/>'),
    "group range": mjcf(
        BOX + '<geom size="1" group="3"/>', '<compiler inertiagrouprange="0 2"/>'
    ),
    "balanced": mjcf(
        '<inertial pos="0 0 0" mass="2" diaginertia="1 2 4"/>', '<compiler balanceinertia="true"/>'
    ),
    "bounds": mjcf('<geom size=".1"/>', '<compiler boundmass="9" boundinertia="8"/>'),
    "aligned": mjcf(
        '<geom type="box" size=".1 .2 .3" pos=".1 0 0" euler="0 0 30"/>',
        joint='<freejoint align="true"/>',
    ),
    "fused": mjcf(
        BOX + '<body name="b" pos="1 0 0"><geom size=".2"/></body>',
        '<compiler fusestatic="true"/>',
    ),
    "discarded": mjcf(
        BOX + '<geom size=".2" contype="0" conaffinity="0"/>', '<compiler discardvisual="true"/>'
    ),
    "class": mjcf(
        '<geom class="c"/>',
        '<default><default class="c"><geom type="box" size=".1 .2 .3" mass="4"/></default>'
        "</default>",
    ),
    "child class": mjcf(BOX, '<default><default class="c"><geom density="9"/></default></default>')
    .replace('name="a"', 'name="a" childclass="c"'),
    "frames": mjcf(f'<frame pos="0 0 1" euler="0 90 0"><frame pos="1 0 0">{BOX}</frame></frame>'),
    "include sets radians": mjcf(inertial('euler="0 0 1"'), '<include file="radian.xml"/>'),
    "include sets a default": mjcf(BOX, '<include file="light.xml"/>'),
    "include in the body": mjcf(BOX + '<include file="ball.xml"/>'),
    "include sets the total": mjcf(INERTIAL, '<include file="seven.xml"/>'),
    "replicate": mjcf(
        BOX + '<replicate count="3" euler="0 0 120"><geom size=".1" pos="1 0 0"/></replicate>'
    ),
    "attach": mjcf(
        BOX + '<attach model="x" body="p" prefix="q_"/>',
        '<asset><model name="x" file="part.xml"/></asset>',
    ),
}  # fmt: skip


@pytest.mark.parametrize("text", COMPILED.values(), ids=COMPILED)
@pytest.mark.filterwarnings("ignore:.*settotalmass")
def test_bodies_are_those_of_the_compiled_model(folder: Path, text: str) -> None:
    found = bodies(text)["bodies"]
    model = mujoco.MjModel.from_xml_path("it.xml")
    assert list(found) == [model.body(index).name for index in range(1, model.nbody)]
    for name, body in found.items():
        index = model.body(name).id
        rotation = np.empty(9)
        mujoco.mju_quat2Mat(rotation, model.body_iquat[index])
        axes = rotation.reshape(3, 3)
        tensor = axes @ np.diag(model.body_inertia[index]) @ axes.T
        assert body["mass"] == model.body_mass[index]
        assert body["center_of_mass"] == model.body_ipos[index].tolist()
        # R I R^T twice, each a sum of nine products of three factors within |I|
        bound = 32 * np.finfo(float).eps * np.abs(tensor).max()
        np.testing.assert_allclose(body["inertia"], tensor, rtol=0, atol=bound)


@pytest.mark.parametrize(
    ("case", "mass", "center", "moment"),
    [
        ("include sets radians", 2.0, 1.0, 1 + math.sin(1.0) ** 2),  # diag(1, 2, .) turned by 1 rad
        ("include sets a default", 24.0, 0.0, 24 * (0.4**2 + 0.6**2) / 12),
        ("include sets the total", 7.0, 1.0, 3.5),
        ("include in the body", 48 + 4000 / 3 * math.pi * 1e-3, 0.0, None),
        ("replicate", 48 + 4000 * math.pi * 1e-3, 0.0, None),
    ],
)
def test_what_other_files_and_settings_change_is_worked_out_by_hand(
    folder: Path, case: str, mass: float, center: float, moment: float | None
) -> None:
    body = bodies(COMPILED[case])["bodies"]["a"]
    # a few roundings of sums of a few terms, of the order of one metre
    assert body["mass"] == pytest.approx(mass, rel=1e-14)
    assert body["center_of_mass"][0] == pytest.approx(center, abs=1e-14)
    if moment is not None:
        assert body["inertia"][0][0] == pytest.approx(moment, rel=1e-14)


CERTAIN = {
    "inertial": mjcf(INERTIAL + MESH, ASSETS),
    "massless meshes": mjcf(BOX + MESH.replace("/>", ' mass="0"/>'), ASSETS),
    "weightless meshes": mjcf(BOX + MESH.replace("/>", ' density="0"/>'), ASSETS),
    "meshes out of range": mjcf(
        BOX + MESH.replace("/>", ' group="2"/>'), ASSETS + '<compiler inertiagrouprange="0 1"/>'
    ),
    "fitted": mjcf(INERTIAL + '<geom type="box" mesh="m"/>', ASSETS),
    "mesh elsewhere": mjcf(f"{BOX}</body><body name='b'><freejoint/>{MESH}", ASSETS),
    "texture": mjcf(
        BOX.replace("/>", ' material="k"/>'),
        '<asset><texture name="t" type="2d" file="none.png"/><material name="k" texture="t"/>'
        "</asset>",
    ),
    "height field": mjcf(
        f'{BOX}</body><body name="ground"><geom type="hfield" hfield="h"/>',
        '<asset><hfield name="h" file="none.png" size="1 1 1 1"/></asset>',
    ),
    "inherited": mjcf(
        INERTIAL + '<geom class="c"/>',
        '<default><default class="c"><geom type="mesh" mesh="m"/></default></default>' + ASSETS,
    ),
}
UNCERTAIN = {
    "no inertial": mjcf(MESH, ASSETS),
    "mass alone": mjcf(MESH.replace("/>", ' mass="2"/>'), ASSETS),
    "total": mjcf(
        f"{INERTIAL}</body><body name='b'>{MESH}", ASSETS + '<compiler settotalmass="5"/>'
    ),
    "from geoms": mjcf(INERTIAL + MESH, ASSETS + '<compiler inertiafromgeom="true"/>'),
    "fused": mjcf(
        f"{INERTIAL}<body name='b'>{MESH}</body>", ASSETS + '<compiler fusestatic="true"/>'
    ),
    "fitted": mjcf('<geom type="capsule" mesh="m"/>', ASSETS),
}


@pytest.mark.parametrize("text", CERTAIN.values(), ids=CERTAIN)
def test_bodies_that_do_not_depend_on_missing_files_are_read(folder: Path, text: str) -> None:
    found = bodies(text)
    without = re.sub(r"<geom[^>]*(mesh|hfield|class)=[^>]*>| material=\"k\"|<asset>.*</asset>", "",
                     text)  # fmt: skip
    if "'b'" in without:  # MuJoCo takes no moving body without mass
        without = without.replace("<freejoint/></body></worldbody>", "</body></worldbody>")
    assert found["bodies"]["a"] == bodies(without)["bodies"]["a"]
    assert "none." in found["lacking"]


@pytest.mark.parametrize("text", UNCERTAIN.values(), ids=UNCERTAIN)
def test_bodies_that_may_depend_on_missing_files_are_refused(folder: Path, text: str) -> None:
    assert bodies(text)["bodies"]["a"] is None
    with pytest.raises(ScenarioError, match=r"body 'a' is dependent on files .*none\.stl"):
        body_of_argument("it.xml#a", in_process)


REFUSED = {
    mjcf(INERTIAL, '<compiler coordinate="global"/>'): "global",
    mjcf(INERTIAL, '<include file="nowhere.xml"/>'): "nowhere.xml",
    mjcf(INERTIAL, '<include file="again.xml"/>'): "again.xml",
    mjcf(INERTIAL + '<geom type="mesh" mesh="undefined"/>'): "undefined",
    mjcf(INERTIAL.replace('pos="1 2 3"', "")): "pos",
    mjcf('<inertial pos="0 0 0" mass="1" diaginertia="1 2 3.1"/>'): "A + B >= C",
    mjcf(""): "mass and inertia of moving bodies",
    mjcf(INERTIAL + "</frame>"): "XML",
    mjcf(f"{INERTIAL}<body name='a'>{BOX}</body>"): "repeated name",
    "<mujoco>" + "<a>" * 3000: "nest",
}


@pytest.mark.parametrize(("text", "reason"), REFUSED.items(), ids=REFUSED.values())
def test_what_mujoco_refuses_is_refused_with_its_reason(
    folder: Path, text: str, reason: str
) -> None:
    Path("it.xml").write_text(text, encoding="utf-8")
    with pytest.raises(ScenarioError) as caught:
        body_of_argument("it.xml#a", in_process)
    assert reason in str(caught.value)
    assert "\n" not in str(caught.value)


def test_undeclared_latin_1_is_read(folder: Path) -> None:
    text = mjcf(BOX).replace('"a"', '"pi\xe8ce"')
    Path("it.xml").write_bytes(text.encode("latin-1"))
    assert body_of_argument("it.xml#pi\xe8ce", in_process).body["mass"] == pytest.approx(48.0)


def test_a_body_is_read_in_a_process_of_its_own(folder: Path) -> None:
    Path("it.xml").write_text(COMPILED["fused"], encoding="utf-8")
    named = body_of_argument("it.xml#a", bodies_of_mjcf)
    assert named.body == compiled("it.xml")["bodies"]["a"]
    with pytest.raises(
        ScenarioError, match="body 'A' is missing; write a, its body with a mass: a"
    ):
        body_of_argument("it.xml#A", in_process)


def test_bodies_without_mass_are_not_suggested(folder: Path) -> None:
    Path("it.xml").write_text(mjcf(BOX, joint='<body name="empty"/>'), encoding="utf-8")
    with pytest.raises(ScenarioError, match=r"without a body; write it\.xml#a, its body with"):
        body_of_argument("it.xml", in_process)
    with pytest.raises(ScenarioError, match="body 'empty' is without mass"):
        body_of_argument("it.xml#empty", in_process)


def test_a_compiler_that_takes_long_or_dies_is_reported(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    Path("it.xml").write_text(mjcf(BOX), encoding="utf-8")
    monkeypatch.setattr(body_file, "SECONDS", 1e-3)
    with pytest.raises(ScenarioError, match=r"did not compile within 0\.001 s"):
        bodies_of_mjcf(Path("it.xml"), "it.xml")
    monkeypatch.setattr(body_file, "SECONDS", 60.0)
    monkeypatch.setattr(body_file, "__name__", "no_such_module")
    with pytest.raises(ScenarioError, match=r"ended its process \(exit code 1\)"):
        bodies_of_mjcf(Path("it.xml"), "it.xml")


def test_without_mujoco_an_mjcf_states_how_to_install_it(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, "mujoco", None)
    assert bodies(mjcf(BOX))["refused"][1] == "install it: pip install 'omegadot[mujoco]'"


def test_nothing_is_written_into_the_current_folder(folder: Path) -> None:
    """MuJoCo warns of a NaN in a file and of a state that diverges."""
    before = {*folder.iterdir(), folder / "it.xml"}
    mujoco.set_mju_user_warning(None)
    adapter = MujocoAdapter("as-shipped")
    bodies(mjcf('<geom size="nan"/>'))
    scenario = load_builtin("t-handle")
    adapter.load(system_of(scenario))
    state = initial_state_of(scenario)
    fast = type(state)(**{**vars(state), "angular_velocity": np.array([1e30, 0.0, 0.0])})
    adapter.run(fast, "Euler", 0.01, 3, 1)
    assert set(folder.iterdir()) == before


VALUES = ["-1", "0", "1e308", "nan", "inf", "", "x", "1 2 3", "auto", "mesh", "hfield", "a", "m"]


@settings(derandomize=True, max_examples=150, deadline=None)
@given(
    text=st.sampled_from([*COMPILED.values(), *CERTAIN.values()]),
    places=st.lists(st.floats(0, 1), min_size=1, max_size=5),
    values=st.lists(st.sampled_from(VALUES), min_size=5, max_size=5),
)
def test_a_spoilt_mjcf_is_read_or_refused(
    tmp_path_factory: pytest.TempPathFactory, text: str, places: list[float], values: list[str]
) -> None:
    for place, value in zip(places, values, strict=False):
        attributes = list(re.finditer(r'="([^"]*)"', text))
        start, end = attributes[int(place * (len(attributes) - 1))].span(1)
        text = text[:start] + value + text[end:]
    path = tmp_path_factory.getbasetemp() / "spoilt.xml"
    path.write_text(text, encoding="utf-8")
    answer = compiled(str(path))
    assert set(answer) in ({"bodies", "lacking"}, {"refused"})
