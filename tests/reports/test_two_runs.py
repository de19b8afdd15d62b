"""Two records compared: rounding is no change, and every change is reported."""

from __future__ import annotations

import copy
from dataclasses import replace

import numpy as np
import polars as pl
import pytest
from changed_records import BOUND, FIGURE, RUN, SMALL, edited, only, value_of, with_run, with_tasks
from hypothesis import given, settings
from hypothesis import strategies as st
from synthetic_record import build, metric, task, with_metrics

from omegadot.reports.two_runs.comparison import compare_records
from omegadot.reports.two_runs.text import as_text


@pytest.fixture(scope="module")
def base():
    return build(**SMALL)


def test_a_record_and_itself_have_no_change(base) -> None:
    same = compare_records(base, base)
    assert not same.regressed
    assert (same.worse, same.better, same.appeared, same.vanished, same.settings) == ((),) * 5
    assert same.headline.startswith("No change.")
    assert same.runs == len(base.run["tasks"])


@settings(derandomize=True, max_examples=10)
@given(seed=st.integers(0, 2**32 - 1))
def test_rounding_on_either_machine_is_no_change(seed: int) -> None:
    """Each run anywhere within its own round-off bound of the same trajectory."""
    base, draw = build(**SMALL), np.random.default_rng(seed)
    bounded = base.metrics.get_column("metric") != "observed_order"

    def machine():
        noise = draw.uniform(-1.0, 1.0, base.metrics.height) * base.metrics["bound"].to_numpy()
        moved = base.metrics["value"].to_numpy() + np.where(bounded.to_numpy(), noise, 0.0)
        return replace(base, metrics=base.metrics.with_columns(value=pl.Series(moved)))

    # The last digit of a sum may round up.
    inside = compare_records(machine(), machine())
    assert not inside.worse
    assert not inside.better


def test_a_version_that_changed_is_listed_once(base) -> None:
    """It is the package's and the engine's; that of another package stands by itself."""
    was, now = copy.deepcopy(base), copy.deepcopy(base)
    for record, version in ((was, "3.9.0"), (now, "3.10.0")):
        record.run["versions"] = {"mujoco": version, "numpy": version}
        for engine in record.run["engines"]:
            engine["version"] = version if engine["name"] == "mujoco" else engine["version"]
    listed = [one.what for one in compare_records(was, now).settings]
    assert listed == ["version of numpy", "mujoco version"]


@pytest.mark.parametrize(("times", "worse", "better"), [(2.1, 1, 0), (1.9, 0, 0), (-2.1, 0, 1)])
def test_a_figure_beyond_both_bounds_is_a_change(base, times, worse, better) -> None:
    moved = edited(base, value=value_of(base) + times * BOUND)
    found = compare_records(base, moved)
    assert (len(found.worse), len(found.better)) == (worse, better)
    assert found.regressed is bool(worse)
    for change in (*found.worse, *found.better):
        assert change.key[:2] == ("sphere", "mujoco")
        assert (change.gate, change.channel, change.metric) == FIGURE
        assert change.measure.band == pytest.approx(2 * BOUND)
        assert change.moved


def test_the_bounds_of_both_records_make_the_band(base) -> None:
    wide = edited(edited(base, bound=1e-3), value=value_of(base) + 0.9e-3)
    assert not compare_records(base, wide).regressed
    assert not compare_records(wide, base).better


@pytest.mark.parametrize("value", [float("nan"), float("inf"), None])
def test_a_figure_that_is_no_number_any_more_is_worse(base, value) -> None:
    broken = edited(base, value=value)
    assert compare_records(base, broken).regressed
    back = compare_records(broken, base)
    assert not back.regressed
    assert len(back.better) == 1
    assert not compare_records(broken, broken).regressed


def test_a_bound_that_allows_everything_holds_nothing(base) -> None:
    loose = edited(base, bound=float("inf"), value=3.0)
    assert not compare_records(base, loose).regressed


@pytest.mark.parametrize(
    ("now", "words"),
    [("fail", "fails"), ("declared", "fails as declared"), ("info", "not judged")],
)
def test_a_verdict_that_turned_worse_is_a_regression_within_the_band(base, now, words) -> None:
    found = compare_records(base, edited(base, verdict=now))
    assert [(c.was, c.now, c.moved) for c in found.worse] == [("pass", now, False)]
    assert f"passes → {words}" in as_text(found)
    assert "_" not in found.worse[0].what
    back = compare_records(edited(base, verdict=now), base)
    assert not back.regressed
    assert len(back.better) == 1


