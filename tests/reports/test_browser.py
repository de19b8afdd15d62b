"""The page in a real browser: charts are drawn, nothing is complained of, names stay text."""

import pytest
from synthetic_record import build, scenario_entry

from omegadot.reports.page.page import draw_page

HOSTILE = "<script>document.title='broken'</script><img src=x onerror=\"document.title='broken'\">"
CHARTS = 7
DRAWN = f"Number(document.documentElement.dataset.drawn || 0) >= {CHARTS}"
# A chart over time of the scenario shown, by its place.
OVER_TIME = "((place) => document.querySelector(`[data-place='${place}']`))"
# The runs in its attitude error, its fourth chart over time.
LINES = """[...document.querySelector("[data-place='3']").data].filter((t) => t.meta).map(
    (t) => ({name: t.name, end: t.y.at(-1), colour: t.line.color, dash: t.line.dash}))"""


@pytest.fixture(scope="module")
def path(tmp_path_factory):
    record = build()
    record.run.update(scenarios=[scenario_entry("sphere", HOSTILE), scenario_entry("spun-again")])
    file = tmp_path_factory.mktemp("page") / "report.html"
    file.write_text(draw_page(record), encoding="utf-8")
    return file


@pytest.fixture
def page(browser, path):
    browser.untouched(path, DRAWN, acting=True)
    return browser


@pytest.fixture
def seen(browser, path):
    """The page for a test that only looks."""
    browser.untouched(path, DRAWN, acting=False)
    return browser


def again(page, action):
    """Do something that redraws every chart, and wait for it."""
    page.evaluate("delete document.documentElement.dataset.drawn")
    page.evaluate(action)
    page.wait(DRAWN)


def changed(name, value):
    return (
        f"{{ const s = document.getElementById('{name}'); s.value = '{value}';"
        " s.dispatchEvent(new Event('change', {bubbles: true})); }"
    )


EULERS = "reference semi-implicit-euler = mujoco Euler"


def test_charts_are_drawn_and_nothing_is_complained_of(page, path):
    assert page.messages == []
    assert page.evaluate("document.querySelectorAll('.chart svg.main-svg').length") >= CHARTS
    assert page.evaluate("document.getElementById('no-charts').hidden")
    again(page, changed("shown", "all"))
    # Of five runs two pairs of engines coincide, and in attitude dart's with one; also two guides
    # and the round-off bound for convergence, the Pareto front for cost, which holds every line,
    # and the bounds in two of the four charts: equal for all runs, so one line.
    lines = 3 + 3 + 3 + 2 + 2 + (2 + 3) + (5 + 1)
    assert (
        page.evaluate("document.querySelectorAll('.chart .scatterlayer .js-line').length") == lines
    )


def test_at_first_best_and_worst_of_each_engine_are_drawn_and_what_coincides_has_all_names(page):
    drawn = "[...document.querySelectorAll('[data-place=\"0\"] ~ .legend li')]"
    names = f"{drawn}.map((l) => l.textContent)"
    first = ["mujoco Euler", "mujoco RK4", "dart semi-implicit"]
    assert page.evaluate(names) == first
    assert [line["name"] for line in page.evaluate(LINES)] == [
        "mujoco Euler = dart semi-implicit",
        "mujoco RK4",
    ]
    again(page, changed("shown", "all"))
    assert page.evaluate(names) == [
        *(EULERS, "reference lie-rk4 = mujoco RK4", "dart semi-implicit")
    ]
    box = "document.querySelector('.panel .one[value=\"3\"]')"
    again(page, f"{box}.click()")
    assert page.evaluate("document.getElementById('shown').value") == "selected"
    assert page.evaluate(names)[1] == "reference lie-rk4"
    again(page, changed("shown", "first"))
    assert page.evaluate(names) == first
    assert page.evaluate("document.querySelector('.controls').offsetHeight") < 60


def test_one_scenario_is_shown_at_a_time_by_tab_key_and_address(page, path):
    shown = (
        "[...document.querySelectorAll('.scenario:not([hidden]) h3 small')].map((s) => s.innerText)"
    )
    assert page.evaluate(shown) == ["sphere"]
    page.evaluate("document.querySelector('#tabs [aria-selected=true]').focus()")
    page.press("ArrowRight", 39)
    assert page.evaluate(shown) == ["spun-again"]
    assert page.evaluate("location.hash + document.activeElement.textContent").split() == [
        *("#scenario-spun-again✓", "spun-again")
    ]
    page.evaluate("document.querySelector('.matrix a[href=\"#scenario-sphere\"]').click()")
    page.wait(f"{shown}[0] === 'sphere'")
    assert page.evaluate("document.querySelectorAll('h3 ~ .charts').length") == 2
    page.call("Page.navigate", url=f"{path.as_uri()}#scenario-spun-again")
    page.wait(f"{shown}[0] === 'spun-again'")
    notice = "document.getElementById('missing')"
    page.evaluate("location.hash = '#scenario-never-run'")
    page.wait(f"!{notice}.hidden")
    assert "no scenario “never-run”" in page.evaluate(f"{notice}.textContent")
    page.evaluate("location.hash = '#scenario-sphere'")
    page.wait(f"{notice}.hidden && {shown}[0] === 'sphere'")


