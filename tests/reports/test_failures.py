"""The failing engines at the top of the page, in the terminal and in a comment."""

from __future__ import annotations

import re
from dataclasses import replace
from io import StringIO

import numpy as np
import polars as pl
import pytest
from rich.console import Console
from synthetic_record import metric, with_metrics

from omegadot.reports.page.glance import glances
from omegadot.reports.page.page import draw_page
from omegadot.reports.record.record import Record
from omegadot.reports.summary.failed_gate import failed_gates
from omegadot.reports.summary.provenance import Sources
from omegadot.reports.summary.summary import summarise
from omegadot.reports.text.markdown import markdown_of
from omegadot.reports.text.numbers import short
from omegadot.reports.text.terminal import print_summary

FAILING = ("dart", "semi-implicit")


def failing(record: Record, cause: str = "the gyroscopic term is missing") -> Record:
    """DART's equation and its runs on one scenario fail; a later gate by more than the first."""
    where = ("sphere", *FAILING, 0.02)
    rows = (
        metric(*where, "trajectory", "attitude", "error_max", 3.0, verdict="fail"),
        metric(*where, "equation", "omega_dot", "residual", 2e-3, verdict="fail"),
        metric(*where, "equation", "omega_dot", "residual_on_path", 1e-3, verdict="fail"),
        metric(*where, "scheme", "omega", "observed_order", 0.1, verdict="fail"),
    )
    tasks = [
        {**task, "gates": {**task["gates"], "equation": "fail"}, "cause": cause}
        if (task["engine"], task["scenario"]) == ("dart", "sphere")
        else task
        for task in record.run["tasks"]
    ]
    return with_metrics(replace(record, run={**record.run, "tasks": tasks}), *rows)


def test_a_failing_engine_is_which_where_why_and_what_it_costs(record: Record) -> None:
    (found,) = summarise(failing(record)).failures
    assert found.sentence == (
        "dart fails the equation gate (omega-dot at given states) in 3 of 6 runs, worst on sphere, "
        "semi-implicit, step 0.02 s: omega-dot residual 0.002, 2e10 times its bound. Its scheme "
        "and trajectory gates fail as well. Likely cause: the gyroscopic term is missing. Cost: "
        "its attitude is off by 0.006 rad on sphere (semi-implicit, step 0.005 s); that of "
        "integrators of its order, 1, that pass by 0.006 rad."
    )
    assert summarise(record).failures == ()


def test_what_it_costs_is_of_the_scenario_that_is_named(record: Record) -> None:
    """Caught: an equation that is worst on one scenario, and the cost of another."""
    equation = metric("sphere", "dart", None, None, "equation", "omega_dot", "residual", 1.0)
    runs = [
        metric(name, *FAILING, 0.02, "trajectory", "attitude", "error_max", value)
        for name, value in (("spun-again", 9.0), ("sphere", 3.0))
    ]
    rows = [{**row, "verdict": "fail"} for row in (equation, *runs)]
    (found,) = summarise(with_metrics(record, *rows)).failures
    assert (found.scenario, found.run) == ("sphere", "")
    assert found.cost.startswith("its attitude is off by 0.006 rad on sphere (semi-implicit, ")


def test_what_fails_in_no_run_costs_nothing_there(record: Record) -> None:
    row = metric("sphere", "dart", None, None, "equation", "torque", "residual", 1.0)
    (found,) = summarise(with_metrics(record, {**row, "verdict": "fail"})).failures
    assert found.cost == "none in its trajectories, which pass"
    alone = record.metrics.filter(gate="equation")
    (found,) = summarise(
        with_metrics(replace(record, metrics=alone), {**row, "verdict": "fail"})
    ).failures
    assert found.cost == ""
    assert "Cost" not in found.sentence


def test_the_failing_gate_stands_beside_its_engine_with_its_number(record: Record) -> None:
    """Caught: a failing cell that shows a figure which passes, and no other."""
    found = failing(record)
    text = "equation gate: omega-dot residual 0.002, 2e10 times its bound"
    failed = {key: cell.failed.text for key, cell in summarise(found).cells.items() if cell.failed}
    assert [(name, column.engine) for name, column in failed] == [("sphere", "dart")]
    assert next(iter(failed.values())).startswith(text)
    page = draw_page(found)
    (beside,) = re.findall(r'<span class="failed">(.*?)</span>', page)
    assert beside.replace("\u2060", "").startswith(text)
    assert page.count('<span class="gate">equation</span>') == 1


def test_a_cause_that_is_not_known_is_not_named(record: Record) -> None:
    found = failing(record, "none is known; omega-dot is off in x alone")
    (failure,) = summarise(found).failures
    assert failure.cause == ""
    assert "Likely cause" not in failure.sentence
    # Caught: "none was found" alone, where something is known.
    assert "No cause was found: omega-dot is off in x alone." in failure.sentence
    assert "<dd>none was found; omega-dot is off in x alone</dd>" in draw_page(found)
    named = {**found.run["tasks"][0], "cause": "the mass is halved", "gates": {"equation": "fail"}}
    tasks = [*found.run["tasks"], {**named, "engine": "dart"}]
    (failure,) = summarise(replace(found, run={**found.run, "tasks": tasks})).failures
    assert (failure.cause, failure.seen) == ("the mass is halved", "")


