"""The accuracy sentence: what is far off though every gate holds, and what to do about it."""

import pytest
from changed_records import cell, first_of, with_run, with_task
from synthetic_record import INTEGRATORS, build, metric, with_metrics

from omegadot.reports.page.glance import _largest, glances
from omegadot.reports.page.page import draw_page
from omegadot.reports.page.templating import arguments
from omegadot.reports.run_record import TaskResult
from omegadot.reports.summary.figures import Figure
from omegadot.reports.summary.headline import headline, remarks
from omegadot.reports.summary.matrix import shown
from omegadot.reports.summary.provenance import Sources
from omegadot.reports.summary.summary import summarise
from omegadot.reports.text.markdown import markdown_of
from omegadot.reports.text.terminal import print_summary


def large(record, size=2.0):
    """The record with DART's attitude error on one scenario so large, at its finest step."""
    where = ["sphere", "dart", "semi-implicit", 0.005, "trajectory", "attitude"]
    more = {"unit": "rad", "note": "explained by semi-implicit-euler, to 1e-11"}
    engines = [{**e, "argument": e["name"]} for e in record.run["engines"]]
    return with_metrics(
        with_run(record, engines=engines), metric(*where, "error_max", size, **more)
    )


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
    failed = with_task(large(record), first_of(record, "mujoco"), gates={"equation": "fail"})
    assert summarise(failed).accuracy is None


def test_of_many_engines_of_one_order_the_worst_is_named(record):
    """Caught: a paragraph that lists the integrators of eighteen engines."""
    where, more = ["sphere", "semi-implicit"], {"unit": "rad", "note": "explained"}
    names = [f"engine{number}" for number in range(5)]
    dart = [task for task in record.run["tasks"] if task["engine"] == "dart"]
    engine = next(e for e in record.run["engines"] if e["name"] == "dart")
    engines = [*record.run["engines"], *({**engine, "name": name} for name in names)]
    tasks = [*record.run["tasks"], *({**task, "engine": name} for name in names for task in dart)]
    errors = [
        metric(where[0], name, where[1], 0.005, "trajectory", "attitude", "error_max", size, **more)
        for size, name in enumerate(names, 2)
    ]
    advice = summarise(
        with_metrics(with_run(record, engines=engines, tasks=tasks), *errors)
    ).accuracy
    assert (
        "order 1 (7 engines, engine4 semi-implicit is worst) is off by up to 6 rad" in advice.text
    )
    assert "order 4 (mujoco RK4) by" in advice.text


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
    failed = with_task(large(record), first_of(record, "dart"), gates={"equation": "fail"})
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
    failed = with_task(record, first_of(record, "dart"), gates={"equation": gates})
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
    failed = with_task(record, first_of(record, "dart"), gates={"equation": "fail"})
    after = [m for m in remarks(summarise(failed)) if "attitude error" in m]
    assert all(m.startswith("Of the engines that pass, at the finest step") for m in after)
    assert not any("dart" in m for m in after)


def test_a_failing_yardstick_is_not_hidden(record):
    failed = with_task(record, first_of(record, "reference"), gates={"equation": "fail"})
    assert "reference" in headline(summarise(failed))


def test_yardsticks_alone_are_reported():
    alone = build(engines={"reference": INTEGRATORS["reference"]})
    assert headline(summarise(alone)).startswith("reference agrees")


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
