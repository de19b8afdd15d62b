"""``omegadot.compare``: what changed from one run to another."""

from __future__ import annotations

import os
from pathlib import Path

from omegadot.reports.record.record import Record, read_record
from omegadot.reports.two_runs.comparison import Comparison, compare_records

RunLike = str | os.PathLike[str] | Record
"""The folder of a run, or its record."""


def compare(was: RunLike, now: RunLike) -> Comparison:
    """What got better, worse, appeared and vanished from one run to another.

    was, now: folders, or records. Raises RecordError.
    """
    records = _record(was), _record(now)
    return compare_records(*records, (_label(was, "A"), _label(now, "B")))


def _record(run: RunLike) -> Record:
    return run if isinstance(run, Record) else read_record(Path(run))


def _label(run: RunLike, otherwise: str) -> str:
    return otherwise if isinstance(run, Record) else Path(run).as_posix()
