"""Where a choice is kept: ``choice.json`` and the page ``choice.html`` in one folder."""

from __future__ import annotations

import json
import os
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from omegadot.reports.choice.page import Section, draw_choice, section_of
from omegadot.reports.record.run_json import dump_json
from omegadot.reports.record.schema import RecordError
from omegadot.reports.record.whole_file import write_whole

NAME = "choice.json"


def check_choice_folder(folder: Path) -> None:
    """Make the folder before the work begins. Raises RecordError where that cannot be done."""
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        reason = error.strerror or type(error).__name__
        raise RecordError(f"{folder}: cannot be written to ({reason}); give another.") from error
    if not os.access(folder, os.W_OK):
        raise RecordError(f"{folder}: cannot be written to; give another.")


def read_choice(folder: Path) -> Section | None:
    """The section of a choice that is stored with a run; None where there is none.

    Raises RecordError, one sentence, where it is not one that omegadot wrote.
    """
    path = folder / NAME
    if not path.is_file():
        return None
    try:
        return section_of(json.loads(path.read_text(encoding="utf-8")))
    except (OSError, ValueError, RecursionError, LookupError, TypeError, AttributeError) as error:
        raise RecordError(
            f"{path}: not a choice that omegadot wrote; remove it or choose again."
        ) from error


def write_choice(choice: Mapping[str, Any], folder: Path) -> None:
    """Page and JSON, each whole or not at all. Raises RecordError."""
    write_whole(folder / NAME, dump_json(choice))
    write_whole(folder / "choice.html", draw_choice(choice))
