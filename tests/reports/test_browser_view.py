"""The 3-D view in a real browser: WebGL draws it, the clock moves it, the keyboard reaches it."""

import json
import math

import numpy as np
import pytest
from synthetic_record import build, scenario_entry

from omegadot.reference_impl.rotations import (
    attitude_angle,
    exp_quaternion,
    normalize,
    quaternion_product,
    rotate,
    rotation_between,
)
from omegadot.reports.page.page import draw_page
from omegadot.reports.page.templating import asset
from omegadot.reports.page.view_3d.view import Codes
from omegadot.written import written

HOSTILE = "<img src=x onerror=\"document.title='broken'\">"
READY = "document.getElementById('view-box').dataset.ready === '1'"
PICTURE = "document.getElementById('view-stage').toDataURL()"
TIME = "Number(document.getElementById('view-time').value)"
TEXT = "document.getElementById('view-status').textContent"
PLAY = "document.getElementById('view-play')"
HANDLE = [
    {"shape": "cylinder", "radius": 0.01, "length": 0.1, "density": 1.0,
     "orientation": [0.5**0.5, 0.0, 0.5**0.5, 0.0]},
    {"shape": "cylinder", "radius": 0.01, "length": 0.05, "density": 1.0,
     "position": [0.0, 0.0, 0.035]},
]  # fmt: skip


@pytest.fixture(scope="module")
def path(tmp_path_factory):
    record = build()
    handle = scenario_entry("spun-again", "A handle, spun")
    handle["definition"]["body"] = {"part": HANDLE}
    # No principal axis is that of the spin: the tip goes around.
    handle["system"]["inertia"] = [[0.4, 0.0, 0.1], [0.0, 0.3, 0.0], [0.1, 0.0, 0.2]]
    record.run.update(scenarios=[scenario_entry("sphere", HOSTILE), handle])
    file = tmp_path_factory.mktemp("page") / "report.html"
    file.write_text(draw_page(record), encoding="utf-8")
    return file


def opened(browser, path, **size):
    browser.open(path, **{"height": 900, **size})
    browser.evaluate("document.getElementById('view').scrollIntoView()")
    browser.wait(READY)
    return browser


@pytest.fixture
def page(browser, path):
    browser.untouched(path, READY, acting=True, height=900)
    browser.evaluate("document.getElementById('view').scrollIntoView()")
    return browser


@pytest.fixture
def seen(browser, path):
    """The page for a test that only looks."""
    browser.untouched(path, READY, acting=False, height=900)
    return browser


def choose(page, name, value):
    page.evaluate(
        f"(() => {{ const s = document.getElementById('{name}'); s.value = {json.dumps(value)};"
        " s.dispatchEvent(new Event('input')); s.dispatchEvent(new Event('change')); })()"
    )


def mask(page):
    """A row of 0 and 1: where the stage, below its titles, is not its own ground."""
    script = """(() => { const c = document.getElementById('view-stage');
        const d = c.getContext('2d').getImageData(0, 40, c.width, c.height - 40).data, found = [];
        for (let k = 0; k < d.length; k += 16)
          found.push([0, 1, 2].some((j) => d[k + j] !== d[j]) ? 1 : 0);
        return found.join(''); })()"""
    return np.array(list(page.evaluate(script))) == "1"


def coverage(page):
    return mask(page).mean()


def listed(page):
    return page.evaluate("[...document.querySelectorAll('#view-runs li')].map((l) => l.innerText)")


def test_it_opens_at_the_end_standing_still(seen, path):
    assert seen.evaluate(TIME) == 4.0
    assert seen.evaluate(f"{PLAY}.textContent") == "Play"
    assert seen.messages == []
    assert [url for url in seen.requests if not url.startswith("data:")] == [path.as_uri()]
    first, *others = listed(seen)
    assert first.startswith("exact, closed-form")
    # The first engine's least exact integrator and the second's; the reference steps back.
    assert [text.split(" at step")[0] for text in others] == ["mujoco Euler", "dart semi-implicit"]


def test_it_is_made_ready_without_being_scrolled_to(browser, path):
    """Paper has no scrolling: once the page is idle, the bodies are unpacked and drawn."""
    browser.open(path, height=300)
    browser.wait(READY)
    assert not browser.evaluate("document.getElementById('view').getBoundingClientRect().top < 300")
    assert coverage(browser) > 0.02


