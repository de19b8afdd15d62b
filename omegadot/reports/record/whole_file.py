"""A text file written whole or not at all, and the folder that it goes to."""

from __future__ import annotations

import os
import secrets
from pathlib import Path


def make_folder(folder: Path) -> None:
    """Make the folder before the work begins. Raises RecordError where that cannot be done."""
    from omegadot.reports.record.schema import RecordError

    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        reason = error.strerror or type(error).__name__
        raise RecordError(f"{folder}: cannot be written to ({reason}); give another.") from error
    if not os.access(folder, os.W_OK):
        raise RecordError(f"{folder}: cannot be written to; give another.")


def write_whole(target: Path, text: str) -> Path:
    """Write a text under another name, then give it its own. Raises RecordError, one sentence."""
    from omegadot.reports.record.schema import RecordError

    if target.is_dir():
        raise RecordError(f"{target}: is a folder; name a file.")
    fresh = target.with_name(f".{target.name}.{secrets.token_hex(6)}")
    try:
        fresh.write_text(text, encoding="utf-8", errors="replace", newline="\n")
        os.replace(fresh, target)
    except OSError as error:
        raise RecordError(f"{target}: cannot be written ({error.strerror}).") from error
    finally:
        fresh.unlink(missing_ok=True)
    return target
