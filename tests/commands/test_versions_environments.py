"""Environments: whole or not there, kept, made again where they must be, never the user's."""

from __future__ import annotations

import json
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import pytest

from omegadot.commands.versions import installer as installing
from omegadot.commands.versions import versions as comparing
from omegadot.commands.versions.environments import Absent, Environments, Place
from omegadot.commands.versions.installer import (
    InstallError,
    Pip,
    Uv,
    installer_named,
    python_of,
    reason_of,
)
from omegadot.commands.versions.release import Span, product_of, requested_releases
from omegadot.harness.usage import UsageError

MUJOCO = product_of("mujoco")


class Fake:
    """An installer that makes an interpreter out of nothing, and knows which wheels there are."""

    name = "fake"

    def __init__(self, missing: Sequence[str] = ()) -> None:
        self.missing, self.made = missing, 0
        self.breaks: BaseException | None = None

    def create(self, folder: Path) -> None:
        python_of(folder).parent.mkdir(parents=True)
        python_of(folder).symlink_to(sys.executable)

    def install(self, folder: Path, requirements: Sequence[str]) -> None:
        if self.breaks:
            raise self.breaks
        if requirements[0].partition("==")[2] in self.missing:
            raise InstallError("no wheel for this platform")
        self.made += 1

    def releases(self, package: str, span: Span) -> list[str]:
        return span.of(["3.6.0", "3.7.0", "4.0.0"])


def test_an_environment_is_made_once(tmp_path: Path) -> None:
    fake = Fake()
    first = Environments(tmp_path, MUJOCO, fake).place("3.6.0")
    again = Environments(tmp_path, MUJOCO, fake).place("3.6.0")
    assert isinstance(first, Place)
    assert isinstance(again, Place)
    assert fake.made == 1
    assert (first.origin, again.origin) == ("fake", "the cache")
    assert first.command == again.command
    assert str(tmp_path) in first.command[0]


def test_what_was_broken_off_is_not_there(tmp_path: Path) -> None:
    fake = Fake()
    fake.breaks = KeyboardInterrupt()
    with pytest.raises(KeyboardInterrupt):
        Environments(tmp_path, MUJOCO, fake).place("3.6.0")
    assert list(tmp_path.iterdir()) == []
    # Killed before it could tidy up: a folder without a marker.
    fake.create(tmp_path / "mujoco-3.6.0-half")
    assert Environments(tmp_path, MUJOCO, None).cached() == []
    fake.breaks = None
    assert isinstance(Environments(tmp_path, MUJOCO, fake).place("3.6.0"), Place)
    assert fake.made == 1


def test_what_the_missing_ones_take_is_known_after_the_first(tmp_path: Path) -> None:
    """Caught: a size of all releases where some are there, or where a bisection makes a few."""
    fake = Fake(missing=["3.1.0"])
    environments = Environments(tmp_path, MUJOCO, fake)
    environments.place("3.6.0")
    wanted = ["3.1.0", "3.2.0", "3.3.0", "3.4.0", "3.6.0"]
    space = environments.space_for(wanted, 5)
    assert (space.first, space.more, fake.made) == ("3.2.0", 2, 2)
    (folder,) = tmp_path.glob("mujoco-3.2.0-*-*/")
    (folder / "large").write_bytes(bytes(1000))
    assert Environments(tmp_path, MUJOCO, fake)._size("3.2.0") > 1000
    assert environments.space_for(wanted, 2).more == 1
    assert environments.space_for(["3.2.0", "3.4.0"], 2).more == 0  # one was requested by name
    assert Environments(tmp_path, MUJOCO, None).space_for(wanted, 5).more == 0


