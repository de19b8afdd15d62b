"""The 3-D view opens with what fails, and beside it with the best that does not."""

from __future__ import annotations

from typing import Any

import polars as pl
from synthetic_record import build, metric, with_metrics

from omegadot.reports.charts.deviations import chart_deviations
from omegadot.reports.charts.palette import lines_of
from omegadot.reports.page.page import draw_page
from omegadot.reports.page.view_3d.view import view_payload
from omegadot.reports.record.record import Record


def opened(record: Record) -> dict[str, tuple[list[str], int]]:
    """By scenario: the names of the lines that the view opens with, and the step's rank."""
    charts = {name: chart for name, chart in chart_deviations(record).items() if chart.units}
    lines = lines_of(charts.values(), record.run["engines"])
    description, _ = view_payload(record, charts, lines)
    return {
        scenario["name"]: ([lines[k].name for k in scenario["first"]], scenario["rank"])
        for scenario in description["scenarios"]
    }


def failing(record: Record, gate: str = "scheme", **where: Any) -> Record:
    """The record with a gate failing in the tasks that have these values."""
    for task in record.run["tasks"]:
        if all(task[key] == value for key, value in where.items()):
            task["gates"] = {**task["gates"], gate: "fail"}
    return record


def test_without_a_failure_engines_are_spread(record: Record) -> None:
    first = (["mujoco Euler", "dart semi-implicit"], 0)
    assert opened(record) == {"sphere": first, "spun-again": first}


def test_the_failing_run_stands_beside_the_best_engine(record: Record) -> None:
    """Caught: a view that leaves out the engine that the page is about, and one of order 1 beside
    RK4, where the order, not the fault, is what one sees."""
    found = opened(failing(record, scenario="sphere", engine="dart"))
    assert found["sphere"] == (["dart semi-implicit", "mujoco Euler"], 0)
    assert found["spun-again"][0] == ["mujoco Euler", "dart semi-implicit"]


def test_the_step_is_the_finest_at_which_it_fails(record: Record) -> None:
    where = {"engine": "mujoco", "integrator": "RK4", "timestep": 0.02}
    assert opened(failing(record, **where))["sphere"] == (["mujoco RK4", "reference lie-rk4"], 2)


def test_a_run_that_fails_by_itself_comes_before_a_wrong_equation(record: Record) -> None:
    """The equation fails for all integrators; RK4, the more exact, fails by itself too."""
    found = failing(record, "equation", engine="mujoco")
    assert opened(found)["sphere"][0][0] == "mujoco Euler"
    found = failing(found, "trajectory", engine="mujoco", integrator="RK4")
    assert opened(found)["sphere"][0][0] == "mujoco RK4"


def test_where_every_engine_fails_the_reference_of_that_order_is_shown(record: Record) -> None:
    found = failing(failing(record, engine="dart"), engine="mujoco")
    names = ["mujoco Euler", "dart semi-implicit", "reference semi-implicit-euler"]
    assert opened(found)["sphere"][0] == names
    found = failing(found, engine="reference")
    assert opened(found)["sphere"][0] == ["reference semi-implicit-euler", "mujoco Euler"]


def test_the_page_opens_on_the_scenario_of_the_first_failure() -> None:
    """Caught: the first in the alphabet, while the headline names another."""
    record = build(("a-sphere", "t-handle", "spun-again"))
    row = metric("spun-again", "dart", None, None, "equation", "omega_dot", "residual", 1.0)
    found = with_metrics(record, {**row, "verdict": "fail"})
    for page, name in ((draw_page(found), "spun-again"), (draw_page(record), "t-handle")):
        select = page.split('<select id="view-scenario">')[1].split("</select>")[0]
        (chosen,) = (option for option in select.split("<option") if " selected" in option)
        assert f">{name}<" in chosen
    opened_at = draw_page(found).split('id="scenario-spun-again"')[1]
    assert opened_at.startswith(' aria-label="A sphere, spun" data-opened')


def test_runs_that_left_no_trajectory_are_left_out(record: Record) -> None:
    kept = record.trajectories.filter(pl.col("engine") != "dart")
    found = failing(Record(record.run, record.metrics, kept), engine="dart")
    assert opened(found)["sphere"][0] == ["mujoco Euler"]


def test_every_engine_is_shown_where_more_than_three_ran() -> None:
    """Caught: the reference counted, so that an everyday run of three engines opens with all."""
    engines = {name: {"Euler": 1} for name in ("reference", "mujoco", "dart", "drake")}
    for more, expected in (({}, False), ({"havok": {"step": 1}}, True)):
        record = build(("sphere",), engines=engines | more, steps=(0.01,))
        assert everyone(record) is expected
        assert everyone(failing(record, engine="dart")) is expected


def everyone(record: Record) -> bool:
    charts = {name: chart for name, chart in chart_deviations(record).items() if chart.units}
    lines = lines_of(charts.values(), record.run["engines"])
    (scenario,) = view_payload(record, charts, lines)[0]["scenarios"]
    return bool(scenario["everyone"])
