"""The number that stands beside a failing gate, and of which state it is."""

from __future__ import annotations

import re
from dataclasses import replace
from io import StringIO

import numpy as np
import pytest
from failing_records import FAILING, failing, failing_in_a_probe
from rich.console import Console
from synthetic_record import metric, with_metrics

from omegadot.reports.page.failures_table import failures_table
from omegadot.reports.page.glance import glances
from omegadot.reports.page.page import draw_page
from omegadot.reports.record.record import Record
from omegadot.reports.summary.failed_gate import failed_gates
from omegadot.reports.summary.provenance import Sources, sources_for
from omegadot.reports.summary.summary import summarise
from omegadot.reports.text.markdown import markdown_of
from omegadot.reports.text.numbers import short
from omegadot.reports.text.terminal import print_summary


def test_a_share_of_a_bound_is_given_by_its_note(record: Record) -> None:
    more = {"verdict": "fail", "bound": 1.0, "note": "its rate is not the equation's"}
    row = metric("sphere", *FAILING, 0.02, "scheme", "omega", "rate_at_no_step", 3e8, **more)
    (found,) = summarise(with_metrics(record, row)).failures
    assert (found.gate, found.looks_at) == ("scheme", "how it steps")
    assert found.measured == "omega: its rate is not the equation's"


def test_samples_that_are_missing_are_given_by_their_note(record: Record) -> None:
    more = {"verdict": "fail", "bound": 1e-12, "note": "the last 5 samples are missing"}
    row = metric("sphere", *FAILING, 0.02, "trajectory", "time", "sample_times", np.inf, **more)
    (found,) = summarise(with_metrics(record, row)).failures
    assert found.measured == "time: the last 5 samples are missing"


def test_no_number_that_passes_stands_beside_a_failing_gate(record: Record) -> None:
    """Caught: the residual, which holds, in a cell of which the scheme gate fails."""
    where = ("sphere", *FAILING, 0.02)
    row = metric(*where, "scheme", "omega", "match", 3e8, bound=1.0, verdict="fail", note="off")
    found = with_metrics(record, row)
    cell = next(cell for cell in summarise(found).cells.values() if cell.failed)
    assert (cell.failed.gate, cell.failed.number) == ("scheme", "3e8 × bound")
    residual = short(cell.residual.value, 1)
    page = draw_page(found)
    (shown,) = re.findall(r'<td class="s-fail" data-rank.*?</td>', page)
    assert '<span class="gate">scheme</span> <span class="n n-failed">3e8 × bound</span>' in shown
    assert shown.count('class="n ') == 1
    raw = StringIO()
    print_summary(found, Console(file=raw, width=160))
    (line,) = (n for n in raw.getvalue().splitlines() if "✗ scheme" in n)
    assert "✗ scheme 3e8 x bound" in line.replace("×", "x")
    assert line.count(residual) == 2  # of the two engines that pass
    (line,) = (n for n in markdown_of(found).splitlines() if n.startswith("| sphere"))
    assert "| ✗ scheme 3e8 × bound |" in line
    assert line.count("3.1e-15") == 2


@pytest.mark.parametrize(
    ("changed", "number"),
    [
        ({"value": 2e-3}, "2e10 × bound"),
        ({"value": float("nan")}, "no number"),
        ({"value": None}, "no number"),
        ({"value": 0.25, "bound": None, "unit": "rad"}, "0.25 rad"),
        ({"value": 0.25, "bound": 0.0, "unit": "rad"}, "0.25 rad"),
        ({"metric": "observed_order", "value": 1.98, "bound": 4.0}, "1.98 of order 4"),
    ],
)
def test_the_number_of_a_failing_gate(
    record: Record, changed: dict[str, object], number: str
) -> None:
    row = metric("sphere", *FAILING, 0.02, "scheme", "omega", "step", 1.0, verdict="fail")
    (failed,) = failed_gates(with_metrics(record, {**row, **changed}).metrics).values()
    assert failed.number == number


def test_a_state_that_no_run_comes_near_is_named_as_such(record: Record) -> None:
    """Caught: a reader sent to a scenario whose every chart is that of a sound engine."""
    found = failing_in_a_probe(record)
    for task in found.run["tasks"]:
        if task["engine"] == "dart" and task["scenario"] == "sphere":
            task["gates"] = {**task["gates"], "scheme": "fail"}
    (failure,) = summarise(found).failures
    assert failure.unseen == (
        "the runs on sphere do not show it: |omega| is at most 2 rad/s, and their invariants and "
        "trajectory gates hold"
    )
    assert f"{failure.unseen[1:]}" in failure.sentence
    assert failure.unseen[1:] in draw_page(found).replace("\u2060", "")
    # Whatever the step of a run, its own steps are not those that fail: none is the worst.
    assert failure.tail == ", in all 3 runs there, with semi-implicit"
    for task in found.run["tasks"]:
        if task["engine"] == "dart":
            task["gates"] = {**task["gates"], "trajectory": "fail"}
    assert summarise(found).failures[0].unseen == ""


def test_an_equation_that_holds_along_the_motion_is_named_as_such(record: Record) -> None:
    where = ("sphere", "dart", None, None, "equation", "omega_dot")
    note = "at a state of |omega| = 31.4 rad/s"
    off = metric(*where, "residual", 1.0, verdict="fail", note=note)
    found = with_metrics(record, off, metric(*where, "residual_on_path", 1e-16))
    (failure,) = summarise(found).failures
    assert f" {note}, 1e13 times its bound" in failure.measured
    text = "along the motion of sphere it does not show: |omega| is at most 2 rad/s, and it holds"
    assert failure.unseen.startswith(text)
    along = metric(*where, "residual_on_path", 1e-3, verdict="fail")
    assert summarise(with_metrics(record, off, along)).failures[0].unseen == ""


