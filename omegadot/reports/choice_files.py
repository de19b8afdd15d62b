"""Where a choice is kept: ``choice.json`` and the page ``choice.html`` in one folder."""

from __future__ import annotations

import os
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from omegadot.reports.choice_page import draw_choice
from omegadot.reports.run_json import dump_json
from omegadot.reports.schema import RecordError


def check_choice_folder(folder: Path) -> None:
    """Make the folder before the work begins. Raises RecordError where that cannot be done."""
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        reason = error.strerror or type(error).__name__
        raise RecordError(f"{folder}: cannot be written to ({reason}); give another.") from error
    if not os.access(folder, os.W_OK):
        raise RecordError(f"{folder}: cannot be written to; give another.")


def write_choice(choice: Mapping[str, Any], folder: Path) -> None:
    """Write page and JSON, each to a name of its own first, so that none is ever half there."""
    texts = {"choice.json": dump_json(choice), "choice.html": draw_choice(choice)}
    try:
        for name, text in texts.items():
            part = folder / f".{name}.part"
            part.write_text(text, encoding="utf-8")
            part.replace(folder / name)
    except OSError as error:
        reason = error.strerror or type(error).__name__
        raise RecordError(f"{folder}: cannot be written to ({reason}); give another.") from error
