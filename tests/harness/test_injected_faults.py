"""Faults of workers, all at once: outcomes stay apart, and the rest of the run is whole.

Two runs, shared by every test here: one of engines that break, one of engines that hang.
"""

import contextlib
import json
import os
import uuid
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import polars as pl
import psutil
import pytest
from command_line import ENGINES, Result, omegadot, quick_scenario

INJECTED = ENGINES / "injected.py"
FAULTY_ENGINES, WELL = "semi-implicit-euler", "rk4-quaternion"
MARK = "OMEGADOT_TEST_MARK"
TINY = """
schema = 1
name = "tiny"
title = "A tiny tumble"
[body]
mass = 2.0
inertia = [1.0, 2.0, 2.5]
[initial]
angular_velocity = [0.3, 2.0, 0.1]
[run]
duration = 0.1
timesteps = [0.01]
sample = 0.01
"""

# In the runs of one scheme: the outcome, and what the reason must contain.
BROKEN = {
    "KillNine": ("crashed", "ended by signal 9 (SIGKILL)"),
    "Segfault": ("crashed", "ended by signal 11 (SIGSEGV)"),
    "Aborts": ("crashed", "(SIGABRT); its last output: [31mAssertion `inertia > 0' failed."),
    "NamelessSignal": ("crashed", "ended by signal 35"),
    "ExitsWithZero": ("crashed", "ended with exit code 0"),
    "LeavesAChild": ("crashed", "ended with exit code 9"),
    "LeavesADaemon": ("crashed", "ended with exit code 9"),
    "ClosesItsChannel": ("crashed", "ended with exit code"),
    "ClosesAndStays": ("crashed", "it closed the channel of its answers; the worker was ended"),
    "WritesIntoTheChannel": ("crashed", "its answer cannot be read"),
    "Exits": ("raised", "SystemExit: 0 (injected.py:"),
    "Interrupts": ("raised", "KeyboardInterrupt (injected.py:"),
    "Recurses": ("raised", "RecursionError: maximum recursion depth exceeded"),
    "EatsMemory": ("raised", "the limit is 0.5 GiB, omegadot run --memory sets another"),
    "LongMessage": ("raised", "ValueError: no convergence, residuals: 0.1 0.1"),
    "OddMessage": ("raised", "[2J [/red] [bold <script>alert(1)</script> {{ x }} ok"),
    "Speechless": ("raised", "SilentError: it cannot be printed"),
    "ReturnsNothing": ("raised", "run() is of type NoneType; answer with a Trajectory"),
    "WrongShape": ("raised", "run().state.orientation has the shape (11, 3); answer with (11, 4)"),
    "FewerStatesThanTimes": ("raised", "has the shape (10, 4); answer with (11, 4)"),
    "ComplexNumbers": (
        "raised",
        "angular_velocity is an array of complex128; answer with an array",
    ),
    "Strings": ("raised", "run().state.angular_velocity is an array of str"),
    "RaggedRows": ("raised", "run().state.angular_velocity is no array"),
    "NoSamples": ("raised", "run().time has the shape (0,)"),
    "TooFewSamples": ("ok", ""),
    "NotANumber": ("diverged", "the state is not finite from t = 0.1 s"),
    "Infinite": ("diverged", "the state is not finite from t = 0.1 s"),
    "Astronomical": ("ok", ""),
    "Floods": ("ok", ""),
    "Twin": ("ok", ""),
    "Reads": ("ok", ""),
    "HangsAtExit": ("ok", ""),
}
# Elsewhere: the outcome of every task.
ELSEWHERE = {
    "DiesInLoad": ("crashed", "ended by signal 6 (SIGABRT)"),
    "ExitsInLoad": ("raised", "SystemExit: the licence has expired"),
    "DiesInModel": ("crashed", "reading the model back: ended by signal 6 (SIGABRT)"),
    "NoModel": ("raised", "reading the model back: model() is of type NoneType"),
    "ModelNotANumber": ("ok", ""),
    "DiesInForwardDynamics": ("crashed", "ended by signal 6 (SIGABRT)"),
    "TorqueOfOneState": ("raised", "inverse_dynamics() has the shape (3,); answer with (200, 3)"),
}
NOT_STARTING = {
    "DiesInInit": ("crashed", "ended by signal 6 (SIGABRT)"),
    "NoDescription": ("raised", "description is of type NoneType; answer with Description"),
    "AtImportDies": ("crashed", "ended with exit code 5"),
    "AtImportExits": ("raised", "SystemExit: 0"),
}
HANGING = (
    *("Sleeps", "Spins", "IgnoresSignals", "StopsItself", "HoldsTheLock"),
    *("SleepsWithAChild", "SleepsWithADaemon"),
)
LATE = "no answer within 4 s; the worker was ended"
SOUND_TO_THE_GATES = ("Floods", "Twin", "Reads", "HangsAtExit")


