"""An engine that dies, hangs, raises or diverges costs its own tasks and nothing else."""

import json
import os
import signal
import subprocess
import time
from collections.abc import Callable
from pathlib import Path

import polars as pl
import psutil
import pytest
from command_line import FAULTY, PROGRAM, Result, omegadot, quick_scenario


def run_faulty(name: str, folder: Path, *more: object) -> Result:
    scenario = quick_scenario(folder)
    bystanders = (
        "--engine",
        "reference:semi-implicit-euler",
        "--engine",
        "reference:rk4-quaternion",
    )
    arguments = ("--engine", name.lower(), "--adapter", f"{FAULTY}:{name}", *bystanders)
    return omegadot("run", scenario, *arguments, "--out", "out", *more, folder=folder)


def outcomes(folder: Path, engine: str) -> dict[str, set[str]]:
    run = json.loads((folder / "out" / "run.json").read_text())
    found: dict[str, set[str]] = {}
    for task in run["tasks"]:
        if task["engine"] == engine:
            found.setdefault(task["integrator"], set()).add(task["outcome"])
    return found


@pytest.mark.parametrize(
    ("name", "outcome", "code", "reason"),
    [
        ("Killed", "crashed", 3, "SIGKILL"),
        ("Exits", "crashed", 3, "exit code 7"),
        ("Hangs", "timeout", 3, "no answer within"),
        ("Raises", "raised", 3, "ArithmeticError: the solver did not converge"),
        ("Diverges", "diverged", 1, "not finite from t = 0.5"),
    ],
)
def test_a_failing_run_costs_only_its_own_tasks(
    name: str, outcome: str, code: int, reason: str, tmp_path: Path
) -> None:
    result = run_faulty(name, tmp_path, "--timeout", 3 if name == "Hangs" else 60)
    assert result.code == code, result.err
    run = json.loads((tmp_path / "out" / "run.json").read_text())
    faulty = [t for t in run["tasks"] if t["outcome"] == outcome]
    assert all(reason in task["reason"] for task in faulty if "not tried" not in task["reason"])
    found = outcomes(tmp_path, name.lower())
    assert found["semi-implicit-euler"] == {outcome}
    if name != "Hangs":  # three time-outs in a row end an engine's turn
        assert found["rk4-quaternion"] == {"ok"}
    others = outcomes(tmp_path, "reference")
    assert all(states == {"ok"} for states in others.values())
    trajectories = pl.read_parquet(tmp_path / "out" / "trajectories.parquet")
    whole = trajectories.filter((pl.col("engine") == "reference") & (pl.col("timestep") == 0.01))
    assert set(whole.group_by("integrator").len()["len"]) == {51}


def test_the_last_output_of_a_dead_worker_are_kept(tmp_path: Path) -> None:
    run_faulty("Killed", tmp_path)
    run = json.loads((tmp_path / "out" / "run.json").read_text())
    reasons = {t["reason"] for t in run["tasks"] if t["outcome"] == "crashed"}
    assert reasons == {"ended by signal 9 (SIGKILL); its last output: assertion failed: mass > 0"}


@pytest.mark.parametrize("name", ["OneSample", "EverySampleTwice"])
def test_another_number_of_samples_costs_only_its_own_tasks(name: str, tmp_path: Path) -> None:
    result = run_faulty(name, tmp_path)
    assert result.code == 1, result.err
    assert outcomes(tmp_path, "reference")
    assert (tmp_path / "out" / "report.html").exists()
    engines = ("--adapter", f"{FAULTY}:{name}", "--engine", "reference:lie-rk4")
    chosen = omegadot(
        "choose", "quick.toml", "--attitude", "1deg", *engines, "--budget", 0.05, folder=tmp_path
    )
    assert chosen.code == 3, chosen.err
    assert "where" in chosen.out
    assert "were requested" in chosen.out
    assert "reference:lie-rk4" in chosen.out


def test_a_flood_on_both_streams_garbles_nothing(tmp_path: Path) -> None:
    result = run_faulty("Chatty", tmp_path)
    assert result.code == 0, result.err
    assert outcomes(tmp_path, "chatty") == {
        "semi-implicit-euler": {"ok"},
        "rk4-quaternion": {"ok"},
    }


