"""The summary shows the worst, and claims no more than the record holds."""

from dataclasses import replace

import polars as pl
import pytest
from changed_records import cell, first_of, with_run, with_task
from synthetic_record import INTEGRATORS, build, metric, task, with_metrics

from omegadot.reports.record.record import Record
from omegadot.reports.record.schema import METRICS, OUTCOMES, TRAJECTORIES, empty
from omegadot.reports.summary.headline import headline, remarks
from omegadot.reports.summary.summary import STATUSES, summarise, task_status, worst
from omegadot.reports.text.numbers import short


def test_every_gate_holding_is_a_pass(record):
    found = cell(record, "sphere", "mujoco")
    assert found.status == "pass"
    assert found.runs == {"pass": 6}


@pytest.mark.parametrize("outcome", [term for term in OUTCOMES if term != "ok"])
def test_a_skip_is_never_a_pass(record, outcome):
    changed = with_task(
        record, first_of(record, "dart"), outcome=outcome, reason="because", gates={}
    )
    found = cell(changed, "sphere", "dart")
    assert found.status == outcome
    assert found.runs == {outcome: 1, "pass": 2}
    (missing,) = summarise(changed).missing
    assert (missing.engine, missing.status, missing.reason) == ("dart", outcome, "because")
    assert missing.scenarios == ("sphere",)


def test_the_worst_status_is_shown(record):
    place = first_of(record, "dart")
    declared = with_task(record, place, gates={"equation": "declared", "model": "pass"})
    assert cell(declared, "sphere", "dart").status == "declared"
    skipped = with_task(declared, place + 1, outcome="unsupported", gates={})
    assert cell(skipped, "sphere", "dart").status == "unsupported"
    failed = with_task(skipped, place + 2, gates={"equation": "fail"})
    assert cell(failed, "sphere", "dart").status == "fail"


def test_the_order_of_statuses():
    assert worst(["pass", "declared"]) == "declared"
    assert worst(["declared", "unsupported"]) == "unsupported"
    assert worst(["crashed", "fail"]) == "fail"
    assert worst([]) == "absent"
    assert set(OUTCOMES) - {"ok"} <= set(STATUSES)


def test_a_run_that_was_not_judged_is_not_a_pass():
    measured = task("s", "e", "i", 0.1, gates={"cost": "info"})
    assert task_status(measured) == "not-judged"
    assert task_status(task("s", "e", "i", 0.1, gates={})) == "not-judged"
    assert task_status(task("s", "e", "i", 0.1, gates={"a": "fail"}, outcome="diverged")) == "fail"


def test_a_failing_row_counts_though_its_task_passes(record):
    row = metric("sphere", "dart", None, None, "model", "model", "mass", 1.0, verdict="fail")
    assert cell(with_metrics(record, row), "sphere", "dart").status == "fail"


def test_numbers_name_the_run_they_come_from(record):
    found = cell(record, "spun-again", "mujoco")
    assert found.residual.value == 6.2e-15
    # Each integrator at its finest step, 0.005 s: first and fourth order.
    assert (found.drift.worst.integrator, found.drift.worst.timestep) == ("Euler", 0.005)
    assert found.drift.worst.value == 0.005
    assert (found.drift.best.integrator, found.drift.best.value) == ("RK4", 0.005**4)
    assert found.attitude.worst.unit == "rad"


def test_the_finest_step_counts_and_its_largest_value(record):
    add = ["sphere", "dart", "semi-implicit", 0.005, "invariants", "angular_momentum"]
    more = with_metrics(record, metric(*add, "drift_quarter", 0.7), metric(*add, "other", 9.0))
    assert cell(more, "sphere", "dart").drift.worst.value == 0.7


def test_what_is_not_a_number_is_the_largest(record):
    row = ["sphere", "dart", "semi-implicit", 0.005, "equation", "omega_dot", "residual_on_path"]
    found = cell(with_metrics(record, metric(*row, float("nan"))), "sphere", "dart")
    assert found.residual.metric == "residual_on_path"


def test_versions_and_setups_are_columns_of_their_own(record):
    tasks = [
        *record.run["tasks"],
        task("sphere", "dart", "semi-implicit", 0.01, engine_version="2.0"),
        task("sphere", "mujoco", "Euler", 0.01, setup="as-shipped"),
    ]
    summary = summarise(replace(record, run={**record.run, "tasks": tasks}))
    labels = [column.label for column in summary.columns]
    # The yardstick stands last: the engines are what is judged.
    assert labels == ["mujoco", "dart 1.0", "dart 2.0", "mujoco as-shipped", "reference"]
    assert summary.cells["spun-again", summary.columns[2]].status == "absent"


