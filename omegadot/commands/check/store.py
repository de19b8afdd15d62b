"""Write the figures that a suite has measured into its folder of baselines."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

from omegadot.commands.check.baseline import updated
from omegadot.commands.check.baseline_file import Baseline, read_baseline, write_baseline
from omegadot.commands.check.generate import Subject


def store(folder: Path, subjects: Iterable[Subject], figures: dict[str, Baseline]) -> list[Path]:
    """Update the baseline of every engine that gave figures; the files that were written."""
    written = []
    for subject in subjects:
        if subject.name in figures:
            stored = read_baseline(folder, subject.name)
            whole = updated(stored, figures[subject.name], subject)
            written.append(write_baseline(folder, subject.name, whole))
    return written
