"""What the page does when it is used: zoom, tables, and the way back from a number."""

import json
from dataclasses import replace

import pytest
from synthetic_record import build, scenario_entry

from omegadot.reports.page.page import draw_page

CHARTS = 7
DRAWN = f"Number(document.documentElement.dataset.drawn || 0) >= {CHARTS}"
RANGES = "[...document.querySelectorAll('.scenario [data-place]')].map("
RANGES += "(c) => [...c._fullLayout.xaxis.range].map((v) => Number(v.toPrecision(3))))"
HOSTILE = "it's <b>bold</b>; rm -rf $HOME"
CARD = "document.getElementById('card')"
COMMANDS = f"[...{CARD}.querySelectorAll('.command code')].map((c) => c.textContent)"


@pytest.fixture(scope="module")
def path(tmp_path_factory):
    record = build()
    arguments = [HOSTILE, "folder/spun-again.toml", "--seed", "7", "--adapter=mine.py:My Engine"]
    record.run["command"] = ["omegadot", "run", *arguments]
    record.run["scenarios"] = [scenario_entry("sphere"), scenario_entry("spun-again")]
    file = tmp_path_factory.mktemp("page") / "report.html"
    file.write_text(draw_page(record), encoding="utf-8")
    return file


@pytest.fixture
def page(browser, path):
    browser.untouched(path, DRAWN, acting=True)
    yield browser
    assert browser.messages == []


def mouse(page, kind, x, y, **more):
    page.call("Input.dispatchMouseEvent", type=kind, x=x, y=y, **more)


def plot(page, place):
    """The plot's edges, in px of the window: left, top, width, height."""
    script = """((place) => { const c = document.querySelector(`[data-place="${place}"]`);
        const r = c.getBoundingClientRect(), s = c._fullLayout._size;
        return [r.left + s.l, r.top + s.t, s.w, s.h]; })"""
    return page.evaluate(f"{script}({place})")


def drag(page, place, start, end):
    left, top, width, height = plot(page, place)
    y, button = top + 0.5 * height, {"button": "left", "buttons": 1, "clickCount": 1}
    mouse(page, "mouseMoved", left + start * width, y)
    mouse(page, "mousePressed", left + start * width, y, **button)
    for part in (0.5 * (start + end), end):
        mouse(page, "mouseMoved", left + part * width, y, button="left", buttons=1)
    mouse(page, "mouseReleased", left + end * width, y, **button)


def test_zoom_in_time_acts_on_all_charts_over_time_of_the_scenario_and_on_no_other(page):
    assert page.evaluate(RANGES) == [[0, 4]] * 4
    drag(page, 1, 0.25, 0.75)
    page.wait(f"{RANGES}.every((r) => r[0] > 0.9 && r[1] < 3.1)")
    assert len({tuple(r) for r in page.evaluate(RANGES)}) == 1
    page.evaluate("delete document.documentElement.dataset.drawn")
    page.evaluate("document.querySelector('fieldset[data-engine=mujoco] .all').click()")
    page.wait(DRAWN)
    assert page.evaluate(RANGES)[2] == pytest.approx([1, 3], abs=0.1)
    page.evaluate("delete document.documentElement.dataset.drawn")
    page.evaluate("document.getElementById('next').click()")
    page.wait(DRAWN)
    assert page.evaluate(RANGES) == [[0, 4]] * 4
    drag(page, 1, 0.25, 0.75)
    page.wait(f"{RANGES}.every((r) => r[0] > 0.9 && r[1] < 3.1)")
    left, top, width, height = plot(page, 3)
    for count in (1, 2):
        button = {"button": "left", "clickCount": count}
        mouse(page, "mousePressed", left + 0.5 * width, top + 0.1 * height, **button)
        mouse(page, "mouseReleased", left + 0.5 * width, top + 0.1 * height, **button)
    page.wait(f"{RANGES}.every((r) => r[0] === 0 && r[1] === 4)")


def test_the_time_under_the_pointer_is_shown_in_all_charts_over_time(page):
    left, top, width, height = plot(page, 0)
    mouse(page, "mouseMoved", left + 0.5 * width, top + 0.5 * height)
    rules = "[...document.querySelectorAll('.now:not([hidden])')].map((r) => +r.dataset.time)"
    page.wait(f"{rules}.length === 4")
    assert page.evaluate(rules) == pytest.approx([2.0] * 4, abs=0.02)
    mouse(page, "mouseMoved", 2, 2)
    page.wait(f"{rules}.length === 0")


def focus(page, selector):
    page.evaluate(f"document.querySelector({json.dumps(selector)}).focus()")


