"""What stands on a narrow screen, or in a narrow table, can be read there."""

import pytest
from synthetic_record import build

from omegadot.reports.page.page import draw_page

READY = "document.querySelector('#why table')?.dataset.ready === 'yes'"
PHONE = {"width": 390, "height": 844}


@pytest.fixture(scope="module")
def pages(tmp_path_factory):
    folder = tmp_path_factory.mktemp("page")
    single = build(engines={"dart": {"semi-implicit": 1}})
    for name, record in (("all", build()), ("single", single)):
        (folder / f"{name}.html").write_text(draw_page(record), encoding="utf-8")
    return folder


def opened(browser, path, **size):
    browser.open(path, **size)
    browser.wait(READY)
    return browser


def test_step_and_lines_are_named_and_wide_enough_on_a_phone(browser, pages):
    page = opened(browser, pages / "all.html", **PHONE)
    widths = """[...document.querySelectorAll('.controls select')].map((s) => [
        s.offsetWidth, s.parentNode.querySelector('span').offsetWidth])"""
    # What a choice needs, with the arrow of the list: 15 letters of 6 px and 24 px.
    for select, label in page.evaluate(widths):
        assert select >= 15 * 6 + 24
        assert label > 0
    assert page.evaluate("document.querySelector('.controls').offsetHeight") < 0.15 * 844


# How many lines a caption takes; how many it would take over the whole width.
CAPTIONS = """[...document.querySelectorAll('main caption')].filter((c) => c.offsetWidth)
    .map((c) => {
    const range = document.createRange();
    range.selectNodeContents(c);
    const words = [...range.getClientRects()].filter((r) => r.width > 1);
    return [c.textContent, c.closest('.scroll').clientWidth, c.offsetWidth,
        Math.max(...words.map((r) => r.right)) - c.closest('.scroll').getBoundingClientRect().left,
        new Set(words.map((r) => Math.round(r.top / 8))).size]; })"""


@pytest.mark.parametrize("name", ["all", "single"])
@pytest.mark.parametrize("width", [390, 768, 1280])
def test_a_caption_is_as_wide_as_the_page_and_not_as_its_table(browser, pages, name, width):
    page = opened(browser, pages / f"{name}.html", width=width, height=900)
    found = page.evaluate(CAPTIONS)
    assert found
    for text, room, own, right, lines in found:
        assert right <= room + 1, text  # and not cut off
        # A letter takes 8 px at most, and the table's tools 19 rem beside it.
        needed = len(text) * 8 / max(room - 19 * 16, 0.5 * room)
        assert lines <= needed + 2, (text, own)


def test_the_sources_of_error_are_cards_on_a_phone(browser, pages):
    page = opened(browser, pages / "all.html", **PHONE)
    cut = """[...document.querySelectorAll('main .scroll')].filter((b) =>
        b.clientWidth && b.scrollWidth > b.clientWidth + 1).map((b) => b.ariaLabel)"""
    assert page.evaluate(cut) == []
    labels = """[...document.querySelectorAll('#why td')].map((cell) =>
        getComputedStyle(cell, '::before').content)"""
    assert "attitude" in " ".join(page.evaluate(labels))
    assert '""' not in page.evaluate(labels)


def test_a_table_that_is_cut_says_so_at_its_edge(browser, pages):
    page = opened(browser, pages / "all.html", **PHONE)
    fold = "document.querySelectorAll('.scenario:not([hidden]) details')[2]"
    box = f"{fold}.querySelector('.scroll')"
    page.evaluate(f"{fold}.open = true")
    page.wait(f"{box}?.classList.contains('cut')")
    assert page.evaluate(f"getComputedStyle({box}).maskImage") != "none"
    page.evaluate(f"{box}.scrollLeft = 1e6")
    page.wait(f"!{box}.classList.contains('cut')")


def test_the_parts_of_the_page_are_named_whole_on_a_phone(browser, pages):
    page = opened(browser, pages / "all.html", **PHONE)
    right = """Math.max(...[...document.querySelectorAll('header nav a')].map((a) =>
        a.getBoundingClientRect().right))"""
    assert page.evaluate(right) <= PHONE["width"]


