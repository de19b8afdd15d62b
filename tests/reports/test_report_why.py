"""Sources of error on the page: clusters, schemes, orders, convergence, cost."""

from dataclasses import replace

import numpy as np
import polars as pl
import pytest
from synthetic_record import build, metric, with_metrics

from omegadot.reports.charts.sweeps import (
    Point,
    Sweep,
    decades,
    guides,
    rounding,
    sweep_payload,
    sweeps_of,
)
from omegadot.reports.page.why import order_table, scheme_table
from omegadot.reports.summary.cluster_sentences import extent, on_scenario, sentence
from omegadot.reports.summary.clusters import clusters_over_scenarios
from omegadot.reports.summary.headline import truth
from omegadot.reports.summary.provenance import Sources
from omegadot.reports.summary.summary import summarise


def cluster(scenario, members, scheme="euler", timestep=0.01):
    return {
        "scenario": scenario,
        "timestep": timestep,
        "scheme": scheme,
        "members": members.split(),
    }


def of(*clusters):
    return {"clusters": list(clusters)}


def test_identical_trajectories_are_not_independent_evidence():
    clusters = of(cluster("a", "x:Euler y:step z:aba+euler"), cluster("a", "x:RK4"))
    (found,) = clusters_over_scenarios(clusters)
    assert sentence(found) == (
        "x Euler, y step and z aba+euler produce identical trajectories (all step euler), "
        "so they count as one witness."
    )
    assert extent(found) == "They do so on the one scenario that tells schemes apart."
    assert found.engines == 3


def test_an_exception_does_not_split_a_cluster_and_is_named():
    same = [cluster(name, "x:a y:b") for name in ("one", "two", "three")]
    apart = [cluster("four", "x:a", "other"), cluster("four", "y:b")]
    (found,) = clusters_over_scenarios(of(*same, *apart))
    assert found.schemes == ("euler",)
    assert extent(found) == "They do so on 3 of 4 scenarios that tell schemes apart, not on four."
    many = [cluster(n, m) for n in "pqrst" for m in ("x:a", "y:b")]
    (found,) = clusters_over_scenarios(of(*same, *[cluster(n, "x:a y:b") for n in "klmno"], *many))
    assert extent(found) == (
        "They do so on 8 of 13 scenarios that tell schemes apart, not on p, q, r and 2 more."
    )


def test_one_that_differs_somewhere_is_named_apart():
    """Caught: "the trajectories differ on top", where only one of three engines does."""
    same = [cluster(name, "x:a y:b z:c") for name in ("one", "two")]
    top = [cluster("top", "x:a z:c"), cluster("top", "y:b")]
    (found,) = clusters_over_scenarios(of(*same, *top))
    assert sentence(found).startswith("x a and z c produce identical trajectories")
    assert extent(found) == (
        "They do so on all 3 scenarios that tell schemes apart. "
        "y b equals them on 2 of these, not on top."
    )
    assert found.engines == 3


def test_a_failing_engine_among_identical_ones_is_named():
    """Caught: a fault that no trajectory shows, in a list of engines that confirm each other."""
    run = of(cluster("one", "x:a y:b"), cluster("one", "x:RK4"))
    gates = {"engine": "y", "integrator": "b", "gates": {"scheme": "fail"}}
    (found,) = clusters_over_scenarios({**run, "tasks": [{**gates, "scenario": "one"}]})
    assert extent(found).endswith("Of these y b fails a gate all the same.")
    (found,) = clusters_over_scenarios({**run, "tasks": [{**gates, "scenario": "other"}]})
    assert "fails" not in extent(found)


def test_a_motion_on_which_all_schemes_agree_makes_no_cluster():
    simple = cluster("sphere", "x:a y:b x:c")
    listing = [cluster(name, own) for name in ("one", "two") for own in ("x:a y:b", "x:c")]
    assert [found.members for found in clusters_over_scenarios(of(simple, *listing))] == [
        ("x:a", "y:b")
    ]


def test_agreement_on_the_exact_solution_is_not_counted():
    """The sphere is solved exactly by every scheme: that makes no copies of each other."""
    sphere = cluster("sphere", "x:a y:b x:c", "rk4") | {"exact": True, "also": ["euler"]}
    assert clusters_over_scenarios(of(sphere)) == []
    more = [cluster("top", "x:a y:b"), cluster("top", "x:c", "rk4")]
    (found,) = clusters_over_scenarios(of(sphere, sphere | {"scenario": "spin"}, *more))
    assert (found.members, found.schemes) == (("x:a", "y:b"), ("euler",))
    assert extent(found) == "They do so on the one scenario that tells schemes apart."


