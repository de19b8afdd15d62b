"""A text file written whole or not at all."""

from __future__ import annotations

import os
import secrets
from pathlib import Path


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
