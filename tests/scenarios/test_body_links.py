"""Links of other people's files: what MuJoCo and Pinocchio make of them is what is read."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from omegadot.reference_impl.from_scenario import system_of
from omegadot.reference_impl.system import Body
from omegadot.scenarios import ScenarioError, scenario_of
from omegadot.scenarios.links import body_of_word

URDF = """<robot name="r">
 <link name="world"/>
 <link name="arm"><inertial>
  <origin xyz="0.1 -0.2 0.3" rpy="0.4 -0.5 2.6"/><mass value="2.5"/>
  <inertia ixx="0.5" ixy="0.01" ixz="-0.02" iyy="0.6" iyz="0.03" izz="0.7"/>
 </inertial></link>
 <link name="hand"><inertial><mass value="0.3"/>
  <inertia ixx="0.002" ixy="0" ixz="0" iyy="0.003" iyz="0" izz="0.004"/>
 </inertial></link>
</robot>"""
SDF = """<sdf version="1.9"><world name="w"><model name="m"><link name="arm"><inertial>
  <pose degrees="true">0.1 -0.2 0.3 30 -40 150</pose><mass>2.5</mass>
  <inertia><ixx>0.5</ixx><ixy>0.01</ixy><ixz>-0.02</ixz><iyy>0.6</iyy><iyz>0.03</iyz><izz>0.7</izz>
  </inertia></inertial></link></model></world></sdf>"""
def scenario(body: dict[str, Any]) -> Any:
    run = {"duration": 1.0, "timesteps": [0.1], "sample": 0.1}
    data = {"schema": 1, "name": "it", "initial": {"angular_velocity": [0.0, 0.0, 1.0]}}
    return scenario_of({**data, "body": body, "run": run}, "it")


def body_in(folder: Path, text: str, link: str, name: str = "file.xml") -> Body:
    """The link as the reference takes it."""
    path = folder / name
    path.write_text(text, encoding="utf-8")
    return system_of(scenario(body_of_word(f"{path}#{link}").body)).body


def assert_same(found: Body, mass: float, center: Any, inertia: Any) -> None:
    # 64 eps: quaternions made unit and turned into matrices, twice, on either side
    bound = 64 * np.finfo(float).eps
    assert found.mass == pytest.approx(mass, rel=bound)
    np.testing.assert_allclose(found.center_of_mass, center, rtol=0, atol=bound * 4)
    inertia = np.asarray(inertia)
    np.testing.assert_allclose(found.inertia, inertia, rtol=0, atol=bound * np.abs(inertia).max())


def test_urdf_links_are_those_that_pinocchio_reads(tmp_path: Path) -> None:
    pinocchio = pytest.importorskip("pinocchio")
    alone = URDF.replace('<link name="world"/>', "").split('<link name="hand">')[0] + "</robot>"
    model = pinocchio.buildModelFromXML(alone, pinocchio.JointModelFreeFlyer())
    theirs = model.inertias[1]
    found = body_in(tmp_path, URDF, "arm")
    assert_same(found, theirs.mass, theirs.lever, theirs.inertia)


def test_sdf_links_are_turned_as_urdf_links_are(tmp_path: Path) -> None:
    angles = " ".join(repr(math.radians(angle)) for angle in (30, -40, 150))
    urdf = URDF.replace('rpy="0.4 -0.5 2.6"', f'rpy="{angles}"')
    expected = body_in(tmp_path, urdf, "arm", "a.urdf")
    for link in ("arm", "m::arm"):
        found = body_in(tmp_path, SDF, link, "a.sdf")
        assert_same(found, expected.mass, expected.center_of_mass, expected.inertia)


def test_sdf_takes_quaternions_with_w_last(tmp_path: Path) -> None:
    half = math.sqrt(0.5)
    pose = f'<pose rotation_format="quat_xyzw">0 0 0 0 0 {half!r} {half!r}</pose>'
    text = SDF.replace('<pose degrees="true">0.1 -0.2 0.3 30 -40 150</pose>', pose)
    found = body_in(tmp_path, text, "arm")
    assert_same(found, 2.5, [0, 0, 0],
                [[0.6, -0.01, -0.03], [-0.01, 0.5, -0.02], [-0.03, -0.02, 0.7]])  # fmt: skip


def test_toml_bodies_are_taken_as_they_are(tmp_path: Path) -> None:
    path = tmp_path / "mine.toml"
    path.write_text("[body]\nmass = 2.0\ninertia = [1.0, 2.0, 2.5]\n", encoding="utf-8")
    named = body_of_word(str(path))
    assert named.name == "mine"
    assert named.body == {"mass": 2.0, "inertia": [1.0, 2.0, 2.5]}


BOMB = '<?xml version="1.0"?><!DOCTYPE r [<!ENTITY a "aaaa">]><robot><link name="&a;"/></robot>'
REFUSED = [
    (URDF, "#amr", "write arm"),
    (URDF, "", "write "),
    (URDF, "#nothing-like-it", "its links: world, arm, hand"),
    (URDF, "#world", "without <inertial>"),
    (URDF.replace('value="2.5"', 'value="${m}"'), "#arm", "xacro"),
    (URDF.replace('value="2.5"', 'value="heavy"'), "#arm", "give a number"),
    (URDF.replace('value="2.5"', 'value="nan"'), "#arm", "give a number"),
    (URDF.replace(' izz="0.7"', ""), "#arm", "izz"),
    (URDF.replace('"hand"', '"arm"'), "#arm", "the name of 2"),
    ("<robot/>", "#arm", "without a named link"),
    ("<robot><link", "#arm", "not valid XML"),
    ("<html/>", "#arm", "give a URDF, an MJCF or an SDF"),
    (BOMB, "#arm", "document type"),
    ("<robot>" + "<a>" * 600 + "</a>" * 600 + "</robot>", "#arm", "nested"),
    (SDF.replace("<pose ", '<pose relative_to="x" '), "#arm", "relative to"),
    (SDF.replace("<inertial>", '<inertial auto="true">'), "#arm", "auto"),
    (SDF.replace("<mass>2.5</mass>", ""), "#arm", "mass"),
    (MJCF.format(compiler='settotalmass="3"', content=INERTIALS[0][1]), "#arm", "settotalmass"),
    (MJCF.format(compiler="", content='<geom type="mesh" mesh="m"/>'), "#arm", "<inertial>"),
    (MJCF.format(compiler="", content=""), "#arm", "without geoms"),
    (MJCF.format(compiler="", content='<geom fromto="0 0 0 1 0 0" type="capsule" size=".1"/>'),
     "#arm", "fromto"),
    (MJCF.format(compiler="", content=INERTIALS[10][1]).replace(
        "<worldbody>", "<default><geom density='3'/></default><worldbody>"), "#arm", "defaults"),
    (MJCF.format(compiler='boundmass="9"', content=INERTIALS[0][1]), "#arm", "boundmass"),
]  # fmt: skip


@pytest.mark.parametrize(("text", "link", "statement"), REFUSED)
def test_what_cannot_be_read_is_told_in_one_sentence(
    tmp_path: Path, text: str, link: str, statement: str
) -> None:
    path = tmp_path / "file.xml"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(ScenarioError) as caught:
        body_of_word(f"{path}{link}")
    sentence = str(caught.value)
    assert statement in sentence
    assert "file.xml" in sentence
    assert "\n" not in sentence


@pytest.mark.parametrize("term", ["missing.urdf#a", ".#a", "\0#a", "missing.toml"])
def test_files_that_are_none_are_told(term: str) -> None:
    with pytest.raises(ScenarioError):
        body_of_word(term)


def test_a_body_that_breaks_the_triangle_inequality_is_told_with_its_key(tmp_path: Path) -> None:
    text = URDF.replace('izz="0.004"', 'izz="0.04"')
    with pytest.raises(ScenarioError, match=r"body\.inertia.*principal moment"):
        body_in(tmp_path, text, "hand")