@dataclass(frozen=True)
class Run:
    """A run with its record, and the processes that it left behind."""

    result: Result
    run: dict[str, Any]
    folder: Path
    left: list[str]

    def tasks(self, engine: str, integrator: str | None = None) -> list[dict[str, Any]]:
        tasks = [task for task in self.run["tasks"] if task["engine"] == engine.lower()]
        return [t for t in tasks if integrator is None or t["integrator"] == integrator]

    def trajectories(self) -> pl.DataFrame:
        return pl.read_parquet(self.folder / "trajectories.parquet")


def processes_marked(mark: str) -> list[str]:
    """Processes that were started, by whomsoever, with this mark in their environment."""
    found = []
    for process in psutil.process_iter():
        with contextlib.suppress(psutil.Error):
            if process.pid != os.getpid() and mark in process.environ().values():
                found.append(" ".join(process.cmdline()))
    return found


def run_engines(folder: Path, adapters: list[str], *more: object) -> Run:
    scenario = quick_scenario(folder, TINY, "tiny.toml")
    arguments = [term for adapter in adapters for term in ("--adapter", adapter)]
    mark = os.environ[MARK] = uuid.uuid4().hex
    try:
        out = ("--out", "out", *more)
        result = omegadot("run", scenario, "--engine", "reference", *arguments, *out, folder=folder)
    finally:
        del os.environ[MARK]
    assert "Traceback" not in result.err, result.err
    run = json.loads((folder / "out" / "run.json").read_text(encoding="utf-8"))
    return Run(result, run, folder / "out", processes_marked(mark))


@pytest.fixture(scope="module")
def broken(tmp_path_factory: pytest.TempPathFactory) -> Run:
    folder = tmp_path_factory.mktemp("broken")
    (folder / "dying.py").write_text("import os\nos._exit(5)\n")
    (folder / "leaving.py").write_text("import sys\nsys.exit(0)\n")
    inside = [n for n in (*BROKEN, *ELSEWHERE, *NOT_STARTING) if not n.startswith("AtImport")]
    adapters = [f"{INJECTED}:{name}" for name in inside]
    adapters += ["dying.py:AtImportDies", "leaving.py:AtImportExits"]
    return run_engines(folder, adapters, "--memory", 0.5)


@pytest.fixture(scope="module")
def hanging(tmp_path_factory: pytest.TempPathFactory) -> Run:
    adapters = [f"{INJECTED}:{name}" for name in (*HANGING, "HangsInLoad")]
    folder = tmp_path_factory.mktemp("hanging")
    return run_engines(folder, adapters, "--timeout", 4, "--jobs", 10)


def check_reason(reason: str, text: str) -> None:
    assert text in reason
    assert reason.isprintable()
    assert len(reason) <= 560  # 500 of the message, and the stage that it came from


@pytest.mark.parametrize("name", BROKEN)
def test_a_fault_in_a_run_costs_that_run_alone(name: str, broken: Run) -> None:
    outcome, reason = BROKEN[name]
    faulty, well = broken.tasks(name, FAULTY_ENGINES), broken.tasks(name, WELL)
    assert [task["outcome"] for task in faulty] == [outcome]
    check_reason(faulty[0]["reason"], reason)
    assert [task["outcome"] for task in well] == ["ok"]
    assert set(well[0]["gates"].values()) <= {"pass", "info"}
    if outcome == "ok":
        sound = "fail" not in faulty[0]["gates"].values()
        assert sound == (name in SOUND_TO_THE_GATES)


