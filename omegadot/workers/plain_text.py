"""Text from an engine, made safe for a record, a terminal and a page."""

from __future__ import annotations

MOST_CHARACTERS = 500
_SHORTENED = " ..."


def one_line(text: str, most: int = MOST_CHARACTERS) -> str:
    """The text as one line of printable characters, cut where it is longer than `most`.

    Control characters, escape codes' first bytes and lone surrogates become spaces, so that the
    line can be written as UTF-8 and shown anywhere.
    """
    start = text[: 8 * most]  # a message may be megabytes long
    line = " ".join("".join(c if c.isprintable() else " " for c in start).split())
    if len(line) <= most and len(start) == len(text):
        return line
    return line[: most - len(_SHORTENED)] + _SHORTENED