def test_the_network_is_left_alone(seen, path):
    assert [url for url in seen.requests if not url.startswith("data:")] == [path.as_uri()]


def test_a_hostile_title_stays_text(seen):
    assert seen.evaluate("document.title").startswith("omegadot report")
    assert (
        seen.evaluate("document.querySelector('.scenario h3').firstChild.data").strip() == HOSTILE
    )
    assert seen.evaluate("document.images.length") == 0


def test_the_charts_hold_what_the_record_holds(page):
    again(page, "document.querySelector('fieldset[data-engine=mujoco] .all').click()")
    ends = {line["name"]: line["end"] for line in page.evaluate(LINES)}
    # Late by 0.3 h t at t = 4 s; codes are good to a thousandth.
    assert ends == {"dart semi-implicit": pytest.approx(0.3 * 0.005 * 4.0, rel=1e-3)}


def test_one_step_is_shown_at_a_time_and_axes_stay(page):
    axis = f"JSON.stringify({OVER_TIME}(3).layout.yaxis.range)"
    before = page.evaluate(axis)
    assert page.evaluate("[...document.getElementById('step').options].map((o) => o.text)") == [
        *("finest (0.005 s)", "second finest (0.01 s)", "third finest (0.02 s)")
    ]
    again(page, changed("step", "2"))
    ends = {line["name"]: line["end"] for line in page.evaluate(LINES)}
    # A run in front is 0.3 h t late, and faster by a thousandth of h.
    assert ends["mujoco Euler = dart semi-implicit"] == pytest.approx(0.302 * 0.02 * 4.0, rel=1e-3)
    assert "step 0.02 s" in page.evaluate("document.querySelectorAll('.at-step')[3].textContent")
    assert page.evaluate(axis) == before


def test_engine_is_colour_and_scheme_is_dash(page):
    again(page, changed("shown", "all"))
    script = """[...document.querySelectorAll('.panel label:has(.one)')].map((label) => {
        const look = getComputedStyle(label.querySelector('path'));
        return [label.textContent.trim(), look.stroke, look.strokeDasharray]; })"""
    looks = {name: look for name, *look in page.evaluate(script)}
    assert looks["Euler"][0] == looks["RK4"][0] != looks["semi-implicit"][0]
    assert looks["Euler"][1] == looks["semi-implicit"][1] == "none"
    assert looks["RK4"][1] == looks["lie-rk4"][1] != "none"
    drawn = {line["name"]: line["dash"] for line in page.evaluate(f"{SWEEP}('cost')")}
    assert drawn["mujoco Euler"] == drawn["dart semi-implicit"] == "solid" != drawn["mujoco RK4"]


def test_a_switch_acts_on_all_charts_and_the_keyboard_reaches_it(page):
    page.evaluate("document.getElementById('lines').open = true")
    page.wait("!document.querySelector('fieldset[data-engine=reference] .all').checked")
    page.evaluate("document.querySelector('#lines summary').focus()")
    for _ in range(3):
        page.press("Tab", 9)
    assert page.evaluate("document.activeElement.matches('fieldset[data-engine=reference] .one')")
    page.evaluate("document.querySelector('fieldset[data-engine=mujoco] .all').focus()")
    page.evaluate("delete document.documentElement.dataset.drawn")
    page.press(" ", 32, " ")
    page.wait(DRAWN)
    counts = page.evaluate("[...document.querySelectorAll('.chart')].map((c) => c.data.length)")
    # Identical states hold a bound and two kinds of them; two of the charts over time hold a bound.
    assert counts == [3, 1, 1, 2, 2, 1 + 3, 1 + 1]
    assert page.evaluate(LINES)[0]["name"] == "dart semi-implicit"


SWEEP = """((kind) => [...document.querySelector(`[data-kind=${kind}]`).data].map(
    (t) => ({name: t.name, x: [...t.x], y: [...t.y], dash: t.line.dash ?? null})))"""


