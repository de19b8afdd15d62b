"""The summary shows the worst, and claims no more than the record holds."""

from dataclasses import replace

import pytest
from synthetic_record import INTEGRATORS, build, metric, task, with_metrics

from omegadot.reports.page.glance import _largest, glances
from omegadot.reports.page.page import draw_page
from omegadot.reports.page.templating import arguments
from omegadot.reports.record.record import Record
from omegadot.reports.record.schema import METRICS, OUTCOMES, TRAJECTORIES, empty
from omegadot.reports.run_record import TaskResult
from omegadot.reports.summary.figures import Figure
from omegadot.reports.summary.headline import headline, remarks
from omegadot.reports.summary.matrix import shown
from omegadot.reports.summary.provenance import Sources
from omegadot.reports.summary.summary import STATUSES, summarise, task_status, worst
from omegadot.reports.text.markdown import markdown_of
from omegadot.reports.text.numbers import short
from omegadot.reports.text.terminal import print_summary


def cell(record, scenario, engine):
    summary = summarise(record)
    (column,) = [c for c in summary.columns if c.label == engine]
    return summary.cells[scenario, column]


def change(record, place, **more):
    tasks = [dict(entry) for entry in record.run["tasks"]]
    tasks[place].update(more)
    return replace(record, run={**record.run, "tasks": tasks})


def edited(record, **entries):
    return replace(record, run={**record.run, **entries})


def first_of(record, engine):
    return next(k for k, entry in enumerate(record.run["tasks"]) if entry["engine"] == engine)


def test_every_gate_holding_is_a_pass(record):
    found = cell(record, "sphere", "mujoco")
    assert found.status == "pass"
    assert found.runs == {"pass": 6}


@pytest.mark.parametrize("outcome", [term for term in OUTCOMES if term != "ok"])
def test_a_skip_is_never_a_pass(record, outcome):
    changed = change(record, first_of(record, "dart"), outcome=outcome, reason="because", gates={})
    found = cell(changed, "sphere", "dart")
    assert found.status == outcome
    assert found.runs == {outcome: 1, "pass": 2}
    (missing,) = summarise(changed).missing
    assert (missing.engine, missing.status, missing.reason) == ("dart", outcome, "because")
    assert missing.scenarios == ("sphere",)


def test_the_worst_status_is_shown(record):
    place = first_of(record, "dart")
    declared = change(record, place, gates={"equation": "declared", "model": "pass"})
    assert cell(declared, "sphere", "dart").status == "declared"
    skipped = change(declared, place + 1, outcome="unsupported", gates={})
    assert cell(skipped, "sphere", "dart").status == "unsupported"
    failed = change(skipped, place + 2, gates={"equation": "fail"})
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
    found = remarks(summarise(edited(record, worker_deaths=[death])))
    sentence = "mujoco: its process ended between two requests (ended by signal 9 (SIGKILL))."
    assert sentence in found
    crashed = [{**entry, "outcome": "crashed"} for entry in record.run["tasks"]]
    found = remarks(summarise(edited(record, worker_deaths=[death], tasks=crashed)))
    assert sentence not in found  # a run of it reports that


def test_an_engine_without_integrators_is_named(record):
    engines = [
        {**e, "integrators": []} if e["name"] == "mujoco" else e for e in record.run["engines"]
    ]
    found = remarks(summarise(edited(record, engines=engines)))
    assert (
        "mujoco has no integrators: its model and the equations that it offers are judged." in found
    )


def test_the_headline_of_a_failing_run(record):
    failed = change(record, first_of(record, "dart"), gates={"equation": "fail"})
    message = headline(summarise(failed))
    assert message == "1 of 2 engines fails: dart, on sphere."


def test_the_headline_of_one_engine_counts_nothing() -> None:
    """Caught: "1 of 1 engine fails"."""
    one = build(("sphere",), engines={"dart": INTEGRATORS["dart"]})
    failed = change(one, 0, gates={"equation": "fail"})
    assert headline(summarise(failed)) == "dart fails on sphere."


def test_the_headline_names_which_engine_fails_on_which_scenario(record):
    other = next(t for t in record.run["tasks"] if t["scenario"] != "sphere")
    failed = change(record, first_of(record, "dart"), gates={"equation": "fail"})
    mujoco = next(
        n
        for n, t in enumerate(failed.run["tasks"])
        if (t["engine"], t["scenario"]) == ("mujoco", other["scenario"])
    )
    message = headline(summarise(change(failed, mujoco, gates={"equation": "fail"})))
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
                failed = change(failed, place, gates={"equation": "fail"})
        return headline(summarise(failed)).partition(": ")[2]

    apart = failing(("dart", names[1]), ("mujoco", names[0]))
    assert "dart (on scenario-1)" in apart
    assert "mujoco (on scenario-0)" in apart
    alike = failing(*((engine, names[0]) for engine in ("dart", "mujoco")))
    assert alike.endswith(", on scenario-0.")
    assert "(" not in alike
    many = failing(("dart", names[0]), *(("mujoco", name) for name in names[:4]))
    assert "scenario" not in many


