"""Text for a comment on a pull request: a name stays text, and nothing grows too long."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence

# A comment may have 65 536 characters; sections are given parts of this.
COMMENT = 48_000
CELL = 240
_ENTITIES = {"&": "&amp;", "<": "&lt;", ">": "&gt;"}
_ACTIVE = re.compile(r"[\\`*_{}\[\]~|$]|^[-+=#]|:(?=//)|(?<=\bwww)\.", re.IGNORECASE)
# A joiner without width keeps a mention or the number of an issue from being one.
_CALLING = re.compile(r"([@#])(?=\w)")
_INVISIBLE = re.compile(r"[\x00-\x1f\x7f\u0085\u2028\u2029\u202a-\u202e\u2066-\u2069]+")


def escape(value: object, longest: int = CELL) -> str:
    """A text of one line in which nothing is markup, a link, a mention or a reference."""
    text = _INVISIBLE.sub(" ", str(value)).encode("utf-8", "replace").decode("utf-8").strip()
    if len(text) > longest:
        text = text[: longest - 1].rstrip() + "…"
    text = _ACTIVE.sub(lambda found: "\\" + found.group(), _CALLING.sub("\\1\u2060", text))
    return re.sub("[&<>]", lambda found: _ENTITIES[found.group()], text)


def code(value: object, longest: int = 1200) -> str:
    """A text between backticks as it is; control characters become blanks."""
    text = _INVISIBLE.sub(" ", str(value)).encode("utf-8", "replace").decode("utf-8").strip()
    text = text if len(text) <= longest else text[: longest - 1] + "…"
    runs = [len(run) for run in re.findall(r"`+", text)]
    fence = "`" * (max(runs, default=0) + 1)
    pad = " " if text[:1] == "`" or text[-1:] == "`" else ""
    return f"{fence}{pad}{text}{pad}{fence}" if text else ""


def table(
    heads: Sequence[str], rows: Iterable[Sequence[object]], room: int, left: str = "more"
) -> list[str]:
    """The lines of a table, as many rows as there is room for in bytes; how many are left out."""
    lines = [_row(map(escape, heads)), _row("---" for _ in heads)]
    used = sum(map(_size, lines))
    waiting = list(rows)
    for number, row in enumerate(waiting):
        line = _row(map(escape, row))
        used += _size(line)
        if used > room:
            return [*lines, "", f"… and {len(waiting) - number} {left}."]
        lines.append(line)
    return lines


def _row(cells: Iterable[str]) -> str:
    return "| " + " | ".join(cells) + " |"


def _size(line: str) -> int:
    return len(line.encode("utf-8")) + 1


def folded(title: str, lines: Iterable[str]) -> list[str]:
    """Lines that are shown when the reader opens them."""
    return ["", f"<details><summary>{title}</summary>", "", *lines, "", "</details>"]