@pytest.mark.parametrize("answer", [None, False, True])
def test_more_than_a_gigabyte_is_installed_by_consent(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, answer: bool | None
) -> None:
    asked: list[str] = []

    def ask(question: str) -> bool:
        asked.append(question)
        return bool(answer)

    monkeypatch.setattr(comparing, "installer_named", lambda name: Fake())
    monkeypatch.setattr(Environments, "_size", lambda self, version: 700_000_000)
    monkeypatch.setattr(comparing, "record_of", lambda *_: {"there": "was no need to stop"})
    monkeypatch.setattr(comparing.Gallery, "measure_all", lambda *_: [])
    arguments: dict[str, Any] = {"cache": tmp_path, "speed": False}
    arguments["ask"] = None if answer is None else ask
    found = "2 more environments of mujoco take about 1.4 GB (3.6.0 took 700 MB)"
    if answer:
        comparing.versions("mujoco", "3.6.0..4.0.0", **arguments)
    else:
        with pytest.raises(UsageError, match="give --yes") as refused:
            comparing.versions("mujoco", "3.6.0..4.0.0", **arguments)
        assert str(refused.value).startswith(found)
    assert asked == ([] if answer is None else [f"{found}. Install them?"])


def test_an_environment_whose_python_is_gone_is_made_again(tmp_path: Path) -> None:
    fake = Fake()
    place = Environments(tmp_path, MUJOCO, fake).place("3.6.0")
    assert isinstance(place, Place)
    Path(place.command[0]).unlink()
    assert isinstance(Environments(tmp_path, MUJOCO, None).place("3.6.0"), Absent)
    assert isinstance(Environments(tmp_path, MUJOCO, fake).place("3.6.0"), Place)
    assert fake.made == 2


def test_other_requirements_are_another_environment(tmp_path: Path) -> None:
    fake = Fake()
    Environments(tmp_path, MUJOCO, fake).place("3.6.0")
    (marker,) = tmp_path.glob("*.json")
    reported = json.loads(marker.read_text())
    marker.write_text(json.dumps({**reported, "requirements": ["mujoco==3.6.0"]}))
    Environments(tmp_path, MUJOCO, fake).place("3.6.0")
    assert fake.made == 2
    marker.write_text("{")
    Environments(tmp_path, MUJOCO, fake).place("3.6.0")
    assert fake.made == 3


def test_a_version_that_cannot_be_installed_is_an_outcome(tmp_path: Path) -> None:
    absent = Environments(tmp_path, MUJOCO, Fake(missing=["3.7.0"])).place("3.7.0")
    assert isinstance(absent, Absent)
    assert "fake" in absent.reason
    assert absent.reason.endswith("no wheel for this platform")
    assert list(tmp_path.iterdir()) == []


def test_offline_there_is_what_the_cache_has(tmp_path: Path) -> None:
    Environments(tmp_path, MUJOCO, Fake()).place("3.6.0")
    Environments(tmp_path, MUJOCO, Fake()).place("4.0.0")
    offline = Environments(tmp_path, MUJOCO, None)
    assert offline.releases(Span("3.0", "3.9")) == ["3.6.0"]
    assert offline.releases(Span("", "")) == ["3.6.0", "4.0.0"]
    absent = offline.place("3.7.0")
    assert isinstance(absent, Absent)
    assert "not in the cache" in absent.reason
    assert isinstance(offline.place("4.0"), Place)  # the same release as 4.0.0


def test_offline_the_ends_of_a_range_that_are_not_there_are_named() -> None:
    wanted, _ = requested_releases(["3.9..3.10.2"], lambda span: ["3.10.0"], ["3.10.0", "4.0.0"])
    assert wanted == ["3.9", "3.10.0", "3.10.2"]
    with pytest.raises(UsageError, match="the cache holds no release that lies there"):
        requested_releases(["1.0..2.0"], lambda span: [], ["3.10.0"])