def test_engines_in_single_precision_are_marked(record):
    engines = [
        e | {"precision": "float32"} if e["name"] == "dart" else e for e in record.run["engines"]
    ]
    summary = summarise(replace(record, run={**record.run, "engines": engines}))
    assert [column.engine for column in summary.columns if column.single] == ["dart"]


def test_an_engine_that_is_not_installed_is_named(record):
    drake = {"name": "drake", "installed": False, "reason": "no module named pydrake"}
    run = {**record.run, "engines": [*record.run["engines"], drake]}
    (missing,) = summarise(replace(record, run=run)).missing
    assert (missing.engine, missing.status, missing.runs) == ("drake", "not-installed", 0)


def test_the_headline_of_a_sound_run(record):
    message = headline(summarise(record))
    assert message.startswith("Both engines agree with the Newton–Euler equations")
    assert "6.2e-15 (mujoco on spun-again)" in message
    (spread,) = remarks(summarise(record))
    assert "spun-again" in spread
    assert "1.5e-9 rad (8.6e-8 deg, mujoco RK4, step 0.005 s)" in spread


def test_a_headline_counts_many_engines_and_lists_few(record):
    """Caught: eighteen names before the first figure."""
    names = [f"engine{number}" for number in range(8)]

    def like_mujoco(rows):
        found = [row for row in rows if row.get("engine", row.get("name")) == "mujoco"]
        key = "engine" if "engine" in found[0] else "name"
        return [*rows, *({**row, key: name} for name in names for row in found)]

    grown = {key: like_mujoco(record.run[key]) for key in ("tasks", "engines")}
    rows = like_mujoco(record.metrics.to_dicts())
    rows = [row for row in rows if (row["engine"], row["gate"]) != ("dart", "equation")]
    metrics = pl.DataFrame(rows, schema=record.metrics.schema)
    summary = summarise(replace(record, run={**record.run, **grown}, metrics=metrics))
    assert headline(summary).startswith("9 of 10 engines agree with the Newton–Euler equations")
    assert "dart holds every gate, and gives no omega-dot at a state." in headline(summary)


def test_a_body_that_cannot_be_is_named_next_to_the_headline(record):
    inertia = [[1.0, 0.0, 0.0], [0.0, 2.0, 0.0], [0.0, 0.0, 3.5]]
    body = {"mass": 1.0, "inertia": inertia, "allow_impossible_inertia": True}
    first, *others = record.run["scenarios"]
    run = {**record.run, "scenarios": [{**first, "definition": {"body": body}}, *others]}
    remark, _ = remarks(summarise(replace(record, run=run)))
    assert remark.startswith(f"{first['name']}: an impossible inertia, allowed on request")
    assert "(3.5 > 3 kg m^2)" in remark


def test_a_process_that_ended_between_requests_is_reported(record):
    """It is no run's outcome, and the command ends with 3 all the same."""
    death = {"engine": "mujoco", "how": "ended by signal 9 (SIGKILL)"}
    found = remarks(summarise(with_run(record, worker_deaths=[death])))
    sentence = "mujoco: its process ended between two requests (ended by signal 9 (SIGKILL))."
    assert sentence in found
    crashed = [{**entry, "outcome": "crashed"} for entry in record.run["tasks"]]
    found = remarks(summarise(with_run(record, worker_deaths=[death], tasks=crashed)))
    assert sentence not in found  # a run of it reports that


def test_an_engine_without_integrators_is_named(record):
    engines = [
        {**e, "integrators": []} if e["name"] == "mujoco" else e for e in record.run["engines"]
    ]
    found = remarks(summarise(with_run(record, engines=engines)))
    assert (
        "mujoco has no integrators: its model and the equations that it offers are judged." in found
    )


def test_the_headline_of_a_failing_run(record):
    failed = with_task(record, first_of(record, "dart"), gates={"equation": "fail"})
    message = headline(summarise(failed))
    assert message == "1 of 2 engines fails: dart, on sphere."


def test_the_headline_of_one_engine_counts_nothing() -> None:
    """Caught: "1 of 1 engine fails"."""
    one = build(("sphere",), engines={"dart": INTEGRATORS["dart"]})
    failed = with_task(one, 0, gates={"equation": "fail"})
    assert headline(summarise(failed)) == "dart fails on sphere."


def test_the_headline_names_which_engine_fails_on_which_scenario(record):
    other = next(t for t in record.run["tasks"] if t["scenario"] != "sphere")
    failed = with_task(record, first_of(record, "dart"), gates={"equation": "fail"})
    mujoco = next(
        n
        for n, t in enumerate(failed.run["tasks"])
        if (t["engine"], t["scenario"]) == ("mujoco", other["scenario"])
    )
    message = headline(summarise(with_task(failed, mujoco, gates={"equation": "fail"})))
    where = f"mujoco (on {other['scenario']}) and dart (on sphere)"
    assert message == f"2 of 2 engines fail: {where}."


