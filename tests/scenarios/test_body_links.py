"""Links of other people's files: what the formats' own libraries make of them is what is read."""

from __future__ import annotations

import math
import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from omegadot.reference_impl.from_scenario import system_of
from omegadot.reference_impl.system import Body
from omegadot.scenarios import ScenarioError, scenario_of
from omegadot.scenarios.links.body_file import NamedBody, body_of_argument
from omegadot.scenarios.links.link import Link
from omegadot.scenarios.tensor import broken_triangle

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
QUATERNION = URDF.replace('name="r"', 'name="r" version="1.2"').replace(
    'rpy="0.4 -0.5 2.6"', 'quat_xyzw="0.1 -0.2 0.5 1"'
)
INERTIAL = """<inertial>
  <pose degrees="true">0.1 -0.2 0.3 30 -40 150</pose><mass>2.5</mass>
  <inertia><ixx>0.5</ixx><ixy>0.01</ixy><ixz>-0.02</ixz><iyy>0.6</iyy><iyz>0.03</iyz><izz>0.7</izz>
  </inertia></inertial>"""
SDF = f"""<sdf version="1.9"><world name="w"><model name="m"><link name="arm">{INERTIAL}</link>
  </model></world></sdf>"""
TWO = f"""<sdf><model name="m"><link name="arm">{INERTIAL}</link><link name="base"/>
  <model name="n"><link name="arm">{INERTIAL}</link><link name="tip">{INERTIAL}</link></model>
  </model></sdf>"""
AUTO = """<sdf version="1.11"><model name="m"><link name="a"><inertial auto="true">{inertial}
  </inertial>{collisions}</link></model></sdf>"""
XACRO = """<robot xmlns:xacro="http://www.ros.org/wiki/xacro" name="r">
 <xacro:macro name="leg"><link name="leg"/></xacro:macro><xacro:leg/>
 <link name="foot"><inertial><mass value="${m}"/></inertial></link>
 <link name="toe"><xacro:solid m="2"/></link></robot>"""


def no_mjcf(path: Path, file: str) -> list[Link]:
    raise AssertionError(f"{path} was taken for an MJCF")


def scenario(body: dict[str, Any]) -> Any:
    run = {"duration": 1.0, "timesteps": [0.1], "sample": 0.1}
    data = {"schema": 1, "name": "it", "initial": {"angular_velocity": [0.0, 0.0, 1.0]}}
    return scenario_of({**data, "body": body, "run": run}, "it")


def named(folder: Path, text: str | bytes, link: str, name: str = "file.xml") -> NamedBody:
    path = folder / name
    path.write_bytes(text.encode() if isinstance(text, str) else text)
    return body_of_argument(f"{path}{link}", no_mjcf)


def body_in(folder: Path, text: str | bytes, link: str) -> Body:
    """The link as the reference takes it."""
    return system_of(scenario(named(folder, text, f"#{link}").body)).body


def assert_same(found: Body, mass: float, center: Any, inertia: Any) -> None:
    # 64 eps: quaternions made unit and turned into matrices, twice, on either side
    bound = 64 * np.finfo(float).eps
    assert found.mass == pytest.approx(mass, rel=bound)
    np.testing.assert_allclose(found.center_of_mass, center, rtol=0, atol=bound * 4)
    inertia = np.asarray(inertia)
    np.testing.assert_allclose(found.inertia, inertia, rtol=0, atol=bound * np.abs(inertia).max())


@pytest.mark.parametrize("text", [URDF, QUATERNION], ids=["rpy", "quat_xyzw"])
def test_urdf_links_are_those_that_pinocchio_reads(tmp_path: Path, text: str) -> None:
    pinocchio = pytest.importorskip("pinocchio")
    alone = text.replace('<link name="world"/>', "").split('<link name="hand">')[0] + "</robot>"
    model = pinocchio.buildModelFromXML(alone, pinocchio.JointModelFreeFlyer())
    theirs = model.inertias[1]
    found = body_in(tmp_path, text, "arm")
    assert_same(found, theirs.mass, theirs.lever, theirs.inertia)


def test_a_quaternion_turns_the_inertia(tmp_path: Path) -> None:
    half = math.sqrt(0.5)
    text = QUATERNION.replace("0.1 -0.2 0.5 1", f"0 0 {half!r} {half!r}")
    found = body_in(tmp_path, text, "arm")
    assert_same(found, 2.5, [0.1, -0.2, 0.3],
                [[0.6, -0.01, -0.03], [-0.01, 0.5, -0.02], [-0.03, -0.02, 0.7]])  # fmt: skip


