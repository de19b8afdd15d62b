"""Option types that several commands share."""

from __future__ import annotations

from enum import StrEnum


class Format(StrEnum):
    """How results are printed."""

    text = "text"
    json = "json"


class PageFormat(StrEnum):
    """How results are printed that may also become a page."""

    text = "text"
    json = "json"
    markdown = "markdown"


class Setup(StrEnum):
    """Engines with what spoils physics switched off, or as they come."""

    physics = "physics"
    as_shipped = "as-shipped"
