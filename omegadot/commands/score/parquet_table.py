"""Parquet: columns of numbers, in double or single precision."""

from __future__ import annotations

import io
from dataclasses import dataclass

import numpy as np
import polars as pl
import pyarrow as pa
import pyarrow.parquet as pq

from omegadot.commands.score.table import LARGEST_NUMBER, MOST_SAMPLES, Column, TraceError

EPS_SINGLE, EPS_DOUBLE = (float(np.finfo(kind).eps) for kind in (np.float32, np.float64))


@dataclass(frozen=True)
class ParquetTable:
    """The columns of a Parquet file."""

    file: str
    names: tuple[str, ...]
    frame: pl.DataFrame

    def __len__(self) -> int:
        """How many samples there are."""
        return len(self.frame)

    def place(self, sample: int) -> str:
        """The row, from one."""
        return f"row {sample + 1}"

    def column(self, name: str) -> Column:
        """One column's numbers. Raises TraceError."""
        column = self.frame.get_column(name)
        if not column.dtype.is_numeric():
            raise TraceError(f"{self.file}: {name!r} holds {column.dtype}, not numbers.")
        values = column.cast(pl.Float64).fill_null(float("nan")).to_numpy()
        bad = np.flatnonzero(~(np.abs(values) <= LARGEST_NUMBER))
        if len(bad):
            more = f", and {len(bad) - 1} more" if len(bad) > 1 else ""
            found = column[int(bad[0])]
            fault = "is empty" if found is None else f"is {found}"
            raise TraceError(
                f"{self.file}: {self.place(int(bad[0]))}: {name!r} {fault}, a finite number of "
                f"sensible size was expected{more}."
            )
        eps = EPS_SINGLE if column.dtype == pl.Float32 else EPS_DOUBLE
        return Column(values, 0.5 * eps * np.abs(values))


def parquet_table(file: str, content: bytes) -> ParquetTable:
    """The table in a Parquet file's bytes. Raises TraceError."""
    try:
        frame = pl.DataFrame(pl.from_arrow(pq.read_table(io.BytesIO(content))))
    except (OSError, ValueError, pa.ArrowException, pl.exceptions.PolarsError) as error:
        raise TraceError(
            f"{file}: not a readable Parquet file (truncated or damaged); write it again."
        ) from error
    if frame.is_empty():
        raise TraceError(f"{file}: has no rows; give a trace with at least two samples.")
    if len(frame) > MOST_SAMPLES:
        raise TraceError(f"{file}: {len(frame):,} samples; give at most {MOST_SAMPLES:,}.")
    return ParquetTable(file, tuple(frame.columns), frame)