def test_a_cell_of_the_matrix_shows_its_runs_by_keyboard(page):
    focus(page, ".matrix tbody tr:nth-child(2) td:nth-child(2) a")
    page.press("Enter", 13, "\r")
    page.wait(f"{CARD}.open")
    assert page.evaluate("document.getElementById('card-title').textContent") == (
        "mujoco on spun-again"
    )
    text = page.evaluate(f"{CARD}.textContent")
    assert "Worst verdict: pass." in text
    assert "6.2e-15 worst omega-dot residual" in text
    tail = "--seed 7 --adapter 'mine.py:My Engine'"
    assert page.evaluate(COMMANDS) == [
        f"omegadot run folder/spun-again.toml --engine mujoco:{name} --timestep {step} {tail}"
        for name, step in (("Euler", "0.02"), ("RK4", "0.005"), ("Euler", "0.005"))
    ]
    page.press("Escape", 27)
    page.wait(f"!{CARD}.open")
    assert page.evaluate("document.activeElement.dataset.card") is not None


def test_a_row_shows_its_run_and_the_command_is_safe_to_paste(page):
    page.evaluate("document.querySelectorAll('.scenario:not([hidden]) details')[2].open = true")
    page.wait("document.querySelector('.with-reasons button.source') !== null")
    rows = "[...document.querySelectorAll('.with-reasons button.source')]"
    page.evaluate(f"{rows}.find((b) => b.textContent === 'RK4, step 0.01 s').focus()")
    page.press("Enter", 13, "\r")
    page.wait(f"{CARD}.open")
    (command,) = page.evaluate(COMMANDS)
    quoted = "'it'\\''s <b>bold</b>; rm -rf $HOME'"
    assert command.startswith(f"omegadot run {quoted} --engine mujoco:RK4 --timestep 0.01 --seed 7")
    facts = page.evaluate(f"[...{CARD}.querySelectorAll('dd')].map((d) => d.textContent)")
    assert facts == ["mujoco 1.0", "physics", "RK4", "0.01 s", "7"]
    page.evaluate("document.execCommand = () => { window.copied = getSelection() + ''; return 1; }")
    page.evaluate("navigator.clipboard.writeText = async (text) => { window.copied = text; }")
    page.evaluate(f"{CARD}.querySelector('.copy').click()")
    page.wait("window.copied !== undefined")
    assert page.evaluate("window.copied") == command


def test_a_point_shows_its_run_by_keyboard_and_by_click(page):
    focus(page, "[data-place='3']")
    for key, code in (("ArrowDown", 40), ("End", 35)):
        page.press(key, code)
    message = page.evaluate("document.getElementById('announcement').textContent")
    assert message.startswith("mujoco RK4 at 4 s: ")
    assert page.evaluate("document.querySelectorAll('.hoverlayer .hovertext').length") >= 1
    page.press("Enter", 13, "\r")
    page.wait(f"{CARD}.open")
    (command,) = page.evaluate(COMMANDS)
    assert "--engine mujoco:RK4 --timestep 0.005" in command
    assert "Attitude error" in page.evaluate(f"{CARD}.textContent")
    page.press("Escape", 27)
    chart = "document.querySelector('[data-kind=equation]')"
    page.evaluate(
        f"{chart}.emit('plotly_click', {{points: [{{data: {chart}.data[1], pointNumber: 0}}]}})"
    )
    page.wait(f"{CARD}.open")
    assert "--engine dart --seed 7" in page.evaluate(COMMANDS)[0]


def column(page, number):
    return page.evaluate(
        "[...document.querySelectorAll('.with-reasons')[0].tBodies[0].rows]"
        ".filter((r) => r.offsetHeight > 0)"
        # Without what keeps an exponent on one line.
        f".map((r) => r.cells[{number}].textContent.replace(/\u2060/g, ''))"
    )


def test_a_table_sorts_filters_and_copies(page):
    page.evaluate("document.querySelectorAll('.scenario:not([hidden]) details')[2].open = true")
    page.wait("document.querySelector('.with-reasons')?.dataset.ready === 'yes'")
    heads = "[...document.querySelector('.with-reasons').tHead.querySelectorAll('button.sort')]"
    drift = f"{heads}.find((b) => b.textContent.startsWith('drift full'))"
    place = 2 + page.evaluate(f"[...{drift}.closest('tr').cells].indexOf({drift}.closest('th'))")
    page.evaluate(f"{drift}.focus()")
    page.press("Enter", 13, "\r")
    values = [float(value) for value in column(page, place)]
    assert len(values) == 15
    assert values == sorted(values) != values[::-1]
    assert page.evaluate(f"{drift}.closest('th').ariaSort") == "ascending"
    page.press("Enter", 13, "\r")
    assert [float(value) for value in column(page, place)] == values[::-1]
    assert page.evaluate("document.querySelectorAll('.with-reasons [aria-sort]').length") == 1
    tools = "document.querySelector('.with-reasons').closest('.scroll').previousElementSibling"
    page.evaluate(
        f"{{ const f = {tools}.querySelector('input'); f.value = 'RK4 mujoco';"
        " f.dispatchEvent(new Event('input')); }"
    )
    assert set(column(page, 0)) == {"mujoco"}
    assert page.evaluate(f"{tools}.querySelector('.feedback').textContent") == "3 of 15 rows"
    page.evaluate("navigator.clipboard.writeText = async (text) => { window.csv = text; }")
    page.evaluate(f"{tools}.querySelector('.copy').click()")
    page.wait("window.csv !== undefined")
    lines = page.evaluate("window.csv").split("\r\n")
    assert "\u2060" not in page.evaluate("window.csv")  # what keeps an exponent on one line
    assert lines[0].startswith("engine,run,outcome: verdict,")
    assert len(lines) == 5
    assert lines[1].startswith('mujoco,"RK4, step ')


