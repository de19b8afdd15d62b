"""A record in a notebook's cell: its page, whole, in a frame."""

from __future__ import annotations

from html import unescape
from pathlib import Path
from time import monotonic, sleep

import pytest
from chromium import PATIENCE, Chromium
from synthetic_record import build

from omegadot.reports import notebook
from omegadot.reports.record import schema
from omegadot.reports.record.record import Record
from omegadot.reports.run_record import RunRecord

EMPTY = Record(
    {"schema": schema.SCHEMA, "engines": [], "scenarios": [], "tasks": []},
    schema.empty(schema.METRICS),
    schema.empty(schema.TRAJECTORIES),
)
CHART = "document.querySelector('.chart svg') !== null"
VIEW = "[...document.querySelectorAll('canvas')].some((one) => one.clientHeight > 0)"


def page_in(cell: str) -> str:
    """The page that a cell's frame holds."""
    start, _, rest = cell.partition('srcdoc="')
    text, _, end = rest.partition('"')
    assert start == "<iframe "
    assert "sandbox=" in end
    assert "allow-same-origin" not in end
    return unescape(text)


def test_a_cell_holds_the_page_and_nothing_else() -> None:
    record = RunRecord.of(build())
    cell = record._repr_html_()
    page = page_in(cell).replace(notebook.OWN_BASE, "")
    assert page == record.page()
    assert record.headline.partition(":")[0] in page
    assert cell.count("<iframe") == 1
    assert cell.isascii(), "the frame depends on the encoding of the page around it"
    assert "://" not in cell
    assert record.headline in repr(record)


def test_a_record_without_a_run_has_a_page() -> None:
    record = RunRecord.of(EMPTY)
    assert page_in(record._repr_html_()).endswith("</html>")
    assert "0 runs" in repr(record)
    assert record.tasks == ()


def test_a_page_too_large_for_a_cell_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(notebook, "LARGEST_PAGE", 1000)
    cell = RunRecord.of(build())._repr_html_()
    assert "iframe" not in cell
    assert ".save(FOLDER)" in cell


def test_charts_and_view_are_drawn_in_the_frame(tmp_path: Path) -> None:
    cell = tmp_path / "cell.html"
    frame = RunRecord.of(build())._repr_html_()
    cell.write_text(f"<!doctype html><title>notebook</title><body>{frame}</body>", "utf-8")
    with Chromium(tmp_path / "profile") as browser:
        browser.open(cell, height=1200)
        attach_to_the_frame(browser)
        browser.wait(VIEW)
        browser.evaluate("document.querySelector('.chart').scrollIntoView()")  # drawn when near
        browser.wait(CHART)
        browser.evaluate("document.querySelector('nav a').click()")
        assert browser.evaluate("location.href").startswith("about:srcdoc#")
        assert not [url for url in browser.requests if not url.startswith("file:")]


def attach_to_the_frame(browser: Chromium) -> None:
    """From here on the browser answers for the frame: a sandbox is a target of its own."""
    end = monotonic() + PATIENCE
    while True:
        targets = browser.call("Target.getTargets")["targetInfos"]
        frames = [one["targetId"] for one in targets if one["type"] == "iframe"]
        if frames:
            break
        assert monotonic() < end, "the cell holds no frame"
        sleep(0.02)
    attached = browser.call("Target.attachToTarget", targetId=frames[0], flatten=True)
    browser._session = attached["sessionId"]
    browser.call("Runtime.enable")