def test_an_order_that_is_not_resolved_any_more_is_no_change(base) -> None:
    order = ("scheme", "attitude", "observed_order")
    assert not compare_records(base, edited(base, figure=order, verdict="info", value=1.0)).worse
    assert compare_records(base, edited(base, figure=order, verdict="fail")).regressed


def test_a_gate_that_fails_without_a_figure_is_reported(base) -> None:
    def failing(entry):
        if (entry["engine"], entry["integrator"], entry["timestep"]) == ("mujoco", "RK4", 0.01):
            entry["gates"] = {**entry["gates"], "trajectory": "fail"}
            entry["why"] = "it diverges from its scheme"
        return entry

    found = compare_records(base, with_tasks(base, failing))
    assert {(c.gate, c.was, c.now) for c in found.worse} == {("trajectory", "pass", "fail")}
    assert len(found.worse) == 2  # on both scenarios
    assert "it diverges from its scheme" in as_text(found)


def test_a_figure_and_its_gate_are_one_change(base) -> None:
    def failing(entry):
        run = (entry["scenario"], entry["engine"], entry["integrator"], entry["timestep"])
        return {**entry, "gates": {**entry["gates"], FIGURE[0]: "fail"}} if run == RUN else entry

    broken = with_tasks(edited(base, verdict="fail", value=1.0), failing)
    assert len(compare_records(base, broken).worse) == 1


@pytest.mark.parametrize("outcome", ["crashed", "timeout", "raised", "diverged", "unsupported"])
def test_an_outcome_that_turned_worse_is_a_regression(base, outcome) -> None:
    def ended(entry):
        if (entry["scenario"], entry["engine"]) == ("sphere", "dart"):
            return {**entry, "outcome": outcome, "gates": {}, "reason": "signal 11"}
        return entry

    found = compare_records(base, with_tasks(base, ended))
    assert {(c.was, c.now) for c in found.worse} == {("ok", outcome)}
    assert len(found.worse) == len(SMALL["steps"])
    back = compare_records(with_tasks(base, ended), base)
    assert not back.regressed
    assert len(back.better) == len(SMALL["steps"])


@pytest.mark.parametrize("outcome", ["crashed", "not-installed"])
def test_an_engine_that_does_not_start_any_more_fails_all_that_it_ran(base, outcome) -> None:
    """Its one task a scenario names neither version nor integrator."""
    gone = only(base, lambda row: row["engine"] != "dart")
    for scenario in SMALL["scenarios"]:
        lost = task(scenario, "dart", "", None, outcome=outcome, engine_version="", gates={})
        gone.run["tasks"].append(lost)
    found = compare_records(base, gone)
    assert len(found.worse) == len(SMALL["scenarios"]) * len(SMALL["steps"])
    assert not found.vanished
    back = compare_records(gone, base)
    assert not back.regressed
    news = back.appeared if outcome == "not-installed" else back.better
    assert len(news) == len(found.worse)


def test_other_steps_and_scenarios_appear_and_vanish(base) -> None:
    fewer = only(base, lambda row: row["scenario"] == "sphere" and row["timestep"] != 0.02)
    gone = compare_records(base, fewer)
    assert not gone.regressed
    assert not gone.worse
    assert len(gone.vanished) == len(base.run["tasks"]) - len(fewer.run["tasks"])
    new = compare_records(fewer, base)
    assert (len(new.appeared), new.regressed) == (len(gone.vanished), False)
    apart = only(base, lambda row: row["timestep"] == 0.02)
    none = compare_records(apart, only(base, lambda row: row["timestep"] == 0.01))
    assert none.headline.startswith("Nothing to compare")


def test_what_fails_and_was_never_run_before_appeared(base) -> None:
    fewer = only(base, lambda row: row["engine"] != "dart")
    failing = with_tasks(
        base, lambda e: {**e, "outcome": "crashed", "gates": {}} if e["engine"] == "dart" else e
    )
    found = compare_records(fewer, failing)
    assert not found.regressed
    assert {entry.status for entry in found.appeared} == {"crashed"}


def test_figures_of_another_seed_compare_by_verdict(base) -> None:
    """A wrong engine's residual at random states is another at other states; on the path, not."""
    engine = ("sphere", "mujoco", None, None)
    wrong = {"bound": BOUND, "verdict": "fail", "unit": "1"}
    at_random = ("equation", "omega_dot", "residual")
    on_path = ("equation", "omega_dot", "residual_on_path")
    rows = [metric(*engine, *name, 0.5, **wrong) for name in (at_random, on_path)]
    first = with_metrics(base, *rows)
    second = with_run(edited(first, engine, at_random, value=0.6), seed=8)
    assert not compare_records(first, second).regressed
    assert compare_records(first, edited(second, engine, on_path, value=0.6)).regressed
    same_seed = edited(first, engine, at_random, value=0.6)
    assert compare_records(first, same_seed).regressed