def test_a_cache_that_cannot_be_made_is_wrong_usage(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    with pytest.raises(UsageError, match="--cache"):
        Environments(tmp_path / "file" / "cache", MUJOCO, Fake()).place("3.6.0")


def test_releases_that_cannot_be_listed_are_one_sentence(tmp_path: Path) -> None:
    class Deaf(Fake):
        def releases(self, package: str, span: Span) -> list[str]:
            raise InstallError("no route to host")

    with pytest.raises(UsageError, match="no route to host"):
        Environments(tmp_path, MUJOCO, Deaf()).releases(Span("3.6.0", ""))


FAKE_UV = """
import re, sys
arguments = sys.argv[1:]
if arguments[:2] != ["pip", "compile"]:
    sys.exit("unexpected")
requested = sys.stdin.read()
there = [(1, 0), (1, 1), (1, 2), (2, 0)]
number = lambda text: tuple(int(part) for part in text.split("."))
for sign, text in re.findall(r"(>=|<=|!=)([0-9.]+)", requested):
    keep = {">=": lambda v: v >= number(text), "<=": lambda v: v <= number(text),
            "!=": lambda v: v != number(text)}[sign]
    there = [version for version in there if keep(version)]
if not there:
    print("  \\u00d7 No solution found when resolving dependencies", file=sys.stderr)
    sys.exit(1)
print("own==" + ".".join(map(str, there[-1])))
"""


def test_uv_is_called_for_one_release_after_the_other(tmp_path: Path) -> None:
    program = tmp_path / "uv.py"
    program.write_text(FAKE_UV)
    uv = Uv([sys.executable, str(program)])
    assert uv.releases("own", Span("1.1", "2.0")) == ["1.1", "1.2", "2.0"]
    assert uv.releases("own", Span("", "")) == ["1.0", "1.1", "1.2", "2.0"]
    assert uv.releases("own", Span("3.0", "4.0")) == []


def test_pip_lists_releases_in_json_and_in_text(monkeypatch: pytest.MonkeyPatch) -> None:
    answers: dict[bool, Any] = {
        True: json.dumps({"versions": ["2.0", "1.1", "1.0"]}),
        False: "own (2.0)\nAvailable versions: 2.0, 1.1, 1.0\n",
    }

    def run(command: Sequence[str]) -> str:
        answer = answers["--json" in command]
        if isinstance(answer, Exception):
            raise answer
        return str(answer)

    monkeypatch.setattr(installing, "_run", run)
    assert Pip().releases("own", Span("1.1", "")) == ["1.1", "2.0"]
    answers[True] = InstallError("no such option: --json")
    assert Pip().releases("own", Span("1.1", "")) == ["1.1", "2.0"]
    answers[True] = InstallError("no route to host")
    with pytest.raises(InstallError, match="no route"):
        Pip().releases("own", Span("", ""))


def test_pip_makes_an_environment_with_this_python(tmp_path: Path) -> None:
    folder = tmp_path / "environment"
    Pip().create(folder)
    assert python_of(folder).exists()
    with pytest.raises(InstallError, match="nowhere"):
        Pip().install(folder, [str(tmp_path / "nowhere" / "own-1.0-py3-none-any.whl")])


def test_the_installer_is_uv_where_there_is_one(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    uv = tmp_path / "uv"
    uv.write_text("#!/bin/sh\n")
    uv.chmod(0o755)
    monkeypatch.setenv("PATH", str(tmp_path))
    assert installer_named("auto").name == "uv"
    assert installer_named("pip").name == "pip"
    uv.unlink()
    monkeypatch.setattr(
        installing.importlib.util, "find_spec", lambda name: None if name == "uv" else object()
    )
    assert installer_named("auto").name == "pip"
    with pytest.raises(InstallError, match="there is no uv"):
        installer_named("uv")
    monkeypatch.setattr(installing.importlib.util, "find_spec", lambda name: None)
    with pytest.raises(InstallError, match="neither uv nor pip"):
        installer_named("auto")


def test_reasons_are_one_short_line() -> None:
    text = "  × No solution found:\n  ╰─▶ Because there is no\n      version of own==9\n"
    assert reason_of(text) == "No solution found: Because there is no version of own==9"
    text = "WARNING: retrying\nERROR: Could not find own==9 (from versions: 1.0, 1.1)\n"
    assert reason_of(text) == "Could not find own==9"
    assert reason_of("") == "no reason given"
    assert len(reason_of("x" * 10_000)) <= installing.LONGEST_REASON
