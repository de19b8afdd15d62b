"""The time stamps of a trace: they must rise, and a digit more or less is a time open."""

from __future__ import annotations

import numpy as np

from omegadot.commands.score.convention import Convention
from omegadot.commands.score.csv_table import CsvTable
from omegadot.commands.score.digits import open_time
from omegadot.commands.score.table import Table, TraceError
from omegadot.reference_impl.system import Array

# Of a motion, more than one instant is needed.
FEWEST_SAMPLES = 2


def stamps_of(table: Table, name: str, how: Convention) -> tuple[Array, Array]:
    """(n,) s from the scenario's start, and what is open of each. Raises TraceError."""
    column = table.column(name)
    unit, raw = how.scale_of("time"), column.values
    if len(raw) < FEWEST_SAMPLES:
        raise TraceError(f"{table.file}: has one sample only; give a trace with at least two.")
    gaps = np.diff(raw)
    repeated, back = np.flatnonzero(gaps == 0.0), np.flatnonzero(gaps < 0.0)
    if len(back):
        k, more = int(back[0]), len(back) - 1
        raise TraceError(
            f"{table.file}: {table.place(k + 1)}: the time goes back from {raw[k]:g} to "
            f"{raw[k + 1]:g}{_more(more)}; sort the samples."
        )
    if len(repeated):
        k, more = int(repeated[0]), len(repeated) - 1
        raise TraceError(
            f"{table.file}: {table.place(k)} and {table.place(k + 1)}: the time {raw[k]:g} is "
            f"repeated{_more(more)}; keep one sample of each instant."
        )
    opened = open_time(table.cells(name), raw) if isinstance(table, CsvTable) else column.open
    return unit * raw - how.time_offset, unit * opened


def _more(count: int) -> str:
    return f", and {count} times more" if count else ""
