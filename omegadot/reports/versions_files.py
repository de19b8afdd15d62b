"""The folder of ``omegadot versions``: the record as JSON, and the page drawn of it."""

from __future__ import annotations

import json
import os
import secrets
from pathlib import Path
from typing import Any

from omegadot.reports.schema import RecordError
from omegadot.reports.versions_page import draw_versions

RECORD, PAGE = "versions.json", "versions.html"


def check_folder(folder: Path) -> None:
    """Make the folder, before any work is done for it. Raises RecordError."""
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise RecordError(f"{folder}: cannot be made a folder ({error.strerror}).") from error


def write_versions(record: dict[str, Any], folder: Path) -> None:
    """Both files, each whole or not at all. Raises RecordError."""
    _write(folder / RECORD, json.dumps(record, indent=2) + "\n")
    _write(folder / PAGE, draw_versions(record))


def _write(target: Path, text: str) -> None:
    fresh = target.with_name(f".{target.name}.{secrets.token_hex(6)}")
    try:
        fresh.write_text(text, encoding="utf-8", errors="replace", newline="\n")
        os.replace(fresh, target)
    except OSError as error:
        fresh.unlink(missing_ok=True)
        raise RecordError(f"{target}: cannot be written ({error.strerror}).") from error