def test_playing_turns_the_body_from_the_start_and_pause_holds_it(page):
    before = page.evaluate(PICTURE)
    choose(page, "view-speed", "0.25")
    page.evaluate(f"{PLAY}.click()")
    page.wait(f"{TIME} > 0.02 && {TIME} < 4")
    assert page.evaluate(f"{PLAY}.textContent") == "Pause"
    page.evaluate(f"{PLAY}.click()")
    held = page.evaluate(f"[{TIME}, {PICTURE}]")
    assert held[0] < 4.0
    assert held[1] != before
    two_frames = "new Promise((r) => requestAnimationFrame(() => requestAnimationFrame(r)))"
    assert page.evaluate(f"{two_frames}.then(() => [{TIME}, {PICTURE}])") == held
    assert page.evaluate(TEXT).startswith("Paused.")


def test_playing_ends_at_the_end_and_announces_a_divergence(page):
    choose(page, "view-scenario", "1")
    choose(page, "view-step", "2")
    # Late by 2 * 0.3 * 0.02 t: beyond a degree at 1.5 s.
    choose(page, "view-time", "1.45")
    page.evaluate(
        "{ window.heard = []; new MutationObserver(() => heard.push("
        f"{TEXT})).observe(document.getElementById('view-status'), {{ childList: true }}); }}"
    )
    choose(page, "view-speed", "10")
    page.evaluate(f"{PLAY}.click()")
    page.wait(f"{PLAY}.textContent === 'Play' && {TIME} === 4")
    sentence = "dart semi-implicit diverges from the exact solution at 1.50 s."
    assert any(text.startswith(sentence) for text in page.evaluate("heard"))


def test_scrubbing_sets_the_clock_and_the_numbers(page):
    choose(page, "view-scenario", "1")
    choose(page, "view-step", "2")
    choose(page, "view-time", "2")
    assert page.evaluate("document.getElementById('view-now').textContent") == "2.00 s"
    as_text = "document.getElementById('view-time').getAttribute('aria-valuetext')"
    assert page.evaluate(as_text) == "2.00 s of 4.00 s"
    # Late by 2 * 0.3 * 0.02 * 2 rad, which is 1.375 degrees.
    (text,) = [text for text in listed(page) if text.startswith("dart")]
    assert "1.4° off" in text
    assert "dart semi-implicit 1.4° off" in page.evaluate(TEXT)


def test_the_moment_of_divergence_is_one_press_away(page):
    choose(page, "view-scenario", "1")
    choose(page, "view-step", "2")
    button = "document.querySelector('#view-runs button')"
    assert page.evaluate(f"{button}.textContent") == "diverges from the exact solution at 1.50 s"
    page.evaluate(f"{button}.click()")
    assert page.evaluate(TIME) == pytest.approx(1.5, abs=4e-3)
    assert page.evaluate("document.querySelectorAll('#view-runs .diverged').length") == 2
    choose(page, "view-time", "1.4")
    assert page.evaluate("document.querySelectorAll('#view-runs .diverged').length") == 0


def test_the_keyboard_plays_and_scrubs(page):
    choose(page, "view-time", "1")
    page.evaluate(f"{PLAY}.focus()")
    page.press(" ", 32, " ")
    page.wait(f"{PLAY}.textContent === 'Pause' && {TIME} > 1")
    page.press(" ", 32, " ")
    page.press("Tab", 9)
    assert page.evaluate("document.activeElement.id") == "view-time"
    before = page.evaluate(TIME)
    page.press("ArrowRight", 39)
    assert page.evaluate(TIME) == pytest.approx(before + 0.004, abs=1e-9)


NO_WEBGL = """const given = HTMLCanvasElement.prototype.getContext;
HTMLCanvasElement.prototype.getContext = function (kind, ...more) {
  return kind.startsWith("webgl") ? null : given.call(this, kind, ...more);
};"""


def half_way(page):
    choose(page, "view-scenario", "1")
    choose(page, "view-time", "2")
    for name in ("momentum", "omega"):
        page.evaluate(f"document.getElementById('view-{name}').click()")
    return mask(page), page.evaluate("document.getElementById('view-plain').hidden")


def test_a_browser_without_webgl_shows_the_same_with_a_note(page, path):
    lit, quiet = half_way(page)
    assert quiet
    hook = page.call("Page.addScriptToEvaluateOnNewDocument", source=NO_WEBGL)
    try:
        found, quiet = half_way(opened(page, path))
        assert not quiet
        page.evaluate("document.getElementById('view-polhode').click()")
        assert [m for m in page.messages if "Canvas2D" not in m] == []
    finally:
        page.call("Page.removeScriptToEvaluateOnNewDocument", **hook)
    assert lit.mean() > 0.02
    # The same outlines, but for lines of three sides instead of six and bodies of 16 for 48.
    assert (lit & found).sum() > 0.9 * (lit | found).sum()


