"""What is shown: the record's format, the summary, the terminal's table, the HTML page.

This room reads records alone, so that a page can be drawn again from a stored run. What is named
here is imported on first use.
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from omegadot.reports.page.page import draw_page
    from omegadot.reports.record.record import (
        Record,
        check_folder,
        read_record,
        write_record,
    )
    from omegadot.reports.record.schema import SCHEMA, RecordError
    from omegadot.reports.summary.summary import Summary, summarise
    from omegadot.reports.text.terminal import print_summary

__all__ = [
    "SCHEMA",
    "Record",
    "RecordError",
    "Summary",
    "check_folder",
    "draw_page",
    "print_summary",
    "read_record",
    "summarise",
    "write_record",
]
_PLACES = {
    "page.page": ("draw_page",),
    "record.record": ("Record", "check_folder", "read_record", "write_record"),
    "record.schema": ("SCHEMA", "RecordError"),
    "summary.summary": ("Summary", "summarise"),
    "text.terminal": ("print_summary",),
}


def __getattr__(name: str) -> Any:
    for module, names in _PLACES.items():
        if name in names:
            return getattr(import_module(f"{__name__}.{module}"), name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
