"""Every fault is reported in one sentence that names file, key and value, and writes nothing."""

from __future__ import annotations

import os
import re
from pathlib import Path

import pytest
from scenario_files import SOUND, with_line, with_parts, write

from omegadot.scenarios import ScenarioError, load_scenario

MASS = "mass = 1.0"
INERTIA = "inertia = [1.0, 2.0, 2.5]"
OMEGA = "angular_velocity = [0.1, 2.0, 0.1]"
DURATION = "duration = 1.0"
STEPS = "timesteps = [0.02, 0.01]"
SAMPLE = "sample = 0.02"
LOADED = SOUND + "[load]\n"
TORQUE = "[[load.torque]]\nframe = 'body'\nvalue = [0, 0, 1]\n"
LINE = 'shape = "point"\nmass = 1.0\nposition = [{0}.1, {0}.2, {0}.3]\n'

# text of the file, key, value as found, text that the advice must have
MALFORMED: list[tuple[str, str, str, str]] = [
    (with_line("schema = 1", ""), "schema", "missing", "schema = 1"),
    (with_line("schema = 1", "schema = 2"), "schema", "2", "schema = 1"),
    (with_line("schema = 1", "schema = true"), "schema", "true", "schema = 1"),
    (with_line("schema = 1", "schema = 1.0"), "schema", "1.0", "schema = 1"),
    (with_line('name = "a-body"', ""), "name", "missing", "kebab"),
    (with_line('name = "a-body"', 'name = "<script>"'), "name", "'<script>'", "lower-case"),
    (with_line('name = "a-body"', 'name = "../up"'), "name", "'../up'", "lower-case"),
    (with_line('name = "a-body"', 'name = "A_Body"'), "name", "'A_Body'", "lower-case"),
    (with_line('name = "a-body"', 'name = "a--b"'), "name", "'a--b'", "lower-case"),
    (with_line('name = "a-body"', 'name = "a\\n"'), "name", r"'a\n'", "lower-case"),
    (with_line('name = "a-body"', "name = 3"), "name", "3", "lower-case"),
    (with_line('name = "a-body"', f'name = "{"a" * 65}"'), "name", "'aaa", "64"),
    (with_line('title = "A body"', 'title = "\\u001b[31m"'), "title", r"'\x1b[31m'", "printable"),
    (with_line('title = "A body"', 'title = " "'), "title", "' '", "printable"),
    (with_line('title = "A body"', "title = 1979-05-27"), "title", "1979-05-27", "text"),
    (with_line('title = "A body"', f'shows = "{"x" * 2000}"'), "shows", "'xxx", "1000"),
    (with_line(MASS, ""), "body.mass", "missing", "mass and inertia"),
    (with_line(MASS, "mass = 0"), "body.mass", "0", "greater than zero"),
    (with_line(MASS, "mass = -1.5"), "body.mass", "-1.5", "greater than zero"),
    (with_line(MASS, "mass = true"), "body.mass", "true", "number"),
    (with_line(MASS, 'mass = "1.0"'), "body.mass", "'1.0'", "number"),
    (with_line(MASS, "mass = nan"), "body.mass", "nan", "finite"),
    (with_line(MASS, "mass = inf"), "body.mass", "inf", "finite"),
    (with_line(MASS, "mass = 1e308"), "body.mass", "1e308", "at most 1e50"),
    (with_line(MASS, "mass = 1e-200"), "body.mass", "1e-200", "at least 1e-50"),
    (with_line(MASS, f"mass = 1{'0' * 400}"), "body.mass", "an integer of 1329 bits", "at most"),
    (with_line(MASS, "mass = [1.0]"), "body.mass", "[1.0]", "number"),
    (with_line(MASS, "mas = 1.0"), "body.mas", "1.0", "write mass"),
    (with_line(MASS, "mass = 1.0\ngravity = [0, 0, -9.8]"), "body.gravity", "[0, 0", "[load]"),
    (with_line(MASS, "mass = 1.0\ncolour = 'red'"), "body.colour", "'red'", "center_of_mass"),
    (with_line(MASS, 'mass = 1.0\n"a\\nb" = 1'), r"body.'a\nb'", "1", "take it out"),
    (with_line(INERTIA, ""), "body.inertia", "missing", "mass and inertia"),
    (with_line(INERTIA, "inertia = 2.0"), "body.inertia", "2.0", "3x3"),
    (with_line(INERTIA, "inertia = [1, 2]"), "body.inertia", "[1, 2]", "3x3"),
    (with_line(INERTIA, "inertia = [1, 0, 1]"), "body.inertia[1]", "0", "greater than zero"),
    (with_line(INERTIA, "inertia = [1, -2, 1]"), "body.inertia[1]", "-2", "greater than zero"),
    (with_line(INERTIA, "inertia = [1, nan, 1]"), "body.inertia[1]", "nan", "finite"),
    (with_line(INERTIA, "inertia = [1, 2, 3.001]"), "body.inertia", "[1, 2, 3.001]", "sum of"),
    (with_line(INERTIA, "inertia = [[1,0,0],[0,1],[0,0,1]]"), "body.inertia[1]", "[0, 1]", "row"),
    (with_line(INERTIA, "inertia = [[1,0,0],[0,1,0],3]"), "body.inertia[2]", "3", "row"),
    (
        with_line(INERTIA, "inertia = [[1,0,0],[0,1,true],[0,0,1]]"),
        "body.inertia[1][2]",
        "true",
        "number",
    ),
    (
        with_line(INERTIA, "inertia = [[2,0.1,0],[0.2,2,0],[0,0,2]]"),
        "body.inertia",
        "[[2, 0.1, 0], [0.2, 2, 0], [0, 0, 2]]",
        "symmetric",
    ),
    (
        with_line(INERTIA, "inertia = [[1,2,0],[2,1,0],[0,0,1]]"),
        "body.inertia",
        "[[1, 2, 0], [2, 1, 0], [0, 0, 1]]",
        "positive definite",
    ),
    (
        with_line(INERTIA, "inertia = [[1,1,0],[1,1,0],[0,0,1]]"),
        "body.inertia",
        "[[1, 1, 0], [1, 1, 0], [0, 0, 1]]",
        "positive definite",
    ),
    (
        with_line(INERTIA, "inertia = [[1,0,0],[0,3,1],[0,1,1]]"),
        "body.inertia",
        "[[1, 0, 0], [0, 3, 1], [0, 1, 1]]",
        "sum of",
    ),
    (
        with_line(MASS, "mass = 1\ncenter_of_mass = [0, 0]"),
        "body.center_of_mass",
        "[0, 0]",
        "three",
    ),
    (with_line(OMEGA, ""), "initial.angular_velocity", "missing", "rad/s"),
    (with_line(OMEGA, "angular_velocity = [0, inf, 0]"), "initial.angular_velocity[1]", "inf", ""),
    (
        with_line(OMEGA, "angular_velocty = [0, 1, 0]"),
        "initial.angular_velocty",
        "[0, 1, 0]",
        "velocity",
    ),
    (
        with_line(OMEGA, f"{OMEGA}\norientation = [0, 0, 0, 0]"),
        "initial.orientation",
        "[0, 0, 0, 0]",
        "zero",
    ),
    (
        with_line(OMEGA, f"{OMEGA}\norientation = [1, 0, 0]"),
        "initial.orientation",
        "[1, 0, 0]",
        "w, x",
    ),
    (with_line(DURATION, "duration = -1.0"), "run.duration", "-1.0", "greater than zero"),
    (with_line(DURATION, 'duration = "long"'), "run.duration", "'long'", "number"),
    (with_line(STEPS, f"{STEPS}\naccuracies = []"), "run.accuracies", "[]", "one to"),
    (with_line(STEPS, f"{STEPS}\naccuracies = [1e-3, 0]"), "run.accuracies[1]", "0", "than zero"),
    (with_line(STEPS, f"{STEPS}\naccuracies = [2.0]"), "run.accuracies[0]", "2.0", "below 1"),
    (with_line(STEPS, f"{STEPS}\naccuracies = [inf]"), "run.accuracies[0]", "inf", "finite"),
    (with_line(STEPS, f"{STEPS}\naccuracies = [0.1, 0.1]"), "run.accuracies[1]", "0.1", "once"),
    (with_line(STEPS, "timesteps = []"), "run.timesteps", "[]", "one to"),
    (with_line(STEPS, "timesteps = 0.01"), "run.timesteps", "0.01", "list"),
    (with_line(STEPS, f"timesteps = {list(range(1, 102))}"), "run.timesteps", "[1, 2", "100"),
    (with_line(STEPS, "timesteps = [0.01, 0]"), "run.timesteps[1]", "0", "greater than zero"),
    (with_line(STEPS, "timesteps = [0.01, -0.1]"), "run.timesteps[1]", "-0.1", "greater than zero"),
    (with_line(STEPS, "timesteps = [0.01, 1.5]"), "run.timesteps[1]", "1.5", "run.duration"),
    (with_line(STEPS, "timesteps = [0.01, 0.01]"), "run.timesteps[1]", "0.01", "once"),
    (with_line(STEPS, "timesteps = [1e-9]"), "run.timesteps[0]", "1e-9", "at most"),
    (
        with_line(STEPS, "timesteps = [2e-8]\nsample = 2e-8").replace(SAMPLE, ""),
        "run.sample",
        "2e-8",
        "at most",
    ),
    (with_line(SAMPLE, "sample = 0"), "run.sample", "0", "greater than zero"),
    (with_line(SAMPLE, "sample = 2.0"), "run.sample", "2.0", "run.duration"),
    (with_line("[run]", "[runs]"), "runs", "a table", "write run"),
    (LOADED + "damping = -0.1", "load.damping", "-0.1", "zero"),
    (LOADED + "gravity = -9.8", "load.gravity", "-9.8", "three"),
    (LOADED + "torque = [0, 0, 1]", "load.torque", "[0, 0, 1]", "table"),
    (LOADED + "torque = { value = [0, 0, 1] }", "load.torque.frame", "missing", "world"),
    (
        LOADED + "torque = { frame = 'earth', value = [0, 0, 1] }",
        "load.torque.frame",
        "'earth'",
        "world",
    ),
    (LOADED + "torque = { frame = 'body' }", "load.torque.value", "missing", "N m"),
    (LOADED + "torque = []", "load.torque", "[]", "table"),
    (LOADED + TORQUE + TORQUE, "load.torque[1].frame", "'body'", "one torque in each frame"),
    (
        LOADED + TORQUE + "[[load.torque]]\nframe = 'world'\n",
        "load.torque[1].value",
        "missing",
        "N m",
    ),
    (LOADED + "'damping ' = 0.1", 'load."damping "', "an unknown key (0.1)", "write damping"),
    (
        LOADED + TORQUE + "values = [0, 0, 1]\n",
        "load.torque[0].values",
        "an unknown key ([0, 0, 1])",
        "value",
    ),
    (
        with_line(OMEGA, f"{OMEGA}\nposition = [0, 0, 0]") + "[load]\npivot = [0, 0, 0]",
        "initial.position",
        "[0.0, 0.0, 0.0]",
        "load.pivot",
    ),
    (
        with_line(OMEGA, f"{OMEGA}\nlinear_velocity = [0, 0, 1]") + "[load]\npivot = [0, 0, 0]",
        "initial.linear_velocity",
        "[0.0, 0.0, 1.0]",
        "load.pivot",
    ),
    (
        "body = 3\n" + SOUND.replace("[body]\nmass = 1.0\ninertia = [1.0, 2.0, 2.5]\n", ""),
        "body",
        "3",
        "[body]",
    ),
    (
        with_line(MASS, "mass = 1.0\npart = 3").replace(INERTIA, ""),
        "body.part",
        "3",
        "[[body.part]]",
    ),
    (with_line(MASS, "part = []").replace(INERTIA, ""), "body.part", "[]", "[[body.part]]"),
    (with_line(MASS, "part = [3]").replace(INERTIA, ""), "body.part[0]", "3", "table"),
    (
        SOUND + "[[body.part]]\nshape = 'sphere'\nradius = 1.0\nmass = 1.0",
        "body.mass",
        "1.0",
        "leave",
    ),
    (with_parts("shape = 'cube'\nmass = 1"), "body.part[0].shape", "'cube'", "box, cyl"),
    (with_parts("mass = 1"), "body.part[0].shape", "missing", "box, cyl"),
    (
        with_parts("shape = 'sphere'\nmass = 1\nradius = 1", "shape = 'box'\nmass = 1"),
        "body.part[1].size",
        "missing",
        "edge",
    ),
    (
        with_parts("shape = 'sphere'\nmass = 1\nradius = 0"),
        "body.part[0].radius",
        "0",
        "greater than zero",
    ),
    (
        with_parts("shape = 'sphere'\nmass = 1\nraduis = 1"),
        "body.part[0].raduis",
        "1",
        "write radius",
    ),
    (
        with_parts("shape = 'box'\nmass = 1\nsize = [1, 0, 1]"),
        "body.part[0].size[1]",
        "0",
        "greater",
    ),
    (with_parts("shape = 'sphere'\nradius = 1"), "body.part[0].mass", "missing", "density"),
    (
        with_parts("shape = 'sphere'\nradius = 1\nmass = 1\ndensity = 2"),
        "body.part[0].density",
        "2.0",
        "leave out",
    ),
    (with_parts("shape = 'point'\ndensity = 2"), "body.part[0].density", "2", "take it out"),
    (
        with_parts("shape = 'sphere'\nradius = 1e45\ndensity = 2"),
        "body.part[0].density",
        "2.0",
        "mass of",
    ),
    (
        with_parts("shape = 'sphere'\nradius = 1e45\nmass = 2"),
        "body.part",
        "a body with moments",
        "kg m^2",
    ),
    (
        with_parts("shape = 'point'\nmass = 1"),
        "body.part",
        "a set of parts on one line",
        "off the line",
    ),
    (
        with_parts(*map(LINE.format, range(4))),
        "body.part",
        "a set of parts on one line",
        "off the line",
    ),
]


