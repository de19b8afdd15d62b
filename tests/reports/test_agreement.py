"""A record that was edited by hand contradicts itself, and no report is drawn of it."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import polars as pl
import pytest
from synthetic_record import metric, with_metrics

import omegadot as api
from omegadot.reports.page.page import draw_page
from omegadot.reports.record.record import METRICS, RUN, Record, read_record, write_record
from omegadot.reports.record.schema import RecordError

Change = Callable[[dict[str, Any]], object]


def _task(run: dict[str, Any], **where: Any) -> dict[str, Any]:
    return next(t for t in run["tasks"] if all(t[key] == value for key, value in where.items()))


RK4 = {"engine": "mujoco", "integrator": "RK4", "timestep": 0.01}


def _drop(run: dict[str, Any], kind: str, name: str) -> None:
    run[kind] = [entry for entry in run[kind] if entry["name"] != name]


EDITS: dict[str, tuple[Change, str]] = {
    "a verdict": (
        lambda run: _task(run, **RK4)["gates"].update(scheme="fail"),
        "the scheme gate of mujoco RK4 on sphere at 0.01 is 'fail', and by its rows 'pass'",
    ),
    "a gate left out": (
        lambda run: _task(run, **RK4)["gates"].pop("trajectory"),
        "the trajectory gate of mujoco RK4 on sphere at 0.01 is 'no verdict', and by its rows",
    ),
    "a gate put in": (
        lambda run: _task(run, **RK4)["gates"].update(cost="pass"),
        "the cost gate of mujoco RK4 on sphere at 0.01 is 'pass', and by its rows 'no verdict'",
    ),
    "all verdicts": (
        lambda run: _task(run, **RK4).update(gates={}),
        "the model gate of mujoco RK4 on sphere at 0.01 is 'no verdict', and by its rows 'pass'",
    ),
    "an engine left out": (
        lambda run: _drop(run, "engines", "dart"),
        "a run of dart is stored, which is not among the engines",
    ),
    "a scenario left out": (
        lambda run: _drop(run, "scenarios", "sphere"),
        "a run on sphere is stored, which is not among the scenarios",
    ),
    "another version": (
        lambda run: run["engines"][1].update(version="2.0"),
        "mujoco Euler on sphere at 0.02 is of version 1.0, which is not among the engines",
    ),
    "a task left out": (
        lambda run: run["tasks"].remove(_task(run, **RK4)),
        "mujoco RK4 on sphere at 0.01 has rows and no run",
    ),
    "an engine renamed": (
        lambda run: [t.update(engine="mujoco") for t in run["tasks"] if t["engine"] == "dart"],
        "mujoco semi-implicit on sphere at 0.02 is 'pass', and by its rows 'no verdict'",
    ),
}


def edited(folder: Path, change: Change) -> None:
    file = folder / RUN
    run = json.loads(file.read_text(encoding="utf-8"))
    change(run)
    file.write_text(json.dumps(run), encoding="utf-8")


@pytest.fixture
def folder(record: Record, tmp_path: Path) -> Path:
    write_record(record, tmp_path / "run", draw_page(record))
    return tmp_path / "run"


@pytest.mark.parametrize("kind", EDITS)
def test_an_edited_record_is_refused_in_one_sentence(kind: str, folder: Path) -> None:
    """Caught: a page of verdicts that nothing has measured."""
    change, sentence = EDITS[kind]
    edited(folder, change)
    for read in (read_record, api.report, lambda path: api.compare(path, path)):
        with pytest.raises(RecordError) as problem:
            read(folder)
        message = str(problem.value)
        assert message.startswith(f"{folder}: run.json and metrics.parquet disagree: ")
        assert sentence in message
        assert message.endswith("; run again.")


def test_rows_changed_beside_their_run_are_refused(folder: Path, record: Record) -> None:
    row = metric("sphere", "dart", "semi-implicit", 0.02, "scheme", "omega", "m", 1.0)
    failing = with_metrics(record, {**row, "verdict": "fail"})
    write_record(failing, folder, draw_page(failing))
    with pytest.raises(RecordError, match=r"scheme gate of dart .* is 'pass', and .* 'fail'"):
        read_record(folder)


METRIC_EDITS: dict[str, tuple[Callable[[pl.DataFrame], pl.DataFrame], str]] = {
    "no value is a number": (
        lambda rows: rows.with_columns(value=pl.lit(float("nan"))),
        r"is nan with a bound of .*, and its verdict is 'pass'",
    ),
    "every value is larger": (
        lambda rows: rows.with_columns(value=pl.col("value") * 1e6),
        r"with a bound of 1e-13, and its verdict is 'pass'",
    ),
    "an explained error is no number": (
        lambda rows: rows.with_columns(
            value=pl.when(pl.col("note").str.starts_with("explained"))
            .then(pl.lit(float("nan")))
            .otherwise("value")
        ),
        r"is nan with a bound of 1e-13, and its verdict is 'pass'",
    ),
    "an error has no reason": (
        lambda rows: rows.with_columns(note=pl.lit("")),
        r"with a bound of 1e-13, and its verdict is 'pass'",
    ),
    "no bounds": (
        lambda rows: rows.with_columns(bound=pl.lit(None, pl.Float64), note=pl.lit("")),
        r"without a bound, and its verdict is 'pass'",
    ),
    "every row twice": (lambda rows: pl.concat([rows, rows]), r" on sphere .*is there twice"),
}


@pytest.mark.parametrize("kind", METRIC_EDITS)
def test_edited_rows_are_refused_in_one_sentence(kind: str, folder: Path) -> None:
    """Caught: a pass beside a value that fails, which no verdict of another file shows."""
    change, sentence = METRIC_EDITS[kind]
    file = folder / METRICS
    change(pl.read_parquet(file)).write_parquet(file)
    with pytest.raises(RecordError, match=sentence) as problem:
        read_record(folder)
    assert str(problem.value).startswith(f"{folder}: metrics.parquet contradicts itself: ")


def test_a_failure_within_its_bound_is_refused(folder: Path, record: Record) -> None:
    row = metric("sphere", "dart", None, None, "equation", "omega_dot", "residual", 1e-16)
    failing = with_metrics(record, {**row, "verdict": "fail"})
    write_record(failing, folder, draw_page(failing))
    with pytest.raises(RecordError, match="with a bound of 1e-13, and its verdict is 'fail'"):
        read_record(folder)


RUN_EDITS: dict[str, tuple[Change, str]] = {
    "engines": (lambda run: run["engines"].extend(run["engines"]), "is among the engines twice"),
    "scenarios": (
        lambda run: run["scenarios"].append(run["scenarios"][0]),
        "sphere is among the scenarios twice",
    ),
    "tasks": (
        lambda run: run["tasks"].append(_task(run, **RK4)),
        "the run mujoco RK4 on sphere at 0.01 is among the tasks twice",
    ),
    "created": (
        lambda run: run.update(created="yesterday"),
        "created is 'yesterday', expected a date and time, as 2026-01-31T12:00:00",
    ),
}


@pytest.mark.parametrize("kind", RUN_EDITS)
def test_what_is_listed_twice_or_is_no_time_is_refused(kind: str, folder: Path) -> None:
    change, sentence = RUN_EDITS[kind]
    edited(folder, change)
    with pytest.raises(RecordError) as problem:
        read_record(folder)
    assert sentence in str(problem.value)


def test_what_agrees_is_read(folder: Path, record: Record) -> None:
    """Rows of engine and scenario belong to each of its tasks, and the worst of all counts."""
    assert read_record(folder).run == json.loads((folder / RUN).read_text())
    whole = metric("sphere", "dart", None, None, "equation", "omega_dot", "residual", 1.0)
    failing = with_metrics(record, {**whole, "verdict": "fail"})
    for task in failing.run["tasks"]:
        if (task["engine"], task["scenario"]) == ("dart", "sphere"):
            task["gates"]["equation"] = "fail"
    floor = metric("sphere", "exact", "closed-form", None, "trajectory", "omega", "floor", 1.0)
    kept = with_metrics(failing, {**floor, "verdict": "info"})
    write_record(kept, folder, draw_page(kept))
    assert len(read_record(folder).metrics) == len(kept.metrics)


@pytest.mark.parametrize("engines", [["mujoco:RK4"], ["reference:lie-rk4", "exact"]])
def test_what_a_run_writes_agrees(engines: list[str], tmp_path: Path) -> None:
    """Of runs with and without failures, refusals and exact solutions."""
    wrong = Path(__file__).parent.parent / "wrong_engines"
    own = [f"{wrong / 'wrong.py'}:GravityUpwards", f"{wrong / 'partial.py'}:NoIntegrator"]
    own += [f"{wrong / 'wrong.py'}:RefusesLongSteps", f"{wrong / 'faulty.py'}:Raises"]
    result = api.run(["offset-com"], [*engines, *own], timesteps=[0.04, 0.02], out=tmp_path / "r")
    stored = read_record(tmp_path / "r")
    assert len(stored.run["tasks"]) == len(result.record.tasks)
    assert (tmp_path / "r" / METRICS).stat().st_size > 0
