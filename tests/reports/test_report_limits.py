"""Bounds, floors, residuals and the Pareto front, against what was put into the record."""

import math

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from synthetic_record import build, metric, with_metrics

from omegadot.reports.charts.bounds import limits_of, residuals_of
from omegadot.reports.charts.deviations import chart_deviations
from omegadot.reports.charts.front import named, pareto_front
from omegadot.reports.charts.palette import lines_of
from omegadot.reports.charts.payload import equation_payload, payload
from omegadot.reports.charts.sweeps import Point, Sweep
from omegadot.reports.summary.provenance import Sources

RUN = ["sphere", "dart", "semi-implicit", 0.01]
KEY = ("dart", "physics", "semi-implicit", 0.01, None)


@pytest.fixture
def judged(record):
    drifts = [
        metric(*RUN, "invariants", "energy", name, 1e-9, bound=bound)
        for name, bound in (("drift_full", 4e-12), ("drift_quarter", 1e-12), ("drift_half", 2.0))
    ]
    floor = {"verdict": "info", "bound": None}
    exact = ["sphere", "exact", "closed-form", None, "trajectory"]
    floors = [
        metric(*exact, "attitude", "resolvable_floor", 3e-14, unit="rad", **floor),
        metric(*exact, "energy", "resolvable_floor", 2e-15, **floor),
        metric(*exact, "omega", "resolvable_floor", 0.0, **floor),
    ]
    return with_metrics(record, *drifts, *floors)


def test_a_bound_holds_up_to_its_fraction_of_the_run_and_means_something(judged):
    found = limits_of(judged.metrics)["sphere"].bounds[KEY]
    # A relative bound of 2 allows everything: it is no bound.
    assert found["energy"] == [(0.25, 1e-12), (1.0, 4e-12)]
    assert found["attitude"] == [(1.0, 1e-13)]


def test_half_a_turn_is_no_bound_for_an_attitude(record):
    row = [*RUN, "trajectory", "attitude", "error_max", 1.0]
    beyond = with_metrics(record, metric(*row, bound=math.pi), metric(*row, bound=math.inf))
    assert limits_of(beyond.metrics) == limits_of(record.metrics)


def test_floors_are_those_of_the_exact_solution_and_zero_is_none(judged):
    assert limits_of(judged.metrics)["sphere"].floors == {"attitude": 3e-14, "energy": 2e-15}


def test_limits_are_drawn_in_the_chart_s_unit_alone(judged):
    limits = limits_of(judged.metrics)["sphere"]
    deviation = next(c for c in chart_deviations(judged)["sphere"].deviations if c.engine == "dart")
    assert limits.floor("energy", "1") == 2e-15
    assert limits.floor("energy", "J") is None
    assert limits.bound(deviation, "angular_momentum", "kg m²/s") == []
    assert limits.floor("attitude", "rad") == 3e-14


def test_the_axes_hold_the_floor_and_the_bounds(judged):
    charts = chart_deviations(judged)
    lines = lines_of(charts.values(), judged.run["engines"])
    described, _ = payload(charts, {}, lines, limits_of(judged.metrics), Sources())
    scenario = described["scenarios"]["sphere"]
    axes = {axis["channel"]: axis for axis in scenario["charts"]}
    assert axes["attitude"]["resolvable"] == 3e-14
    assert axes["attitude"]["low"] <= -14
    assert axes["omega_dot"]["resolvable"] is None
    (bounds,) = [
        entry[5]
        for entry in scenario["deviations"]
        if described["lines"][entry[0]]["engine"] == "dart" and entry[5][1][:1] == [0.25]
    ]
    assert bounds[list(axes).index("energy")] == [0.25, 1e-12, 1.0, 4e-12]


def test_a_residual_is_the_worst_of_its_kind_and_one_that_is_no_number_is_worst(record):
    add = ["sphere", "mujoco", None, None, "equation", "omega_dot"]
    rows = [
        metric(*add, "residual", 5.0, bound=7.0),
        metric(*add, "residual_on_path", 0.0),
        metric("sphere", "dart", None, None, *add[4:], "residual", math.nan),
    ]
    found = {r.engine: r for r in residuals_of(with_metrics(record, *rows).metrics)["sphere"]}
    assert found["mujoco"].random == (5.0, 7.0)
    assert found["mujoco"].path == (0.0, 1e-13)
    assert found["dart"].random == (None, 1e-13)
    assert found["dart"].path == (None, None)
    drawn = equation_payload(found.values(), Sources(), ["mujoco", "dart", "reference"])
    assert [row[0] for row in drawn] == ["reference", "mujoco", "dart"]
    assert drawn[1][4:] == [5.0, 7.0, 0.0, 1e-13]
    assert drawn[2][4] is None


def sweep(engine, *points):
    """points: (step, error, cost)."""
    return Sweep(engine, "physics", "a", 1.0, tuple(Point(h, e, None, c) for h, e, c in points))


def test_the_pareto_front_is_of_engines_without_the_reference():
    sweeps = [
        sweep("x", (0.1, 1e-2, 1.0), (0.01, 1e-4, 10.0), (0.001, 1e-4, 100.0)),
        sweep("y", (0.1, 2e-2, 2.0), (0.01, 1e-3, 5.0), (0.001, None, 0.1)),
        sweep("reference", (0.1, 1e-9, 1e-3)),
    ]
    front = pareto_front(sweeps)
    assert [(p.engine, p.timestep) for p in front] == [("x", 0.1), ("y", 0.01), ("x", 0.01)]
    assert named(front[1]) == (
        "y a at step 0.01 s",
        "0.001 rad (0.057 deg) for 5 s per simulated second",
    )


def test_below_the_floor_the_cheaper_run_stands_for_all():
    front = pareto_front([sweep("x", (0.1, 5e-15, 1.0), (0.01, 1e-15, 2.0))], floor=1e-14)
    assert [p.timestep for p in front] == [0.1]


@settings(derandomize=True, max_examples=60)
@given(st.lists(st.tuples(st.floats(1e-9, 3.0), st.floats(1e-6, 1e3)), max_size=12))
def test_every_run_is_matched_by_the_front_and_no_member_beats_another(values):
    points = [(0.1 + k, error, cost) for k, (error, cost) in enumerate(values)]
    front = pareto_front([sweep("x", *points)])
    for _, error, cost in points:
        assert any(p.error <= error and p.cost <= cost for p in front)
    for one in front:
        assert not any(
            other is not one and other.error <= one.error and other.cost <= one.cost
            for other in front
        )


def test_a_default_record_has_a_line_of_the_front_as_text():
    from omegadot.reports.page.page import draw_page

    page = draw_page(build(("sphere",)))
    assert "mujoco RK4 at step 0.02\u00a0s" in page  # on one line
    assert "at random states" in page
