"""The page in a real browser: charts are drawn, nothing is complained of, names stay text."""

import pytest
from chromium import Chromium
from synthetic_record import build, scenario_entry

from omegadot.reports.page.page import draw_page

HOSTILE = "<script>document.title='broken'</script><img src=x onerror=\"document.title='broken'\">"
CHARTS = 14
DRAWN = f"Number(document.documentElement.dataset.drawn || 0) >= {CHARTS}"
# A chart over time of the first scenario, by its place.
OVER_TIME = "((place) => document.querySelector(`[data-place='${place}']`))"
# The runs in the attitude error of the first scenario, its fourth chart over time.
LINES = """[...document.querySelector("[data-place='3']").data].filter((t) => t.meta).map(
    (t) => ({name: t.name, end: t.y.at(-1), colour: t.line.color, dash: t.line.dash}))"""


@pytest.fixture(scope="module")
def browser(tmp_path_factory):
    with Chromium(tmp_path_factory.mktemp("profile")) as chromium:
        yield chromium


@pytest.fixture(scope="module")
def path(tmp_path_factory):
    record = build()
    record.run.update(scenarios=[scenario_entry("sphere", HOSTILE), scenario_entry("spun-again")])
    file = tmp_path_factory.mktemp("page") / "report.html"
    file.write_text(draw_page(record), encoding="utf-8")
    return file


@pytest.fixture
def page(browser, path):
    browser.messages.clear()
    browser.requests.clear()
    browser.open(path)
    browser.wait(DRAWN)
    return browser


def again(page, action):
    """Do something that redraws every chart, and wait for it."""
    page.evaluate("delete document.documentElement.dataset.drawn")
    page.evaluate(action)
    page.wait(DRAWN)


def test_charts_are_drawn_and_nothing_is_complained_of(page, path):
    assert page.messages == []
    assert page.evaluate("document.querySelectorAll('.chart svg.main-svg').length") >= CHARTS
    assert page.evaluate("document.getElementById('no-charts').hidden")
    # Five lines a chart; also two guides and the round-off bound for convergence, the Pareto front
    # for cost, and the bounds in two of the four charts: equal for all runs, so one line.
    lines = 2 * (4 * 5 + 5 + 3 + 5 + 1 + 2)
    assert (
        page.evaluate("document.querySelectorAll('.chart .scatterlayer .js-line').length") == lines
    )


def test_the_network_is_left_alone(page, path):
    assert [url for url in page.requests if not url.startswith("data:")] == [path.as_uri()]


def test_a_hostile_title_stays_text(page):
    assert page.evaluate("document.title").startswith("omegadot report")
    assert (
        page.evaluate("document.querySelector('.scenario h3').firstChild.data").strip() == HOSTILE
    )
    assert page.evaluate("document.images.length") == 0


def test_the_charts_hold_what_the_record_holds(page):
    ends = {line["name"]: line["end"] for line in page.evaluate(LINES)}
    assert list(ends) == [
        *("reference semi-implicit-euler", "reference lie-rk4"),
        *("mujoco Euler", "mujoco RK4", "dart semi-implicit"),
    ]
    # Late by 0.3 h t at t = 4 s; codes are good to a thousandth.
    assert ends["dart semi-implicit"] == pytest.approx(0.3 * 0.005 * 4.0, rel=1e-3)


def test_one_step_is_shown_at_a_time_and_axes_stay(page):
    axis = f"JSON.stringify({OVER_TIME}(3).layout.yaxis.range)"
    before = page.evaluate(axis)
    assert page.evaluate("[...document.getElementById('step').options].map((o) => o.text)") == [
        *("finest (0.005 s)", "second finest (0.01 s)", "third finest (0.02 s)")
    ]
    again(
        page,
        "{ const step = document.getElementById('step'); step.value = '2';"
        " step.dispatchEvent(new Event('change')); }",
    )
    ends = {line["name"]: line["end"] for line in page.evaluate(LINES)}
    assert ends["dart semi-implicit"] == pytest.approx(0.3 * 0.02 * 4.0, rel=1e-3)
    assert "step 0.02 s" in page.evaluate("document.querySelectorAll('.at-step')[3].textContent")
    assert page.evaluate(axis) == before


def test_engine_is_colour_and_scheme_is_dash(page):
    looks = {line["name"]: (line["colour"], line["dash"]) for line in page.evaluate(LINES)}
    assert looks["mujoco Euler"][0] == looks["mujoco RK4"][0] != looks["dart semi-implicit"][0]
    assert looks["mujoco Euler"][1] == looks["dart semi-implicit"][1] == "solid"
    assert looks["mujoco RK4"][1] == looks["reference lie-rk4"][1] != "solid"


def test_a_switch_acts_on_all_charts_and_the_keyboard_reaches_it(page):
    page.evaluate("document.getElementById('step').focus()")
    for _ in range(2):
        page.press("Tab", 9)
    assert page.evaluate("document.activeElement.matches('fieldset[data-engine] .all')")
    page.evaluate("delete document.documentElement.dataset.drawn")
    page.press(" ", 32, " ")
    page.wait(DRAWN)
    counts = page.evaluate("[...document.querySelectorAll('.chart')].map((c) => c.data.length)")
    # Identical states hold a bound and two kinds of them; two of the charts over time hold a bound.
    assert counts == [3, 3, 3, 4, 4, 6, 4] * 2
    assert page.evaluate(LINES)[0]["name"] == "mujoco Euler"


