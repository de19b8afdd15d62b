"""The command line: exit codes, sentences, and what a run leaves behind."""

import json
import subprocess
import sys
from pathlib import Path

import polars as pl
import pyarrow.parquet as pq
import pytest
from command_line import FAULTY, PROGRAM, QUICK, Result, omegadot, quick_scenario

from omegadot.reports.record import schema
from omegadot.scenarios import builtin_names


def sentence(result: Result) -> str:
    """The one line of a refusal."""
    assert result.code == 2, result.err
    assert result.out == ""
    (line,) = result.err.splitlines()
    assert line.startswith("omegadot: ")
    assert line.endswith(".")
    return line


@pytest.fixture(scope="module")
def small_run(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("small")
    scenario = quick_scenario(folder)
    engines = ("mujoco:RK4", "pinocchio", "dart", "reference", "exact")
    arguments = [argument for engine in engines for argument in ("--engine", engine)]
    result = omegadot("run", scenario, *arguments, "--out", "out", folder=folder)
    assert result.code == 0, result.err
    return folder / "out"


def test_a_run_leaves_the_contracts_files(small_run: Path) -> None:
    assert {file.name for file in small_run.iterdir()} == {
        "run.json",
        "metrics.parquet",
        "trajectories.parquet",
        "report.html",
    }
    metrics = pl.read_parquet(small_run / "metrics.parquet")
    assert metrics.columns == list(schema.METRICS)
    trajectories = pq.read_schema(small_run / "trajectories.parquet")
    assert trajectories.names == list(schema.TRAJECTORIES)
    assert trajectories.field("ax").metadata == {b"unit": b"rad/s^2"}


def test_every_integrator_and_step_is_a_task(small_run: Path) -> None:
    run = json.loads((small_run / "run.json").read_text())
    listed = {e["name"]: e for e in run["engines"]}
    for name, engine in listed.items():
        tasks = [t for t in run["tasks"] if t["engine"] == name]
        if name == "exact":
            assert [(t["integrator"], t["timestep"]) for t in tasks] == [
                (tasks[0]["integrator"], None)
            ]
            continue
        wanted = ["RK4"] if name == "mujoco" else [i["name"] for i in engine["integrators"]]
        assert {(t["integrator"], t["timestep"]) for t in tasks} == {
            (integrator, step) for integrator in wanted for step in (0.02, 0.01, 0.005)
        }
    assert {t["outcome"] for t in run["tasks"]} == {"ok"}


def test_trajectories_stand_at_the_engines_own_steps(small_run: Path) -> None:
    table = pl.read_parquet(small_run / "trajectories.parquet")
    for step, every in ((0.02, 1), (0.01, 2), (0.005, 4)):
        one = table.filter((pl.col("engine") == "mujoco") & (pl.col("timestep") == step))
        assert one["time"].to_list() == [n * every * step for n in range(51)]
    exact = table.filter(pl.col("engine") == "exact")
    assert exact["timestep"].null_count() == len(exact)
    assert set(table["time"]) <= set(exact["time"])


def test_all_gates_hold_with_a_reason(small_run: Path) -> None:
    run = json.loads((small_run / "run.json").read_text())
    for task in run["tasks"]:
        assert set(task["gates"].values()) <= {"pass", "info"}, task
        assert {"model", "equation", "invariants"} <= set(task["gates"])
        if task["engine"] != "exact":
            assert task["why"].startswith(("explained by", "within round-off"))


def test_the_page_can_be_drawn_again(small_run: Path, tmp_path: Path) -> None:
    before = (small_run / "report.html").read_text()
    (small_run / "report.html").unlink()
    result = omegadot("report", small_run, folder=tmp_path)
    assert result.code == 0, result.err
    assert (small_run / "report.html").read_text() == before


def test_json_is_for_machines(tmp_path: Path) -> None:
    quick_scenario(tmp_path)
    arguments = ("--engine", "mujoco:Euler", "--timestep", 0.01, "--format", "json")
    result = omegadot("run", "quick.toml", *arguments, folder=tmp_path)
    assert result.code == 0, result.err
    assert result.err == ""
    assert result.json["exit_code"] == 0
    assert [task["timestep"] for task in result.json["tasks"]] == [0.01]
    assert (tmp_path / "omegadot-run" / "run.json").exists()


def test_an_earlier_record_gives_way_and_nothing_else_does(tmp_path: Path) -> None:
    quick_scenario(tmp_path)
    arguments = ("run", "quick.toml", "--engine", "exact", "--out", "out")
    assert omegadot(*arguments, folder=tmp_path).code == 0
    assert omegadot(*arguments, folder=tmp_path).code == 0
    (tmp_path / "out" / "thesis.txt").write_text("mine")
    assert "thesis.txt" in sentence(omegadot(*arguments, folder=tmp_path))


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (("run", "t-handel"), "t-handle"),
        (("run", "nowhere.toml"), "nowhere.toml"),
        (("run", "sphere", "--engine", "mujocco"), "write mujoco"),
        (("run", "sphere", "--engine", "mujoco:RK5"), "write RK4"),
        (("run", "sphere", "--engine", "reference:rk5"), "no integrator 'rk5'"),
        (
            ("run", "sphere", "--engine", "reference", "--engine", "reference:rk5"),
            "reference:rk5: reference",
        ),
        (
            ("run", "sphere", "--engine", "reference:rk5", "--engine", "reference"),
            "no integrator 'rk5'",
        ),
        (("run", "sphere", "--timestep", "0"), "not a positive number"),
        (("run", "sphere", "--timestep", "nan"), "not a positive number"),
        (("run", "sphere", "--timestep", "1e9"), "longer than"),
        (("run", "sphere", "--timestep", "1e-12"), "would take 5e12 steps; give one of at least"),
        (("run", "sphere", "--timestep", "soon"), "--timestep"),
        (("run", "sphere", "--timeout", "1e300"), "at most 1e9"),
        (("run", "sphere", "--timeout", "inf"), "at most 1e9"),
        (("run", "sphere", "--memory", "1e300"), "at most 1e9"),
        (("choose", "sphere", "--attitude", "1deg", "--budget", "1e300"), "at most 1e9"),
        (("run", "sphere", "--out", "x" * 300), "cannot be written"),
        (("run", "sphere", "--out", "/dev/null/x"), "cannot be written"),
        (("run", "sphere", "--setup", "racing"), "racing"),
        (("run", "sphere", "--adapter", "mine"), "no class is named"),
        (("run", "sphere", "--speed"), "--speed"),
        (("run", "sphere", "--timeout", "-1"), "--timeout"),
        (("report", "nowhere"), "no such folder"),
        (("fly",), "fly"),
    ],
)
def test_wrong_usage_is_one_sentence(
    arguments: tuple[str, ...], message: str, tmp_path: Path
) -> None:
    assert message in sentence(omegadot(*arguments, folder=tmp_path))
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("arguments", ["scenarios", "run quick.toml --engine dart"])
def test_an_output_that_is_full_or_closed_is_one_sentence(arguments: str, tmp_path: Path) -> None:
    quick_scenario(tmp_path)
    command = [*PROGRAM, *arguments.split()]
    with Path("/dev/full").open("w") as full:
        done = subprocess.run(
            command, cwd=tmp_path, stdout=full, stderr=subprocess.PIPE, text=True, check=False
        )
    assert done.returncode == 3
    assert done.stderr == ("omegadot: standard output: cannot be used (No space left on device).\n")
    shell = ["sh", "-c", '"$@" >&-', "sh", *command]
    done = subprocess.run(shell, cwd=tmp_path, stderr=subprocess.PIPE, text=True, check=False)
    assert "Traceback" not in done.stderr


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="a device of Linux")
def test_the_exit_code_stands_where_nothing_can_be_reported(tmp_path: Path) -> None:
    shell = ["sh", "-c", '"$@" 2>/dev/full', "sh", *PROGRAM, "check", "mujocco"]
    done = subprocess.run(shell, cwd=tmp_path, capture_output=True, text=True, check=False)
    assert done.returncode == 2