def test_sdf_links_are_turned_as_urdf_links_are(tmp_path: Path) -> None:
    angles = " ".join(repr(math.radians(angle)) for angle in (30, -40, 150))
    urdf = URDF.replace('rpy="0.4 -0.5 2.6"', f'rpy="{angles}"')
    expected = body_in(tmp_path, urdf, "arm")
    for link in ("arm", "m::arm"):
        found = body_in(tmp_path, SDF, link)
        assert_same(found, expected.mass, expected.center_of_mass, expected.inertia)


def test_sdf_takes_quaternions_with_w_last(tmp_path: Path) -> None:
    half = math.sqrt(0.5)
    pose = f'<pose rotation_format="quat_xyzw">0 0 0 0 0 {half!r} {half!r}</pose>'
    text = SDF.replace('<pose degrees="true">0.1 -0.2 0.3 30 -40 150</pose>', pose)
    found = body_in(tmp_path, text, "arm")
    assert_same(found, 2.5, [0, 0, 0],
                [[0.6, -0.01, -0.03], [-0.01, 0.5, -0.02], [-0.03, -0.02, 0.7]])  # fmt: skip


def test_links_of_one_name_take_the_name_of_their_model(tmp_path: Path) -> None:
    for link in ("m::arm", "m::n::arm", "n::arm", "tip", "n::tip", "m::n::tip"):
        assert named(tmp_path, TWO, f"#{link}").body["mass"] == 2.5
    with pytest.raises(ScenarioError, match="the name of 2; write m::arm or m::n::arm"):
        named(tmp_path, TWO, "#arm")
    with pytest.raises(ScenarioError, match=r"its links with a mass: m::arm, m::n::arm, tip\.$"):
        named(tmp_path, TWO, "#nothing-like-it")


def collision(shape: str, more: str = "", name: str = "c") -> str:
    return f'<collision name="{name}">{more}<geometry>{shape}</geometry></collision>'


BOX = "<box><size>0.2 0.4 0.6</size></box>"
BALL = "<sphere><radius>0.3</radius></sphere>"
ROUND = "<{0}><radius>0.2</radius><length>0.5</length></{0}>"
SOLIDS = {  # mass at 1000 kg/m^3, height of the centre of mass, moments over the mass
    BOX: (48.0, 0.0, (0.52 / 12, 0.4 / 12, 0.2 / 12)),
    BALL: (4000 / 3 * math.pi * 0.027, 0.0, (0.036, 0.036, 0.036)),
    "<ellipsoid><radii>0.1 0.2 0.3</radii></ellipsoid>": (
        8 * math.pi, 0.0, (0.13 / 5, 0.1 / 5, 0.05 / 5)),
    ROUND.format("cylinder"): (
        20 * math.pi, 0.0, (0.01 + 0.25 / 12, 0.01 + 0.25 / 12, 0.02)),
    # a cone on its base: 3/80 (4 r^2 + h^2) and 3/10 r^2, a quarter of its height up
    ROUND.format("cone"): (20 / 3 * math.pi, -0.125, (0.41 * 3 / 80, 0.41 * 3 / 80, 0.012)),
}  # fmt: skip
# a capsule: the cylinder and a ball whose halves are half its length away
TUBE, CAPS = 20 * math.pi, 4000 / 3 * math.pi * 0.008
ACROSS = TUBE * (0.01 + 0.25 / 12) + CAPS * (0.4 * 0.04 + 0.25 / 4 + 3 / 8 * 0.5 * 0.2)
ALONG = TUBE * 0.02 + CAPS * 0.016
SOLIDS[ROUND.format("capsule")] = (
    TUBE + CAPS,
    0.0,
    tuple(moment / (TUBE + CAPS) for moment in (ACROSS, ACROSS, ALONG)),
)


@pytest.mark.parametrize(("shape", "expected"), SOLIDS.items(), ids=lambda item: str(item)[:6])
@pytest.mark.parametrize("turned", [False, True])
def test_an_inertia_is_computed_from_a_plain_shape(
    tmp_path: Path, shape: str, expected: Any, turned: bool
) -> None:
    mass, height, moments = expected
    pose = "<pose degrees='true'>1 2 3 0 90 0</pose>" if turned else ""  # z to x, x to -z
    found = body_in(tmp_path, AUTO.format(inertial="", collisions=collision(shape, pose)), "a")
    center = [1 + height, 2, 3] if turned else [0, 0, height]
    x, y, z = (mass * moment for moment in moments)
    inertia = np.diag([z, y, x] if turned else [x, y, z])
    assert_same(found, mass, center, inertia)