def large(record, size=2.0):
    """The record with DART's attitude error on one scenario so large, at its finest step."""
    where = ["sphere", "dart", "semi-implicit", 0.005, "trajectory", "attitude"]
    more = {"unit": "rad", "note": "explained by semi-implicit-euler, to 1e-11"}
    engines = [{**e, "argument": e["name"]} for e in record.run["engines"]]
    return with_metrics(edited(record, engines=engines), metric(*where, "error_max", size, **more))


def test_a_large_error_of_sound_engines_is_said_and_what_to_do(record, capsys):
    """Caught: a tick, "all engines agree", and an attitude that is upside down."""
    summary = summarise(large(record))
    advice = summary.accuracy
    assert advice.sentence == (
        "Sound, not necessarily accurate: on sphere, step 0.005 s, order 1 (dart semi-implicit, "
        "mujoco Euler) is off by up to 2 rad (115 deg); order 4 (mujoco RK4) by 7.5e-10 rad "
        "(4.3e-8 deg). The reason is the step, too coarse for order 1 here; the equations hold. "
        "omegadot choose sphere --attitude 1deg finds an engine and a step that suffice."
    )
    assert not any("attitude error" in remark for remark in remarks(summary))  # said once
    page = draw_page(large(record)).replace("\u2060", "")
    assert page.index("<h1>") < page.index(advice.text) < page.index('id="verdicts"')
    assert f"<code>{arguments(advice.command)}</code>" in page
    print_summary(large(record))
    assert advice.sentence in " ".join(capsys.readouterr().out.split())
    assert advice.text in markdown_of(large(record)).replace("\\", "")
    assert summarise(large(record, 0.017)).accuracy is None  # below a degree
    failed = change(large(record), first_of(record, "mujoco"), gates={"equation": "fail"})
    assert summarise(failed).accuracy is None


def test_a_large_drift_is_said_where_the_attitude_is_right(record):
    where = ["sphere", "dart", "semi-implicit", 0.005, "invariants", "angular_momentum"]
    advice = summarise(with_metrics(record, metric(*where, "drift_full", 0.03))).accuracy
    assert (
        "order 1 (dart semi-implicit, mujoco Euler) has an angular momentum off by" in advice.text
    )
    assert "off by up to 3 %; order 4 (mujoco RK4) by" in advice.text
    assert advice.command.startswith("omegadot choose sphere --momentum-drift 0.01")


def test_a_pass_that_is_far_off_stands_out(record):
    """Caught: a green tick, and nothing else, for a run that is upside down."""
    for size, shown_ in ((2.0, "115 deg off"), (0.9, "")):
        found = large(record, size)
        cells = {c.engine: own for (name, c), own in summarise(found).cells.items() if own.far_off}
        assert [own.far_off for own in cells.values()] == [shown_] * bool(shown_)
        rows = glances(summarise(found), found.metrics, Sources())
        assert [row["far_off"] for row in rows if row["engine"].startswith("dart")] == [shown_]
        page = draw_page(found)
        assert page.count("115 deg off") == 2 * bool(shown_)  # in the table and in the matrix
    failed = change(large(record), first_of(record, "dart"), gates={"equation": "fail"})
    assert cell(failed, "sphere", "dart").far_off == ""


def test_the_reason_of_one_coarse_run_is_its_step():
    """Caught: "off by 180 deg" without a reason, and a choice among the one engine alone."""
    found = large(build(("sphere",), engines={"dart": INTEGRATORS["dart"]}))
    advice = summarise(found).accuracy
    assert "order 1 (dart semi-implicit) is off by 2 rad" in advice.text
    assert advice.text.endswith(
        "The reason is the step, too coarse for order 1 here; the equations hold."
    )
    assert advice.command == "omegadot choose sphere --attitude 1deg"


def test_an_engine_of_ones_own_is_in_the_command(record):
    found = large(build(("sphere",), engines={"dart": INTEGRATORS["dart"]}))
    found.run["engines"][0]["argument"] = "my dart.py:Dart"
    assert summarise(found).accuracy.command == (
        "omegadot choose sphere --attitude 1deg --adapter 'my dart.py:Dart'"
    )


