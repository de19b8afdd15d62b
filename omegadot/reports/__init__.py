"""What is shown: the record's format, the summary, the terminal's table, the HTML page.

This room reads records alone, so that a page can be drawn again from a stored run.
"""

from omegadot.reports.page import draw_page
from omegadot.reports.record import Record, check_folder, read_record, write_record
from omegadot.reports.schema import SCHEMA, RecordError
from omegadot.reports.summary import Summary, summarise
from omegadot.reports.terminal import print_summary

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
