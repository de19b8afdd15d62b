"""The printed page: what stands on its sheets, read out of the PDF itself."""

import pytest
from pdf_text import printed_pages
from synthetic_record import build

from omegadot.reports.page.page import draw_page

READY = "document.querySelector('#why table')?.dataset.ready === 'yes'"


@pytest.fixture(scope="module")
def path(tmp_path_factory):
    file = tmp_path_factory.mktemp("page") / "report.html"
    record = build(steps=(0.00125, 0.0015, 0.002, 0.0025, 0.003, 0.004, 0.005, 0.00625))
    file.write_text(draw_page(record), encoding="utf-8")
    return file


@pytest.fixture
def page(browser, path):
    browser.open(path, height=900)
    browser.wait(READY)
    return browser


def test_a_table_that_goes_on_has_its_whole_head_on_the_next_sheet(page):
    """Chromium leaves out the buttons of a head that it repeats, and with them their text."""
    page.evaluate("""(() => {
        const body = document.querySelector('#why table').tBodies[0], rows = [...body.rows];
        for (let k = 0; k < 30; k++) body.append(...rows.map((row) => row.cloneNode(true)));
    })()""")
    sheets = printed_pages(page)
    with_groups = [text for text in sheets if "implementedin" in text]
    assert len(with_groups) > 1
    for text in with_groups:
        for head in ("engine", "integrator", "scheme", "ofround-offbound", "attitude,rad"):
            assert head in text.split("implementedin")[0] + text.split("implementedin")[1][:200]


def test_the_paper_says_that_the_view_is_left_out(page):
    assert "The3-Dviewisleftoutonpaper" in "".join(printed_pages(page))
    assert page.evaluate("document.querySelector('.paper').offsetHeight") == 0


def printed(page, script):
    page.evaluate("dispatchEvent(new Event('beforeprint'))")
    page.call("Emulation.setEmulatedMedia", media="print")
    found = page.evaluate(script)
    page.call("Emulation.setEmulatedMedia", media="")
    page.evaluate("dispatchEvent(new Event('afterprint'))")
    return found


def test_no_text_on_paper_is_larger_than_what_it_belongs_to(page):
    """Sizes of the screen, in rem, would stand beside those of the paper, in pt."""
    larger = """(() => {
        const size = (e) => parseFloat(getComputedStyle(e).fontSize);
        const owned = 'main :is(li, p, td, th, figcaption) > :is(span, small)';
        return [...document.querySelectorAll(`${owned}, main caption`)].filter((e) =>
            size(e) > size(e.tagName === 'CAPTION' ? document.body : e.parentNode))
            .map((e) => e.textContent); })()"""
    assert printed(page, larger) == []


def test_charts_on_paper_can_be_read(page):
    """px on paper: 72 of 96 are a pt; 5 pt is the least that print shops set."""
    sizes = """[...document.querySelectorAll('.still')].map((s) =>
        parseFloat(getComputedStyle(s.querySelector('text')).fontSize)
        * s.getBoundingClientRect().width / s.viewBox.baseVal.width)"""
    page.resize(718, 900)  # what a sheet of A4 has between its margins
    assert min(printed(page, sizes)) * 72 / 96 >= 5.0


def test_columns_of_the_pareto_list_stand_apart(page):
    page.resize(718, 900)
    gap = """[...document.querySelectorAll('ol.front')].map((list) => {
        const style = getComputedStyle(list);
        return [style.breakInside, parseFloat(style.columnGap) / parseFloat(style.fontSize)]; })"""
    for inside, em in printed(page, gap):
        assert inside == "avoid"
        assert em >= 3.0  # a number and its dot hang in the gap


def test_labels_of_an_axis_do_not_touch_on_paper(page):
    """Texts of one line of one picture, from left to right."""
    touching = """[...document.querySelectorAll('.still')].flatMap((s) => {
        const lines = new Map();
        for (const text of s.querySelectorAll(':scope > text:not(.e)')) {
            const key = text.getAttribute('y');
            lines.set(key, [...(lines.get(key) ?? []), text]);
        }
        return [...lines.values()].flatMap((own) => {
            const boxes = own.map((t) => [t.getBoundingClientRect(), t.textContent]);
            boxes.sort((a, b) => a[0].left - b[0].left);
            return boxes.slice(1).filter(([b], k) => b.left < boxes[k][0].right).map((b) => b[1]);
        }); })"""
    page.resize(718, 900)
    assert printed(page, touching) == []


@pytest.mark.parametrize("above", [0, 150, 300, 450, 600, 750])
def test_the_title_of_a_scenario_stands_above_its_table(page, above):
    """Pushed down by so many px, a title comes to the foot of a sheet."""
    page.evaluate(
        "document.querySelector('main').style.setProperty('padding-top', 0);"
        f"document.getElementById('scenarios').style.paddingTop = '{above}px'"
    )
    titled = [text for text in printed_pages(page) if "Asphere,spun" in text]
    assert titled
    for text in titled:
        assert text.count("worstomega-dotresidual,relative") >= text.count("Asphere,spun")
