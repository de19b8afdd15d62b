"""The terminal's table: whole where there is room, honest where there is none."""

import io
from dataclasses import replace

import pytest
from rich.console import Console
from synthetic_record import INTEGRATORS, build

from omegadot.reports.text.terminal import print_summary

FIVE = dict.fromkeys(("reference", "mujoco", "pinocchio", "dart", "drake"), INTEGRATORS["mujoco"])
NAMES = ("sleeping-top-unstable", "sphere")


def printed(record, width, encoding="utf-8"):
    raw = io.BytesIO()
    file = io.TextIOWrapper(raw, encoding=encoding)
    print_summary(record, Console(file=file, width=width))
    file.flush()
    return raw.getvalue().decode(encoding)


def row(text, name):
    return next(line for line in text.splitlines() if line.startswith(name))


@pytest.mark.parametrize(("engines", "width"), [(4, 132), (5, 160)])
def test_all_three_numbers_fit_below_their_headings(engines, width):
    some = dict(list(FIVE.items())[:engines])
    text = printed(build(NAMES, engines=some), width)
    assert row(text, "sphere").count("✓ 6e-15    0.005 0.01") == engines
    assert text.count("residual drift attitude") == engines
    assert max(map(len, text.splitlines())) <= width


@pytest.mark.parametrize("width", [45, 60, 80, 100])
def test_verdicts_survive_a_narrow_terminal(width):
    text = printed(build(NAMES, engines=FIVE), width)
    assert row(text, "sphere").count("✓") == 5
    assert max(map(len, text.splitlines())) <= width


def test_where_one_number_fits_it_is_named_at_the_left():
    text = printed(build(NAMES, engines=FIVE), 80)
    assert row(text, "sphere").count("✓ 6e-15 ") == 5
    assert text.splitlines()[1].rstrip() == "omega-dot residual"


def test_runs_of_the_yardsticks_are_counted_apart():
    text = printed(build(NAMES, engines=dict(list(FIVE.items())[:2])), 120)
    assert "12 runs: 12 pass; 12 runs of exact and reference: 12 pass" in text
    alone = printed(build(NAMES, engines=dict(list(FIVE.items())[:1])), 120)
    assert "12 runs: 12 pass\n" in alone
    assert " of exact and reference" not in alone


def test_piped_output_is_plain_and_whole(capsys, record):
    print_summary(record)
    text = capsys.readouterr().out
    assert "\x1b" not in text
    assert row(text, "sphere").count("3e-15") == 3
    assert "18 runs: 18 pass; 12 runs of exact and reference: 12 pass" in text
    assert "Both engines agree" in text


def test_an_encoding_without_signs(record):
    tasks = [dict(entry) for entry in record.run["tasks"]]
    tasks[0]["gates"] = {"model": "fail"}
    text = printed(replace(record, run={**record.run, "tasks": tasks}), 120, "latin-1")
    assert "ok 3e-15" in text
    assert "FAIL model" in text


def test_what_did_not_run_has_its_outcome_and_reason(record):
    tasks = [dict(entry) for entry in record.run["tasks"]]
    tasks[-1].update(outcome="crashed", reason="signal 9 [bold]", gates={})
    drake = {"name": "drake", "installed": False, "reason": "no pydrake"}
    run = {**record.run, "tasks": tasks, "engines": [*record.run["engines"], drake]}
    text = printed(replace(record, run=run), 160)
    assert "crashed 2/3" in row(text, "spun-again")
    assert "dart: crashed, 1 run on spun-again: signal 9 [bold]" in text
    assert "drake: not-installed: no pydrake" in text
    assert "1 crashed" in text


def test_runs_that_were_not_made_hide_no_numbers_of_the_others(record):
    """Caught: a cell with one unsupported run of three shows nothing that the two measured."""
    tasks = [dict(entry) for entry in record.run["tasks"]]
    whole = row(printed(record, 160), "spun-again")
    tasks[-1].update(outcome="unsupported", reason="three angles", gates={})
    found = row(printed(replace(record, run={**record.run, "tasks": tasks}), 160), "spun-again")
    numbers = whole.rsplit("✓", 1)[1].split()
    assert found.rsplit("unsupported 2/3", 1)[1].split()[:3] == numbers
    assert len(numbers) == 3


def test_an_empty_record_is_reported_as_such(record):
    run = {**record.run, "tasks": [], "scenarios": [], "engines": []}
    text = printed(replace(record, run=run, metrics=record.metrics.clear()), 80)
    assert "No run was made." in text


@pytest.mark.parametrize("width", [90, 160])
def test_many_engines_have_a_row_each_and_share_a_reason(width):
    """A column each would be cut off; a reason of many engines would be as many lines."""
    many = {f"engine-{letter}": INTEGRATORS["mujoco"] for letter in "abcdefghij"}
    record = build(NAMES, engines=many)
    tasks = [dict(entry) for entry in record.run["tasks"]]
    for task in tasks:
        if task["engine"] in ("engine-b", "engine-d") and task["scenario"] == "sphere":
            reason = f"{task['engine']} has no such bodies"
            task.update(outcome="unsupported", reason=reason, gates={})
    text = printed(replace(record, run={**record.run, "tasks": tasks}), width)
    assert max(map(len, text.splitlines())) <= width
    assert row(text, "engine-a").split()[1:3] == ["2", "6e-15"]
    assert row(text, "engine-b").split()[1:3] == ["1", "1"]
    lines = " ".join(text.split())
    shared = "engine-b and engine-d: unsupported, 6 runs each on sphere: the engine has no such"
    assert lines.count(shared) == lines.count("has no such bodies") == 1