def test_the_glance_shows_the_residual_that_the_failure_names(record: Record) -> None:
    """Caught: "worst, 0.5" beside a table that has 0.6, of a scenario with a wider bound."""
    rows = [
        metric(name, "dart", None, None, "equation", "omega_dot", "residual", value, bound=bound)
        for name, value, bound in (("sphere", 0.5, 1e-14), ("spun-again", 0.6, 1e-8))
    ]
    found = with_metrics(record, *({**row, "verdict": "fail"} for row in rows))
    (failure,) = summarise(found).failures
    assert failure.measured.startswith("omega-dot residual 0.5 ")
    rows_shown = glances(summarise(found), found.metrics, Sources())
    (shown,) = (g for g in rows_shown if g["engine"].startswith("dart"))
    assert shown["residual"][0] == "0.5"
    # Caught: "fail 6 of 126 pass", which is read twice.
    tasks = [
        {**task, "outcome": "unsupported", "gates": {}} if task["scenario"] != "sphere" else task
        for task in failing(record).run["tasks"]
    ]
    found = replace(found, run={**record.run, "tasks": tasks})
    rows_shown = glances(summarise(found), found.metrics, Sources())
    (shown,) = (g for g in rows_shown if g["engine"].startswith("dart"))
    assert (shown["status"], shown["runs"]) == ("fail", "3 of 6 runs fail; 3 unsupported")
    assert shown["error_source"][0] == "a fault: equation gate fails"


def test_the_plain_residual_is_quoted_where_it_fails(record: Record) -> None:
    """Caught: "after another mass was loaded", which reads as numbers kept from another system, of
    an engine that is as wrong without any."""
    after, note = "residual_of_sibling", "after the same system with another mass was loaded"
    rows = [
        metric("sphere", "dart", None, None, "equation", channel, name, value, **more)
        for channel, name, value, more in (
            ("omega_dot", "residual", 0.12, {}),
            ("torque", "residual", 0.5, {"bound": 1e-14}),
            ("omega_dot", after, 0.15, {"note": note}),
        )
    ]
    rows = [{**row, "verdict": "fail"} for row in rows]
    (found,) = summarise(with_metrics(record, *rows)).failures
    assert found.measured == (
        "omega-dot residual 0.12 (12 % of the terms of the equation), 1.2e12 times its bound"
    )
    (found,) = summarise(with_metrics(record, rows[1])).failures
    assert found.measured.startswith("torque residual 0.5 (50 % of the terms of the equation)")
    (found,) = summarise(with_metrics(record, rows[2])).failures  # it is all that fails
    assert note in found.measured


def test_the_cell_the_table_and_the_headline_have_one_residual(record: Record) -> None:
    """Caught: 0.5 at the top, 0.69 in the table and the bound of 0.5 in the cell."""
    rows = [
        metric("sphere", "dart", None, None, "equation", channel, "residual", value, bound=bound)
        for channel, value, bound in (("omega_dot", 0.69, 2e-14), ("torque", 0.5, 1.4e-14))
    ]
    found = with_metrics(record, *({**row, "verdict": "fail"} for row in rows))
    summary = summarise(found)
    assert "residual 0.69 " in summary.failures[0].measured
    (cell,) = (cell for cell in summary.cells.values() if cell.failed)
    assert cell.failed.number == "3.4e13 × bound"
    (table, *_), _ = failures_table(found, summary.columns, sources_for(found.run["engines"]))
    assert table.size == "3.4e13 × bound (0.69 relative)"
    (shown,) = (g for g in glances(summary, found.metrics, Sources()) if g["status"] == "fail")
    assert shown["residual"][0] == "0.69"


def test_a_residual_after_another_load_is_named_where_it_is_shown(record: Record) -> None:
    """Caught: 0.12 at the top and 0.15 in the table, of a system that is not the scenario's."""
    note = "after the same system with another mass was loaded"
    rows = [
        metric("sphere", "dart", None, None, "equation", "omega_dot", name, value, **more)
        for name, value, more in (
            ("residual", 0.12, {}),
            ("residual_of_sibling", 0.15, {"note": note}),
        )
    ]
    rows = [{**row, "verdict": "fail"} for row in rows]

    def shown(found: Record) -> tuple[str, str]:
        table = glances(summarise(found), found.metrics, Sources())
        return next(row["residual"] for row in table if row["engine"].startswith("dart"))

    found = with_metrics(record, *rows)
    assert "residual 0.12 " in summarise(found).failures[0].measured
    assert shown(found) == ("0.12", "on sphere; bound 1e-13")
    after = "after a similar system was loaded, on sphere; bound 1e-13"
    assert shown(with_metrics(record, rows[1])) == ("0.15", after)


def test_the_failing_gate_stands_beside_its_engine_with_its_number(record: Record) -> None:
    """Caught: a failing cell that shows a figure which passes, and no other."""
    found = failing(record)
    text = (
        "equation gate: omega-dot residual 0.002 (0.2 % of the terms of the equation), 2e10 times"
    )
    failed = {key: cell.failed.text for key, cell in summarise(found).cells.items() if cell.failed}
    assert [(name, column.engine) for name, column in failed] == [("sphere", "dart")]
    assert next(iter(failed.values())).startswith(text)
    page = draw_page(found)
    (beside,) = re.findall(r'<span class="failed">(.*?)</span>', page)
    assert beside.replace("\u2060", "").startswith(text)
    assert page.count('<span class="gate">equation</span>') == 1
