"""Read a trace's file, CSV or Parquet."""

from __future__ import annotations

import io
from pathlib import Path

import polars as pl
import pyarrow as pa
import pyarrow.parquet as pq

from omegadot.commands.score.csv_table import csv_table
from omegadot.commands.score.table import MOST_SAMPLES, Table, TraceError

LARGEST_FILE = 500_000_000  # bytes
PARQUET_MAGIC = b"PAR1"


def read_table(path: Path) -> Table:
    """A CSV or Parquet file, recognised by how it begins. Raises TraceError."""
    content = _read(path)
    if content.startswith(PARQUET_MAGIC) or path.suffix.lower() in (".parquet", ".pq"):
        return parquet_table(str(path), content)
    return csv_table(str(path), content)


def _read(path: Path) -> bytes:
    try:
        if path.is_dir():
            raise TraceError(f"{path}: is a directory; give a CSV or Parquet file.")
        if not path.exists():
            raise TraceError(f"{path}: no such file; give a CSV or Parquet file.")
        if not path.is_file():
            raise TraceError(f"{path}: is not a regular file; give a CSV or Parquet file.")
        size = path.stat().st_size
        if size > LARGEST_FILE:
            raise TraceError(
                f"{path}: holds {size:,} bytes; give a trace of at most {LARGEST_FILE:,}."
            )
        content = path.read_bytes()
    except OSError as error:
        raise TraceError(f"{path}: not readable ({error.strerror or error}).") from error
    except TraceError:
        raise
    except ValueError as error:  # a NUL in the name
        raise TraceError(f"{str(path)!r}: not a path.") from error
    if not content.strip():
        raise TraceError(f"{path}: is empty; give a trace with at least two samples.")
    return content


def parquet_table(file: str, content: bytes) -> Table:
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
    return Table(file, tuple(frame.columns), frame.get_columns())