def test_another_scenario_has_another_body(page):
    ball = page.evaluate(PICTURE)
    reported = "document.getElementById('view-description').textContent"
    assert "homogeneous ball" in page.evaluate(reported)
    choose(page, "view-scenario", "1")
    assert page.evaluate(reported).startswith("A handle, spun: drawn from its parts")
    assert page.evaluate(PICTURE) != ball
    assert page.evaluate("document.getElementById('view-charts').hash") == "#scenario-spun-again"


def test_every_option_changes_the_picture(page):
    choose(page, "view-scenario", "1")
    seen = [page.evaluate(PICTURE)]
    for name in ("momentum", "omega", "polhode", "trace", "overlaid"):
        page.evaluate(f"document.getElementById('view-{name}').click()")
        seen.append(page.evaluate(PICTURE))
    for angle in ("view-turn", "view-tilt"):
        choose(page, angle, "-60")
        seen.append(page.evaluate(PICTURE))
    assert len(set(seen)) == len(seen)
    assert page.messages == []


def test_dragging_turns_and_tilts_the_view_as_its_sliders_do(page):
    x, y = page.evaluate(
        "(() => { const b = document.getElementById('view-stage').getBoundingClientRect();"
        " return [b.x + 200, b.y + 150]; })()"
    )
    before = page.evaluate(PICTURE)
    for kind, dx, dy in (("Pressed", 0, 0), ("Moved", 60, 20), ("Released", 60, 20)):
        page.call("Input.dispatchMouseEvent", type=f"mouse{kind}", x=x + dx, y=y + dy,
                  button="left", buttons=int(kind != "Released"), clickCount=1)  # fmt: skip
    sliders = "['turn', 'tilt'].map((n) => Number(document.getElementById(`view-${n}`).value))"
    assert page.evaluate(sliders) == [35 - 30, 22 + 10]
    assert page.evaluate(PICTURE) != before


def test_the_step_is_that_of_the_whole_page(page):
    choose(page, "view-step", "2")
    assert page.evaluate("document.getElementById('step').value") == "2"
    assert "at step 0.02 s" in listed(page)[1]
    page.evaluate(
        "{ const s = document.getElementById('step'); s.value = '1';"
        " s.dispatchEvent(new Event('change')); }"
    )
    assert page.evaluate("document.getElementById('view-step').value") == "1"
    assert "at step 0.01 s" in listed(page)[1]


def test_runs_can_be_chosen_and_left_out(page):
    options = page.evaluate(
        "[...document.querySelector('.view-engine').options].map((o) => [o.text, o.value])"
    )
    assert [text for text, _ in options] == [
        *("none", "reference semi-implicit-euler", "reference lie-rk4"),
        *("mujoco Euler", "mujoco RK4", "dart semi-implicit"),
    ]
    page.evaluate(
        "document.querySelectorAll('.view-engine').forEach((s) => {"
        " s.value = '-1'; s.dispatchEvent(new Event('change')); })"
    )
    assert len(listed(page)) == 1
    assert page.evaluate(TEXT).endswith("the exact solution alone.")


def test_the_table_behind_it_holds_every_run(page):
    choose(page, "view-scenario", "1")
    rows = page.evaluate(
        "[...document.querySelectorAll('#view-table tbody tr')]"
        ".map((r) => [...r.cells].map((c) => c.textContent))"
    )
    assert len(rows) == 15
    assert ["dart semi-implicit", "step 0.02 s", "1.50 s", "2.8°", "4.00 s", "–"] in rows
    assert ["mujoco RK4", "step 0.005 s", "does not", "8.6e-8°", "4.00 s", "–"] in rows


def test_a_hostile_title_stays_text(seen):
    reported = "document.getElementById('view-description').textContent"
    assert seen.evaluate(reported).startswith(HOSTILE)
    assert seen.evaluate("document.images.length") == 0
    assert seen.evaluate("document.title").startswith("omegadot report")


def test_the_dark_has_a_picture_of_its_own_and_no_width_scrolls_sideways(browser, path):
    light = opened(browser, path).evaluate(PICTURE)
    assert opened(browser, path, dark=True).evaluate(PICTURE) != light
    whole = "document.documentElement.scrollWidth === document.documentElement.clientWidth"
    assert browser.evaluate(whole)
    browser.resize(360, 900)
    browser.wait(whole)


