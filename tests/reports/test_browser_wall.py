"""All engines side by side in the 3-D view: each in its cell, and what never flips is framed."""

from __future__ import annotations

import json

import pytest
from axe_check import LOOKS, VIOLATIONS, axe
from test_browser_stage import run
from test_browser_view import NO_WEBGL, PICTURE, PLAY, READY, TEXT, choose, listed, opened
from turning_record import turning_record

from omegadot.reports.page.page import draw_page

MODE = "document.getElementById('view-mode').value"
# Of every cell its text, line by line, and its classes.
CELLS = """[...document.querySelectorAll('#view-wall li')].map((cell) => [
    cell.querySelector('b').textContent, cell.querySelector('.head').lastChild.textContent,
    cell.innerText.split('\\n').map((line) => line.trim()), [...cell.classList]])"""
# The share of each body's place that is not the ground on which it stands.
COVERED = """(() => { const stage = document.getElementById('view-stage');
    const from = stage.getBoundingClientRect(), context = stage.getContext('2d');
    return [...document.querySelectorAll('#view-wall .body')].map((body) => {
      const to = body.getBoundingClientRect();
      const data = context.getImageData(to.x - from.x, to.y - from.y, to.width, to.height).data;
      let off = 0;
      for (let k = 0; k < data.length; k += 4)
        if ([0, 1, 2].some((j) => data[k + j] !== data[j])) off++;
      return (4 * off) / data.length; }); })()"""


@pytest.fixture(scope="module")
def path(tmp_path_factory):
    record = turning_record()
    for task in record.run["tasks"]:
        if (task["engine"], task["integrator"], task["timestep"]) == ("mujoco", "Euler", 0.01):
            task["gates"] = {**task["gates"], "scheme": "fail"}
    file = tmp_path_factory.mktemp("page") / "report.html"
    file.write_text(draw_page(record), encoding="utf-8")
    return file


@pytest.fixture
def page(browser, path):
    browser.untouched(path, READY, acting=True, height=900)
    browser.evaluate("document.getElementById('view').scrollIntoView()")
    choose(browser, "view-scenario", "1")
    return browser


def cells(page):
    return {name: (own, lines, names) for name, own, lines, names in page.evaluate(CELLS)}


def test_it_opens_with_every_engine_once_and_the_exact_one_first(page):
    assert page.evaluate(MODE) == "all"
    found = cells(page)
    assert list(found) == ["exact", "reference", "mujoco", "dart", "drake", "havok"]
    assert [own for own, _, _ in found.values()] == [
        *("closed-form", "lie-rk4", "RK4", "semi-implicit", "discrete", "step"),
    ]
    assert listed(page) == []
    assert page.messages == []
    assert min(page.evaluate(COVERED)) > 0.02


def test_a_body_that_never_flips_is_framed_and_a_late_one_is_counted(page):
    found = cells(page)
    assert "2 of 2 flips" in found["exact"][1]
    assert "2 of 2 flips" in found["drake"][1]
    assert "flips late: 1 of 2" in found["dart"][1]
    assert "never flips" in found["havok"][1]
    framed = {name for name, (_, _, names) in found.items() if "fails" in names}
    assert framed == {"havok", "mujoco"}
    assert "✗ Euler fails" in found["mujoco"][1]
    choose(page, "view-time", "1.2")
    found = cells(page)
    assert "1 of 2 flips" in found["drake"][1]
    assert "0 of 2 flips" in found["dart"][1]
    assert "never flips" in found["havok"][1]


def test_errors_and_divergences_follow_the_clock(page):
    choose(page, "view-step", "1")
    choose(page, "view-time", "1.4")
    assert "diverged" not in cells(page)["dart"][2]
    choose(page, "view-time", "2")
    # Late by 2 * 0.3 * 0.02 * 2 rad, which is 1.375 degrees; beyond a degree at 1.5 s.
    _, lines, names = cells(page)["dart"]
    assert "1.4° off" in lines
    assert "⚑ 1.50 s" in " ".join(lines)
    assert "diverged" in names
    assert "diverged" not in cells(page)["mujoco"][2]


def test_engines_that_diverge_together_are_announced_together(page):
    """Caught: a reader who hears the last of five."""
    choose(page, "view-step", "1")
    choose(page, "view-time", "1.45")
    page.evaluate(
        "{ window.heard = []; new MutationObserver(() => heard.push("
        f"{TEXT})).observe(document.getElementById('view-status'), {{ childList: true }}); }}"
    )
    choose(page, "view-speed", "10")
    page.evaluate(f"{PLAY}.click()")
    page.wait(f"{PLAY}.textContent === 'Play'")
    (text,) = [text for text in page.evaluate("heard") if "diverges" in text]
    for name in ("dart semi-implicit", "drake discrete", "havok step"):
        assert f"{name} diverges from the exact solution at 1.50 s." in text


def test_the_least_exact_integrator_may_be_chosen(page):
    choose(page, "view-which", "least")
    own, lines, _ = cells(page)["mujoco"]
    assert own == "Euler"
    assert "✗ fails: scheme" in lines
    choose(page, "view-step", "1")
    assert "fails" not in cells(page)["mujoco"][2]  # it fails at the finer step alone


def test_a_scenario_without_flips_mentions_none(page):
    choose(page, "view-scenario", "0")
    found = cells(page)
    assert "flip" not in json.dumps([lines for _, lines, _ in found.values()])
    assert "fails" not in found["havok"][2]


