"""What a failing gate states: what is off, by how much, and against which bound."""

from __future__ import annotations

import math
from collections.abc import Sequence

from omegadot.gates.rows import Row
from omegadot.reports.text.numbers import listed, short

# Their notes are the whole sentence, with the figures in it.
NOTE_ALONE = ("match", "observed_order", "sample_times")

# For these the note is clearer than the figure, a fraction of its bound.
NOTE_BEFORE_FIGURE = ("restarted", "rate_at_no_step", "start", "precision")


def _excess(row: Row) -> float:
    """How many times its bound a value is; infinite where it is not finite or nothing is due."""
    if row.metric in NOTE_ALONE:
        return 0.0
    if row.bound is None or not math.isfinite(row.value):
        return math.inf
    return row.value / row.bound if row.bound > 0.0 else math.inf


def _unit(row: Row) -> str:
    return "" if row.unit == "1" else f" {row.unit}"


def sentence(row: Row) -> str:
    """One failing row as text."""
    if row.metric in (*NOTE_ALONE, *NOTE_BEFORE_FIGURE) and row.note:
        return f"{row.channel}: {row.note}"
    message = f"{row.channel}: {row.metric} is {short(row.value, 3)}{_unit(row)}"
    if row.bound is not None:
        excess, bound = _excess(row), f"{short(row.bound)}{_unit(row)}"
        times = f"{short(excess)} times " if math.isfinite(excess) else "above "
        message += f", {times}its bound of {bound}"
    return f"{message} ({row.note})" if row.note else message


def failure(rows: Sequence[Row], cause: str = "") -> str:
    """The failing rows of one gate: the worst in full, the other channels by name."""
    failing = [row for row in rows if row.verdict == "fail"]
    worst = max(failing, key=_excess)
    others = dict.fromkeys(row.channel for row in failing if row.channel != worst.channel)
    message = sentence(worst)
    if others:
        message += f"; {listed(list(others))} {'fail' if len(others) > 1 else 'fails'} as well"
    return f"{message}. Likely cause: {cause.rstrip('.')}." if cause else f"{message}."