def test_the_script_turns_as_the_reference_does(seen):
    random = np.random.default_rng(3)
    vectors, points = random.normal(size=(2, 20, 3))
    script = (
        f"(() => {{ {asset('view_trajectory.js')};"
        f" const v = {vectors.tolist()}, p = {points.tolist()};"
        " const still = [1, 0, 0, 0]; return v.map((r, k) => ["
        "...rotate(turnBy(r), p[k]), ...rotate(slerp(still, turnBy(r), 0.25), p[k]),"
        " angleBetween(turnBy(times(r, 0.3)), turnBy(r))]); })()"
    )
    found = np.array(seen.evaluate(script))
    turned = np.linalg.norm(vectors, axis=1, keepdims=True)
    short = np.where(turned > np.pi, vectors * (1 - 2 * np.pi / turned), vectors)
    assert found[:, :3] == pytest.approx(rotate(exp_quaternion(vectors), points), abs=1e-14)
    assert found[:, 3:6] == pytest.approx(rotate(exp_quaternion(0.25 * short), points), abs=1e-14)
    between = 0.7 * turned[:, 0]
    assert found[:, 6] == pytest.approx(np.minimum(between, 2 * np.pi - between), abs=1e-14)


def test_the_script_reads_attitudes_as_they_were_packed(seen):
    random = np.random.default_rng(4)
    q, w = normalize(random.normal(size=(6, 4))), random.uniform(-3.0, 3.0, (6, 3))
    error, spin = random.uniform(-1.0, 1.0, (2, 3, 3))
    codes = Codes()
    for rows, largest in ((q, 1.0), (w, 3.0), (error, np.pi), (spin, 24.0)):
        codes.add(rows, largest)
    scenario = {"times": [0, 1, 2, 3, 4, 5], "start": 0, "fastest": 3.0, "frames": [[0, 2, 5]]}
    entry = [0, 0, "step 1 s", 0, 42, 3, None, 1.0, 5.0]
    packed = codes.all().view(np.int16).tolist()
    script = (
        f"(() => {{ {asset('view_trajectory.js')}; const scenario = {json.dumps(scenario)};"
        f" const loaded = {{ codes: {packed}, data: {{ lines: [{{}}], spins: 8 }} }};"
        " const exact = exactTrajectory(loaded, scenario);"
        f" const run = runTrajectory(loaded, scenario, exact, {json.dumps(entry)});"
        " return [...run.q.map((q, k) => [...q, ...run.w[k]]),"
        " [...poseAt(run, 3).q, ...poseAt(run, 3).w]]; })()"
    )
    found = np.array(seen.evaluate(script))
    frames = [0, 2, 5]
    truth = quaternion_product(q[frames], exp_quaternion(error))
    half = 0.5 / 32767
    assert attitude_angle(found[:3, :4], truth).max() <= (math.sqrt(3) * np.pi + 4) * half
    assert np.abs(found[:3, 4:] - w[frames] - spin).max() <= 1.01 * (3.0 + 24.0) * half
    # A third of the way from the sample at 2 s to that at 5 s, the short way round.
    third = quaternion_product(
        found[1, :4], exp_quaternion(rotation_between(found[1, :4], found[2, :4]) / 3)
    )
    assert attitude_angle(found[3, :4], third) <= 1e-14
    assert found[3, 4:] == pytest.approx((2 * found[1, 4:] + found[2, 4:]) / 3, abs=1e-14)


def test_what_fails_is_shown_at_first_and_marked(browser, tmp_path):
    """Caught: a view that opens with other engines than the one that fails."""
    record = build()
    for task in record.run["tasks"]:
        if (task["scenario"], task["engine"], task["timestep"]) == ("sphere", "dart", 0.01):
            task["gates"] = {**task["gates"], "scheme": "fail"}
    file = tmp_path / "report.html"
    file.write_text(draw_page(record), encoding="utf-8")
    page = opened(browser, file)
    _, failed, best = listed(page)
    assert failed.startswith("dart semi-implicit at step 0.01 s")
    assert "fails: scheme" in failed
    assert best.startswith("mujoco Euler")  # of the same order: the fault is seen, not the order
    assert "fails" not in best
    choose(page, "view-scenario", "1")
    assert [text.split(" at step")[0] for text in listed(page)[1:]] == [
        *("mujoco Euler", "dart semi-implicit"),
    ]
    assert page.evaluate("document.getElementById('view-step').value") == "0"


def test_the_script_writes_numbers_as_the_page_does(seen):
    """Caught: 1.23e+5 in a hover text beside 1.2e5 in a table."""
    random = np.random.default_rng(5)
    numbers = [0.0, 0.005, 2.0, 1e-4, 9.9999e-5, 99999.96, 1e5, 2.8e6, 5e-324, 1.7e308]
    numbers += (random.normal(size=200) * 10.0 ** random.uniform(-20, 20, 200)).tolist()
    digits = [2 + k % 5 for k in range(len(numbers))]
    script = (
        f"(() => {{ {asset('written.js')}; const d = {digits};"
        f" return {json.dumps(numbers)}.map((x, k) => written(x, d[k])); }})()"
    )
    assert seen.evaluate(script) == [written(*pair) for pair in zip(numbers, digits, strict=True)]