@pytest.mark.parametrize("name", ELSEWHERE)
def test_a_fault_elsewhere_is_reported_with_every_task(name: str, broken: Run) -> None:
    outcome, reason = ELSEWHERE[name]
    tasks = broken.tasks(name)
    assert [task["outcome"] for task in tasks] == [outcome, outcome]
    for task in tasks:
        check_reason(task["reason"], reason)
        assert ("fail" in task["gates"].values()) == (name == "ModelNotANumber")


@pytest.mark.parametrize("name", NOT_STARTING)
def test_an_engine_that_does_not_start_reports_why(name: str, broken: Run) -> None:
    outcome, reason = NOT_STARTING[name]
    (task,) = broken.tasks(name)
    assert task["outcome"] == outcome
    check_reason(task["reason"], reason)


@pytest.mark.parametrize("name", HANGING)
def test_a_hang_costs_its_time_limit_alone(name: str, hanging: Run) -> None:
    assert [t["outcome"] for t in hanging.tasks(name, FAULTY_ENGINES)] == ["timeout"]
    check_reason(hanging.tasks(name, FAULTY_ENGINES)[0]["reason"], LATE)
    assert [t["outcome"] for t in hanging.tasks(name, WELL)] == ["ok"]


def test_a_hang_in_load_is_not_waited_for_again_and_again(hanging: Run) -> None:
    assert {t["outcome"] for t in hanging.tasks("HangsInLoad")} == {"timeout"}
    assert hanging.run["seconds"] < 60


@pytest.mark.parametrize("which", ["broken", "hanging"])
def test_the_rest_of_the_run_is_whole(which: str, request: pytest.FixtureRequest) -> None:
    found: Run = request.getfixturevalue(which)
    tasks = found.tasks("reference")
    assert len(tasks) > 5
    assert all(task["outcome"] == "ok" for task in tasks)
    assert all("fail" not in task["gates"].values() for task in tasks)
    samples = found.trajectories().drop("scenario", "setup", "timestep", "accuracy")
    well = samples.filter(pl.col("integrator") == WELL)
    own = well.filter(pl.col("engine") == "reference").drop("engine")
    assert len(own) == 11
    for (engine,), theirs in well.group_by("engine"):
        assert theirs.drop("engine").equals(own), engine


@pytest.mark.parametrize("which", ["broken", "hanging"])
def test_the_record_is_readable(which: str, request: pytest.FixtureRequest) -> None:
    found: Run = request.getfixturevalue(which)
    assert found.run["complete"]
    assert found.result.code == 3
    assert found.result.err == ""
    assert pl.read_parquet(found.folder / "metrics.parquet").height > 0
    page = (found.folder / "report.html").read_text(encoding="utf-8")
    assert "<script>alert(1)" not in page
    assert "\x1b" not in found.result.out


@pytest.mark.parametrize("which", ["broken", "hanging"])
def test_no_process_is_left_behind(which: str, request: pytest.FixtureRequest) -> None:
    assert request.getfixturevalue(which).left == []


def test_every_death_is_counted(broken: Run, hanging: Run) -> None:
    dead = {death["engine"] for death in broken.run["worker_deaths"]}
    every = {**BROKEN, **ELSEWHERE, **NOT_STARTING}
    assert dead == {name.lower() for name, (outcome, _) in every.items() if outcome == "crashed"}
    assert hanging.run["worker_deaths"] == []


def test_an_answer_that_is_wrong_is_no_crash(tmp_path: Path) -> None:
    names = ("TooFewSamples", "NotANumber", "Infinite", "Astronomical", "ModelNotANumber")
    found = run_engines(tmp_path, [f"{INJECTED}:{name}" for name in names])
    assert found.result.code == 1, found.result.err
