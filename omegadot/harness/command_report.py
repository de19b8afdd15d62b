"""``omegadot report``: the page of a stored run, drawn again."""

from __future__ import annotations

import os
import secrets
from pathlib import Path

from omegadot.reports.page import draw_page
from omegadot.reports.record import PAGE, read_record
from omegadot.reports.schema import RecordError


def redraw(folder: Path) -> Path:
    """Draw the page anew and put it in the run's folder; returns its path. Raises RecordError."""
    page = draw_page(read_record(folder))
    target = folder / PAGE
    fresh = folder / f".{PAGE}.{secrets.token_hex(6)}"
    try:
        fresh.write_text(page, encoding="utf-8", errors="replace", newline="\n")
        os.replace(fresh, target)
    except OSError as error:
        fresh.unlink(missing_ok=True)
        raise RecordError(f"{target}: cannot be written ({error.strerror}).") from error
    return target
