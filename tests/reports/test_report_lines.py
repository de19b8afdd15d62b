"""Which lines a chart shows, which are one, and how they are written as SVG."""

import re

import numpy as np
from synthetic_record import build, engine_entry, metric, with_metrics

from omegadot.reports.charts.coinciding import leaders, shown_first, sweep_leaders
from omegadot.reports.charts.deviations import Series, chart_deviations
from omegadot.reports.charts.packing import codes_of
from omegadot.reports.charts.palette import dashes
from omegadot.reports.charts.payload import Codes
from omegadot.reports.charts.svg import path_of
from omegadot.reports.page.page import draw_page
from omegadot.reports.page.sections import failing_lanes

TIME = np.linspace(0.0, 1.0, 5)
ERROR = np.array([np.nan, 1e-6, 1e-5, 1e-4, 1e-3])


def run(timestep=0.1):
    return Series("x", "physics", "a", timestep, None, TIME, {}, {}, {})


def led(*values, decades=11.0, floor=None, steps=None):
    runs = [run(step) for step in steps or [0.1] * len(values)]
    return leaders(runs, values, decades, floor)


def test_runs_no_farther_apart_than_a_line_is_broad_are_one():
    # Two px of 220 are a tenth of a decade here.
    near, far = ERROR * 10**0.09, ERROR * np.array([1, 1, 1, 1, 10**0.11])
    assert led(ERROR, near, far) == [0, 0, 2]
    assert led(ERROR, near, steps=[0.1, 0.2]) == [0, 1]


def test_below_the_floor_no_two_are_different():
    noisy = np.array([1e-16, *ERROR[1:]])
    assert led(ERROR, noisy) == [0, 1]
    assert led(ERROR, noisy, floor=1e-13) == [0, 0]
    gap = np.where(np.isclose(TIME, 0.5), np.nan, ERROR)
    assert led(ERROR, gap, floor=1e-13) == [0, 1]


def test_errors_over_the_step_are_one_where_every_step_agrees():
    own = {0.1: 1e-2, 0.2: 2e-2}
    found = sweep_leaders([own, {0.1: 1e-2, 0.2: 4e-2}, {0.1: 1e-2}, dict(own)], 2.0)
    assert found == [0, 1, 2, 0]


def test_best_and_worst_of_each_engine_are_shown_first_and_one_that_fails():
    engines = {"reference": {"lie-rk4": 4}, "mujoco": {"Euler": 1, "mid": 2, "RK4": 4}}
    record = build(("sphere",), engines=engines)
    chart = chart_deviations(record)["sphere"]
    ends = {("mujoco", "physics", "Euler"), ("mujoco", "physics", "RK4")}
    assert shown_first(chart) == ends
    add = ["sphere", "mujoco", "mid", 0.01, "trajectory", "omega", "error_max", 1.0]
    failing = failing_lanes(with_metrics(record, metric(*add, verdict="fail")).metrics)
    assert shown_first(chart, failing["sphere"]) == {*ends, ("mujoco", "physics", "mid")}
    alone = chart_deviations(build(("sphere",), engines={"reference": {"lie-rk4": 4}}))
    assert shown_first(alone["sphere"]) == {("reference", "physics", "lie-rk4")}


def test_codes_are_shared_where_they_are_equal_to_a_thousandth():
    codes = Codes()
    starts = codes.keep([ERROR, ERROR * 1.0003, ERROR * 1.01], [0, 0, 0])
    assert starts == [0, 0, 5]
    assert codes.keep([ERROR], [0]) == [10]
    np.testing.assert_array_equal(codes.parts[-1], codes_of(ERROR))


def test_a_path_has_few_points_and_goes_where_the_line_goes():
    xs = np.arange(200.0)
    ys = np.where(xs < 100, 100 + 50 * np.sin(xs / 20), 80.0)
    ys[150] = np.nan
    parts = re.findall(r"M(\d+) (\d+)l([^M]*)", path_of(xs, ys))
    assert len(parts) == 2
    drawn = []
    for x, y, moves in parts:
        steps = np.array(re.findall(r"(-?\d+)([+-]\d+)", moves), dtype=int)
        drawn.append(np.array([int(x), int(y)]) + np.vstack(([0, 0], np.cumsum(steps, axis=0))))
    assert sum(map(len, drawn)) < 40
    for points, own in zip(drawn, (xs < 150, xs > 150), strict=True):
        # Half a px by the points that are left out, half a px by whole px at either end.
        assert np.abs(np.interp(xs[own], *points.T) - ys[own]).max() <= 1.5
    assert path_of(np.array([3.0]), np.array([4.0])) == "M3 4h0"


def test_the_commonest_schemes_have_the_plainest_dashes():
    engines = [
        engine_entry("one", {"own": 1, "lie-rk4": 4}),
        engine_entry("two", {"RK4": 4}),
        engine_entry("three", {"Euler": 1, "RK4": 4}),
        engine_entry("four", {"semi-implicit": 1}),
    ]
    found = dashes(engines)
    assert found["two", "RK4"] == ""
    assert len({found["four", "semi-implicit"], found["two", "RK4"], found["one", "own"]}) == 3


def test_twenty_engines_have_a_row_each_and_the_failing_ones_stand_first():
    engines = {f"engine-{k:02}": {"Euler": 1, "RK4": 4} for k in range(20)}
    record = build(("sphere",), engines=engines, steps=(0.02, 0.01), samples=5)
    rows = [
        metric(
            "sphere", f"engine-{k:02}", None, None, "model", "model", "mass", 1.0, verdict="fail"
        )
        for k in range(12, 18)
    ]
    page = draw_page(with_metrics(record, *rows))
    table = re.search(r'<table class="glance.*?</table>', page, re.S)[0]
    names = re.findall(r'<th scope="row">(\S+)', table)
    assert len(names) == 20
    assert names[:6] == [f"engine-{k}" for k in range(12, 18)]
    heads = re.search(r'<table class="matrix many crowd">.*?</thead>', page, re.S)[0]
    assert heads.index("engine-12") < heads.index("engine-00")
    assert "3 more engines fail: engine-15, engine-16, engine-17" in page
    # All twenty make the same error: one line, with their names.
    assert page.count(" = ".join(f"engine-{k:02} RK4" for k in range(20))) >= 4