def test_the_text_says_the_same_as_the_picture(page):
    choose(page, "view-step", "1")
    choose(page, "view-time", "4")
    sentence = "At 4.00 s: 2 of 5 engines within 1° of the exact attitude; never flip: havok."
    assert page.evaluate(TEXT) == sentence
    label = "document.getElementById('view-stage').getAttribute('aria-label')"
    assert page.evaluate(label).endswith(sentence)
    rows = page.evaluate(
        "[...document.querySelectorAll('#view-table tbody tr')]"
        ".map((r) => [r.cells[0].textContent, r.cells[5].textContent])"
    )
    assert ["havok step", "never flips"] in rows
    assert ["dart semi-implicit", "flips late: 1 of 2"] in rows
    assert ["mujoco RK4", "2 of 2 flips"] in rows


def test_the_three_runs_are_a_choice_that_stays(page):
    wall = page.evaluate(PICTURE)
    choose(page, "view-mode", "runs")
    assert page.evaluate(CELLS) == []
    names = [text.split(" at step")[0] for text in listed(page)[1:]]
    assert names == ["mujoco Euler", "dart semi-implicit"]
    assert page.evaluate(PICTURE) != wall
    choose(page, "view-scenario", "0")
    assert page.evaluate(MODE) == "runs"
    choose(page, "view-mode", "all")
    assert len(cells(page)) == 6
    off = "['overlaid', 'polhode'].map((n) => document.getElementById(`view-${n}`).disabled)"
    assert page.evaluate(off) == [True, True]


def test_options_and_the_clock_move_every_body(page):
    seen = [page.evaluate(PICTURE)]
    for name in ("momentum", "omega"):
        page.evaluate(f"document.getElementById('view-{name}').click()")
        seen.append(page.evaluate(PICTURE))
    for name, value in (("view-turn", "-60"), ("view-time", "2")):
        choose(page, name, value)
        seen.append(page.evaluate(PICTURE))
    assert len(set(seen)) == len(seen)


def test_one_webgl_canvas_draws_all(browser, path):
    """Caught: a context a cell; browsers take the first away when there are sixteen."""
    counted = """window.given = []; const get = HTMLCanvasElement.prototype.getContext;
    HTMLCanvasElement.prototype.getContext = function (kind, ...more) {
      const found = get.call(this, kind, ...more);
      if (kind.startsWith('webgl')) given.push(found);
      return found; };"""
    hook = browser.call("Page.addScriptToEvaluateOnNewDocument", source=counted)
    try:
        opened(browser, path)
        held = "new Set(given.filter((one) => one && !one.isContextLost())).size"
        assert browser.evaluate(held) == 1
    finally:
        browser.call("Page.removeScriptToEvaluateOnNewDocument", **hook)


def test_without_webgl_every_cell_has_its_body(browser, path):
    hook = browser.call("Page.addScriptToEvaluateOnNewDocument", source=NO_WEBGL)
    try:
        opened(browser, path)
        assert not browser.evaluate("document.getElementById('view-plain').hidden")
        assert len(covered := browser.evaluate(COVERED)) == 6
        assert min(covered) > 0.02
    finally:
        browser.call("Page.removeScriptToEvaluateOnNewDocument", **hook)


@pytest.mark.parametrize("width", [360, 390, 800])
def test_a_narrow_window_has_three_cells_a_row_or_more(browser, path, width):
    opened(browser, path, width=width)
    page = browser.evaluate(
        "(() => { const at = [...document.querySelectorAll('#view-wall li')]"
        ".map((cell) => cell.getBoundingClientRect());"
        " return [at.filter((one) => one.top === at[0].top).length,"
        " document.documentElement.scrollWidth - document.documentElement.clientWidth]; })()"
    )
    assert page[0] >= 3
    assert page[1] == 0
    assert min(browser.evaluate(COVERED)) > 0.02


@LOOKS
def test_axe_finds_nothing_in_the_cells(browser, path, look):
    opened(browser, path, **look)
    browser.evaluate(axe() + "; 0")
    assert browser.evaluate(VIOLATIONS.replace("document", "'#view'")) == []


def test_in_software_a_moving_picture_has_one_sample_a_pixel(browser, path):
    opened(browser, path)
    found = run(
        browser,
        """const theme = { mark: "#00ff00", stand: "#ffffff" }, sizes = [];
        const canvas = document.createElement("canvas"), context = canvas.getContext("2d");
        const cell = { x: 0, y: 0, width: 100, height: 100 };
        for (const small of [false, true]) {
          refine(small);
          const geometry = geometryOf([["cylinder", [1, 1], [0, 0, 0], [1, 0, 0, 0]]]);
          const own = sceneOf({ geometry, pivot: false }, "#ff0000", theme, "#0000ff");
          own.set({ q: [1, 0, 0, 0], points: [], vectors: [] });
          clock.runs = small;
          paintScenes(context, 100, 100, [{ cell, camera: cameraOf(0, 0, cell), scene: own }]);
          sizes.push([webgl.domElement.width, webgl.info.render.triangles]);
        }
        return [software, ...sizes];""",
    )
    software, (still, many), (moving, few) = found
    assert software
    assert (still, moving) == (200, 100)
    assert few < many / 2
