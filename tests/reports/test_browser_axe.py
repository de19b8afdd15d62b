"""axe-core finds nothing on the page: in the light, in the dark, on a phone, with a card open."""

import pytest
from axe_check import LOOKS, VIOLATIONS, axe
from synthetic_record import build, metric, task, with_metrics

from omegadot.reports.page.page import draw_page

CHARTS = 7


@pytest.fixture(scope="module")
def path(tmp_path_factory):
    """A page with everything on it: failures, declared exceptions, what did not run."""
    record = build(("sphere",), steps=(0.01,))
    fail = {"verdict": "fail", "note": "too far"}
    declared = {"verdict": "declared", "note": "known, see the engine's own list"}
    add = ["sphere", "dart", "semi-implicit", 0.01, "trajectory", "omega"]
    record = with_metrics(
        record,
        metric(*add, "error_max", 1.0, **fail),
        metric("sphere", "mujoco", None, None, "model", "model", "inertia", 1.0, **declared),
    )
    record.run["tasks"][0].update(gates={"model": "declared"})
    record.run["tasks"].append(task("sphere", "drake", None, None, outcome="crashed", gates={}))
    file = tmp_path_factory.mktemp("axe") / "report.html"
    file.write_text(draw_page(record), encoding="utf-8")
    return file


def opened(browser, path, **look):
    browser.open(path, **look)
    browser.wait(f"Number(document.documentElement.dataset.drawn || 0) >= {CHARTS}")
    browser.evaluate("document.querySelectorAll('details').forEach((d) => { d.open = true; })")
    browser.wait("document.querySelector('.with-reasons') !== null")
    browser.wait("[...document.querySelectorAll('table')].every((t) => t.dataset.ready)")
    browser.evaluate(axe() + "; 0")


@LOOKS
def test_axe_finds_nothing(browser, path, look):
    opened(browser, path, **look)
    assert browser.evaluate(VIOLATIONS) == []


def test_axe_finds_nothing_on_a_card_and_would_find_a_field_without_a_name(browser, path):
    opened(browser, path)
    browser.evaluate("document.querySelector('a[data-card]').click()")
    browser.wait("document.getElementById('card').open")
    assert browser.evaluate(VIOLATIONS.replace("document", "'#card'")) == []
    browser.evaluate("document.getElementById('card').close()")
    browser.evaluate("document.querySelector('input[type=search]').removeAttribute('aria-label')")
    browser.evaluate("document.querySelector('input[type=search]').placeholder = ''")
    fields = VIOLATIONS.replace("document", "'.tools'")
    assert [found[0] for found in browser.evaluate(fields)] == ["label"]
