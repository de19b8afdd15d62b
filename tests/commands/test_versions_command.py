"""``omegadot versions`` finds what changed between releases, and what it cannot determine."""

from __future__ import annotations

import json
import os
import re
import sys
from pathlib import Path
from typing import Any

import pytest
from axe_check import LOOKS, violations
from chromium import Chromium
from command_line import QUICK, Result, omegadot, quick_scenario
from versioned_engine import ALL, TARGET, arguments

from omegadot.commands.options import PageFormat, exit_code
from omegadot.commands.versions.command import print_versions
from omegadot.commands.versions.versions import versions as compare_versions
from omegadot.harness.usage import UsageError
from omegadot.reports.versions.sheet import sheet_of
from omegadot.reports.versions.text import markdown_of, print_sheet

OLD_MUJOCO = "OMEGADOT_OLD_MUJOCO_PYTHON"
FAULTY = ("1.5", "1.6", "1.7")


def versions(folder: Path, *more: object, scenario: str = QUICK) -> Result:
    path = quick_scenario(folder, scenario)
    own = ("versioned", "--adapter", TARGET, "--scenario", path, "--offline", "--cache", folder)
    return omegadot("versions", *own, *more, folder=folder)


@pytest.fixture(scope="module")
def seen(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, Any]:
    """Every release looked at once: the folder of what was written, and the JSON."""
    folder = tmp_path_factory.mktemp("versions")
    own = [
        *arguments(folder, *ALL[1:], *FAULTY, "1.8"),
        "2.0",
        "--out",
        folder / "out",
        "--no-speed",
    ]
    result = versions(folder, *own, "--format", "json")
    assert result.code == 1, result.err  # 1.8 is not as it declares
    return folder / "out", result.json


def test_a_bisection_in_which_nothing_runs_reports_it(tmp_path: Path) -> None:
    result = versions(
        tmp_path, *arguments(tmp_path, *FAULTY[:2]), "--bisect", "order", "--out", "out"
    )
    assert result.code == 3, result.err
    assert "none of which ran" in result.out
    assert "Releases run: 1.5 and 1.6." in result.out
    assert "Traceback" not in result.err
    assert (tmp_path / "out" / "versions.html").exists()


@LOOKS
def test_axe_finds_nothing_on_the_page(
    seen: tuple[Path, Any], tmp_path: Path, look: dict[str, Any]
) -> None:
    with Chromium(tmp_path) as browser:
        assert violations(browser, seen[0] / "versions.html", **look) == []


def step(record: Any, to: str) -> dict[str, tuple[Any, Any]]:
    """The metrics that changed at a release, with their values before and after."""
    (found,) = (step for step in record["steps"] if step["to"] == to)
    return {
        change["metric"]: tuple(
            side and (side["value"] if side["value"] is not None else side["text"])
            for side in (change["before"], change["after"])
        )
        for change in found["changes"]
    }


def test_changes_are_found_where_they_are(seen: tuple[Path, Any]) -> None:
    _, record = seen
    assert [s["to"] for s in record["steps"]] == [*ALL[2:], "1.8"]
    assert step(record, "1.3") == {}
    assert step(record, "1.8") == {}

    at_2 = step(record, "1.2")
    assert at_2["convention:velocity frame"] == ("body axes", "world axes")
    before, after = at_2["scheme:step:free"]
    assert "semi-implicit-euler" in before
    assert after == "lie-rk4-naive"
    assert at_2["order:step:free:omega"] == (
        pytest.approx(1, abs=0.15),
        pytest.approx(4, abs=0.15),
    )
    assert at_2["order:step:free:attitude"][1] == pytest.approx(2, abs=0.15)
    before, after = at_2["drift:quick:step:0.01:energy"]
    assert before > 1e-4 > 1e-6 > after

    at_4 = step(record, "1.4")
    assert at_4["scheme:step:free"] == ("lie-rk4-naive", "lie-rk4")
    assert at_4["order:step:free:attitude"][1] == pytest.approx(4, abs=0.15)
    assert "order:step:free:omega" not in at_4
    assert at_4["integrator:second"] == (None, "there")
    assert not any(":second:" in metric for metric in at_4)


