"""One measured value: what a gate writes and `metrics.parquet` holds."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

VERDICTS = ("info", "pass", "declared", "fail")


@dataclass(frozen=True)
class Row:
    """A value of the contract's `metrics.parquet`, without the columns that name its task."""

    gate: str
    channel: str
    metric: str
    value: float
    unit: str
    bound: float | None = None
    verdict: str = "info"
    note: str = ""


def within(
    gate: str, channel: str, metric: str, value: float, unit: str, bound: float, note: str = ""
) -> Row:
    """A row that passes where the value is at most its bound; NaN fails. note: of a failure."""
    if value <= bound:
        return Row(gate, channel, metric, value, unit, bound, "pass")
    return Row(gate, channel, metric, value, unit, bound, "fail", note)


def worst(verdicts: Iterable[str]) -> str | None:
    """The worst of some verdicts, None of none."""
    return max(verdicts, key=VERDICTS.index, default=None)
