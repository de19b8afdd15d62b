"""What a failure costs, in which order failures stand, and what of a failing engine holds."""

from __future__ import annotations

import re
from dataclasses import replace
from typing import Any

import pytest
from synthetic_record import build, metric, with_metrics

from omegadot.reports.page.failures_table import failures_table
from omegadot.reports.page.glance import glances
from omegadot.reports.page.page import draw_page
from omegadot.reports.page.templating import asset
from omegadot.reports.record.record import Record
from omegadot.reports.summary.headline import headline
from omegadot.reports.summary.provenance import Sources, sources_for
from omegadot.reports.summary.summary import summarise

RK4 = ("mujoco", "RK4")
EULER = ("dart", "semi-implicit")


def erring(
    record: Record, errors: dict[tuple[str, float], float], run: tuple[str, str] = RK4, **more: Any
) -> Record:
    """The record with these attitude errors of a run, by scenario and step, that fail."""
    for (scenario, step), value in errors.items():
        for task in record.run["tasks"]:
            own = task["scenario"], task["engine"], task["integrator"], task["timestep"]
            if own == (scenario, *run, step):
                task["gates"] = {**task["gates"], "trajectory": "fail"}
        where = (scenario, *run, step, "trajectory", "attitude", "error_max")
        row = metric(*where, value, **{"unit": "rad", "verdict": "fail", **more})
        record = with_metrics(record, row)
    return record


def cost(record: Record) -> str:
    return summarise(record).failures[0].cost


def of_order_four(record: Record, **errors: float) -> Record:
    """A second engine of order 4, with these errors on the scenarios."""
    entry = next(e for e in record.run["engines"] if e["name"] == "reference")
    record.run["engines"].append({**entry, "name": "other"})
    for scenario, value in errors.items():
        where = (scenario.replace("_", "-"), "other", "lie-rk4", 0.005, "trajectory", "attitude")
        record = with_metrics(record, metric(*where, "error_max", value, unit="rad"))
    return record


def test_the_price_is_of_the_dearest_scenario(record: Record) -> None:
    """Caught: millionths of a degree of the run that is most times its bound, next to a scenario
    on which the same integrator is off by thousand times that."""
    found = of_order_four(record, sphere=1e-9, spun_again=1e-7)
    found = erring(found, {("sphere", 0.005): 1e-7}, bound=1e-15)
    found = erring(found, {("spun-again", 0.005): 1e-4}, bound=1e-6)
    assert summarise(found).failures[0].scenario == "sphere"
    assert cost(found) == (
        "attitude wrong by 0.0001 rad (0.0057 deg) on spun-again with RK4, step 0.005 s; sound "
        "integrators of order 4: 1e-7 rad (5.7e-6 deg)"
    )


def test_a_motion_on_which_sound_runs_err_as_much_shows_no_price(record: Record) -> None:
    """Caught: "2.5 rad, sound ones 2 rad" of a fault that is plain elsewhere."""
    found = of_order_four(record, sphere=1e-9, spun_again=2.0)
    found = erring(found, {("sphere", 0.005): 0.1, ("spun-again", 0.005): 2.5})
    assert cost(found).startswith("attitude wrong by 0.1 rad (5.7 deg) on sphere with RK4")


def test_a_coarse_step_that_is_dearer_is_named(record: Record) -> None:
    """Caught: the finest step's thousandths of a degree alone, where the coarse one is visible."""
    found = erring(record, {("sphere", 0.005): 2e-5, ("sphere", 0.02): 1.2e-3})
    assert cost(found).endswith("; at step 0.02 s wrong by 0.0012 rad (0.069 deg)")
    same = erring(build(), {("sphere", 0.005): 2e-5, ("sphere", 0.02): 2.0001e-5})
    assert "step 0.02" not in cost(same)


def test_an_order_that_is_too_low_is_told_where_no_cause_is_known(record: Record) -> None:
    """Caught: "what fails is listed", and the one clue in the thirteenth row of a table."""
    found = erring(record, {("sphere", 0.005): 2e-5, ("spun-again", 0.005): 2e-5})
    for scenario, order in (("sphere", 2.92), ("spun-again", 3.06)):
        where = (scenario, *RK4, 0.005, "scheme")
        low = metric(*where, "attitude", "observed_order", order, bound=4.0, verdict="fail")
        match = metric(*where, "attitude", "match", 3e8, bound=1.0, verdict="fail")
        found = with_metrics(found, low, match)
    (failure,) = summarise(found).failures
    text = "RK4 shows order 2.92 to 3.06 in attitude, not 4; equation gate and Euler hold"
    assert failure.seen == text
    assert f"<dd>none was found; {text}</dd>" in draw_page(found)
    for task in found.run["tasks"]:
        if task["engine"] == "mujoco" and "fail" in task["gates"].values():
            task["cause"] = "the last stage is left out"
    assert summarise(found).failures[0].seen == ""