def test_a_scenario_that_is_another_one_compares_by_verdict(base) -> None:
    def heavier(mass):
        scenarios = copy.deepcopy(base.run["scenarios"])
        scenarios[0]["definition"]["body"]["mass"] = mass
        return scenarios

    moved = edited(base, value=value_of(base) + 1.0)
    other = with_run(moved, scenarios=heavier(2.0))
    found = compare_records(base, other)
    assert not found.regressed
    assert found.redefined == {"sphere"}
    reported = [(d.what, d.was, d.now) for d in found.settings]
    assert ("sphere body.mass", "1.0", "2.0") in reported
    assert compare_records(base, edited(other, verdict="fail")).regressed


def test_the_steps_of_a_scenario_do_not_make_it_another_one(base) -> None:
    def with_steps(steps):
        scenarios = copy.deepcopy(base.run["scenarios"])
        scenarios[0]["definition"]["run"] = {"duration": 4.0, "timesteps": steps}
        scenarios[0]["title"] = f"with {len(steps)} steps"
        return with_run(base, scenarios=scenarios)

    assert not compare_records(with_steps([0.1]), with_steps([0.1, 0.2])).redefined


def test_versions_are_an_axis_and_not_a_key(base) -> None:
    """One engine in another version is the same engine; two of them in one record are two."""

    def version(number):
        metrics = base.metrics.with_columns(engine_version=pl.lit(number))
        tasks = [{**entry, "engine_version": number} for entry in base.run["tasks"]]
        return replace(with_run(base, tasks=tasks), metrics=metrics)

    one, two = version("1.0"), version("2.0")
    moved = edited(two, value=value_of(base) + 1.0)
    assert len(compare_records(one, moved).worse) == 1
    both = replace(
        with_run(base, tasks=one.run["tasks"] + two.run["tasks"]),
        metrics=pl.concat([one.metrics, two.metrics]),
    )
    apart = compare_records(both, moved)
    assert len(apart.worse) == 1
    assert apart.worse[0].key.version == "2.0"
    assert len(apart.vanished) == len(base.run["tasks"])


def timed(record, factor, seed, spread=0.2):
    """The record with every step timed anew: at `factor` times its cost, within the spread."""
    noise = np.random.default_rng(seed).uniform(1.0, 1.0 + spread, record.metrics.height)
    cost = pl.col("gate") == "cost"
    value = pl.when(cost).then(pl.col("value") * factor * pl.Series(noise)).otherwise("value")
    return replace(record, metrics=record.metrics.with_columns(value=value))


def test_costs_are_reported_and_never_judged() -> None:
    base = build(scenarios=("a", "b", "c"), samples=4)
    found = compare_records(timed(base, 1.0, 1), timed(base, 50.0, 2))
    assert not found.regressed
    assert {round(cost.median, -1) for cost in found.costs} == {50}
    assert len(found.costs) == 5
    assert all(cost.low <= cost.median <= cost.high for cost in found.costs)


def test_noise_of_timings_is_no_difference() -> None:
    base = build(scenarios=("a", "b", "c"), samples=4)
    for seed in range(10):
        assert not compare_records(timed(base, 1.0, seed), timed(base, 1.0, seed + 99)).costs


def test_timings_that_are_too_few_or_not_repeated_show_no_change(base) -> None:
    assert not compare_records(timed(base, 1.0, 1), timed(base, 50.0, 2)).costs  # two steps of two
    again = build(scenarios=("a", "b", "c"), samples=4)
    assert not compare_records(again, timed(again, 50.0, 2, spread=0.0)).costs  # one value for all


def test_what_an_engine_declares_is_a_difference(base) -> None:
    other = with_run(base, seed=8)
    other.run["engines"][1]["integrators"][0]["scheme"] = "lie-rk4"
    other.run["machine"]["processor"] = "arm64"
    reported = {d.what: (d.was, d.now) for d in compare_records(base, other).settings}
    assert reported["mujoco Euler, declared scheme"] == ("semi-implicit-euler", "lie-rk4")
    assert reported["machine processor"] == ("x86_64", "arm64")
    assert reported["seed"] == ("7", "8")
