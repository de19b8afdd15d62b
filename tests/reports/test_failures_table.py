"""The page's table of failures: its order, its causes, and that no engine hides another."""

from __future__ import annotations

import re
from typing import Any

import pytest
from synthetic_record import metric, with_metrics

from omegadot.reports.page.failures_table import MOST, Failure, failures_table
from omegadot.reports.page.page import draw_page
from omegadot.reports.record.record import Record
from omegadot.reports.summary.provenance import sources_for
from omegadot.reports.summary.summary import summarise

CAUSE = "in the steps, the damping is 0.1 N m s/rad, whatever was requested"
RUN = ("sphere", "dart", "semi-implicit")


def shown(record: Record) -> tuple[list[Failure], int]:
    columns = summarise(record).columns
    return failures_table(record, columns, sources_for(record.run["engines"]))


def failing(record: Record) -> Record:
    """Two engines fail; the largest number is of the last gate, and of the second engine."""

    def row(name: str, where: tuple[str, ...], step: float | None, *of: Any, **more: Any) -> Any:
        place = (*where, step) if len(where) == 3 else (*where, None, step)
        return metric(*place, *of[:2], name, of[2], **{"verdict": "fail", **more})

    other, engine = ("sphere", "mujoco", "RK4"), ("sphere", "dart")
    rows = (
        row("error_max", RUN, 0.02, "trajectory", "attitude", 9e9),
        row("unexplained", RUN, 0.02, "scheme", "omega", 3e-12),
        row("unexplained", RUN, 0.01, "scheme", "omega", 5e-12),
        row("unexplained", RUN, 0.02, "scheme", "attitude", 4e-11, note="farthest"),
        row("observed_order", RUN, None, "scheme", "omega", 0.9, bound=2.0),
        row("residual", engine, None, "equation", "omega_dot", 2e-13),
        row("inertia", engine, None, "model", "model", 1.0, verdict="declared", note="see #1"),
        row("error_max", other, 0.02, "trajectory", "attitude", 9e12),
    )
    for task in record.run["tasks"]:
        if (task["scenario"], task["engine"]) == ("sphere", "dart"):
            task["gates"] = {**task["gates"], "equation": "fail"}
            task["cause"] = f"{CAUSE}, at {task['timestep']} s"
    return with_metrics(record, *rows)


def test_what_to_look_at_first_comes_first(record: Record) -> None:
    """Caught: by raw size alone, the last gate of the last engine stands at the top."""
    rows, left = shown(failing(record))
    assert left == 0
    others = "omega observed order, omega unexplained"
    assert [(row.verdict, row.engine, row.gate, row.measure) for row in rows] == [
        ("fail", "mujoco 1.0", "trajectory", "attitude error max"),
        ("fail", "dart 1.0", "equation", "omega-dot residual"),
        ("fail", "dart 1.0", "scheme", f"attitude unexplained; also {others}"),
        ("fail", "dart 1.0", "trajectory", "attitude error max"),
        ("declared", "dart 1.0", "model", "inertia"),
    ]
    page = draw_page(failing(record))
    assert page.index("Sorted for reading") < page.index('<table class="judged')


def test_a_row_is_a_gate_with_its_worst_measure_and_run(record: Record) -> None:
    rows, _ = shown(failing(record))
    (scheme,) = (row for row in rows if row.gate == "scheme")
    assert scheme.size == "400 × bound (4e-11)"
    assert scheme.run == "semi-implicit, step 0.02 s; 2 runs"
    assert scheme.note == "farthest"
    (equation,) = (row for row in rows if row.gate == "equation")
    assert equation.run == ""  # all share it
    page = draw_page(failing(record))
    assert "9e9 ✗ fail, bound 1e-\u206013" in page


@pytest.mark.parametrize(
    ("changed", "size"),
    [
        ({"value": 3.0}, "3 × bound"),
        ({"value": 0.25, "bound": 0.1, "unit": "rad"}, "2.5 × bound (0.25 rad)"),
        ({"value": 0.9, "bound": 2.0, "metric": "observed_order"}, "0.90 of order 2"),
        ({"value": 0.25, "bound": None, "unit": "rad"}, "0.25 rad"),
    ],
)
def test_how_far_it_is_beyond_its_bound(
    record: Record, changed: dict[str, object], size: str
) -> None:
    row = metric(*RUN, 0.02, "scheme", "omega", "match", 1.0, bound=1.0, verdict="fail")
    (found,), _ = shown(with_metrics(record, {**row, **changed}))
    assert found.size == size


def test_every_failure_has_its_cause_beside_it(record: Record) -> None:
    """Caught: the cause of another run, another engine, or none."""
    rows, _ = shown(failing(record))
    causes = {(row.engine, row.gate): row.cause for row in rows if row.verdict == "fail"}
    assert causes["dart 1.0", "scheme"] == f"{CAUSE}, at 0.02 s"
    assert causes["dart 1.0", "equation"].startswith(CAUSE)
    assert causes["mujoco 1.0", "trajectory"] == ""
    page = draw_page(failing(record))
    table = re.search(r'<table class="judged.*?</table>', page, re.S)
    assert table is not None
    cells = re.findall(r'<td data-head="likely cause" class="cause">(.*?)</td>', table.group())
    assert cells[0] == "–"
    assert cells[1].startswith(CAUSE)


@pytest.mark.parametrize("value", [None, float("nan"), float("inf")])
def test_what_is_no_number_is_the_worst(record: Record, value: float | None) -> None:
    rows = (
        metric(*RUN, 0.02, "scheme", "omega", "match", 1e300, bound=1.0, verdict="fail"),
        metric(*RUN, 0.02, "scheme", "attitude", "match", value, bound=1.0, verdict="fail"),
    )
    (first,), _ = shown(with_metrics(record, *rows))
    assert (first.measure, first.size) == (
        "attitude distance from the scheme; also omega distance from the scheme",
        "no number",
    )


def test_an_engine_of_many_failures_hides_no_other(record: Record) -> None:
    """Caught: a table that ends where its first engine is done."""
    rows = [
        metric(f"s{k}", "dart", None, None, "model", "model", "mass", 1.0, verdict="fail")
        for k in range(MOST)
    ]
    found, left = shown(with_metrics(record, *rows))
    assert (len(found), left) == (MOST, 0)
    last = metric("sphere", "reference", "lie-rk4", 0.02, "trajectory", "omega", "error_max", 1.0)
    both = with_metrics(record, *rows, {**last, "verdict": "fail"})
    found, left = shown(both)
    assert {row.engine for row in found} == {"dart 1.0", "reference 1.0"}
    assert left == MOST + 1 - len(found)
    assert f"{left} more are in metrics.parquet" in draw_page(both)
