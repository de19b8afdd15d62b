"""``omegadot.compare``: what changed from one run to another."""

from __future__ import annotations

import os
from pathlib import Path

from omegadot.commands.typed import typed
from omegadot.reports.record.record import Record, read_record
from omegadot.reports.record.whole_file import path_of
from omegadot.reports.two_runs.comparison import Comparison, compare_records

RunLike = str | os.PathLike[str] | Record
"""The folder of a run, or its record."""


@typed
def compare(was: RunLike, now: RunLike) -> Comparison:
    """What got better, worse, appeared and vanished from one run to another.

    was, now: folders, or records. Raises RecordError.
    """
    one, other = (
        run if isinstance(run, Record) else read_record(path_of(run)) for run in (was, now)
    )
    labels = (_label(was, "A"), _label(now, "B"))
    return compare_records(one, other, labels)


def _label(run: RunLike, otherwise: str) -> str:
    return otherwise if isinstance(run, Record) else Path(run).as_posix()
