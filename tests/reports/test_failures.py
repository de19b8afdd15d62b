"""The failing engines at the top of the page, in the terminal and in a comment."""

from __future__ import annotations

from dataclasses import replace

import polars as pl
import pytest
from failing_records import FAILING, failing
from synthetic_record import metric, with_metrics

from omegadot.reports.page.glance import glances
from omegadot.reports.page.page import draw_page
from omegadot.reports.record.record import Record
from omegadot.reports.summary.provenance import Sources
from omegadot.reports.summary.summary import summarise
from omegadot.reports.text.markdown import markdown_of
from omegadot.reports.text.terminal import print_summary


def test_a_failing_engine_is_which_where_why_and_what_it_costs(record: Record) -> None:
    (found,) = summarise(failing(record)).failures
    assert found.sentence == (
        "dart fails the equation gate (omega-dot at given states) on sphere, before any step is "
        "taken, so in all 3 runs there: omega-dot residual 0.002 (0.2 % of the terms of the "
        "equation), 2e10 times its bound. Its scheme and trajectory gates fail as well. Likely "
        "cause: the gyroscopic term is missing. Holds: the equation gate on spun-again. Cost: "
        "attitude wrong by 3 rad (172 deg) on sphere with semi-implicit, step 0.02 s; sound "
        "integrators of order 1: 0.024 rad (1.4 deg)."
    )
    assert summarise(record).failures == ()


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
    lines = capsys.readouterr().out.splitlines()
    assert f"{failure.head}." in lines
    # A line each, by the names that the page has.
    listed = [line.strip() for line in lines if line.startswith("  ")]
    for name, text in failure.labelled:
        assert any(line.startswith(name) and line.endswith(text) for line in listed)
        assert f"<dt>{name}</dt>" in page
    assert "gyroscopic term is missing" in markdown_of(found)
    assert "The errors over time differ more" not in page  # it follows an agreement alone


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
        "--setup as-shipped --timestep 0.02 --seed 7"
    )
    assert failure.purpose == "runs it alone"


def test_where_and_in_how_many_runs_it_fails(record: Record) -> None:
    """Caught: "in 6 of 18 runs, worst on" the only scenario, of a gate that takes no step."""
    (failure,) = summarise(failing(record)).failures
    assert (failure.lead, failure.tail) == (
        *("on ", ", before any step is taken, so in all 3 runs there"),
    )
    both = failing(record)
    row = metric("spun-again", "dart", None, None, "equation", "omega_dot", "residual", 1e-3)
    (failure,) = summarise(with_metrics(both, {**row, "verdict": "fail"})).failures
    assert failure.lead == "on 2 of 2 scenarios, worst on "
    rows = [
        metric("sphere", *FAILING, step, "scheme", "omega", "match", size, verdict="fail")
        for step, size in ((0.02, 3.0), (0.01, 2.0))
    ]
    (failure,) = summarise(with_metrics(record, *rows)).failures
    assert failure.tail == ", with semi-implicit, step 0.02 s"
    for task in record.run["tasks"]:
        if (task["engine"], task["scenario"]) == ("dart", "sphere") and task["timestep"] > 0.005:
            task["gates"] = {**task["gates"], "scheme": "fail"}
    (failure,) = summarise(with_metrics(record, *rows)).failures
    assert failure.tail == ", in 2 of 3 runs there, worst with semi-implicit, step 0.02 s"


def test_a_cause_among_several_is_named_as_open(record: Record) -> None:
    """Caught: one cell, run again by its command, gives another cause than the page, and does not
    say that more scenarios had excluded it."""
    (failure,) = summarise(failing(record, "either the mass is halved, or the inertia is")).failures
    assert failure.cause.endswith("; more scenarios may exclude some)")
    assert "more scenarios" not in summarise(failing(record)).failures[0].cause


def test_an_equation_that_every_integrator_shares_names_them_so(record: Record) -> None:
    row = metric("sphere", "dart", None, None, "equation", "omega_dot", "residual", 1.0)
    found = failing(with_metrics(record, {**row, "verdict": "fail"}))
    (failure,) = summarise(found).failures
    assert failure.run == "semi-implicit"  # its only one
    tasks = [*found.run["tasks"]]
    tasks += [{**t, "integrator": "RK4"} for t in tasks if t["engine"] == "dart"]
    (failure,) = summarise(replace(found, run={**found.run, "tasks": tasks})).failures
    assert failure.run == "every integrator"


def test_an_engine_that_declares_no_scheme_says_so(record: Record) -> None:
    """Caught: a dash, and the reason of it folded away."""
    metrics = record.metrics.filter(pl.col("metric") != "match")
    found = glances(summarise(replace(record, metrics=metrics)), metrics, Sources())
    assert {g["error_source"][0] for g in found} == {"no scheme declared"}