def refusal(path: str | Path) -> ScenarioError:
    """The error of a file, held to the form of one printable sentence."""
    with pytest.raises(ScenarioError) as caught:
        load_scenario(path)
    sentence = str(caught.value)
    assert sentence.isprintable()
    assert len(sentence) < 700
    assert sentence.endswith(".")
    assert not re.search(r"[.!?] [A-Z]", sentence), "more than one sentence"
    return caught.value


@pytest.mark.parametrize(
    ("text", "key", "found", "advice"),
    MALFORMED,
    ids=[f"{key}={found}" for _, key, found, _ in MALFORMED],
)
def test_one_sentence_names_file_key_and_value(
    tmp_path: Path, text: str, key: str, found: str, advice: str
) -> None:
    path = write(tmp_path, text)
    error = refusal(path)
    assert error.file == str(path)
    assert error.key == key
    assert found in error.found
    assert advice in error.advice
    assert all(part in str(error) for part in (str(path), key, found, advice))
    assert os.listdir(tmp_path) == ["case.toml"]


def test_an_unknown_key_is_reported_before_what_its_misspelling_leaves_missing(
    tmp_path: Path,
) -> None:
    text = with_line(MASS, "").replace(OMEGA, "omega = [1, 2, 3]")
    assert refusal(write(tmp_path, text)).key == "initial.omega"