def test_unsupported_is_neither_a_pass_nor_a_failure(tmp_path: Path) -> None:
    result = run_faulty("Unsupporting", tmp_path)
    assert result.code == 3, result.err  # nothing of the engine that was given is judged
    run = json.loads((tmp_path / "out" / "run.json").read_text())
    refused = [t for t in run["tasks"] if t["engine"] == "unsupporting"]
    assert {t["outcome"] for t in refused} == {"unsupported"}
    assert {t["reason"] for t in refused} == {"this engine has no rigid bodies"}
    assert all(t["gates"] == {} for t in refused)
    assert "unsupported" in result.out


@pytest.mark.parametrize(
    ("name", "outcome", "reason"),
    [("Unstartable", "raised", "no licence found"), ("Missing", "not-installed", "No module")],
)
def test_an_engine_that_does_not_start_is_reported(
    name: str, outcome: str, reason: str, tmp_path: Path
) -> None:
    result = run_faulty(name, tmp_path)
    assert result.code == 3, result.err
    run = json.loads((tmp_path / "out" / "run.json").read_text())
    tasks = [t for t in run["tasks"] if t["engine"] == name.lower()]
    assert [t["outcome"] for t in tasks] == [outcome]
    assert reason in tasks[0]["reason"]


def long_run(folder: Path) -> subprocess.Popen[str]:
    """A run that is busy for a minute: one of its workers hangs."""
    arguments = ["run", str(quick_scenario(folder)), "--engine", "dart", "--engine", "reference"]
    return subprocess.Popen(
        [
            *PROGRAM,
            *arguments,
            "--timestep",
            "0.01",
            "--adapter",
            f"{FAULTY}:Hangs",
            "--out",
            "out",
        ],
        cwd=folder,
        env={**os.environ, "OMEGADOT_TEST_MARKS": str(folder)},
        # A shell's background jobs ignore SIGINT, and so would every child of such a job.
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL) and None,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )


def wait_until(condition: Callable[[], object]) -> None:
    end = time.monotonic() + 60.0
    while not condition():
        assert time.monotonic() < end, "the run never came that far"
        time.sleep(0.05)


def wait_for_worker(process: subprocess.Popen[str], name: str) -> int:
    for _ in range(600):
        for child in psutil.Process(process.pid).children():
            if any(name in target for target in child.cmdline()[-3:-2]):
                return child.pid
        time.sleep(0.05)
    raise AssertionError(f"no worker for {name} came up")


def test_ctrl_c_leaves_a_readable_record(tmp_path: Path) -> None:
    process = long_run(tmp_path)
    wait_until((tmp_path / "hangs").exists)
    process.send_signal(signal.SIGINT)
    _, err = process.communicate(timeout=60)
    assert process.returncode == 130, err
    assert err == "omegadot: interrupted.\n"
    run = json.loads((tmp_path / "out" / "run.json").read_text())
    assert run["complete"] is False
    assert {t["outcome"] for t in run["tasks"]} == {"interrupted"}
    assert (tmp_path / "out" / "report.html").exists()
    assert pl.read_parquet(tmp_path / "out" / "metrics.parquet").columns


def test_ctrl_c_in_a_choice_is_one_sentence(tmp_path: Path) -> None:
    arguments = ["choose", quick_scenario(tmp_path), "--attitude", "1e-9", "--engine", "dart"]
    process = subprocess.Popen(
        [*PROGRAM, *map(str, arguments), "--budget", "60", "--out", "out"],
        cwd=tmp_path,
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL) and None,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )
    wait_for_worker(process, "dart")
    process.send_signal(signal.SIGINT)
    out, err = process.communicate(timeout=60)
    assert (process.returncode, out, err) == (130, "", "omegadot: interrupted.\n")
    assert list((tmp_path / "out").iterdir()) == []


def test_a_worker_killed_from_outside_is_replaced(tmp_path: Path) -> None:
    quick_scenario(tmp_path)
    arguments = ["run", "quick.toml", "--adapter", f"{FAULTY}:Hangs", "--engine", "mujoco:Euler"]
    process = subprocess.Popen(
        [*PROGRAM, *arguments, "--timestep", "0.01", "--out", "out"],
        cwd=tmp_path,
        env={**os.environ, "OMEGADOT_TEST_MARKS": str(tmp_path)},
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )
    worker = wait_for_worker(process, "faulty.py")
    wait_until((tmp_path / "hangs").exists)
    os.kill(worker, signal.SIGKILL)
    _, err = process.communicate(timeout=120)
    assert process.returncode == 3, err
    assert outcomes(tmp_path, "mujoco") == {"Euler": {"ok"}}
    assert outcomes(tmp_path, "hangs") == {
        "semi-implicit-euler": {"crashed"},
        "rk4-quaternion": {"ok"},
    }