def test_schemes_that_no_scenario_distinguishes_are_all_named():
    both = [cluster(name, "x:a y:b") | {"also": ["short-turns"]} for name in ("one", "two")]
    (found,) = clusters_over_scenarios(of(*both))
    expected = "(both step euler; no scenario here tells it from short-turns)"
    assert expected in sentence(found)
    distinguished = cluster("three", "x:a y:b")
    (found,) = clusters_over_scenarios(
        of(distinguished, distinguished | {"scenario": "four"}, *both)
    )
    assert found.schemes == ("euler",)


def test_together_means_at_every_step():
    clusters = [
        cluster("one", "x:a y:b", timestep=0.02),
        cluster("one", "x:a", timestep=0.01),
        cluster("one", "y:b", timestep=0.01),
    ]
    assert clusters_over_scenarios(of(*clusters)) == []


def test_in_a_group_every_two_agree():
    # a mostly goes with b, and b with c, but a seldom with c: b cannot bring them together.
    clusters = [
        *(cluster("one", own) for own in ("x:a y:b", "z:c")),
        *(cluster("two", own) for own in ("y:b z:c", "x:a")),
        cluster("three", "x:a y:b z:c"),
    ]
    assert [found.members for found in clusters_over_scenarios(of(*clusters))] == [("x:a", "y:b")]


def test_a_scheme_that_the_reference_lacks_has_no_name():
    (found,) = clusters_over_scenarios(of(cluster("one", "x:a y:b", None)))
    assert "identical trajectories (no scheme of the reference)" in sentence(found)


def test_a_scheme_that_depends_on_the_scenario_is_named_with_it():
    """Caught: "no scheme of the reference", beside a table that names one for every run."""
    damped = [cluster(n, "x:a y:b", "implicit") for n in ("one", "two")]
    top = cluster("top", "x:a y:b")
    (found,) = clusters_over_scenarios(of(top, damped[0]))
    assert "(both step euler on top and implicit on one)" in sentence(found)
    # Caught: the scheme of the most scenarios, stated of all of them.
    (found,) = clusters_over_scenarios(of(*damped, top))
    assert "(both step implicit on one and two and euler on top)" in sentence(found)
    (found,) = clusters_over_scenarios(of(*damped, cluster("top", "x:a y:b", None)))
    assert "implicit on one and two and no scheme of the reference on top" in sentence(found)
    # At every step, or it is not that of the scenario's runs.
    (found,) = clusters_over_scenarios(of(top, cluster("top", "x:a y:b", None, timestep=0.02)))
    assert "(no scheme of the reference)" in sentence(found)


def test_a_record_without_clusters_has_no_sentence():
    assert clusters_over_scenarios({}) == []
    assert on_scenario({}, "sphere") == ""
    assert on_scenario(of(cluster("one", "x:a")), "sphere") == ""


def test_one_scenarios_clusters_are_those_of_its_finest_step():
    coarse = cluster("one", "x:a y:b z:c", timestep=0.02)
    message = on_scenario(of(coarse, cluster("one", "x:a z:c"), cluster("one", "y:b")), "one")
    assert message == "3 runs at step 0.01 s produce 2 different trajectories: x a = z c."


def row(table, *heads):
    (found,) = [r for r in table.rows if r.heads[: len(heads)] == heads]
    return found


def test_the_scheme_table_leaves_the_reference_out(record):
    table = scheme_table(record, Sources())
    assert {r.heads[0] for r in table.rows} == {"mujoco", "dart"}
    euler = row(table, "mujoco", "Euler")
    assert euler.heads[2] == "semi-implicit-euler"
    assert [value.text for value in euler.values] == ["6 of 6", "0.0004", "–", "2e-14"]


def test_a_scheme_that_is_not_implemented_stands_out(record):
    add = ["sphere", "dart", "semi-implicit", 0.04, "scheme", "omega", "match"]
    found = with_metrics(record, metric(*add, 3e8, verdict="fail"))
    equalled, share, *_ = row(scheme_table(found, Sources()), "dart").values
    assert (equalled.text, equalled.mark) == ("6 of 7 ✗ fail", "fail")
    assert share.text == "3e8"


def test_a_scheme_that_depends_on_the_system_is_reported(record):
    tasks = [dict(task) for task in record.run["tasks"]]
    for task in tasks:
        if task["integrator"] == "Euler" and task["scenario"] == "sphere":
            task["scheme"] = "another" if task["timestep"] == 0.02 else task["scheme"]
        if task["engine"] == "dart":
            task["scheme"] = None
    table = scheme_table(replace(record, run={**record.run, "tasks": tasks}), Sources())
    assert row(table, "mujoco", "Euler").heads[2] == "semi-implicit-euler (another in 1 run)"
    assert row(table, "dart").heads[2] == "none declared"


