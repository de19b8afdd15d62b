"""What a comment would make of a text: markup, links, mentions and references."""

from __future__ import annotations

import re

from markdown_it import MarkdownIt

OWN = ("<details>", "</details>", "<summary>", "</summary>")


def active(text: str) -> list[str]:
    """Whatever in it is more than text, headings, lists, tables and code."""
    html = MarkdownIt("commonmark", {"html": True}).enable("table").render(text)
    for tag in OWN:
        html = html.replace(tag, "")
    reported = re.sub(r"<code>.*?</code>", "", html, flags=re.DOTALL)
    allowed = r"/?(?:h3|p|ul|li|table|thead|tbody|tr|th|td|strong|hr /)"
    found = re.findall(rf"<(?!{allowed}>)[^>]*>", reported)
    found += re.findall(r"(?<![\w`])[@#]\w+", re.sub(r"&#?\w+;", "", reported))
    # Some renderers make a link of a bare address as well, unless its colon is escaped.
    return found + re.findall(r"(?<!\\):(?=//)", re.sub(r"(`+).*?\1", "", text))
