"""A comparison of two records as text, comment, JSON and page."""

from __future__ import annotations

import json
from dataclasses import replace

import polars as pl
import pytest
from axe_check import LOOKS, violations
from changed_records import BOUND, RUN, SMALL, edited, value_of, with_run, with_tasks
from chromium import Chromium
from comment import active
from synthetic_record import build

from omegadot.reports.record.run_json import dump_json
from omegadot.reports.two_runs.comparison import compare_records
from omegadot.reports.two_runs.page import draw_two_runs
from omegadot.reports.two_runs.text import as_json, as_markdown, as_text

HOSTILE = "<img src=x onerror=alert(1)>|`@octocat` #1 [a](https://example.org) *b*"


@pytest.fixture(scope="module")
def base():
    return build(**SMALL)


def hostile_records():
    """Names and reasons that would be markup, links and mentions; and very many of them."""
    names = tuple(f"{HOSTILE} {number}" for number in range(20))
    engines = {f"{HOSTILE} {e}": {f"{HOSTILE} {i}": 1 for i in range(4)} for e in range(3)}
    base = build(scenarios=names, engines=engines, steps=(0.02,), samples=2)
    broken = base.metrics.with_columns(value=pl.col("value") + 1.0, note=pl.lit(HOSTILE * 40))
    return base, with_tasks(
        replace(base, metrics=broken),
        lambda e: {**e, "outcome": "raised", "gates": {}, "reason": HOSTILE * 40},
    )


def test_hostile_names_stay_text_and_comments_stay_short() -> None:
    found = compare_records(*hostile_records(), (HOSTILE, HOSTILE))
    message = as_markdown(found)
    assert len(message.encode()) < 65_536
    assert not active(message)
    page = draw_two_runs(found)
    assert "<img" not in page
    assert "://" not in page
    assert "<script" not in page
    assert "\x1b" not in as_text(compare_records(*hostile_records(), ("\x1b[31m", "b")))


def test_the_page_shows_both_numbers_and_the_change(base) -> None:
    moved = edited(base, value=value_of(base) + 1.0, verdict="fail")
    page = draw_two_runs(compare_records(base, moved, ("old", "new")))
    cells = [part for part in page.split("<td") if "✓ pass → ✗ fail" in part]
    assert len(cells) == 1
    assert 'class="m-worse"' in cells[0]
    assert "1 worse" in cells[0]
    assert "no change" in page
    assert page.count("<h2") == 4  # runs, verdicts, worse, method


def test_everything_is_in_the_json(base) -> None:
    moved = edited(base, value=float("nan"), verdict="fail")
    found = json.loads(dump_json(as_json(compare_records(base, moved))))
    (change,) = found["worse"]
    assert found["regressed"] is True
    assert (change["scenario"], change["engine"], change["integrator"]) == RUN[:3]
    assert (change["value_was"], change["value_now"]) == (value_of(base), None)
    assert change["band"] == pytest.approx(2 * BOUND)


def test_what_appeared_and_vanished_has_integrators_and_steps(base) -> None:
    """Caught: an engine whose RK4 alone vanished, in a row that names the engine only."""
    engine, integrator = RUN[1], RUN[2]
    gone = [e for e in base.run["tasks"] if (e["engine"], e["integrator"]) != (engine, integrator)]
    fewer = with_run(base, tasks=gone)
    steps = [f"step {step} s" for step in SMALL["steps"]]
    for pair, term in (((base, fewer), "Vanished"), ((fewer, base), "Appeared")):
        found = compare_records(*pair)
        line = as_text(found).split(f"{term}\n")[1].splitlines()[0]
        row = next(line for line in as_markdown(found).splitlines() if f"| {integrator} |" in line)
        cells = draw_two_runs(found).split(f'id="{term.lower()}"')[1].split("</table>")[0]
        for text in (" ".join(part.split()) for part in (line, row, cells)):
            assert all(name in text for name in (engine, integrator, *steps)), text
        assert f"{len(base.run['tasks']) - len(gone)} runs" in line


def test_a_seed_that_no_float_holds_is_shown(base) -> None:
    found = compare_records(base, with_run(base, seed=10**400))
    assert "beyond 1e308" in as_text(found)
    assert draw_two_runs(found)


@LOOKS
def test_axe_finds_nothing_on_the_page(base, tmp_path, look):
    worse = edited(base, value=value_of(base) * 3 + 1, verdict="fail")
    fewer = with_run(worse, tasks=worse.run["tasks"][:-2])
    page = tmp_path / "two-runs.html"
    page.write_text(draw_two_runs(compare_records(base, fewer)), encoding="utf-8")
    with Chromium(tmp_path / "profile") as browser:
        assert violations(browser, page, **look) == []
        assert browser.messages == []