def test_shapes_add_up_with_densities_of_their_own(tmp_path: Path) -> None:
    """Two boxes end to end are one, however the density comes to be the same."""
    half = "<box><size>0.1 0.4 0.6</size></box>"
    left = collision(half, "<pose>-0.05 0 0 0 0 0</pose><density>500</density>", "l")
    right = collision(half, "<pose>0.05 0 0 0 0 0</pose>", "r")
    text = AUTO.format(inertial="<density>500</density>", collisions=left + right)
    assert_same(body_in(tmp_path, text, "a"), 24.0, [0, 0, 0], np.diag([1.04, 0.8, 0.4]))
    lighter = text.replace("<density>500</density>", "<density>250</density>", 1)
    found = body_in(tmp_path, lighter, "a")  # the right half keeps to the inertial's density
    assert_same(found, 18.0, [-0.05 / 3, 0, 0], found.inertia)


def test_a_given_mass_scales_the_computed_inertia(tmp_path: Path) -> None:
    text = AUTO.format(inertial="<mass>12</mass>", collisions=collision(BOX))
    assert_same(body_in(tmp_path, text, "a"), 12.0, [0, 0, 0], np.diag([0.52, 0.4, 0.2]))


def test_toml_bodies_are_taken_as_they_are(tmp_path: Path) -> None:
    text = "[body]\nmass = 2.0\ninertia = [1.0, 2.0, 2.5]\n"
    found = named(tmp_path, text, "", "mine.toml")
    assert found == NamedBody("mine", {"mass": 2.0, "inertia": [1.0, 2.0, 2.5]})


COMMENTED = "\n\n<?xml version='1.1' encoding='utf-16'?>\n<!-- a -- b --> <!--- <arm> --->" + URDF
READ = {
    "declaration after lines, dashes in comments": COMMENTED.encode(),
    "byte order mark": b"\xef\xbb\xbf" + URDF.encode(),
    "utf-16": URDF.encode("utf-16"),
    "undeclared latin-1": URDF.replace("<link", "<!-- pi\xe8ce --><link").encode("latin-1"),
    "gb2312": b"<?xml version='1.0' encoding='gb2312'?>"
    + URDF.replace('"r"', '"\u673a"').encode("gb2312"),
    "unbound prefix": URDF.replace("<inertial>", "<gazebo:x/><inertial>").encode(),
    "white space in a number": URDF.replace('"2.5"', '" 2.5\n"').encode(),
    "spellings": URDF.replace('"2.5"', '"+.25e+1"').replace('"0.5"', '"5.E-1"').encode(),
    "a comment within CDATA": URDF.replace(
        "<inertial>", "<x><![CDATA[ <!-- ]]></x><inertial>").encode() + b"<!-- -->",
    "xacro where it does not matter": URDF.replace(
        "<link ", "<xacro:leg/><link ", 1).replace(
        "<inertial>", '<visual><mesh filename="$(find x)"/></visual><inertial>').encode(),
}  # fmt: skip


@pytest.mark.parametrize("content", READ.values(), ids=READ)
def test_xml_is_read_as_robot_libraries_read_it(tmp_path: Path, content: bytes) -> None:
    assert named(tmp_path, content, "#arm").body == named(tmp_path, URDF, "#arm").body


