"""``omegadot compare``: two records held against each other."""

from __future__ import annotations

from pathlib import Path

from omegadot.reports.record.record import read_record
from omegadot.reports.record.run_json import dump_json
from omegadot.reports.two_runs import compare_records
from omegadot.reports.two_runs.text import as_json, as_markdown, as_text


def compare_folders(was: Path, now: Path, form: str) -> tuple[str, int]:
    """What changed from one record to the other, and the exit code. Raises RecordError."""
    comparison = compare_records(
        read_record(was), read_record(now), (was.as_posix(), now.as_posix())
    )
    if form == "json":
        message = dump_json(as_json(comparison)).rstrip("\n")
    elif form == "markdown":
        message = as_markdown(comparison).rstrip("\n")
    else:
        message = as_text(comparison)
    return message, 1 if comparison.regressed else 0
