"""The flips that the 3-D view counts are those of the stored samples, run by run."""

from __future__ import annotations

from dataclasses import replace

import polars as pl
import pytest
from turning_record import LATE, turning_record

from omegadot.reports.charts.divergence import system_from
from omegadot.reports.page.view_3d.turning import Turning, turning_of
from omegadot.reports.record.record import Record


@pytest.fixture(scope="module")
def record() -> Record:
    return turning_record()


def turning(record: Record, name: str = "turning", truth: str = "closed-form") -> Turning:
    (entry,) = (entry for entry in record.run["scenarios"] if entry["name"] == name)
    rows = record.trajectories.filter(pl.col("scenario") == name)
    return turning_of(rows, system_from(entry["system"]), truth)


def test_each_run_has_its_flips_and_whether_they_are_in_time(record: Record) -> None:
    found = turning(record)
    assert found.exact == pytest.approx([1.0, 3.0])
    assert len(found.runs) == 6 * 2
    for (engine, *_), (times, turns) in found.runs.items():
        expected = {"havok": ([], "never"), "dart": ([1 / LATE], "late")}
        own, verdict = expected.get(engine, ([1.0, 3.0], "yes"))
        # Linear between samples 0.1 s apart, of a cosine over pi: a part in a hundred of them.
        assert times == pytest.approx(own, abs=1e-3)
        assert turns == verdict


def test_where_the_exact_motion_turns_nothing_over_there_is_none(record: Record) -> None:
    assert turning(record, "sphere") == Turning()
    steady = record.trajectories.with_columns(
        wz=pl.when(pl.col("engine") == "exact").then(2.0).otherwise(pl.col("wz"))
    )
    assert turning(replace(record, trajectories=steady)) == Turning()


def test_a_run_that_blew_up_is_asked_for_the_flips_before(record: Record) -> None:
    """Caught: a run that ended before the first flip, said never to flip."""
    for end, expected in ((0.5, None), (2.0, "never")):
        gone = (pl.col("engine") == "havok") & (pl.col("time") > end)
        broken = record.trajectories.with_columns(
            wz=pl.when(gone).then(float("nan")).otherwise(pl.col("wz"))
        )
        found = turning(replace(record, trajectories=broken)).runs
        assert {turns for key, (_, turns) in found.items() if key[0] == "havok"} == {expected}