def test_versions_that_cannot_be_measured_are_outcomes(seen: tuple[Path, Any]) -> None:
    _, record = seen
    outcomes = {v["version"]: (v["outcome"], v["reason"]) for v in record["versions"]}
    assert all(outcomes[version][0] == "ok" for version in ALL[1:])
    assert outcomes["1.5"][0] == "crashed"
    assert "SIGABRT" in outcomes["1.5"][1]
    assert outcomes["1.6"] == ("not-installed", "libold.so: cannot open shared object file")
    assert outcomes["1.7"][0] == "crashed"
    assert outcomes["2.0"][0] == "not-installed"
    assert "not in the cache" in outcomes["2.0"][1]


def test_the_page_and_the_record_are_written(seen: tuple[Path, Any]) -> None:
    folder, record = seen
    assert json.loads((folder / "versions.json").read_text()) == record
    page = (folder / "versions.html").read_text()
    for message in ("1.1 → 1.2", "lie-rk4-naive → lie-rk4", "not in the cache", "SIGABRT", "<svg"):
        assert message in page
    assert "://" not in page
    assert not list(folder.glob(".*"))


def test_text_and_markdown_agree(
    seen: tuple[Path, Any], capsys: pytest.CaptureFixture[str]
) -> None:
    sheet = sheet_of(seen[1])
    print_sheet(sheet)
    text, page = " ".join(capsys.readouterr().out.split()), markdown_of(sheet)
    for message in (
        "velocity frame: body axes → world axes",
        "order 1 → 4 in omega (free)",
        "order 1 → 2 in attitude (free)",
        "nothing changed beyond rounding",
        "not-installed: libold.so",
    ):
        assert message in text
        assert message in page
    title = "versioned 1.1 to 1.8: 5 of 9 versions, 2 steps with changes"
    assert text.startswith(title)
    assert page.startswith(f"# {title}\n")
    assert "| scheme:step:free | 1.1: " in page


def test_what_is_not_as_declared_is_named(seen: tuple[Path, Any]) -> None:
    faults = {v["version"]: v["faults"] for v in seen[1]["versions"] if v["faults"]}
    assert list(faults) == ["1.8"]
    assert faults["1.8"][0] == "second, free: it does not step the declared lie-rk4"
    assert ("1.8", faults["1.8"][0]) in sheet_of(seen[1]).wrong


def looked(folder: Path, *versions: str, **more: Any) -> dict[str, Any]:
    """The arguments over releases of the engine, without their timings."""
    return {
        "engine": "versioned",
        "releases": arguments(folder, *versions),
        "scenarios": quick_scenario(folder),
        "integrators": "step",
        "adapter": TARGET,
        "offline": True,
        "cache": folder,
        "speed": False,
        **more,
    }


def printed(form: str, **requested: Any) -> int:
    """Compare, print, and give the exit code, as the command does."""
    found = compare_versions(**requested)
    print_versions(found, PageFormat(form))
    return exit_code(found.passed, found.comparable)


@pytest.mark.parametrize(
    ("metric", "expected"),
    [
        ("velocity frame", [("1.1", "1.2")]),
        ("order attitude step", [("1.1", "1.2"), ("1.3", "1.4")]),
    ],
)
def test_bisect_names_the_releases(
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
    metric: str,
    expected: list[tuple[str, str]],
) -> None:
    assert printed("json", **looked(tmp_path, *ALL, bisect=metric)) == 0
    found = json.loads(capsys.readouterr().out)["bisect"]["found"]
    assert [(step["from"], step["to"]) for step in found] == expected
    assert all(step["changes"] for step in found)


