"""``import omegadot``: light, typed, and of one mind with the command line."""

from __future__ import annotations

import ast
import importlib
import re
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import polars as pl
import pytest
from command_line import omegadot, quick_scenario

import omegadot as api
from omegadot.commands.cli import main

HEAVY = ("numpy", "scipy", "polars", "pydantic", "mujoco", "pinocchio", "dartpy", "typer", "rich")
ENGINE = "mujoco:RK4"


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with a scenario, and what the command line has made of it."""
    place = tmp_path_factory.mktemp("api")
    quick_scenario(place)
    done = omegadot("run", "quick.toml", "--engine", ENGINE, "--out", "typed", folder=place)
    assert done.code == 0, done.err
    return place


@pytest.fixture(scope="module")
def result(folder: Path) -> api.RunResult:
    """The same, by the function."""
    return api.run(folder / "quick.toml", ENGINE)


def test_import_loads_nothing_and_a_script_needs_no_guard(folder: Path) -> None:
    script = folder / "script.py"
    script.write_text(
        "import sys, omegadot\n"
        "dir(omegadot)\n"
        f"print([name for name in {HEAVY} if name in sys.modules])\n"
        f"print(omegadot.run('quick.toml', '{ENGINE}', timesteps=0.02).passed)\n"
    )
    done = subprocess.run(
        [sys.executable, script], cwd=folder, capture_output=True, text=True, check=False
    )
    assert done.stdout.split() == ["[]", "True"], done.stderr
    assert done.stderr == ""
    assert {path.name for path in folder.iterdir()} == {"quick.toml", "script.py", "typed"}


def test_a_type_checker_sees_what_is_there() -> None:
    tree = ast.parse(Path(api.__file__).read_text(encoding="utf-8"))
    (typed,) = (
        node for node in tree.body if isinstance(node, ast.If) and isinstance(node.test, ast.Name)
    )
    seen = {
        alias.name: node.module
        for node in typed.body
        if isinstance(node, ast.ImportFrom)
        for alias in node.names
    }
    assert {*seen, "__version__"} == set(api.__all__)
    assert set(api.__all__) <= set(dir(api))
    for name, module in seen.items():
        assert getattr(api, name) is getattr(importlib.import_module(str(module)), name)
    with pytest.raises(AttributeError, match="no attribute 'rnu'"):
        api.rnu  # noqa: B018


def test_function_and_command_measure_the_same(result: api.RunResult, folder: Path) -> None:
    typed = api.read_record(folder / "typed")
    assert result.passed
    assert result.folder is None
    measured = pl.col("gate") != "cost"
    ours, theirs = result.record.metrics.filter(measured), typed.metrics.filter(measured)
    assert ours.equals(theirs)
    assert ours.height > 50
    assert result.record.trajectories.equals(typed.trajectories)
    assert result.record.tasks == typed.tasks
    assert [task.outcome for task in typed.tasks] == ["ok"] * 3
    assert typed.run["command"][:2] == ["omegadot", "run"]
    assert result.record.run["command"] == []
    assert result.record.headline in typed.markdown()


def test_exact_is_the_records(result: api.RunResult, folder: Path) -> None:
    kept = result.record.trajectories.filter(engine="exact")
    states = api.exact(folder / "quick.toml")
    assert states.to_polars().select(kept.columns[6:]).equals(kept.select(kept.columns[6:]))
    assert set(kept["integrator"]) == {states.source} == {"closed-form"}
    floors = result.record.metrics.filter(engine="exact", metric="resolvable_floor")
    (floor,) = floors.filter(channel="attitude")["value"]
    assert floor == np.max(states.attitude_floor)


def test_exact_at_any_times(folder: Path) -> None:
    for scenario in ("driven-world", folder / "quick.toml"):
        whole = api.exact(scenario)
        row = len(whole.time) // 3
        one = api.exact(scenario, whole.time[row])
        assert one.orientation.shape == (1, 4)
        np.testing.assert_array_equal(one.attitude_floor[0], whole.attitude_floor[row])
        assert np.max(np.abs(one.orientation[0] - whole.orientation[row])) < 1e-15
        beyond = api.exact(scenario, [2.0 * whole.time[-1]])
        assert beyond.attitude_floor[0] > whole.attitude_floor[-1]
    for times in ([1.0, 1.0], [-1.0], [], ["soon"], [[0.0]], [float("nan")]):
        with pytest.raises(api.UsageError, match="rising numbers"):
            api.exact("sphere", times)


def test_a_scenario_in_code_is_the_files(folder: Path) -> None:
    file = api.scenario(str(folder / "quick.toml"))
    tables = file.to_dict()
    del tables["schema"]
    tables["body"]["inertia"] = np.array(tables["body"]["inertia"])
    assert api.scenario(**tables) == api.scenario(tables) == api.scenario(file) == file
    longer = api.scenario("sphere", name="long", run={"duration": 9.0})
    assert (longer.name, longer.run.duration) == ("long", 9.0)
    assert longer.initial == api.scenario("sphere").initial
    ball = {"part": [{"shape": "sphere", "radius": 1.0, "mass": 2.0}]}
    assert api.scenario(file, body=ball).body.mass is None
    for given, text in ((3, "type int"), ({"name": "x"}, "in x, body is missing")):
        with pytest.raises(api.ScenarioError, match=text):
            api.scenario(given)


@pytest.mark.parametrize(
    ("call", "line"),
    [
        (lambda: api.run("t-handel"), "run t-handel"),
        (lambda: api.run("sphere", "mujocco"), "run sphere --engine mujocco"),
        (lambda: api.run("sphere", "mujoco:RK5"), "run sphere --engine mujoco:RK5"),
        (lambda: api.run("sphere", timesteps=-1.0), "run sphere --timestep -1"),
        (lambda: api.run("sphere", adapters="no.py"), "run sphere --adapter no.py"),
        (lambda: api.check("mujocco"), "check mujocco"),
        (lambda: api.choose("sphere"), "choose sphere"),
        (lambda: api.choose("sphere", attitude="1m"), "choose sphere --attitude 1m"),
        (lambda: api.score("no.csv", "sphere"), "score no.csv --scenario sphere"),
        (lambda: api.fit("no.csv"), "fit no.csv"),
        (lambda: api.versions("mujoco", "4.0.0"), "versions mujoco 4.0.0"),
        (lambda: api.faults("exact"), "faults --engine exact"),
        (lambda: api.report("nowhere"), "report nowhere"),
        (lambda: api.compare("nowhere", "there"), "compare nowhere there"),
    ],
)
def test_errors_are_the_commands(
    call: Any, line: str, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str],
    tmp_path: Path,
) -> None:  # fmt: skip
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(sys, "argv", ["omegadot", *line.split()])
    with pytest.raises(SystemExit) as ended:
        main()
    assert ended.value.code == 2
    with pytest.raises(ValueError, match=r".") as raised:
        call()
    assert capsys.readouterr().err == f"omegadot: {raised.value}\n"
    assert isinstance(raised.value, api.UsageError | api.ScenarioError | api.RecordError)


@pytest.mark.parametrize(
    ("arguments", "text"),
    [
        ({"setup": "as_shipped"}, "--setup as_shipped: no such setup; write as-shipped"),
        ({"jobs": 0}, "--jobs 0: give a whole number of at least 1"),
        ({"jobs": 1.5}, "jobs is 1.5; give a whole number."),
        ({"timeout": -1.0}, "--timeout -1.0: give a number above 0"),
        ({"timeout": "3"}, "timeout is '3'; give a number."),
        ({"memory": "x"}, "memory is 'x'; give a number."),
        ({"seed": -1}, "--seed -1"),
        ({"timesteps": "0.01"}, "timesteps is '0.01'; give a number or a list of such."),
        ({"exceptions": "none.toml"}, "none.toml is missing"),
    ],
)
def test_arguments_of_the_wrong_kind_are_one_sentence(arguments: Any, text: str) -> None:
    with pytest.raises(api.UsageError, match=re.escape(text)):
        api.run("sphere", ENGINE, **arguments)


def test_one_or_several_are_taken_in_any_container(folder: Path) -> None:
    quick = api.scenario(folder / "quick.toml")
    for steps in (
        np.array([0.02, 0.04]),
        {0.02, 0.04},
        iter([0.02, 0.04]),
        pl.Series([0.02, 0.04]),
    ):
        tasks = api.run((quick,), {ENGINE}, timesteps=steps).record.tasks
        assert sorted({task.timestep for task in tasks}) == [0.02, 0.04]
    with pytest.raises(api.UsageError, match="no feature 'contact'"):
        api.choose(quick, ENGINE, attitude="1deg", features="contact")
    with pytest.raises(api.UsageError, match="--budget 0: give a number above 0"):
        api.choose(quick, ENGINE, attitude="1deg", budget=0)
    with pytest.raises(api.ScenarioError, match=r"none\.urdf is missing"):
        api.choose(body=folder / "none.urdf", angular_velocity=[0, 0, 1], duration=1, omega=1.0)


@pytest.mark.parametrize("scenario", ["sphere", "t-handle"])
def test_exact_beyond_every_digit_is_refused(scenario: str) -> None:
    with pytest.raises(api.UsageError, match="holds no digit"):
        api.exact(scenario, 1e300)


@pytest.mark.parametrize("call", [
    lambda none: api.run(none),
    lambda none: api.run("sphere", none),
    lambda none: api.run("sphere", "exact", timesteps=none),
    lambda none: api.run("sphere", "exact", accuracies=none),
    lambda none: api.check("exact", scenarios=none),
    lambda none: api.check("exact", scenarios="sphere", integrators=none),
    lambda none: api.choose(none, attitude="1deg"),
    lambda none: api.choose("sphere", none, attitude="1deg"),
    lambda none: api.schemes(none),
    lambda none: api.faults(none),
    lambda none: api.versions("mujoco", ["1.0", "2.0"], scenarios=none, offline=True),
    lambda none: api.versions("mujoco", ["1.0", "2.0"], integrators=none, offline=True),
])  # fmt: skip
def test_an_empty_list_is_no_request_for_everything(call: Any) -> None:
    with pytest.raises(api.UsageError, match="is empty; name at least one"):
        call([])


@pytest.mark.parametrize("path", [3, "x" * 300])
@pytest.mark.parametrize("call", [
    lambda path: api.run("sphere", "exact", out=path),
    lambda path: api.run("sphere", "exact", exceptions=path),
    lambda path: api.check("exact", scenarios="sphere", exceptions=path),
    lambda path: api.choose("sphere", "exact", attitude="1deg", out=path),
    lambda path: api.score(path, "sphere"),
    lambda path: api.fit(path),
    lambda path: api.fit("no.csv", out=path),
    lambda path: api.report(path),
    lambda path: api.compare(path, path),
    lambda path: api.read_record(path),
])  # fmt: skip
def test_a_path_that_can_be_none_is_an_error_of_our_own(call: Any, path: Any) -> None:
    with pytest.raises((api.UsageError, api.RecordError, api.ScenarioError), match=r"\.$"):
        call(path)


@pytest.mark.parametrize(
    "line",
    [
        "score no.csv --scenario sphere --detect --omega-bias 1,2,3",
        "score no.csv --scenario sphere --detect --out here",
        "run sphere --setup as-shipped --exceptions no.toml",
        "check exact --scenario sphere --seed 5",
        "versions mujoco 1.0 2.0 --offline --installer pip",
        "versions mujoco 1.0 2.0 --offline --bisect energy --jobs 2",
        "fit no.csv --out fitted",
    ],
)
def test_an_option_that_would_be_ignored_is_refused(
    line: str, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(sys, "argv", ["omegadot", *line.split()])
    with pytest.raises(SystemExit) as ended:
        main()
    assert ended.value.code == 2
    assert "no.csv" not in (err := capsys.readouterr().err)
    assert err.count("\n") == 1
