"""Time stamps that are dates, as ISO 8601 writes them, or times of day: as seconds, to all digits.

A date without a zone is read as UTC. Only differences of stamps and of ``--time-offset`` matter.
"""

from __future__ import annotations

import re
from datetime import datetime, timedelta
from decimal import Decimal

import polars as pl

DATE = re.compile(
    r"(?:(\d{4})[-/]?(\d\d)[-/]?(\d\d)[T ])?(\d\d):?(\d\d):?(\d\d)(?:[.,](\d+))?\s*"
    r"(Z|UTC|[+-]\d\d(?::?\d\d)?)?$"
)
_SEPARATED = re.compile(r"[T:]")
ZERO = datetime(1970, 1, 1)


def is_date(text: str) -> bool:
    """Whether a cell is a date with a time, or a time of day, and no plain number."""
    return bool(_SEPARATED.search(text) and DATE.match(text))


def seconds_of(text: str) -> str | None:
    """The seconds since 1970, or of the day, as a decimal number; None of anything else."""
    found = DATE.match(text.strip()) if _SEPARATED.search(text) else None
    if found is None:
        return None
    year, month, day, hour, minute, second, part, zone = found.groups()
    try:
        days = (datetime(int(year), int(month), int(day)) - ZERO).days if year else 0
    except ValueError:
        return None
    whole = 86400 * days + 3600 * int(hour) + 60 * int(minute) + int(second)
    if zone and zone[0] in "+-":
        digits = zone[1:].replace(":", "").ljust(4, "0")
        away = 3600 * int(digits[:2]) + 60 * int(digits[2:])
        whole -= away if zone[0] == "+" else -away
    return _joined(whole, part or "")


def as_date(seconds: Decimal) -> str:
    """The date of s since 1970 in UTC, or the time of day of fewer than a day has."""
    whole, part = divmod(seconds, 1)
    date = ZERO + timedelta(seconds=int(whole))
    text = date.strftime("%H:%M:%S" if 0 <= seconds < 86400 else "%Y-%m-%dT%H:%M:%S")
    digits = format(part, "f").partition(".")[2].rstrip("0")
    return f"{text}.{digits}" if digits else text


def _joined(whole: int, part: str) -> str:
    """``whole + 0.part``, whatever the sign of the first."""
    if not part or whole >= 0:
        return f"{whole}.{part}" if part else str(whole)
    return str(Decimal(whole) + Decimal(f"0.{part}"))


def decimal_seconds(cells: pl.Series) -> list[str] | None:
    """A column of dates, texts or Parquet's own, as decimal seconds; None of any other."""
    if cells.dtype == pl.Date or isinstance(cells.dtype, pl.Datetime | pl.Duration):
        ticks = cells.cast(pl.Datetime("ns")) if cells.dtype == pl.Date else cells
        unit = {"ms": 3, "us": 6, "ns": 9}[getattr(ticks.dtype, "time_unit", None) or "us"]
        whole = ticks.to_physical().to_list()
        return ["" if t is None else str(Decimal(t).scaleb(-unit)) for t in whole]
    if cells.dtype != pl.String or not is_date(cells.fill_null("").str.strip_chars()[0]):
        return None
    return [seconds_of(cell) or "" for cell in cells.fill_null("")]