def test_grey_lines_are_named_below_their_chart(browser, pages):
    page = opened(browser, pages / "all.html", width=1280, height=900)
    looks = """[...document.querySelectorAll('figure')].map((figure) =>
        ['still', 'greys'].map((own) => [...figure.querySelectorAll(`.${own} path`)]
            .map((p) => p.getAttribute('class'))))"""
    found = page.evaluate(looks)
    greys = {"b", "d", "f", "p"}
    for drawn, named in found:
        assert greys & set(drawn) <= set(named)
    assert {look for _, named in found for look in named} >= {"b", "d", "p"}


BROKEN = """(own) => {
    const walker = document.createTreeWalker(own, NodeFilter.SHOW_TEXT);
    const range = document.createRange(), found = [];
    for (let node = walker.nextNode(); node; node = walker.nextNode()) {
        for (const part of node.data.matchAll(WORDS)) {
            range.setStart(node, part.index);
            range.setEnd(node, part.index + part[0].length);
            const tops = [...range.getClientRects()].filter((r) => r.width > 1)
                .map((r) => r.bottom);
            if (tops.length && Math.max(...tops) - Math.min(...tops) > 6) found.push(part[0]);
        }
    }
    return found; }"""
NUMBER = r"/[\d.]+e[-\u2060\d]+|[\d.]+(?=[\s\u00a0](?:s|rad)\b)[\s\u00a0]\w+/g"


@pytest.mark.parametrize("width", [340, 390, 450, 700, 900])
def test_no_number_is_broken_between_two_lines(browser, pages, width):
    page = opened(browser, pages / "all.html", width=width, height=900)
    page.evaluate("document.querySelectorAll('.scenario details').forEach((d) => (d.open = true))")
    script = BROKEN.replace("WORDS", NUMBER)
    assert page.evaluate(f"({script})(document.querySelector('main'))") == []


@pytest.mark.parametrize("width", [340, 390, 420, 450])
def test_no_option_of_a_command_is_broken(browser, pages, width):
    page = opened(browser, pages / "all.html", width=width, height=900)
    page.evaluate("document.querySelector('.matrix a[data-card]').click()")
    page.wait("document.getElementById('card').open")
    script = BROKEN.replace("WORDS", r"/(?<=^|\s)--?\w[\w-]*/g")
    for place in ("header", "#card"):
        assert page.evaluate(f"({script})(document.querySelector('{place}'))") == []
    text = "document.querySelector('#card .command code').textContent"
    assert page.evaluate(text).startswith("omegadot run sphere --engine ")


def test_a_term_is_explained_where_it_is_asked_for(browser, pages):
    page = opened(browser, pages / "all.html", width=1280, height=900)
    link = "document.querySelector('#verdicts-title a.term')"
    page.evaluate(f"{link}.focus()")
    page.press("Enter", 13, "\r")
    page.wait("document.getElementById('card').open")
    assert page.evaluate("[scrollY, location.hash]") == [0, ""]
    text = page.evaluate("document.getElementById('card').textContent")
    assert "The result of a gate" in text
    assert "Values: " in text
    page.press("Escape", 27)
    assert page.evaluate(f"document.activeElement === {link}")
    # The way into the glossary, where the term stands out.
    page.evaluate(f"{link}.click()")
    page.evaluate("document.querySelector('#card .body a').click()")
    page.wait("location.hash === '#term-verdict'")
    assert not page.evaluate("document.getElementById('card').open")
    back = "getComputedStyle(document.getElementById('term-{}')).backgroundColor"
    assert page.evaluate(back.format("verdict")) != page.evaluate(back.format("setup"))


def test_a_phone_explains_no_numbers_that_it_does_not_show(browser, pages):
    shown = """['.matrix .n', '.of-numbers'].map((name) =>
        [...document.querySelectorAll(name)].some((e) => e.offsetWidth > 0))"""
    for width, there in ((390, False), (1280, True)):
        page = opened(browser, pages / "all.html", width=width, height=900)
        assert page.evaluate(shown) == [there, there]
