"""Where a record goes whose folder is taken: of an interrupted run, or of a second at once."""

from __future__ import annotations

import itertools
import os
from pathlib import Path
from typing import Any

from omegadot.reports.record.record import RUN
from omegadot.reports.record.run_json import read_run
from omegadot.reports.record.schema import RecordError

_UNFINISHED = ("interrupted", "not-installed")
Written = tuple[int, int] | None  # the inode and the time (ns) of a record's run.json


def written_in(folder: Path) -> Written:
    """Which record is in `folder`, to know later whether it is another; None of none."""
    try:
        found = os.stat(folder / RUN)
    except OSError:  # what cannot be read is refused as it is written
        return None
    return found.st_ino, found.st_mtime_ns


def place_of_complete(folder: Path, earlier: Written) -> tuple[Path, str]:
    """The folder for a complete run that was to go to `folder`, and a sentence on what stays.

    It is `folder` unless its record is another than the `earlier` one, of when the run began: two
    runs into one folder would else lose the first. Then it is the first free of ``folder-2``,
    ``folder-3`` and so on.
    """
    now = written_in(folder)
    if now is None or now == earlier:
        return folder, ""
    beside = (folder.with_name(f"{folder.name}-{n}") for n in itertools.count(2))
    free = next(place for place in beside if not os.path.lexists(place))
    return free, f"The record in {folder} is kept: another run wrote it during this one."


def place_of_interrupted(run: dict[str, Any], folder: Path) -> tuple[Path | None, str]:
    """The folder for an interrupted `run` that was to go to `folder`, and a sentence on what stays.

    It is `folder` where that holds no record, or one of an interrupted run with at most as many
    finished tasks; else ``folder-interrupted`` under the same condition; else None.
    """
    own, note = _finished(run), ""
    for place in (folder, folder.with_name(f"{folder.name}-interrupted")):
        if not os.path.lexists(place / RUN):  # False as well of a name that is too long
            return place, note
        kept = _kept(place)
        if kept is None:
            note = f"The earlier record in {place} is kept: this run was interrupted."
        elif kept <= own:
            return place, note
        else:
            note = (
                f"The record in {place} is kept: its run was interrupted after {kept} tasks, "
                f"this one after {own}."
            )
    return None, note


def _finished(run: dict[str, Any]) -> int:
    return sum(task["outcome"] not in _UNFINISHED for task in run["tasks"])


def _kept(folder: Path) -> int | None:
    """The finished tasks of an interrupted run's record; None for any other, which stays."""
    try:
        run = read_run(folder / RUN)
    except RecordError:
        return None
    return None if run.get("complete", True) else _finished(run)