def test_a_folder_that_is_gone_is_one_sentence(tmp_path: Path) -> None:
    gone = tmp_path / "gone"
    gone.mkdir()
    shell = ["sh", "-c", 'rmdir ../gone; "$@"', "sh", *PROGRAM, "run", "sphere"]
    done = subprocess.run(shell, cwd=gone, capture_output=True, text=True, check=False)
    assert done.returncode == 3
    assert done.stderr == (
        "omegadot: the current folder does not exist any more; change to another.\n"
    )


def test_a_malformed_scenario_is_one_sentence(tmp_path: Path) -> None:
    quick_scenario(tmp_path, QUICK.replace("mass = 2.0", "mass = -2.0"))
    message = sentence(omegadot("run", "quick.toml", folder=tmp_path))
    assert "quick.toml" in message
    assert "body.mass" in message
    assert "-2.0" in message
    assert [file.name for file in tmp_path.iterdir()] == ["quick.toml"]


def test_a_step_longer_than_a_flip_ends_well(tmp_path: Path) -> None:
    # Explicit schemes blow up here and the implicit one finds no solution: all of it is shown.
    text = QUICK.replace("[0.3, 2.0, 0.1]", "[300.0, 2000.0, 100.0]")
    text = text.replace("[0.02, 0.01, 0.005]", "[0.5]")
    quick_scenario(tmp_path, text)
    result = omegadot("run", "quick.toml", "--format", "json", folder=tmp_path)
    assert result.code in (0, 1), result.err
    assert {t["outcome"] for t in result.json["tasks"]} <= {"ok", "diverged"}