BOMB = '<?xml version="1.0"?><!DOCTYPE r [<!ENTITY a "aaaa">]><robot><link name="&a;"/></robot>'
OUTSIDE = '<!DOCTYPE r SYSTEM "file:///etc/passwd"><robot/>'
REFUSED = [
    (URDF, "#amr", "write arm"),
    (URDF, "#ARM", "write arm"),
    (URDF, "#wrld", "give another"),
    (URDF, "", "file.xml#arm, its links with a mass: arm, hand"),
    (URDF, "#nothing-like-it", "its links with a mass: arm, hand"),
    (URDF, "#world", "without <inertial>"),
    ('<robot><link name="a"/></robot>', "", "none of its links has a mass"),
    (URDF.replace('value="2.5"', 'value="${m}"'), "#arm", "expand it with xacro"),
    (XACRO, "#leg", "expand it with xacro"),
    (XACRO, "#foot", "expand it with xacro"),
    (XACRO, "#toe", "expand it with xacro"),
    ("<xacro:x/>", "#leg", "expand it with xacro"),
    ('<robot><link name="${side}_leg"/></robot>', "#left_leg", "expand it with xacro"),
    *(
        (URDF.replace('value="2.5"', f'value="{number}"'), "#arm", "give a number")
        for number in ("heavy", "nan", "inf", "infinity", "1_000", "\u0661", "2,5", "2 5",
                       "0x10", "1e", "\u00a02", "")
    ),
    (URDF.replace('value="2.5"', 'value="1e400"'), "#arm", "at most 1e50"),
    (URDF.replace(' izz="0.7"', ""), "#arm", "izz"),
    (URDF.replace('"hand"', '"arm"'), "#arm", "the name of 2; give every one a name of its own"),
    (QUATERNION.replace("1.2", "1.0"), "#arm", "version '1.0', which ignores it"),
    (QUATERNION.replace('version="1.2"', ""), "#arm", "version '1.0', which ignores it"),
    (QUATERNION.replace("quat_", 'rpy="0 0 0" quat_'), "#arm", "given rpy and quat_xyzw"),
    (QUATERNION.replace("0.1 -0.2 0.5 1", "0 0 0 0"), "#arm", "a quaternion of zeros"),
    ("<robot/>", "#arm", "without a named link"),
    ("<robot><link", "#arm", "not valid XML"),
    ("", "#arm", "not valid XML"),
    ('<robot a="<!--"/><b c="-->"/>', "#arm", "not valid XML"),
    ("<!--" * 9, "#arm", "not valid XML"),
    ("<html/>", "#arm", "give a URDF, an MJCF or an SDF"),
    (BOMB, "#arm", "document type"),
    (OUTSIDE, "#arm", "document type"),
    ("<robot>" + "<a>" * 600 + "</a>" * 600 + "</robot>", "#arm", "nested"),
    (SDF.replace("<pose ", '<pose relative_to="x" '), "#arm", "relative to"),
    (SDF.replace("<mass>2.5</mass>", ""), "#arm", "mass"),
    (SDF.replace("<world", "<include/><world"), "#leg", "expand its includes"),
    (TWO, "#base", "without <inertial>"),
    (SDF.replace("<mass>", "<fluid_added_mass/><mass>"), "#arm", "there is no fluid here"),
    (SDF.replace("inertia>", "inertja>"), "#arm", "inertia is missing"),
    (SDF.replace("<ixx>0.5</ixx>", ""), "#arm", "ixx is missing"),
    (SDF.replace("<mass>", "<mass>1</mass><mass>"), "#arm", "given 2 times"),
    (SDF.replace('degrees="true"', 'rotation_format="axis"'), "#arm", "euler_rpy or quat_xyzw"),
    (URDF.replace('<mass value="2.5"/>', ""), "#arm", "give <mass>"),
    (SDF.replace("<inertial>", '<inertial auto="maybe">'), "#arm", "write true or false"),
    (SDF.replace("<inertial>", '<inertial auto="true">'), "#arm", "without a <collision>"),
    *(
        (AUTO.format(inertial="", collisions=collisions), "#a", why)
        for collisions, why in (
            (collision("<mesh><uri>x</uri></mesh>"), "<mesh>"),
            (collision("<plane/>"), "<plane>"),
            (collision(""), "without a shape"),
            (collision(BOX + BALL), "<box> and <sphere>"),
            (collision(BOX) + collision(BALL), "two collisions of one name"),
            (collision(BOX, "<pose relative_to='j'>0 0 0 0 0 0</pose>"), "relative to"),
            (collision(BOX, "<density>0</density>"), "greater than zero"),
            (collision("<box><size>1 -1 1</size></box>"), "greater than zero"),
            (collision("<box/>"), "missing"),
        )
    ),
]  # fmt: skip


@pytest.mark.parametrize(("text", "link", "reason"), REFUSED)
def test_what_cannot_be_read_is_refused_in_one_sentence(
    tmp_path: Path, text: str, link: str, reason: str
) -> None:
    with pytest.raises(ScenarioError) as caught:
        named(tmp_path, text, link)
    sentence = str(caught.value)
    assert reason in sentence
    assert "file.xml" in sentence
    assert "\n" not in sentence