def three(record: Record) -> Record:
    """Three engines that fail, the dearest of them in the middle of the record."""
    found = erring(record, {("sphere", 0.005): 1e-4}, RK4)
    found = erring(found, {("sphere", 0.005): 2.0}, EULER)
    row = metric("sphere", "reference", None, None, "equation", "torque", "residual", 1.0)
    return with_metrics(found, {**row, "verdict": "fail"})


def test_boxes_headline_and_tables_have_one_order(record: Record) -> None:
    """Caught: the cheapest fault first at the top, and the dearest two screens down on a phone."""
    found = three(record)
    summary = summarise(found)
    assert [failure.engine for failure in summary.failures] == ["dart", "mujoco", "reference"]
    assert "dart, mujoco and reference" in headline(summary)
    rows = glances(summary, found.metrics, Sources())
    assert [row["engine"].split()[0] for row in rows] == ["dart", "mujoco"]
    table, _ = failures_table(found, summary.columns, sources_for(found.run["engines"]))
    named = dict.fromkeys(row.engine.split()[0] for row in table)
    assert [*named] == ["dart", "mujoco", "reference"]
    boxes = re.findall(r"<li><p><b>(.*?)</b> fails", draw_page(found))
    assert boxes == ["dart", "mujoco", "reference"]


def test_an_attitude_that_is_no_number_is_dearer_than_any(record: Record) -> None:
    found = erring(three(record), {("sphere", 0.01): float("nan")}, RK4)
    assert summarise(found).failures[0].engine == "mujoco"


def scoped(record: Record, **system: Any) -> Record:
    """DART's equation fails on `sphere`, whose system has this besides."""
    entries = [
        {**e, "system": {**e["system"], **system}} if e["name"] == "sphere" else e
        for e in record.run["scenarios"]
    ]
    row = metric("sphere", "dart", None, None, "equation", "omega_dot", "residual", 1.0)
    found = replace(record, run={**record.run, "scenarios": entries})
    return with_metrics(found, {**row, "verdict": "fail"})


@pytest.mark.parametrize(
    ("system", "alone"),
    [
        ({}, ""),
        ({"pivot": [0.0, 0.0, 0.0]}, "; only where it fails is there a pivot"),
        (
            {"damping": 0.1, "gravity": [0.0, 0.0, -9.8]},
            "; only where it fails is there gravity and damping",
        ),
    ],
)
def test_where_the_gate_holds_and_what_is_not_there(
    record: Record, system: dict[str, Any], alone: str
) -> None:
    """Caught: "fails on heavy-top", and no word that a free body is not concerned."""
    found = scoped(record, **system)
    (failure,) = summarise(found).failures
    assert failure.scope == f"the equation gate on spun-again{alone}"
    assert f"<dt>what holds</dt><dd>{failure.scope}</dd>" in draw_page(found)
    assert f"Holds: {failure.scope}." in failure.sentence


def test_what_other_scenarios_have_too_sorts_nothing(record: Record) -> None:
    found = scoped(record, damping=0.1)
    entry = next(e for e in found.run["scenarios"] if e["name"] == "spun-again")
    entry["system"] = {**entry["system"], "damping": 0.2}
    assert summarise(found).failures[0].scope == "the equation gate on spun-again"
    row = metric("spun-again", "dart", None, None, "equation", "omega_dot", "residual", 1.0)
    both = with_metrics(found, {**row, "verdict": "fail"})
    assert summarise(both).failures[0].scope == ""  # it holds nowhere


def test_only_failing_runs_are_framed_as_such() -> None:
    """Caught: a failing run without a frame beside a sound one that has one."""
    script = asset("view_stage.js")
    body = script.split("function frame(")[1].split("\n}")[0]
    assert body.index("if (!trajectory.gates) return;") < body.index("strokeRect")
