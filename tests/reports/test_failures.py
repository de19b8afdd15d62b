"""The failing engines at the top of the page, in the terminal and in a comment."""

from __future__ import annotations

import re
from dataclasses import replace
from io import StringIO

import numpy as np
import polars as pl
import pytest
from changed_records import FIGURE, edited
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
        "dart fails the equation gate (omega-dot at given states) on sphere, before any step is "
        "taken, so in all 3 runs there: omega-dot residual 0.002 (0.2 % of the terms of the "
        "equation), 2e10 times its bound. Its scheme and trajectory gates fail as well. Likely "
        "cause: the gyroscopic term is missing. Holds: the equation gate on spun-again. Cost: "
        "attitude wrong by 3 rad (172 deg) on sphere with semi-implicit, step 0.02 s; sound "
        "integrators of order 1: 0.024 rad (1.4 deg)."
    )
    assert summarise(record).failures == ()


def test_what_it_costs_names_its_scenario(record: Record) -> None:
    """Caught: an equation that is worst on one scenario, and the dearer run of another left out."""
    equation = metric("sphere", "dart", None, None, "equation", "omega_dot", "residual", 1.0)
    runs = [
        metric(name, *FAILING, 0.02, "trajectory", "attitude", "error_max", value)
        for name, value in (("spun-again", 9.0), ("sphere", 3.0))
    ]
    rows = [{**row, "verdict": "fail"} for row in (equation, *runs)]
    (found,) = summarise(with_metrics(record, *rows)).failures
    assert (found.scenario, found.run) == ("sphere", "")
    text = "attitude wrong by 9 rad (516 deg) on spun-again with semi-implicit"
    assert found.cost.startswith(text)


def test_what_fails_in_no_run_costs_nothing_there(record: Record) -> None:
    row = metric("sphere", "dart", None, None, "equation", "torque", "residual", 1.0)
    (found,) = summarise(with_metrics(record, {**row, "verdict": "fail"})).failures
    assert found.cost == "nothing in its trajectories, which pass"
    alone = record.metrics.filter(gate="equation")
    (found,) = summarise(
        with_metrics(replace(record, metrics=alone), {**row, "verdict": "fail"})
    ).failures
    assert found.cost == ""
    assert "Cost" not in found.sentence


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
        "--setup as-shipped --timestep 0.02 --seed 7"
    )
    assert failure.purpose == "runs it alone"


def test_an_attitude_is_compared_with_those_of_its_order(record: Record) -> None:
    """Caught: a first-order engine whose error stands beside a range that begins at RK4's."""
    found = failing(record)
    assert summarise(found).failures[0].cost.endswith("of order 1: 0.024 rad (1.4 deg)")
    for engine in found.run["engines"]:
        for own in engine["integrators"] if engine["name"] == "mujoco" else ():
            own["orders"] = {"attitude": 4}
    cost = summarise(found).failures[0].cost
    assert cost.endswith("of other orders: 1.9e-7 to 0.024 rad (1.1e-5 to 1.4 deg)")
    for engine in found.run["engines"]:
        for own in engine["integrators"]:
            own["orders"] = {}
    cost = summarise(found).failures[0].cost
    assert cost.endswith("; sound integrators: 1.9e-7 to 0.024 rad (1.1e-5 to 1.4 deg)")


def failing_in_a_probe(record: Record, **error: object) -> Record:
    """DART's steps fail from a state that its run does not reach; the error that it has is this."""
    where = ("sphere", *FAILING, 0.005)
    row = metric(*where, "scheme", "omega", "rate_at_no_step", 3e8, bound=1.0, verdict="fail")
    return with_metrics(edited(record, where, FIGURE, **error), row)


def test_an_error_that_sound_integrators_have_as_well_costs_nothing(record: Record) -> None:
    """Caught: "off by 2 rad" of a run that is a sound engine's to rounding."""
    (same,) = record.metrics.filter(
        engine="mujoco", scenario="sphere", integrator="Euler", timestep=0.005, metric="error_max"
    )["value"]
    text = (
        "nothing in the attitude on sphere: semi-implicit, step 0.005 s, has an error of 0.006 rad "
        "(0.34 deg) there, as sound integrators of order 1 have: 0.006 rad (0.34 deg)"
    )
    equal = {"value": same + 1.5e-9, "bound": 1e-9, "verdict": "info"}
    near = edited(record, ("sphere", "mujoco", "Euler", 0.005), FIGURE, bound=1e-9)
    for case in (failing_in_a_probe(record), failing_in_a_probe(near, **equal)):
        (found,) = summarise(case).failures
        assert found.cost == text
    beyond = {**equal, "value": same + 3e-9}  # more than both bounds
    (found,) = summarise(failing_in_a_probe(near, **beyond)).failures
    assert found.cost.startswith("attitude wrong by 0.006 rad (0.34 deg) on sphere")


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


def test_an_error_of_its_order_costs_nothing_where_no_other_has_that_order(record: Record) -> None:
    found = failing_in_a_probe(record)
    for engine in found.run["engines"]:
        for own in engine["integrators"] if engine["name"] == "mujoco" else ():
            own["orders"] = {"attitude": 4}
    (failure,) = summarise(found).failures
    assert failure.cost.startswith("nothing in the attitude on sphere")
    assert failure.cost.endswith("which passes as the truncation error of its order")


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


def test_an_engine_that_declares_no_scheme_says_so(record: Record) -> None:
    """Caught: a dash, and the reason of it folded away."""
    metrics = record.metrics.filter(pl.col("metric") != "match")
    found = glances(summarise(replace(record, metrics=metrics)), metrics, Sources())
    assert {g["error_source"][0] for g in found} == {"no scheme declared"}


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