@pytest.mark.parametrize(("text", "found"), [("", "is missing"), ("body = 3", "is 3")])
def test_a_toml_file_without_a_body_is_refused(tmp_path: Path, text: str, found: str) -> None:
    with pytest.raises(ScenarioError, match=f"body {found}; write it as a table"):
        named(tmp_path, text, "", "mine.toml")


@pytest.mark.parametrize("argument", ["missing.urdf#a", ".#a", "\0#a", "missing.toml"])
def test_paths_without_a_file_are_refused(argument: str) -> None:
    with pytest.raises(ScenarioError):
        body_of_argument(argument, no_mjcf)


def test_a_file_that_is_too_large_is_refused(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("omegadot.scenarios.links.xml_file.LARGEST_FILE", 100)
    with pytest.raises(ScenarioError, match="give one of at most 100 bytes"):
        named(tmp_path, URDF, "#arm")


FLAT = URDF.replace(
    'ixx="0.002" ixy="0" ixz="0" iyy="0.003" iyz="0" izz="0.004"',
    'ixx="8.53333333333e-07" ixy="0" ixz="0" iyy="1.70666666667e-06" iyz="0"'
    ' izz="8.53333333333e-07"',
)  # twelve digits of a flat body: its greatest moment exceeds the sum of the others by 2e-12


@pytest.mark.parametrize("origin", ["", '<origin rpy="0.3 -1 2"/>'])
def test_a_flat_body_may_be_off_by_the_digits_it_is_printed_with(
    tmp_path: Path, origin: str
) -> None:
    text = FLAT.replace('<mass value="0.3"/>', f'{origin}<mass value="0.3"/>')
    assert body_in(tmp_path, text, "hand").mass == 0.3


def test_a_body_that_breaks_the_triangle_inequality_is_refused_with_its_numbers(
    tmp_path: Path,
) -> None:
    text = URDF.replace('izz="0.004"', 'izz="0.00500000004"')
    with pytest.raises(ScenarioError, match=r"body\.inertia .*\(0\.00500000004 > 0\.005\)"):
        body_in(tmp_path, text, "hand")
    body = named(tmp_path, text, "#hand").body
    allowed = scenario({**body, "allow_impossible_inertia": True})
    assert broken_triangle(np.array(allowed.body.inertia)) == "0.00500000004 > 0.005"
    assert scenario_of(allowed.to_dict(), "again") == allowed


@settings(derandomize=True, max_examples=300, deadline=None)
@given(
    text=st.sampled_from([URDF, QUATERNION, TWO, XACRO, COMMENTED,
                          AUTO.format(inertial="<mass>1</mass>", collisions=collision(BOX))]),
    cuts=st.lists(st.tuples(st.floats(0, 1), st.integers(0, 40)), max_size=3),
    pieces=st.lists(
        st.sampled_from(["<", ">", '"', "&#0;", "\0", "\xff", "<!--", "-->", "]]>", "<a>" * 50,
                         "1e999", "-", "${x}", "::", "<inertial>", "</link>"])
        | st.text(max_size=9),
        min_size=3, max_size=3),
    link=st.sampled_from(["#arm", "", "#m::arm", "#toe", "#a", "#x" * 300]),
    encoding=st.sampled_from(["utf-8", "utf-16", "utf-32", "utf-7"]),
)  # fmt: skip
def test_a_spoilt_file_is_read_or_refused(
    tmp_path_factory: pytest.TempPathFactory, text: str, cuts: Any, pieces: list[str], link: str,
    encoding: str,
) -> None:  # fmt: skip
    for (place, length), piece in zip(cuts, pieces, strict=False):
        start = int(place * len(text))
        text = text[:start] + piece + text[start + length :]
    content = text.encode(encoding, "replace")
    sentence = "file.xml"
    try:
        scenario(named(tmp_path_factory.getbasetemp(), content, link).body)
    except ScenarioError as error:
        sentence = str(error)
    assert len(sentence.splitlines()) == 1
    assert re.search(r"file\.xml|^in it, ", sentence)


@settings(derandomize=True, max_examples=100, deadline=None)
@given(content=st.binary(max_size=200))
def test_any_bytes_are_read_or_refused(
    tmp_path_factory: pytest.TempPathFactory, content: bytes
) -> None:
    with pytest.raises(ScenarioError):
        named(tmp_path_factory.getbasetemp(), content, "#arm")
