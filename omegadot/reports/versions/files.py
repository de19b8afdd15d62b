"""The folder of ``omegadot versions``: the record as JSON, and the page drawn of it."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from omegadot.reports.record.schema import RecordError
from omegadot.reports.record.whole_file import write_whole
from omegadot.reports.versions.page import draw_versions

RECORD, PAGE = "versions.json", "versions.html"


def check_folder(folder: Path) -> None:
    """Make the folder, before any work is done for it. Raises RecordError."""
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise RecordError(f"{folder}: cannot be made a folder ({error.strerror}).") from error


def write_versions(record: dict[str, Any], folder: Path) -> None:
    """Both files, each whole or not at all. Raises RecordError."""
    write_whole(folder / RECORD, json.dumps(record, indent=2) + "\n")
    write_whole(folder / PAGE, draw_versions(record))
