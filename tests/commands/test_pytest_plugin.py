"""The pytest plugin, as pytest runs it: engines checked without a test file, and nothing else."""

import subprocess
import sys
import tomllib
from pathlib import Path

import pytest
from command_line import FAULTY, WRONG, quick_scenario
from pytest_line import PLUGIN, outcomes, plugin_arguments, run_pytest

ROOT = Path(__file__).parents[2]
SOUND = ("--adapter", f"{WRONG}:Sound")
WRONG_ENGINE = ("--adapter", f"{WRONG}:SecretDamping")


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """An empty folder with a scenario in it, and no test."""
    quick_scenario(tmp_path)
    return tmp_path


def quick(*arguments: object) -> tuple[object, ...]:
    return (*arguments, "--scenario", "quick.toml")


def test_an_empty_folder_is_enough(folder: Path) -> None:
    result = run_pytest(*quick("--engine", "mujoco:RK4"), "--junitxml=out.xml", folder=folder)
    assert result.code == 0, result.out
    assert "omegadot: mujoco" in result.out
    assert "(RK4): 11 checks, model and equation on 1 scenario, and " in result.out
    assert "collected 11 items" in result.out
    found = outcomes(folder / "out.xml")
    assert len(found) == 11
    assert set(found.values()) == {"passed"}
    assert "omegadot.quick.mujoco-RK4-quick-0.005-trajectory" in found


def test_a_wrong_engine_fails_with_its_checks_and_two_workers_agree(folder: Path) -> None:
    idle = ("--adapter", f"{FAULTY}:Unsupporting")
    arguments = quick(*WRONG_ENGINE, *idle, "--scenario", "sphere")
    alone = run_pytest(*arguments, "--junitxml=one.xml", folder=folder)
    shared = run_pytest(*arguments, "-n", "2", "--junitxml=two.xml", folder=folder)
    assert alone.code == shared.code == 1
    one = outcomes(folder / "one.xml")
    assert one == outcomes(folder / "two.xml")
    assert set(one.values()) == {"passed", "failure", "skipped"}
    assert "a skip is not a pass (unsupported: this engine has no rigid bodies)" in alone.out
    assert "a skip is not a pass (unsupported: this engine has no rigid bodies)" in shared.out
    failed = {name for name, outcome in one.items() if outcome == "failure"}
    assert "omegadot.quick.secretdamping-semi-implicit-euler-quick-0.01-scheme" in failed
    assert not any(name.endswith(("model", "equation")) for name in failed)
    assert "times its bound" in alone.out  # the message states by which bound
    assert "Traceback" not in alone.out


def test_a_failing_check_is_run_again_by_its_node_id(folder: Path) -> None:
    nodeid = "omegadot::quick::sound-semi-implicit-euler-quick-0.01-scheme"
    result = run_pytest(*quick(*SOUND), nodeid, "-v", folder=folder)
    assert result.code == 0, result.out
    assert "1 passed" in result.out
    assert f"{nodeid} PASSED" in result.out
    selected = run_pytest(*quick(*SOUND), "-k", "invariants", "--co", "-q", folder=folder)
    assert "3/11 tests collected (8 deselected)" in selected.out


def test_random_systems_are_collected(folder: Path) -> None:
    engine = ("--engine", "reference:lie-rk4", "--co", "-q")
    some = run_pytest(
        *quick(*engine, "--omegadot-random", "1", "--omegadot-seed", 5), folder=folder
    )
    assert "omegadot::random-5-0::reference-random-5-0-equation" in some.out
    assert "omegadot::quick::reference-quick-equation" in some.out
    whole = run_pytest(*engine, folder=folder).out
    assert "omegadot::random-0-23::reference-random-0-23-equation" in whole
    assert "omegadot::sphere::reference-sphere-equation" in whole
    refused = run_pytest(*engine, "--omegadot-random", "-1", folder=folder)
    assert "--random -1: give a whole number" in refused.out + refused.err


@pytest.mark.parametrize(
    ("arguments", "code", "message"),
    [
        (("--require-engine", "nope"), 1, "nope-start - not-installed: no engine of this name"),
        (("--adapter", f"{FAULTY}:Missing", "--require-engine", "missing"), 1, "missing-start"),
        (("--adapter", f"{FAULTY}:Missing"), 1, "missing: all of its 1 check was skipped"),
        (("--adapter", f"{FAULTY}:Raises"), 1, "raised: ArithmeticError: the solver did not conv"),
        (("--engine", "mujocco"), 4, "write mujoco"),
    ],
)
def test_no_engine_is_lost(
    arguments: tuple[str, ...], code: int, message: str, folder: Path
) -> None:
    result = run_pytest(*quick(*arguments), folder=folder)
    assert result.code == code, result.out + result.err
    assert message in result.out + result.err