def test_a_headline_pairs_each_failing_engine_with_its_own_scenarios():
    """Caught: "dart and mujoco, on sphere and t-handle", of which each engine fails on one."""
    names = [f"scenario-{k}" for k in range(5)]
    record = build(names)

    def failing(*pairs):
        failed = record
        for place, entry in enumerate(record.run["tasks"]):
            if (entry["engine"], entry["scenario"]) in pairs:
                failed = with_task(failed, place, gates={"equation": "fail"})
        return headline(summarise(failed)).partition(": ")[2]

    apart = failing(("dart", names[1]), ("mujoco", names[0]))
    assert "dart (on scenario-1)" in apart
    assert "mujoco (on scenario-0)" in apart
    alike = failing(*((engine, names[0]) for engine in ("dart", "mujoco")))
    assert alike.endswith(", on scenario-0.")
    assert "(" not in alike
    many = failing(("dart", names[0]), *(("mujoco", name) for name in names[:4]))
    assert "scenario" not in many


def both_setups(record):
    """The record with every engine but the reference in a second setup."""
    tasks = [*record.run["tasks"]]
    tasks += [{**t, "setup": "as-shipped"} for t in tasks if t["engine"] != "reference"]
    other = record.metrics.filter(pl.col("engine") != "reference")
    shipped = other.with_columns(setup=pl.lit("as-shipped"))
    run = {**record.run, "tasks": tasks}
    return replace(record, run=run, metrics=pl.concat([record.metrics, shipped]))


def failing_in(record, engine, *setups):
    for place, entry in enumerate(record.run["tasks"]):
        who = entry["engine"], entry.get("setup") or "physics", entry["scenario"]
        if who in [(engine, setup, "sphere") for setup in setups]:
            record = with_task(record, place, gates={"equation": "fail"})
    return record


def test_a_headline_counts_an_engine_in_two_setups_once(record):
    """Caught: "2 of 4 engines fail" of two engines in two setups."""
    both = both_setups(record)
    assert headline(summarise(both)).startswith("Both engines agree with the Newton–Euler")

    def message(engine, *setups):
        return headline(summarise(failing_in(both, engine, *setups)))

    assert message("dart", "as-shipped") == "1 of 2 engines fails: dart as-shipped, on sphere."
    assert message("dart", "physics") == (
        "1 of 2 engines fails: dart set up for physics, on sphere."
    )
    assert message("dart", "physics", "as-shipped") == "1 of 2 engines fails: dart, on sphere."


def test_a_headline_of_one_engine_in_two_setups_counts_nothing():
    both = both_setups(build(("sphere",), engines={"dart": INTEGRATORS["dart"]}))
    assert headline(summarise(both)).startswith("dart agrees with")
    shipped = headline(summarise(failing_in(both, "dart", "as-shipped")))
    assert shipped == "dart as-shipped fails on sphere."


def test_an_engine_that_ran_in_one_setup_alone_does_not_agree_in_both(record):
    both = both_setups(record)
    for place, entry in enumerate(both.run["tasks"]):
        if (entry["engine"], entry.get("setup")) == ("dart", "as-shipped"):
            both = with_task(both, place, outcome="crashed", gates={})
    message = headline(summarise(both))
    assert message.startswith("mujoco and dart set up for physics (of 2 engines) agree with")
    assert message.endswith("No verdict on dart as-shipped (crashed).")


def test_an_engine_without_a_verdict_does_not_agree(record):
    crashed = record
    for place, entry in enumerate(record.run["tasks"]):
        if entry["engine"] == "dart":
            crashed = with_task(crashed, place, outcome="crashed", gates={})
    message = headline(summarise(crashed))
    assert message.startswith("mujoco (of 2 engines) agrees")
    assert "6 of 30 runs gave no verdict; the reasons are listed." in remarks(summarise(crashed))


def test_a_partial_and_an_empty_record():
    run = {"schema": 1, "complete": False, "engines": [], "scenarios": [], "tasks": []}
    summary = summarise(Record(run, empty(METRICS), empty(TRAJECTORIES)))
    assert headline(summary).startswith("No verdict")
    assert remarks(summary) == ["Partial record: the run was interrupted."]


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (None, "–"),
        (float("nan"), "not finite"),
        (float("inf"), "not finite"),
        (0.0, "0"),
        (3.14e-15, "3.1e-15"),
        (2.0, "2"),
        (-0.05, "-0.05"),
        (1.5e12, "1.5e12"),
    ],
)
def test_numbers_are_short_and_never_hide_what_is_not_one(value, text):
    assert short(value) == text
