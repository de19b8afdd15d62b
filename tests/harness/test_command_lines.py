"""Programs that serve an engine: how they are given, what they are called, and what is refused."""

import os
import re
from pathlib import Path

import pytest

from omegadot.harness.arguments import adapters_named, engine_choices
from omegadot.harness.engine_target import target_of
from omegadot.harness.own_engines import known_engines
from omegadot.harness.usage import UsageError


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The current folder, with programs in it, and one on the path."""
    (tmp_path / "bin").mkdir()
    for name in ("spinner", "spinner-0.1", "3dof", "bin/onpath", "spun.py", "mujoco"):
        (tmp_path / name).write_text("#!/bin/sh\n", encoding="utf-8")
        (tmp_path / name).chmod(0o755)
    (tmp_path / "notes.js").write_text("", encoding="utf-8")
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("PATH", str(tmp_path / "bin"), prepend=os.pathsep)
    return tmp_path


@pytest.mark.parametrize(
    ("given", "name", "command"),
    [
        ("./spinner", "spinner", "./spinner"),
        ("spinner", "spinner", "./spinner"),
        ("top=./spinner", "top", "top=./spinner"),
        ("top=onpath", "top", "top=onpath"),
        ("top.v2+=./spinner x", "top.v2+", "top.v2+=./spinner x"),
        ("top=./spun.py", "top", "top=./spun.py"),
        ("./spinner-0.1", "spinner-0-1", "./spinner-0.1"),
        ("./spinner x", "spinner", "./spinner x"),
        ("./spinner --serve", "spinner", "./spinner --serve"),
        ("./spinner - --port=3", "spinner", "./spinner - --port=3"),
        ("env OMP=1 ./spinner", "spinner", "env OMP=1 ./spinner"),
        ("onpath notes.js 3 '|'", "notes", "onpath notes.js 3 '|'"),
    ],
)
def test_programs_are_given_and_named(folder: Path, given: str, name: str, command: str) -> None:
    assert adapters_named([given]) == {name: f"command:{command}"}
    (choice,) = engine_choices([given])
    assert (choice.name, choice.target) == (name, f"command:{command}")


def test_a_program_by_its_whole_path_may_stand_in_omegadot_toml(folder: Path) -> None:
    lines = f'[adapters]\nown = "{folder / "spinner"}"\nother = "spinner"\n'
    Path("omegadot.toml").write_text(lines, encoding="utf-8")
    found = known_engines()
    assert found["own"] == f"command:{folder / 'spinner'}"
    assert found["other"] == "command:./spinner"
    Path("omegadot.toml").write_text('[adapters]\nown = "worker"\n', encoding="utf-8")
    with pytest.raises(UsageError, match=r"no class is named; give FILE\.py:Class, module:"):
        known_engines()


def test_an_engine_that_is_known_is_no_file_of_its_name(folder: Path) -> None:
    (choice,) = engine_choices(["mujoco"])
    assert not choice.target.startswith("command:")
    assert target_of("./spinner") == "command:./spinner"


@pytest.mark.parametrize(
    ("given", "reason"),
    [
        ("9bad=./spinner x", "'9bad' is no name; give at most 60 letters"),
        ("9bad=./spinner", "'9bad' is no name; give at most 60 letters"),
        ("_X=1 ./spinner", "or write env _X=1 ./spinner if _X is a variable of the environment"),
        ("OMP=1 ./spinner", "there is no program 1; .* or write env OMP=1 ./spinner if OMP is a"),
        ("top=", "no program is named"),
        ("./nothing", "there is no program ./nothing; install it or check its path."),
        ("./notes.js", r"is a file that cannot be started; make it executable \(chmod \+x\), or"),
        ("notes.js", "is a file that cannot be started"),
        ("top=spinner", "no program spinner on the path; write ./spinner for the file"),
        ("./3dof", "its name, 3dof, is none; write another before it, as NAME=PROGRAM"),
        ("env ./spinner | cat", r"\| is a shell's, and the program is started without one"),
        ("./spinner > log", "> is a shell's"),
        ("./spinner 2>&1", ">& is a shell's"),
        ("./spinner < 'a'", "< is a shell's"),
        ("./spinner &", "& is a shell's"),
        ("./spinner;./spinner", "; is a shell's"),
    ],
)
def test_lines_that_are_refused(folder: Path, given: str, reason: str) -> None:
    with pytest.raises(UsageError, match=reason):
        engine_choices([given])


@pytest.mark.parametrize("argument", ["'|'", '"a>b"', "--x='a&b'", r"a\;b"])
def test_a_quoted_operator_is_an_argument(folder: Path, argument: str) -> None:
    assert target_of(f"./spinner {argument}") == f"command:./spinner {argument}"


def test_a_name_of_another_folder_is_told_where_names_stand(folder: Path) -> None:
    where = "; names of your own stand in omegadot.toml of the current folder"
    with pytest.raises(UsageError, match=re.escape(f"{where}, which has none.")):
        engine_choices(["spiner"])
    Path("omegadot.toml").write_text("", encoding="utf-8")
    with pytest.raises(UsageError, match=re.escape(f"{where}.")):
        engine_choices(["spiner"])