def test_a_declared_exception_is_an_expected_failure(folder: Path) -> None:
    tables = "".join(
        f'[[exception]]\ncheck = "secretdamping-*-{gate}"\nreason = "It is damped."\n'
        'link = "https://example.org/3"\n'
        for gate in ("scheme", "invariants", "trajectory")
    )
    (folder / "known.toml").write_text('engine = "secretdamping"\n' + tables)
    arguments = quick(*WRONG_ENGINE, "--exceptions", "known.toml")
    result = run_pytest(*arguments, "--junitxml=out.xml", "-rx", folder=folder)
    assert result.code == 0, result.out
    assert "https://example.org/3" in result.out
    assert list(outcomes(folder / "out.xml").values()).count("xfail") == 9


def test_baselines_are_gathered_from_all_workers(folder: Path) -> None:
    arguments = quick("--engine", "reference:lie-rk4", "--scenario", "sphere", "--baseline", "kept")
    written = run_pytest(*arguments, "--update-baseline", "-n", "2", folder=folder)
    assert written.code == 0, written.out
    text = (folder / "kept" / "reference.toml").read_text()
    assert '[scenario."quick".run."lie-rk4"."0.005"]' in text
    assert '[scenario."sphere".run."lie-rk4"."0.01"]' in text
    again = run_pytest(*arguments, folder=folder)
    assert again.code == 0, again.out
    assert "at the finest step" in again.out


def test_checks_stand_next_to_tests_where_these_are_named(folder: Path) -> None:
    (folder / "test_mine.py").write_text("def test_mine(): pass\n")
    arguments = quick("--engine", "reference:lie-rk4", "--co", "-q")
    assert "11 tests collected" in run_pytest(*arguments, folder=folder).out
    assert "12 tests collected" in run_pytest(*arguments, "test_mine.py", folder=folder).out
    options = "addopts = --engine reference:lie-rk4 --scenario quick.toml"
    (folder / "pytest.ini").write_text(f"[pytest]\n{options}\n")
    assert "12 tests collected" in run_pytest("--co", "-q", folder=folder).out


def test_a_taken_option_stays_with_its_owner(folder: Path) -> None:
    (folder / "conftest.py").write_text(
        "def pytest_addoption(parser):\n    parser.addoption('--engine', default='postgres')\n"
    )
    (folder / "test_mine.py").write_text(
        "def test_mine(request):\n    assert request.config.getoption('--engine') == 'sqlite'\n"
    )
    theirs = run_pytest("--engine", "sqlite", folder=folder)
    assert theirs.code == 0, theirs.out + theirs.err
    assert "1 passed" in theirs.out
    ours = run_pytest(*quick("--omegadot-engine", "reference:lie-rk4"), "--co", folder=folder)
    assert "collected 11 items" in ours.out


def test_other_peoples_pytest_is_left_alone(folder: Path) -> None:
    (folder / "test_mine.py").write_text(
        "import sys\n\ndef test_mine():\n"
        "    heavy = {'numpy', 'scipy', 'polars', 'typer', 'omegadot.harness'}\n"
        "    assert not heavy & set(sys.modules)\n"
    )
    result = run_pytest("-p", "no:hypothesispytest", folder=folder, fresh=True)
    assert result.code == 0, result.out
    assert "omegadot:" not in result.out
    helped = run_pytest("--help", folder=folder)
    assert "--omegadot-engine" in helped.out
    assert "--require-engine" in helped.out


def test_the_plugin_itself_imports_pytest_alone() -> None:
    code = (
        f"import sys, pytest; before = set(sys.modules); import {PLUGIN}; "
        "print(*sorted(set(sys.modules) - before))"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    folders = ["omegadot", "omegadot.commands", "omegadot.commands.check"]
    assert done.stdout.split() == [*folders, PLUGIN]


def test_it_is_announced_to_pytest() -> None:
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    assert project["entry-points"]["pytest11"] == {"omegadot": PLUGIN}
    assert plugin_arguments() in ([], ["-p", PLUGIN])