def test_bisect_of_what_stays_reports_it(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    requested = looked(tmp_path, *ALL, bisect="default timestep")
    assert printed("text", **requested, out=tmp_path / "out") == 1
    message = capsys.readouterr().out
    assert "the ends do not differ" in message
    assert "Releases run: 1.0 and 1.4." in message
    assert "the ends do not differ" in (tmp_path / "out" / "versions.html").read_text()


def test_with_one_version_there_is_nothing_to_compare(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert printed("json", **looked(tmp_path, "1.0", "1.5", speed=True)) == 3
    pace = json.loads(capsys.readouterr().out)["versions"][0]["seconds_per_step"]["step"]
    assert 0.0 < pace["least"] <= pace["median"] <= pace["most"]
    assert printed("text", **looked(tmp_path, "1.0", "1.5", bisect="frame")) == 3
    assert "fewer than two versions" in capsys.readouterr().out


def test_an_interpreter_with_another_version_is_not_taken(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    requested = looked(tmp_path, "1.0", bisect="frame")
    wrong = requested["releases"][0].replace("1.0=", "1.3=")
    assert printed("json", **{**requested, "releases": ["9.9", wrong]}) == 3
    record = json.loads(capsys.readouterr().out)
    reasons = {v["version"]: v["reason"] for v in record["versions"]}
    assert reasons["1.3"] == "the interpreter given for it has 1.0"


@pytest.mark.parametrize(
    ("more", "message"),
    [
        ({"bisect": "order attitude stap"}, "no metric has 'stap' in its name; write step"),
        ({"integrators": ["stap"]}, "write step"),
        ({"timestep": -1.0}, "not a positive number"),
        ({"engine": "mujoko", "adapter": None}, "write mujoco"),
        ({"engine": "mujoco", "adapter": None, "package": "own"}, "give --adapter too"),
        ({"releases": ["1.0"]}, "at least two versions"),
        ({"releases": ["3.0..4.0"]}, "the cache holds no release that lies there"),
    ],
)
def test_wrong_usage_is_one_sentence(tmp_path: Path, more: dict[str, Any], message: str) -> None:
    with pytest.raises(UsageError) as caught:
        compare_versions(**looked(tmp_path, "1.0", "1.2", **more))
    assert message in str(caught.value)
    assert "\n" not in str(caught.value)


def test_a_wrong_argument_ends_the_command_with_2(tmp_path: Path) -> None:
    result = omegadot("versions", "mujoco", "1.0", "2.0", "--scenario", "t-handel", folder=tmp_path)
    assert result.code == 2
    assert "t-handle" in result.err
    assert result.err.count("\n") == 1


def test_mujoco_4_steps_runge_kutta_differently(tmp_path: Path) -> None:
    """Two real releases: found without a request, and nothing sound is accused."""
    python = os.environ.get(OLD_MUJOCO)
    if python is None:
        pytest.skip(f"{OLD_MUJOCO} names no interpreter that has MuJoCo 3.17.0, NumPy and SciPy")
    own = ("mujoco", f"3.17.0={python}", f"4.0.0={sys.executable}", "--scenario", "box")
    few = ("--integrator", "RK4", "--integrator", "implicitfast", "--no-speed", "--format", "json")
    result = omegadot("versions", *own, *few, folder=tmp_path)
    assert result.code == 0, result.err or result.out
    changed = step(result.json, "4.0.0")
    assert {metric.split(":")[0] for metric in changed} <= {"scheme", "order", "drift", "default"}
    about = {m.split(":")[2 if m.startswith("drift") else 1] for m in changed if "default" not in m}
    assert about == {"RK4"}
    before, after = changed["order:RK4:free:attitude"]
    assert before == pytest.approx(2, abs=0.15)
    assert after == pytest.approx(4, abs=0.15)
    for record in result.json["versions"]:
        figures = record["figures"]
        assert re.match("body", figures["convention:free joint angular velocity frame"]["value"])
        ratio = figures["drift:box:implicitfast:0.01:energy ratio E/E0"]["value"]
        assert ratio == pytest.approx(0.9260, abs=5e-5)
