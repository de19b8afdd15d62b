"""What a record's tables hold: columns, types, units and allowed values."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

import polars as pl

from omegadot.written import written

if TYPE_CHECKING:
    import pyarrow as pa

SCHEMA = 1

CHANNELS = (
    "omega_dot",
    "omega",
    "attitude",
    "energy",
    "angular_momentum",
    "linear_momentum",
    "position",
    "torque",
    "model",
    "time",
)
# Engines that every run is judged by: they are no part of a comparison.
YARDSTICKS = ("exact", "reference")
GATES = ("model", "equation", "scheme", "invariants", "trajectory", "cost")
VERDICTS = ("fail", "declared", "pass", "info")
OUTCOMES = (
    "ok",
    "unsupported",
    "not-installed",
    "diverged",
    "raised",
    "crashed",
    "timeout",
    "interrupted",
)
SETUPS = ("physics", "as-shipped")


class RecordError(ValueError):
    """A record cannot be read or written; the message is one sentence for the user."""


@dataclass(frozen=True)
class Field:
    """One column. unit: SI, "1" for a pure number, None where a unit makes no sense.

    least: the smallest number that may stand there, where all must be finite.
    """

    dtype: type[pl.String] | type[pl.Float64]
    unit: str | None = None
    nullable: bool = False
    allowed: tuple[str, ...] | None = None
    least: float | None = None


_TEXT = Field(pl.String)
_SMALLEST = 5e-324  # above zero
_KNOBS = {
    "timestep": Field(pl.Float64, "s", nullable=True, least=_SMALLEST),
    "accuracy": Field(pl.Float64, "1", nullable=True, least=_SMALLEST),
}

METRICS: Mapping[str, Field] = {
    "scenario": _TEXT,
    "engine": _TEXT,
    "engine_version": _TEXT,
    "setup": Field(pl.String, allowed=SETUPS),
    "integrator": Field(pl.String, nullable=True),
    **_KNOBS,
    "gate": Field(pl.String, allowed=GATES),
    "channel": Field(pl.String, allowed=CHANNELS),
    "metric": _TEXT,
    "value": Field(pl.Float64, nullable=True),
    "unit": _TEXT,
    "bound": Field(pl.Float64, nullable=True),
    "verdict": Field(pl.String, allowed=VERDICTS),
    "note": Field(pl.String, nullable=True),
}


def _vector(prefix: str, unit: str, axes: str = "xyz") -> dict[str, Field]:
    return {f"{prefix}{axis}": Field(pl.Float64, unit) for axis in axes}


TRAJECTORIES: Mapping[str, Field] = {
    "scenario": _TEXT,
    "engine": _TEXT,
    "setup": Field(pl.String, allowed=SETUPS),
    "integrator": _TEXT,
    **_KNOBS,
    "time": Field(pl.Float64, "s", least=0.0),
    **_vector("q", "1", "wxyz"),
    **_vector("w", "rad/s"),
    **_vector("a", "rad/s^2"),
    **_vector("p", "m"),
    **_vector("v", "m/s"),
}


def arrow_schema(fields: Mapping[str, Field]) -> pa.Schema:
    """The same columns for Arrow, each with its unit in the field's metadata."""
    import pyarrow as pa  # imported by writers only

    kinds = {pl.String: pa.large_string(), pl.Float64: pa.float64()}
    return pa.schema(
        [
            pa.field(name, kinds[f.dtype], metadata=None if f.unit is None else {"unit": f.unit})
            for name, f in fields.items()
        ]
    )


def empty(fields: Mapping[str, Field]) -> pl.DataFrame:
    """A frame of these columns without a row."""
    return pl.DataFrame(schema={name: f.dtype for name, f in fields.items()})


def conform(frame: pl.DataFrame, fields: Mapping[str, Field], where: str) -> pl.DataFrame:
    """The frame with exactly these columns, in order and cast.

    Raises RecordError naming `where` and the column that is missing, of another type, null where a
    value must stand, or holding a number or a value the contract does not allow.
    """
    missing = [name for name in fields if name not in frame.columns]
    if missing:
        raise RecordError(f"{where}: the column {missing[0]!r} is missing; write the record again.")
    try:
        frame = frame.select(pl.col(name).cast(f.dtype) for name, f in fields.items())
    except pl.exceptions.PolarsError as error:
        raise RecordError(f"{where}: a column has another type than the contract's.") from error
    for name, field in fields.items():
        column = frame.get_column(name)
        if not field.nullable and column.null_count():
            raise RecordError(f"{where}: the column {name!r} has empty values, it must have none.")
        if field.least is not None:
            wrong = column.filter(~(column.is_finite() & (column >= field.least)))
            if len(wrong):
                kind = "no positive number" if field.least else "no number from 0 on"
                raise RecordError(
                    f"{where}: the column {name!r} holds {written(wrong[0])}, {kind}."
                )
        if field.allowed is not None:
            unknown = column.filter(~column.is_in(field.allowed))
            if len(unknown):
                raise RecordError(
                    f"{where}: the column {name!r} holds {unknown[0]!r}, "
                    f"expected one of {', '.join(field.allowed)}."
                )
    return frame