SWEEP = """((kind) => [...document.querySelector(`[data-kind=${kind}]`).data].map(
    (t) => ({name: t.name, x: [...t.x], y: [...t.y], dash: t.line.dash ?? null})))"""


def test_convergence_is_drawn_over_the_step_with_its_slopes(page):
    drawn = {line["name"]: line for line in page.evaluate(f"{SWEEP}('convergence')")}
    assert drawn["dart semi-implicit"]["x"] == [0.005, 0.01, 0.02]
    assert drawn["dart semi-implicit"]["y"] == pytest.approx([6e-3, 1.2e-2, 2.4e-2])
    (low, high), (start, end) = drawn["order 4"]["x"], drawn["order 4"]["y"]
    assert (low, high) == (0.005, 0.02)
    assert end / start == pytest.approx(4.0**4, rel=1e-3)
    assert drawn["round-off bound"]["y"] == [1e-13] * 3
    layout = "document.querySelector('[data-kind=convergence]').layout"
    assert page.evaluate(f"{layout}.xaxis.type + {layout}.yaxis.type") == "loglog"
    assert page.evaluate(f"{layout}.xaxis.ticktext") == ["0.005", "0.01", "0.02"]
    assert page.evaluate(f"{layout}.yaxis.range[0]") <= -13


def test_work_is_drawn_against_precision(page):
    drawn = {line["name"]: line for line in page.evaluate(f"{SWEEP}('cost')")}
    assert len(drawn) == 5 + 1
    assert drawn["mujoco RK4"]["x"] == pytest.approx([4e-4, 2e-4, 1e-4])
    assert drawn["mujoco RK4"]["y"] == pytest.approx([1.2 * h**4 for h in (0.005, 0.01, 0.02)])
    text = page.evaluate("document.querySelector('[data-kind=cost]').data[4].text[0]")
    assert text == "step 0.005 s: 7.50e-10 rad<br>4.00e-4 s per simulated second"


def test_sweeps_keep_colour_and_dash_and_leave_with_their_engine(page):
    looks = {line["name"]: line["dash"] for line in page.evaluate(f"{SWEEP}('cost')")}
    assert looks["mujoco Euler"] == looks["dart semi-implicit"] == "solid"
    again(page, "document.querySelectorAll('fieldset[data-engine] .all')[1].click()")
    left = {line["name"] for line in page.evaluate(f"{SWEEP}('convergence')")}
    assert left == {
        *("reference semi-implicit-euler", "reference lie-rk4", "dart semi-implicit"),
        *("order 1", "order 4", "round-off bound"),
    }


def test_axes_are_logarithmic_and_zeros_lie_on_a_marked_floor(page):
    layout = "document.querySelector('[data-place=\"0\"]').layout"
    assert page.evaluate(f"{layout}.yaxis.type") == "log"
    # dart's omega-dot is exact in this record.
    zeros = "document.querySelector('[data-place=\"0\"]').data.at(-1).y"
    assert set(page.evaluate(f"[...{zeros}].slice(1)")) == {1e-17}
    assert page.evaluate(f"{zeros}[0]") is None
    assert page.evaluate(f"{layout}.yaxis.range[0]") < -17
    assert "drawn here" in page.evaluate(f"{layout}.annotations[0].text")


def test_the_dark_has_colours_of_its_own(browser, path):
    looks = []
    for dark in (False, True):
        browser.open(path, dark=dark)
        browser.wait(DRAWN)
        back = browser.evaluate("document.querySelector('.chart').layout.paper_bgcolor")
        looks.append((back, browser.evaluate(LINES)[2]["colour"]))
    assert looks == [("#ffffff", "#0068ab"), ("#1c2024", "#56a8e0")]


@pytest.mark.parametrize("width", [360, 768, 1280])
def test_no_width_scrolls_sideways(browser, path, width):
    browser.open(path, width=width, height=12000)
    browser.wait(DRAWN)
    root = "document.documentElement"
    assert browser.evaluate(f"{root}.scrollWidth - {root}.clientWidth") == 0


@pytest.mark.parametrize("width", [360, 1280])
def test_long_names_do_not_widen_the_page(browser, tmp_path, width):
    steps = {"RK4": 4}
    record = build(engines={"a" * 300: steps, " ".join(["abc"] * 60): steps})
    file = tmp_path / "report.html"
    file.write_text(draw_page(record), encoding="utf-8")
    browser.open(file, width=width, height=12000)
    browser.wait("document.documentElement.dataset.drawn")
    browser.evaluate("document.querySelectorAll('details').forEach((part) => (part.open = true))")
    root = "document.documentElement"
    assert browser.evaluate(f"{root}.scrollWidth - {root}.clientWidth") == 0


def test_charts_wait_until_they_come_near(browser, path):
    browser.open(path, height=500)
    assert browser.evaluate("document.querySelectorAll('.chart svg').length") == 0
    browser.evaluate("document.querySelectorAll('.scenario')[1].scrollIntoView()")
    browser.wait("document.querySelectorAll('.scenario')[1].querySelector('.chart svg') !== null")


def test_the_matrix_shows_one_number_at_a_time(page):
    shown = """[...document.querySelectorAll(".matrix td .n")]
        .filter((n) => n.offsetWidth > 0).map((n) => n.className)"""
    assert set(page.evaluate(shown)) == {"n n-residual"}
    page.evaluate("document.getElementById('show-attitude').click()")
    assert set(page.evaluate(shown)) == {"n n-attitude"}