def test_a_newer_schema_is_reported_before_the_keys_it_may_bring(tmp_path: Path) -> None:
    text = with_line("schema = 1", "schema = 2\nfriction = 1")
    assert refusal(write(tmp_path, text)).key == "schema"


@pytest.mark.parametrize(
    ("content", "found"),
    [
        (b"schema = ", "end of document"),
        (b"schema = 1\nschema = 2\n", "line 2"),
        (b"a = 1\n[b\n", "line 2"),
        (b"a" + b".a" * 200_000 + b" = 1", "more than 32 parts in line 1"),
        (b"\n'a b'" + b' . "a b"' * 40_000 + b" = 1", "more than 32 parts in line 2"),
        (b"a = " + b"[" * 100_000, "nested too deep"),
        (b"a = " + b"1" * 100_000, "digits"),
        (b"\xff\xfe\x00", "UTF-16"),
        (b"\xff\x00", "byte 0xff in line 1"),
        (b"schema = 1\nname = '\xe9'", "byte 0xe9 in line 2"),
        (b"\x00" * 50, "line 1"),
        (b"<xml/>", "line 1"),
    ],
)
def test_what_is_not_toml_is_refused_with_its_line(
    tmp_path: Path, content: bytes, found: str
) -> None:
    error = refusal(write(tmp_path, content))
    assert error.key is None
    assert found in error.found