def test_of_one_step_none_is_the_finest(record):
    """Caught: "at the finest step" of a run with one, and no word on the orders that it lacks."""
    one = build(steps=(0.005,))
    assert summarise(one).one_step
    assert not summarise(record).one_step
    (spread,) = remarks(summarise(one))
    assert "At the one step the attitude error" in spread
    for found, shown_ in ((one, True), (record, False)):
        page = draw_page(found)
        assert ("no order can be observed" in page) is shown_
        assert ("at the one step, which shows no order" in page) is shown_


def test_an_engine_shows_its_largest_error_and_where() -> None:
    """Caught: a median, which hides the scenario on which the engine fails or is no use."""
    errors = {"a": 1e-7, "b": 1e-7, "c": 3.1}
    figures = [Figure(v, "rad", s, "dart", "error_max", "RK4", 0.01) for s, v in errors.items()]
    assert _largest(figures) == (
        *("3.1 rad (178 deg)", "step 0.01 s; median of 3 scenarios 1e-7 rad", "RK4, on c"),
    )
    assert _largest(figures[:1]) == ("1e-7 rad (5.7e-6 deg)", "step 0.01 s", "RK4, on a")


@pytest.mark.parametrize(("gates", "text"), [("fail", "1 of 3 runs fail"), ("info", "2 of 3 runs")])
def test_runs_are_counted_in_one_sense(record, gates, text):
    """Caught: "fail 0 of 6 runs pass" beside "fail 6 of 18 runs"."""
    failed = change(record, first_of(record, "dart"), gates={"equation": gates})
    found = cell(failed, "sphere", "dart")
    assert shown(found).part.startswith(text)
    assert shown(cell(failed, "sphere", "mujoco")).part == ""
    rows = glances(summarise(failed), failed.metrics, Sources())
    runs = {row["engine"].split()[0]: row["runs"] for row in rows}
    if gates == "fail":
        assert runs == {"dart": "1 of 6 runs fail", "mujoco": "12 of 12 runs pass"}


def test_an_accuracy_is_that_of_engines_that_pass(record):
    """Caught: a range whose one end is what a failing engine did."""
    before = next(m for m in remarks(summarise(record)) if "attitude error" in m)
    assert "the finest step the attitude error" in before
    failed = change(record, first_of(record, "dart"), gates={"equation": "fail"})
    after = [m for m in remarks(summarise(failed)) if "attitude error" in m]
    assert all(m.startswith("Of the engines that pass, at the finest step") for m in after)
    assert not any("dart" in m for m in after)


def test_a_failing_yardstick_is_not_hidden(record):
    failed = change(record, first_of(record, "reference"), gates={"equation": "fail"})
    assert "reference" in headline(summarise(failed))


def test_an_engine_without_a_verdict_does_not_agree(record):
    crashed = record
    for place, entry in enumerate(record.run["tasks"]):
        if entry["engine"] == "dart":
            crashed = change(crashed, place, outcome="crashed", gates={})
    message = headline(summarise(crashed))
    assert message.startswith("mujoco (of 2 engines) agrees")
    assert "6 of 30 runs gave no verdict; the reasons are listed." in remarks(summarise(crashed))


def test_a_partial_and_an_empty_record():
    run = {"schema": 1, "complete": False, "engines": [], "scenarios": [], "tasks": []}
    summary = summarise(Record(run, empty(METRICS), empty(TRAJECTORIES)))
    assert headline(summary).startswith("No verdict")
    assert remarks(summary) == ["Partial record: the run was interrupted."]


def test_yardsticks_alone_are_reported():
    alone = build(engines={"reference": INTEGRATORS["reference"]})
    assert headline(summarise(alone)).startswith("reference agrees")


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


def test_integrators_that_do_as_well_make_no_spread():
    one = build(("sphere",), engines={"dart": INTEGRATORS["dart"]})
    assert remarks(summarise(one)) == []
    assert headline(summarise(one)).startswith("dart agrees")


@pytest.mark.parametrize(("trajectory", "failed"), [("info", False), ("fail", True)])
def test_a_run_that_diverges_fails_only_with_a_gate(trajectory: str, failed: bool) -> None:
    """Caught: exit code 1 for a step at which every scheme of this kind blows up."""
    gates = {"model": "pass", "equation": "pass", "trajectory": trajectory}
    who = ("t-handle", "dart", "6.20", "physics", "semi-implicit", 0.2, None)
    assert TaskResult(*who, "diverged", "", gates, "", None).failed is failed


def test_an_error_that_is_no_number_has_no_size(record):
    """Caught: "is off by up to not finite", of a run that blows up at a coarse step."""
    sentence = summarise(large(record, float("inf"))).accuracy.sentence
    assert "(dart semi-implicit) leaves the range of numbers" in sentence
    assert "not finite" not in sentence
