"""A cause belongs to runs of which a gate fails: in the record, and wherever runs are shown."""

from __future__ import annotations

from pathlib import Path

from synthetic_record import metric, with_metrics

import omegadot
from omegadot.reports.page.page import draw_page
from omegadot.reports.record.record import Record
from omegadot.reports.run_record import RunRecord
from omegadot.reports.summary.summary import summarise
from omegadot.reports.text.markdown import markdown_of

WRONG = Path(__file__).parent.parent / "wrong_engines" / "wrong.py"
CAUSE = "the gyroscopic term is missing"


def test_what_passes_beside_a_failure_has_no_cause() -> None:
    """Caught: a cause in every task of the engine, or as the reason of what is sound in it."""
    engine = f"{WRONG}:GravityAlwaysDown"
    record = omegadot.run(["sphere", "offset-com"], engine, timesteps=0.04).record
    tasks = {task.scenario: task for task in record.tasks}
    assert tasks["offset-com"].gates["equation"] == "fail"
    assert tasks["offset-com"].gates["trajectory"] == "pass"
    assert "gravity" in tasks["offset-com"].cause
    assert not tasks["sphere"].failed
    assert tasks["sphere"].cause == ""
    for task in record.run["tasks"]:
        assert bool(task.get("cause")) is ("fail" in task["gates"].values())
        assert "cause" not in task["why"]


def with_causes(record: Record, engine: str) -> Record:
    """An engine of which one scenario fails, in a record that has its cause in every task."""
    for task in record.run["tasks"]:
        if task["engine"] == engine:
            task["cause"] = CAUSE
            if task["scenario"] == "sphere":
                task["gates"] = {**task["gates"], "equation": "fail"}
    where = ("sphere", engine, None, None)
    return with_metrics(
        record, metric(*where, "equation", "omega_dot", "residual", 2.0, verdict="fail")
    )


def test_a_cause_is_shown_with_failing_runs_alone(record: Record) -> None:
    """Caught: pages and texts that print a task's cause whatever its verdict."""
    found = with_causes(record, "dart")
    causes = {(task.scenario, task.failed, task.cause) for task in RunRecord.of(found).tasks}
    assert ("sphere", True, CAUSE) in causes
    assert ("spun-again", False, CAUSE) not in causes
    page = draw_page(found)
    sphere, again = page.split('id="scenario-spun-again"')
    assert f"likely cause: {CAUSE}" in sphere
    assert CAUSE not in again
    assert "fail: equation" in sphere
    assert CAUSE in markdown_of(found)
    (failure,) = summarise(found).failures
    assert failure.cause == CAUSE


def test_a_cause_without_a_failure_is_shown_nowhere(record: Record) -> None:
    for task in record.run["tasks"]:
        task["cause"] = CAUSE
    assert CAUSE not in draw_page(record)
    assert CAUSE not in markdown_of(record)
    assert summarise(record).failures == ()