def test_convergence_is_drawn_over_the_step_with_its_slopes(seen):
    drawn = {line["name"]: line for line in seen.evaluate(f"{SWEEP}('convergence')")}
    eulers = drawn["mujoco Euler = dart semi-implicit"]
    assert eulers["x"] == [0.005, 0.01, 0.02]
    assert eulers["y"] == pytest.approx([6e-3, 1.2e-2, 2.4e-2])
    (low, high), (start, end) = drawn["order 4"]["x"], drawn["order 4"]["y"]
    assert (low, high) == (0.005, 0.02)
    assert end / start == pytest.approx(4.0**4, rel=1e-3)
    assert drawn["round-off bound"]["y"] == [1e-13] * 3
    layout = "document.querySelector('[data-kind=convergence]').layout"
    assert seen.evaluate(f"{layout}.xaxis.type + {layout}.yaxis.type") == "loglog"
    assert seen.evaluate(f"{layout}.xaxis.ticktext") == ["0.005", "0.01", "0.02"]
    assert seen.evaluate(f"{layout}.yaxis.range[0]") <= -13


def test_work_is_drawn_against_precision(seen):
    drawn = {line["name"]: line for line in seen.evaluate(f"{SWEEP}('cost')")}
    assert len(drawn) == 3 + 1
    assert drawn["mujoco RK4"]["x"] == pytest.approx([4e-4, 2e-4, 1e-4])
    assert drawn["mujoco RK4"]["y"] == pytest.approx([1.2 * h**4 for h in (0.005, 0.01, 0.02)])
    text = seen.evaluate("document.querySelector('[data-kind=cost]').data[2].text[0]")
    assert text == "step 0.005 s: 7.5e-10 rad<br>0.0004 s per simulated second"


def test_sweeps_leave_with_their_engine(page):
    again(page, "document.querySelector('fieldset[data-engine=mujoco] .all').click()")
    left = {line["name"] for line in page.evaluate(f"{SWEEP}('convergence')")}
    assert left == {"dart semi-implicit", "order 1", "order 4", "round-off bound"}


def test_axes_are_logarithmic_and_zeros_lie_on_a_marked_floor(seen):
    layout = "document.querySelector('[data-place=\"0\"]').layout"
    assert seen.evaluate(f"{layout}.yaxis.type") == "log"
    # dart's omega-dot is exact in this record.
    zeros = "document.querySelector('[data-place=\"0\"]').data.at(-1).y"
    assert set(seen.evaluate(f"[...{zeros}].slice(1)")) == {1e-17}
    assert seen.evaluate(f"{zeros}[0]") is None
    assert seen.evaluate(f"{layout}.yaxis.range[0]") < -17
    assert "drawn here" in seen.evaluate(f"{layout}.annotations[0].text")


def test_the_dark_has_colours_of_its_own(browser, path):
    looks = []
    for dark in (False, True):
        browser.open(path, dark=dark)
        browser.wait(DRAWN)
        back = browser.evaluate("document.querySelector('.chart').layout.paper_bgcolor")
        looks.append((back, browser.evaluate(LINES)[0]["colour"]))
    assert looks == [("#ffffff", "#0068ab"), ("#1c2024", "#56a8e0")]


# Charts take on the window's width a moment later.
WHOLE = "document.documentElement.scrollWidth === document.documentElement.clientWidth"


def test_no_width_scrolls_sideways(browser, path):
    browser.open(path, width=360, height=12000)
    browser.wait(DRAWN)
    assert browser.evaluate(WHOLE)
    for width in (768, 1280):
        browser.resize(width, 12000)
        browser.wait(WHOLE)


def test_long_names_do_not_widen_the_page(browser, tmp_path):
    steps = {"RK4": 4}
    record = build(("sphere",), {"a" * 300: steps, " ".join(["abc"] * 60): steps}, (0.02,))
    file = tmp_path / "report.html"
    file.write_text(draw_page(record), encoding="utf-8")
    browser.open(file, width=360, height=12000)
    browser.wait("document.documentElement.dataset.drawn")
    browser.evaluate("document.querySelectorAll('details').forEach((part) => (part.open = true))")
    browser.wait("document.querySelector('.with-reasons')?.dataset.ready")
    assert browser.evaluate(WHOLE)
    browser.resize(1280, 12000)
    browser.wait(WHOLE)


def test_charts_are_pictures_until_they_come_near(browser, path):
    browser.open(path, height=500)
    assert browser.evaluate("document.querySelectorAll('.chart .main-svg').length") == 0
    assert browser.evaluate("document.querySelectorAll('.chart .still').length") == CHARTS
    browser.evaluate("document.querySelector('.chart').scrollIntoView()")
    browser.wait("document.querySelector('.chart .main-svg') !== null")
    assert browser.evaluate("document.querySelector('.chart.live .still').clientWidth") == 0


def test_the_matrix_shows_one_number_at_a_time(page):
    shown = """[...document.querySelectorAll(".matrix td .n")]
        .filter((n) => n.offsetWidth > 0).map((n) => n.className)"""
    assert set(page.evaluate(shown)) == {"n n-residual"}
    page.evaluate("document.getElementById('show-attitude').click()")
    assert set(page.evaluate(shown)) == {"n n-attitude"}