def test_a_huge_file_is_refused_unread(tmp_path: Path) -> None:
    path = tmp_path / "huge.toml"
    with path.open("wb") as stream:
        stream.truncate(100_000_000_000)  # sparse; a loader that reads it all runs out of memory
    assert "100,000,000,000 bytes" in refusal(path).found


def test_a_file_at_the_limit_is_read(tmp_path: Path) -> None:
    filler = "#" * (1_000_000 - len(SOUND))
    assert load_scenario(write(tmp_path, SOUND + filler)).name == "a-body"
    assert "1,000,001 bytes" in refusal(write(tmp_path, SOUND + filler + "#")).found


def test_places_that_hold_no_file(tmp_path: Path) -> None:
    assert refusal(tmp_path / "none.toml").found == "missing"
    assert refusal(tmp_path).found == "a directory"
    assert refusal(f"{tmp_path}/a\0b.toml").found == "not a path"
    assert refusal(f"{tmp_path}/\ud800.toml").found == "not a path"
    assert "too long" in refusal(f"{tmp_path}/{'a' * 5000}.toml").found
    assert "Not a directory" in refusal(write(tmp_path, SOUND) / "inner.toml").found
    os.mkfifo(tmp_path / "pipe.toml")  # opening it would wait for ever
    assert refusal(tmp_path / "pipe.toml").found == "not a regular file"


def test_a_path_that_steers_the_terminal_is_shown_escaped(tmp_path: Path) -> None:
    assert r"\x1b[2J" in refusal(tmp_path / "\x1b[2J.toml").file


def test_a_file_without_permission(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def deny(*_: object) -> None:  # taking the permission away would not stop a test run by root
        raise PermissionError(13, "Permission denied")

    path = write(tmp_path, SOUND)
    monkeypatch.setattr(Path, "open", deny)
    assert "Permission denied" in refusal(path).found
