"""Who gave a number, and what must stand in the command that gives it again."""

from synthetic_record import build, metric, with_metrics

from omegadot.reports.page.glance import glances
from omegadot.reports.page.tables import deviation_table, engine_table, run_table
from omegadot.reports.summary import matrix
from omegadot.reports.summary.provenance import Sources, command_of, provenance_payload, sources_for
from omegadot.reports.summary.summary import summarise


def run(*arguments, names=("sphere", "spun")):
    return {"command": ["omegadot", "run", *arguments], "scenarios": [{"name": n} for n in names]}


def payload_of(given):
    return provenance_payload(given, Sources(), {e["name"]: e["name"] for e in given["scenarios"]})


def requested_as(given):
    return dict(payload_of(given)["scenarios"].values())


def test_a_scenario_of_a_file_is_requested_by_its_path():
    given = run("--engine", "mujoco", "a folder/sphere.toml", "--timestep=0.1", "spun")
    assert requested_as(given) == {"sphere": "a folder/sphere.toml", "spun": "spun"}


def test_where_nothing_or_something_else_was_requested_the_name_stands():
    assert requested_as(run()) == {"sphere": "sphere", "spun": "spun"}
    assert requested_as(run("one")) == {"sphere": "sphere", "spun": "spun"}
    assert requested_as({"scenarios": [{"name": "x"}]}) == {"x": "x"}


def test_options_that_change_what_is_computed_are_kept():
    given = run("--adapter", "mine.py:Mine", "--out", "x", "--timestep", "0.1", "--timestep=0.2")
    assert payload_of(given)["options"] == ["--adapter", "mine.py:Mine"]
    assert payload_of(given)["steps"] == ["0.1", "0.2"]
    assert command_of(given).startswith("omegadot run --adapter mine.py:Mine --out x")


def test_a_source_has_one_number_and_the_engine_s_version():
    sources = sources_for([{"name": "mujoco", "version": "4.0.0"}])
    row = {"engine": "mujoco", "integrator": "RK4", "timestep": 0.01, "gate": "cost"}
    assert sources.number(row) == sources.number(row) == 0
    assert sources.number({**row, "engine_version": "3.0"}) == 1
    found = provenance_payload(run("sphere", "spun"), sources, {"sphere": "a", "spun": "b"})
    assert found["sources"][0] == ["mujoco", "4.0.0", "physics", "RK4", 0.01, None]
    assert found["scenarios"] == {"a": ["sphere", "sphere"], "b": ["spun", "spun"]}
    assert found["requested"] == ["sphere", "spun"]


def test_rows_of_all_tables_name_one_and_the_same_run(record):
    sources = sources_for(record.run["engines"])
    own = record.metrics.filter(record.metrics["scenario"] == "sphere")
    tasks = [task for task in record.run["tasks"] if task["scenario"] == "sphere"]
    from omegadot.reports.charts.deviations import chart_deviations

    runs = run_table(own, tasks, sources).rows
    all_series = deviation_table(chart_deviations(record)["sphere"], sources).rows
    assert {row.heads: row.source for row in runs} == {row.heads: row.source for row in all_series}
    assert len({row.source for row in runs}) == len(runs)
    listed = list(sources.numbers)
    for row in engine_table(own, sources).rows:
        if row.source < len(listed):
            assert listed[row.source].integrator is None


def test_cards_follow_the_matrix_and_name_the_runs_of_its_numbers(record):
    summary, sources = summarise(record), Sources()
    cells = [shown for _, row in matrix.matrix(summary) for shown in row]
    found = matrix.cards(summary, sources, {"sphere": "one", "spun-again": "two"})
    assert [cell.card for cell in cells] == list(range(len(found)))
    place = next(k for k, c in enumerate(summary.columns) if c.engine == "mujoco")
    anchor, status, part, numbers, own = found[place]
    listed = list(sources.numbers)
    assert (anchor, status, part, listed[own].integrator) == ("one", "pass", "", None)
    drift = {what: listed[source] for what, _, source in numbers if "drift" in what}
    assert [(s.integrator, s.timestep) for s in drift.values()] == [
        ("RK4", 0.005),
        ("Euler", 0.005),
    ]


def test_each_engine_in_one_row(record):
    found = {g["engine"]: g for g in glances(summarise(record), record.metrics, Sources())}
    assert list(found) == ["mujoco 1.0", "dart 1.0"]
    mujoco = found["mujoco 1.0"]
    assert (mujoco["status"], mujoco["runs"]) == ("pass", "12 of 12 runs pass")
    assert mujoco["residual"] == ("6.2e-15", "on spun-again; bound 1e-13")
    # Of the two scenarios the errors are 1.2 h^4 and twice that: the larger one is shown.
    shown, details, where = mujoco["best"]
    assert shown.startswith(f"{2.0 * 1.2 * 0.005**4:.1e}".replace("e-0", "e-") + " rad (")
    assert details.startswith("step 0.005 s; median of 2 scenarios")
    assert where == "RK4, on spun-again"
    assert mujoco["error_source"] == (
        "truncation error of the scheme",
        "equals the declared scheme in all 12 runs",
    )
    assert mujoco["cost"][0] == "2 … 2 µs"


def test_a_failed_gate_is_the_source_of_error_though_every_scheme_matches(record):
    add = ["sphere", "dart", None, None, "equation", "omega_dot", "residual"]
    broken = with_metrics(record, metric(*add, 0.1, bound=1e-13, verdict="fail"))
    found = {g["engine"]: g for g in glances(summarise(broken), broken.metrics, Sources())}
    assert found["dart 1.0"]["error_source"] == (
        "a fault: equation gate fails",
        "equals the declared scheme in all 6 runs",
    )


def test_an_engine_that_does_not_step_its_scheme_is_not_excused():
    record = build(("sphere",), steps=(0.02, 0.01))
    import polars as pl

    wrong = (pl.col("engine") == "dart") & (pl.col("metric") == "match")
    metrics = record.metrics.with_columns(
        verdict=pl.when(wrong & (pl.col("timestep") == 0.01))
        .then(pl.lit("fail"))
        .otherwise("verdict")
    )
    found = {g["engine"]: g for g in glances(summarise(record), metrics, Sources())}
    assert found["dart 1.0"]["error_source"] == (
        "a fault: scheme gate fails",
        "equals the declared scheme in 1 of 2 runs",
    )
