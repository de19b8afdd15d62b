"""The glossary: one source for the page and docs/glossary.md, and every link leads to a term."""

import re
from pathlib import Path

import pytest
from synthetic_record import build

from omegadot.reports.page.glossary import TERMS, glossary_markdown, linked, terms_in
from omegadot.reports.page.page import draw_page

DOCUMENT = Path(__file__).parents[2] / "docs" / "glossary.md"
REQUIRED = {
    *("residual", "floor", "round-off bound", "explained", "consistent"),
    *("scheme", "companion", "order", "defect"),
    "whole inertia",  # which causes name
}


def test_the_document_is_the_page_s_own_glossary():
    assert DOCUMENT.read_text(encoding="utf-8") == glossary_markdown()


def test_every_term_has_two_sentences_and_a_formula_or_unit():
    names = [term.name for term in TERMS]
    assert names == sorted(names, key=str.lower)
    assert set(names) >= REQUIRED
    for term in TERMS:
        assert len(re.findall(r"[.](?: |$)", term.text)) == 2, term.name
        assert term.formula


@pytest.mark.parametrize(
    ("heading", "names"),
    [
        ("worst omega-dot residual, relative", ["residual"]),
        ("observed order (declared)", ["order"]),
        ("fraction of round-off bound", ["round-off bound"]),
        ("Failures and declared exceptions", ["declared exception"]),
        ("reordered schemers", []),
        ("whose body never flips", ["flips in time"]),  # not the flips within
        ("flip time", ["flip"]),
        ("scheme-bound order", ["order"]),  # no part of a compound
    ],
)
def test_terms_are_found_as_whole_terms(heading, names):
    assert [term.name for term in terms_in(heading)] == names


def test_a_heading_stays_text():
    assert linked("<b>order</b>").startswith("&lt;b&gt;order&lt;/b&gt; <a ")


def test_every_link_of_the_page_leads_to_a_term():
    page = draw_page(build(("sphere",)))
    targets = set(re.findall(r'href="#(term-[^"]+)"', page))
    assert {"term-residual", "term-scheme", "term-order", "term-round-off-bound"} <= targets
    assert targets <= set(re.findall(r'<dt id="([^"]+)"', page))