def test_orders_are_ranges_of_what_was_judged(record):
    add = ["sphere", "dart", "semi-implicit", 0.04, "scheme", "attitude", "observed_order"]
    more = [
        metric(*add, 0.88, bound=1.0),
        metric(*add, 0.2, bound=1.0, verdict="info", note="not resolved"),
    ]
    cells = row(order_table(with_metrics(record, *more), Sources()), "dart").values
    assert cells[1].text == "0.88 … 1.01 (1)"
    assert {cell.text for place, cell in enumerate(cells) if place != 1} == {"–"}
    failed = metric(*add, 0.3, bound=1.0, verdict="fail")
    cell = row(order_table(with_metrics(record, failed), Sources()), "dart").values[1]
    assert (cell.text, cell.mark) == ("0.30 … 1.01 (1) ✗ fail", "fail")


def test_sweeps_hold_error_and_cost_per_simulated_second(record):
    found = sweeps_of(record.metrics)
    assert set(found) == {"sphere", "spun-again"}
    (dart,) = [s for s in found["sphere"] if s.engine == "dart"]
    assert dart.order == 1.0
    assert [p.timestep for p in dart.points] == [0.005, 0.01, 0.02]
    assert [p.cost for p in dart.points] == pytest.approx([4e-4, 2e-4, 1e-4])
    assert [p.error for p in dart.points] == pytest.approx([6e-3, 1.2e-2, 2.4e-2])
    assert dart.points[0].bound == 1e-13


def test_what_is_not_finite_is_not_drawn(record):
    add = ["sphere", "dart", "semi-implicit", 0.04]
    wild = with_metrics(
        record,
        metric(*add, "trajectory", "attitude", "error_max", float("nan"), bound=float("inf")),
        metric(*add, "cost", "time", "time_per_step", None),
    )
    (dart,) = [s for s in sweeps_of(wild.metrics)["sphere"] if s.engine == "dart"]
    assert dart.points[-1] == Point(0.04, None, None, None)


def sweep(order, *errors, bound=1e-13):
    steps = (0.01, 0.02, 0.04)
    return Sweep(
        "x", "physics", "a", order, tuple(map(Point, steps, errors, [bound] * 3, [1.0] * 3))
    )


def test_guides_have_the_slope_that_they_name():
    found = guides(
        [sweep(2.0, 1e-6, 4e-6, 1.6e-5), sweep(2.0, 1e-8, 1e-8, 1e-8), sweep(None, 1, 1, 1)]
    )
    ((order, h0, e0, h1, e1),) = found
    assert (order, h0, h1) == (2.0, 0.01, 0.04)
    assert e0 == pytest.approx(2e-6)  # above the larger of the two
    assert np.log(e1 / e0) / np.log(h1 / h0) == pytest.approx(2.0)


def test_no_guide_starts_in_rounding_or_goes_beyond_half_a_turn():
    assert guides([sweep(1.0, 2.0, 3.0, 3.0)]) == []
    assert guides([sweep(1.0, 1e-14, 1e-14, 1e-14)]) == []
    ((_, _, _, end, error),) = guides([sweep(2.0, 0.3, 1.2, 3.0)])
    assert end < 0.04
    assert error == pytest.approx(np.pi)


def test_the_rounding_line_is_the_largest_bound_that_means_something():
    wide = [sweep(1.0, 1, 1, 1, bound=1e-9), sweep(1.0, 1, 1, 1), sweep(1.0, 1, 1, 1, bound=9.0)]
    assert rounding(wide) == [[0.01, 1e-9], [0.02, 1e-9], [0.04, 1e-9]]


def test_axes_hold_all_values_and_know_of_zeros():
    assert decades(np.array([2e-5, 3e-2])) == {"low": -5, "high": -1, "floor": False}
    assert decades(np.array([0.0, 3e-2])) == {"low": -17, "high": -1, "floor": True}
    assert decades(np.array([])) == {"low": -16, "high": -16, "floor": False}


def test_only_lines_of_the_page_are_drawn():
    found = sweep_payload([sweep(1.0, 1e-3, 2e-3, None)], {("x", "physics", "a"): 4}, Sources())
    # Step, error, cost, and the number of the run that they are of.
    points = [[0.01, 0.001, 1.0, 0], [0.02, 0.002, 1.0, 1], [0.04, None, 1.0, 2]]
    assert found["lines"] == [[4, points, 0]]
    assert sweep_payload([sweep(1.0, 1e-3, 2e-3, 4e-3)], {}, Sources())["lines"] == []


def test_the_kinds_of_exact_solution_are_counted(record):
    assert truth(summarise(record)) == ["Exact solution: closed-form on 2 of 2 scenarios."]
    series = pl.when(pl.col("scenario") == "sphere").then(pl.lit("series"))
    mixed = record.trajectories.with_columns(integrator=series.otherwise(pl.col("integrator")))
    assert truth(summarise(replace(record, trajectories=mixed))) == [
        "Exact solution: closed-form on 1 and series on 1 of 2 scenarios."
    ]
    empty = build(("sphere",)).trajectories.clear()
    assert truth(summarise(replace(record, trajectories=empty))) == []
