"""Records with wrong values anywhere: the page is drawn, or the refusal is one sentence."""

from __future__ import annotations

import copy
import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import polars as pl
import pytest
from synthetic_record import build

from omegadot.commands.report.report import report
from omegadot.reports.record.record import METRICS, RUN, TRAJECTORIES, Record, write_record
from omegadot.reports.record.schema import RecordError

WRONG = (None, "x", -1, 1e308, [], {}, [1], {"a": 1}, True)
MISSING = object()
NUMBERS = (float("nan"), float("inf"), -1.0, 0.0, 1e308, None)
TEXTS = ("", "\x1b[31m", "<b>", None)


@pytest.fixture(scope="module")
def small(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, Record]:
    record = build(("sphere",), {"mujoco": {"RK4": 4}}, (0.02, 0.01), 8)
    folder = tmp_path_factory.mktemp("records") / "run"
    write_record(record, folder, "")
    return folder, record


def places(value: Any, way: tuple[Any, ...] = ()) -> Iterator[tuple[Any, ...]]:
    """The ways to every value, of lists to the first of their entries alone."""
    if way:
        yield way
    entries = value.items() if isinstance(value, dict) else enumerate(value[:1])
    for key, entry in entries:
        if isinstance(entry, dict | list):
            yield from places(entry, (*way, key))
        else:
            yield (*way, key)


def changed(run: dict[str, Any], way: tuple[Any, ...], value: object) -> dict[str, Any]:
    fresh = copy.deepcopy(run)
    inner: Any = fresh
    for key in way[:-1]:
        inner = inner[key]
    if value is MISSING:
        del inner[way[-1]]
    else:
        inner[way[-1]] = value
    return fresh


def drawn(folder: Path, page: Path) -> bool:
    """Whether the page is drawn; where it is not, the reason is one sentence."""
    page.unlink(missing_ok=True)
    try:
        report(folder, out=page)
    except RecordError as problem:
        text = str(problem)
        assert text.endswith("."), text
        assert "\n" not in text, text
        assert not page.exists()
        return False
    assert page.stat().st_size > 50_000
    return True


def test_a_wrong_value_anywhere_in_the_run_file(small: tuple[Path, Record], tmp_path: Path) -> None:
    folder, _ = small
    written = (folder / RUN).read_text()
    run, outcomes = json.loads(written), []
    try:
        for number, way in enumerate(places(run)):
            # Two of the wrong values at each place: all of them over the places of one kind.
            for value in (WRONG[number % 9], WRONG[(4 * number + 5) % 9], MISSING):
                (folder / RUN).write_text(json.dumps(changed(run, way, value)))
                outcomes.append(drawn(folder, tmp_path / "page.html"))
    finally:
        (folder / RUN).write_text(written)
    assert len(outcomes) > 250
    assert 50 < sum(outcomes) < len(outcomes) - 50  # neither refuses all nor takes all


@pytest.mark.filterwarnings("ignore::RuntimeWarning")  # 1e308 overflows, as it may
@pytest.mark.parametrize("table", [METRICS, TRAJECTORIES])
def test_a_wrong_value_anywhere_in_a_table(
    table: str, small: tuple[Path, Record], tmp_path: Path
) -> None:
    folder, record = small
    frame = record.metrics if table == METRICS else record.trajectories
    written = (folder / table).read_bytes()
    try:
        for name in frame.columns:
            kind = frame[name].dtype
            for value in NUMBERS if kind == pl.Float64 else TEXTS:
                here = pl.int_range(pl.len()) == 1
                wrong = pl.lit(value, kind).alias(name)
                for column in (wrong, pl.when(here).then(wrong).otherwise(name).alias(name)):
                    frame.with_columns(column).write_parquet(folder / table)
                    drawn(folder, tmp_path / "page.html")
    finally:
        (folder / table).write_bytes(written)