def test_the_matrix_sorts_by_the_number_that_is_shown(page):
    page.evaluate("document.getElementById('show-drift').click()")
    heads = "document.querySelectorAll('.matrix button.sort')"
    names = (
        "[...document.querySelector('.matrix').tBodies[0].rows].map((r) => r.cells[0].innerText)"
    )
    page.evaluate(f"{heads}[0].click()")
    assert page.evaluate(names) == ["sphere", "spun-again"]
    page.evaluate("document.getElementById('show-residual').click()")
    for _ in range(2):
        page.evaluate(f"{heads}[2].click()")
    assert page.evaluate(names) == ["spun-again", "sphere"]


def test_a_spreadsheet_is_given_no_formula(page):
    page.evaluate(
        "document.querySelector('.matrix').tBodies[0].rows[0].cells[0].textContent ="
        " '=HYPERLINK(1)'"
    )
    page.evaluate("navigator.clipboard.writeText = async (text) => { window.csv = text; }")
    page.evaluate(
        "document.querySelector('.matrix').closest('.scroll')"
        ".previousElementSibling.querySelector('.copy').click()"
    )
    page.wait("window.csv !== undefined")
    assert page.evaluate("window.csv").split("\r\n")[1].startswith("'=HYPERLINK(1),")


def test_a_page_without_charts_still_has_its_tables_and_cards(browser, tmp_path):
    record = build(("sphere",), steps=(0.02,))
    file = tmp_path / "report.html"
    bare = replace(record, trajectories=record.trajectories.clear())
    file.write_text(draw_page(bare), encoding="utf-8")
    browser.messages.clear()
    browser.open(file)
    assert browser.evaluate("document.querySelectorAll('.chart').length") == 0
    browser.evaluate("document.querySelector('a[data-card]').click()")
    browser.wait(f"{CARD}.open")
    assert browser.evaluate("document.querySelector('.matrix').dataset.ready") == "yes"
    assert browser.messages == []


def test_paper_gets_every_scenario_with_its_charts_and_the_bodies(browser, path):
    """Printing does not wait: what was never scrolled to is there at once, as a picture."""
    browser.messages.clear()
    browser.open(path, width=1000, height=200)
    browser.wait("document.getElementById('view-box').dataset.ready")
    charts = "document.querySelectorAll('.chart').length"
    assert browser.evaluate(charts) == CHARTS
    browser.evaluate("document.querySelectorAll('.scenario:not([hidden]) details')[2].open = true")
    browser.wait("document.querySelector('.with-reasons')?.dataset.ready === 'yes'")
    browser.evaluate("dispatchEvent(new Event('beforeprint'))")
    drawn = "[...document.querySelectorAll('.chart')].map((c) => c.querySelectorAll('path').length)"
    assert browser.evaluate(charts) == 2 * CHARTS
    assert min(browser.evaluate(drawn)) > 3
    assert browser.evaluate("document.querySelectorAll('details[open] .with-reasons').length") == 2
    browser.call("Emulation.setEmulatedMedia", media="print")
    hidden = "[...document.querySelectorAll('.still')].filter((s) => !s.clientWidth).length"
    assert browser.evaluate(hidden) == 0
    for what in (".controls", "#view", ".hint"):  # nothing to click, no empty places
        assert browser.evaluate(f"document.querySelector('{what}').offsetHeight") == 0
    assert "click" not in browser.evaluate("document.body.innerText")
    browser.call("Emulation.setEmulatedMedia", media="")
    browser.evaluate("dispatchEvent(new Event('afterprint'))")
    assert browser.evaluate(charts) == CHARTS
    width = "document.querySelector('.chart .main-svg')?.clientWidth"
    browser.evaluate("document.querySelector('.chart').scrollIntoView()")
    browser.wait(f"{width} > 21 * 16")
    # Charts that show what their reader selected are printed as they are.
    browser.evaluate("document.getElementById('shown').value = 'all'")
    browser.evaluate(
        "document.getElementById('shown').dispatchEvent(new Event('change', {bubbles: true}))"
    )
    browser.evaluate("dispatchEvent(new Event('beforeprint'))")
    assert browser.evaluate(width) == 21 * 16
    browser.evaluate("dispatchEvent(new Event('afterprint'))")
    browser.wait(f"{width} > 21 * 16")
    assert browser.messages == []