def test_scenarios_and_engines_are_listed(tmp_path: Path) -> None:
    listed = omegadot("scenarios", "--format", "json", folder=tmp_path)
    assert tuple(s["name"] for s in listed.json) == builtin_names()
    assert all(s["title"] and s["shows"] and s["source"] for s in listed.json)
    text = omegadot("scenarios", folder=tmp_path)
    assert all(name in text.out for name in builtin_names())
    engines = omegadot("engines", "--format", "json", folder=tmp_path)
    found = {e["name"]: e for e in engines.json}
    assert {"exact", "reference", "mujoco", "pinocchio", "dart"} <= set(found)
    assert all(found[name]["switched_off"] for name in ("mujoco", "dart"))
    missing = omegadot("engines", "--adapter", f"{FAULTY}:Missing", folder=tmp_path)
    assert missing.code == 0
    assert "not available" in missing.out
    assert "semi-implicit-euler" in missing.out


def test_letters_that_the_output_cannot_hold_end_nothing(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    # as of a pipe on Windows, whose code pages know no omega
    monkeypatch.setenv("PYTHONIOENCODING", "ascii")
    quick_scenario(tmp_path)
    result = omegadot("run", "quick.toml", "--engine", "reference:lie-rk4", folder=tmp_path)
    assert result.code == 0, result.err
    assert "the Newton-Euler equations" in result.out  # a letter that another stands for
    missing = omegadot("run", "\N{GREEK SMALL LETTER OMEGA}.toml", folder=tmp_path)
    assert missing.code == 2
    assert "?.toml" in missing.err  # one that none stands for


def test_an_extended_type_that_there_is_not_is_refused(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("OMEGADOT_EXTENDED", "quad")
    quick_scenario(tmp_path)
    (tmp_path / "trace.csv").write_text("t,qw,qx,qy,qz\n0,1,0,0,0\n1,1,0,0,0\n", encoding="utf-8")
    quick = QUICK.replace("[run]", "[load]\ndamping = 0.1\n[run]")  # no closed form: by series
    quick_scenario(tmp_path, quick)
    message = sentence(omegadot("score", "trace.csv", "--scenario", "quick.toml", folder=tmp_path))
    assert "OMEGADOT_EXTENDED is 'quad'" in message


def test_a_memory_limit_that_is_not_kept_is_reported(tmp_path: Path) -> None:
    quick_scenario(tmp_path)
    code = (
        "import omegadot.commands.run.command as c; c._memory_is_limited = lambda: False; "
        "from omegadot.commands.cli import main; main()"
    )
    command = ["run", "quick.toml", "--engine", "reference:lie-rk4", "--memory", "1"]
    done = subprocess.run(
        [sys.executable, "-c", code, *command], cwd=tmp_path, capture_output=True, text=True
    )
    assert done.returncode == 0
    assert "--memory is ignored" in done.stderr


def test_help_and_version_are_quick(tmp_path: Path) -> None:
    assert "0.1.0" in omegadot("--version", folder=tmp_path).out
    assert "scenarios" in omegadot("--help", folder=tmp_path).out
    assert "--timestep" in omegadot("run", "--help", folder=tmp_path).out


def test_a_check_starts_without_tables() -> None:
    """Caught: an import that a tenth of the time of a small check goes into, and no more."""
    code = "import sys, omegadot.commands.check.check; sys.exit('polars' in sys.modules)"
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0


def test_files_of_the_current_folder_stand_in_for_no_module(tmp_path: Path) -> None:
    for name in ("json", "inspect", "numpy", "mujoco"):
        (tmp_path / f"{name}.py").write_text("raise SystemExit('not this one')")
    own = Path(__file__).parents[2] / "docs" / "examples" / "toy_engine.py"
    (tmp_path / "my_engine.py").write_text(own.read_text(encoding="utf-8"), encoding="utf-8")
    (tmp_path / "a.xml").write_text(
        "<mujoco><worldbody><body name='a'><geom size='1'/></body></worldbody></mujoco>"
    )
    before = {path.name for path in tmp_path.iterdir()}
    program = [sys.executable, "-P", *PROGRAM[1:]]  # as the installed command: without the folder
    for line in (
        "run sphere --engine mujoco:RK4 --adapter my_engine:ToyAdapter --timestep 0.02 --out o",
        "choose sphere --body a.xml#a --engine mujoco:RK4 --attitude 1deg --budget 0.05",
    ):
        command = [*program, *line.split()]
        done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, check=False)
        assert done.returncode == 0, done.stderr
    assert {path.name for path in tmp_path.iterdir()} - before - {"__pycache__"} == {"o"}