def test_it_stands_wherever_the_run_is_summed_up(
    record: Record, capsys: pytest.CaptureFixture[str]
) -> None:
    found = failing(record)
    (failure,) = summarise(found).failures
    page = draw_page(found)
    places = [page.index(text) for text in ("<h1>", f"<dd>{failure.cause}</dd>", "Verdicts")]
    assert places == sorted(places)
    measured = f"<dd>{failure.measured}. Its scheme and trajectory gates fail as well</dd>"
    assert measured in page.replace("\u2060", "")
    assert f"<dd>{failure.cost}</dd>" in page.replace("\u2060", "")
    table = page[page.index("Engine by engine") :]
    assert table.index(">dart ") < table.index(">mujoco ")  # the record has mujoco first
    print_summary(found)
    assert failure.sentence in " ".join(capsys.readouterr().out.split())
    assert "gyroscopic term is missing" in markdown_of(found)
    assert "The errors over time differ more" not in page  # it follows an agreement alone


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


def checkable(record: Record, command: tuple[str, ...] = (), **more: object) -> Record:
    """The record of engines of which DART is one of the reader's own."""
    engines = [
        {**e, "argument": "my dart.py:Dart" if e["name"] == "dart" else e["name"], **more}
        for e in record.run["engines"]
    ]
    return replace(record, run={**record.run, "engines": engines, "command": list(command)})


def test_what_to_type_next_stands_with_the_failure(record: Record) -> None:
    """Caught: a failing page that ends with what is wrong, and a command for an engine's name
    that no command takes."""
    found = checkable(failing(record))
    (failure,) = summarise(found).failures
    assert failure.command == "omegadot check 'my dart.py:Dart'"
    assert failure.sentence.endswith(f"Next: {failure.command}")  # no full stop to copy
    assert "<code>omegadot check &#39;my dart.py:Dart&#39;</code>" in draw_page(found)
    assert f"Next: {failure.command}" in markdown_of(found).replace("\\", "")
    (failure,) = summarise(failing(record)).failures  # as of a trace, which no command checks
    assert failure.command == ""
    assert "<dt>next</dt>" not in draw_page(failing(record))


def test_the_next_command_repeats_how_the_failure_was_run(record: Record) -> None:
    command = ("omegadot", "run", "my sphere.toml", "spun.toml", "--engine", "dart")
    (failure,) = summarise(checkable(failing(record), command, via="urdf")).failures
    assert failure.command == (
        "omegadot check 'my dart.py:Dart' --scenario 'my sphere.toml' --via urdf"
    )
    other = {"name": "RK4", "scheme": None, "orders": {}, "knob": "timestep", "note": ""}
    found = checkable(failing(record))
    for engine in found.run["engines"]:
        if engine["name"] == "dart":
            engine["integrators"] = [*engine["integrators"], other]
    (failure,) = summarise(found).failures  # of two integrators one fails
    assert failure.command.endswith("--integrator semi-implicit")
    # `check` has no other setup than physics: there it is the failing run itself.
    rows = [{**row, "setup": "as-shipped"} for row in found.metrics.to_dicts()]
    found = with_metrics(replace(found, metrics=found.metrics.clear()), *rows)
    (failure,) = summarise(found).failures
    assert failure.command == (
        "omegadot run sphere --adapter 'my dart.py:Dart' --engine dart:semi-implicit "
        "--setup as-shipped --timestep 0.02"
    )
    assert failure.purpose == "runs it alone"


def test_an_attitude_is_compared_with_those_of_its_order(record: Record) -> None:
    """Caught: a first-order engine whose error stands beside a range that begins at RK4's."""
    found = failing(record)
    assert summarise(found).failures[0].cost.endswith("its order, 1, that pass by 0.006 rad")
    for engine in found.run["engines"]:
        for own in engine["integrators"] if engine["name"] == "mujoco" else ():
            own["orders"] = {"attitude": 4}
    cost = summarise(found).failures[0].cost
    assert cost.endswith("that of integrators of other orders that pass by 7.5e-10 to 0.006 rad")
    for engine in found.run["engines"]:
        for own in engine["integrators"]:
            own["orders"] = {}
    cost = summarise(found).failures[0].cost
    assert cost.endswith("that of integrators that pass by 7.5e-10 to 0.006 rad")


def test_an_equation_that_every_integrator_shares_names_them_so(record: Record) -> None:
    row = metric("sphere", "dart", None, None, "equation", "omega_dot", "residual", 1.0)
    found = failing(with_metrics(record, {**row, "verdict": "fail"}))
    (failure,) = summarise(found).failures
    assert failure.run == "semi-implicit"  # its only one
    tasks = [*found.run["tasks"]]
    tasks += [{**t, "integrator": "RK4"} for t in tasks if t["engine"] == "dart"]
    (failure,) = summarise(replace(found, run={**found.run, "tasks": tasks})).failures
    assert failure.run == "every integrator"


def test_the_glance_shows_the_residual_that_the_failure_names(record: Record) -> None:
    """Caught: "worst, 0.5" beside a table that has 0.6, of a scenario with a wider bound."""
    rows = [
        metric(name, "dart", None, None, "equation", "omega_dot", "residual", value, bound=bound)
        for name, value, bound in (("sphere", 0.5, 1e-14), ("spun-again", 0.6, 1e-8))
    ]
    found = with_metrics(record, *({**row, "verdict": "fail"} for row in rows))
    (failure,) = summarise(found).failures
    assert failure.measured.startswith("omega-dot residual 0.5, ")
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
    assert (shown["status"], shown["runs"]) == ("fail", "3 of 6 runs; 3 unsupported")
    assert shown["error_source"][0] == "a fault: equation gate fails"


def test_an_engine_that_declares_no_scheme_says_so(record: Record) -> None:
    """Caught: a dash, and the reason of it folded away."""
    metrics = record.metrics.filter(pl.col("metric") != "match")
    found = glances(summarise(replace(record, metrics=metrics)), metrics, Sources())
    assert {g["error_source"][0] for g in found} == {"no scheme declared"}
