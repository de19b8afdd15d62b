"""Engines and results from Python: classes, failures, progress, threads, interruption."""

from __future__ import annotations

import importlib
import sys
import threading
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from command_line import FAULTY, WRONG, omegadot, quick_scenario

import omegadot as api
from omegadot.commands.engines.page import AGAIN, markdown_of, section

TOY = Path(__file__).parents[2] / "docs" / "examples" / "toy_engine.py"


@pytest.fixture(scope="module")
def quick(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return quick_scenario(tmp_path_factory.mktemp("engines"))


@pytest.fixture
def toy(monkeypatch: pytest.MonkeyPatch) -> Any:
    """The class of the toy engine, imported from a folder that only this process searches."""
    monkeypatch.syspath_prepend(str(TOY.parent))
    monkeypatch.delitem(sys.modules, "toy_engine", raising=False)
    return importlib.import_module("toy_engine").ToyAdapter


def test_an_engine_is_a_class_a_file_or_a_name(toy: Any, quick: Path) -> None:
    by_class = api.check(toy, scenarios=quick)
    typed = omegadot("check", TOY, "--scenario", quick, "--format", "json", folder=quick.parent)
    assert by_class.passed
    assert typed.code == 0
    checks = {check["id"]: check["verdict"] for check in typed.json["checks"]}
    assert {i: result.verdict for i, result in by_class.results.items()} == checks
    assert next(iter(by_class.results)) == "toy-quick-model"
    assert repr(by_class) == f"<omegadot check of {len(checks)}: {len(checks)} pass>"
    found = api.run(quick, [toy, "mujoco:Euler"], timesteps=np.array([0.02]))
    assert {task.engine for task in found.record.tasks} == {"toy", "mujoco"}


class HereAdapter:
    """It stands in a test's module, as in a script that is imported."""


def test_a_class_that_no_process_can_import_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    class LocalAdapter:
        pass

    with pytest.raises(api.UsageError, match=r"defined in a function.*give FILE\.py:LocalAdapter"):
        api.run("sphere", LocalAdapter)
    monkeypatch.setattr(HereAdapter, "__module__", "__main__")
    with pytest.raises(api.UsageError, match="a notebook or the script itself"):
        api.check(HereAdapter)
    with pytest.raises(api.UsageError, match="give a text or a class or a list of such"):
        api.run("sphere", HereAdapter())  # type: ignore[arg-type]


def test_what_fails_is_named(quick: Path) -> None:
    found = api.run(quick, [f"{WRONG}:NoGyroscopic", f"{FAULTY}:Killed"], timesteps=0.02)
    assert not found.passed
    assert not found.answered
    assert {task.engine for task in found.failures} == {"nogyroscopic"}
    assert all(task.gates["equation"] == "fail" for task in found.failures)
    assert {(task.engine, task.outcome) for task in found.unanswered} == {("killed", "crashed")}
    checked = api.check(f"{WRONG}:NoGyroscopic", scenarios=quick, shrink=False)
    assert not checked.passed
    assert checked.answered
    failed = checked.failures["nogyroscopic-quick-equation"]
    assert failed.verdict == "fail"
    assert "omega_dot" in failed.message


def test_single_precision_is_checked_down_to_its_causes(quick: Path) -> None:
    engines = WRONG.with_name("single_engines.py")
    assert api.check(f"{engines}:SingleEuler", scenarios=quick).passed
    wrong = api.check(f"{engines}:SingleCoupling", scenarios=quick, shrink=False)
    message = wrong.failures["singlecoupling-quick-equation"].message
    assert "the gyroscopic term is scaled by 1.25" in message


def test_progress_is_reported_and_nothing_printed(
    quick: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    seen: list[api.Progress] = []
    api.run(quick, "mujoco:RK4", progress=seen.append)
    assert [p.done for p in seen if p.total is not None] == [0, 1, 2, 3]
    assert seen[-1] == api.Progress("running", 3, 3)
    assert capfd.readouterr() == ("", "")
    api.run(quick, "mujoco:RK4", timesteps=0.02, progress=True)
    shown = capfd.readouterr()
    assert shown.out == ""
    assert "\rrunning: 1 of 1 " in shown.err


def test_it_runs_in_a_thread(quick: Path) -> None:
    found: list[api.RunResult] = []
    thread = threading.Thread(target=lambda: found.append(api.run(quick, "mujoco:RK4")))
    thread.start()
    thread.join()
    assert found[0].passed


def test_an_interruption_keeps_what_came_in(quick: Path, tmp_path: Path) -> None:
    def stop(now: api.Progress) -> None:
        if now.total is not None:
            raise KeyboardInterrupt

    with pytest.raises(api.RunInterrupted) as caught:
        api.run(quick, "mujoco:RK4", out=tmp_path / "cut", progress=stop)
    result = caught.value.result
    assert not result.complete
    assert not result.passed
    assert api.read_record(tmp_path / "cut").run["complete"] is False


def test_a_choice_is_ranked(quick: Path, tmp_path: Path) -> None:
    choice = api.choose(quick, "mujoco", attitude=1e-3, budget=0.02, out=tmp_path / "choice")
    assert choice.qualifies
    best = choice.best
    assert best is not None
    assert best == choice.ranking[0]
    assert best.errors["attitude"] <= 1e-3
    assert [row.rank for row in choice.ranking] == sorted(row.rank for row in choice.ranking)
    assert {path.name for path in choice.written} == {"choice.html", "choice.json"}
    none = api.choose(quick, "mujoco:Euler", attitude=1e-9, budget=0.02)
    assert (none.best, none.ranking, none.qualifies) == (None, (), False)
    assert none.answered


def test_a_trace_is_detected_and_scored() -> None:
    trace, scenario = TOY.with_name("tumbling-brick.csv"), "nesc-checkcase-2"
    (reading,) = api.detect(trace, scenario).fitting
    by_detection = api.score(trace, scenario, attitude="1deg", **reading.arguments())
    mapped = api.score(trace, scenario, map_file=TOY.with_name("tumbling-brick.toml"))
    assert by_detection.passed
    assert not by_detection.failures
    assert set(by_detection.channels) >= {"omega", "attitude", "energy"}
    omega = mapped.channels["omega"]
    assert by_detection.channels["omega"].max == pytest.approx(omega.max, rel=1e-6)
    assert (omega.unit, omega.verdict) == ("rad/s", "info")
    (row,) = by_detection.requirements
    assert row.verdict == "pass"
    strict = api.score(trace, scenario, attitude="1e-9deg", **reading.arguments())
    assert not strict.passed
    assert [task.engine for task in strict.failures] == ["trace"]


def test_the_page_of_engines_is_what_their_adapters_report() -> None:
    """Caught: a convention, a default or an integrator that changed, and the page did not."""
    page = (Path(__file__).parents[2] / "docs" / "engines.md").read_text(encoding="utf-8")
    known = [entry.description for entry in api.engines() if entry.description is not None]
    assert len(known) >= 5
    for own in known:
        assert "\n".join(section(own)) + "\n" in page, f"docs/engines.md is old: {AGAIN}"
    made = markdown_of(api.engines())
    assert page.startswith(made[: made.index("| exact")])
