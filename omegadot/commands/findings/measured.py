"""What was measured of a finding: its figure in a record, and that of its script; kept as JSON."""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping
from dataclasses import asdict, dataclass, fields, replace
from pathlib import Path
from typing import Any

import polars as pl

from omegadot.commands.findings.entry import Entry
from omegadot.harness.usage import UsageError
from omegadot.reports.record.record import Record
from omegadot.reports.record.schema import SETUPS
from omegadot.reports.record.whole_file import write_whole
from omegadot.scenarios import ScenarioError
from omegadot.scenarios.files import read_bytes

FILE = "measured.json"
MARK = '"omegadot findings"'
LARGEST = 1_000_000
VERDICTS_FROM_WORST = ("fail", "declared", "pass", "info")
_TEXTS = ("release", "unit", "verdict", "script_release", "script_error")


@dataclass(frozen=True)
class Measured:
    """Of one finding. A number is None, and a text "", where there is none.

    release: of the engine in the record.  value, unit, bound: of the metric's row.  verdict: the
    worst of the run's rows.  physics: the value set up for physics, of a finding as shipped.
    script_release, script_value, script_mended: what the script printed; script_error: why it
    printed nothing.
    """

    release: str = ""
    value: float | None = None
    unit: str = ""
    bound: float | None = None
    verdict: str = ""
    physics: float | None = None
    script_release: str = ""
    script_value: float | None = None
    script_mended: float | None = None
    script_error: str = ""


def from_records(entry: Entry, records: Iterable[Record], before: Measured) -> Measured:
    """What the last of the records that has the run holds of it; else what was known before."""
    found = before
    for record in records:
        run = _rows(entry, record, entry.setup)
        row = _row(entry, run)
        if row is None:
            continue
        other = _row(entry, _rows(entry, record, SETUPS[0])) if entry.setup != SETUPS[0] else None
        own = {name: row[name] for name in ("value", "unit", "bound")}
        verdicts = set(run["verdict"])
        worst = next(one for one in VERDICTS_FROM_WORST if one in verdicts)
        physics = other["value"] if other else None
        release = row["engine_version"]
        found = replace(before, release=release, verdict=worst, physics=physics, **own)
    return found


def _rows(entry: Entry, record: Record, setup: str) -> pl.DataFrame:
    """Those of the run; those of the model and of equations have no integrator and step."""
    own = {"engine": entry.engine, "scenario": entry.scenario_name, "setup": setup}
    given = {"integrator": entry.integrator, "timestep": entry.timestep}
    wanted = [pl.col(name) == value for name, value in own.items()]
    wanted += [pl.col(name).is_null() | (pl.col(name) == value) for name, value in given.items()]
    return record.metrics.filter(*wanted)


def _row(entry: Entry, run: pl.DataFrame) -> dict[str, Any] | None:
    """That of the finding's metric."""
    names = ("gate", "channel", "metric")
    wanted = [pl.col(name) == value for name, value in zip(names, entry.row, strict=True)]
    rows = run.filter(*wanted).to_dicts()
    return rows[0] if rows else None


def read_measured(folder: Path) -> dict[str, Measured]:
    """By the name of a finding what was measured before; {} for nothing. Raises UsageError."""
    path = folder / FILE
    if not path.exists():
        return {}
    try:
        data = json.loads(read_bytes(path, str(path), "JSON", LARGEST))
        return {str(name): _read(own) for name, own in data["findings"].items()}
    except ScenarioError as error:
        raise UsageError(str(error)) from None
    except (ValueError, KeyError, TypeError, AttributeError, RecursionError):
        raise UsageError(
            f"{path}: not what findings wrote; remove it, and measure again."
        ) from None


def _read(own: Mapping[str, Any]) -> Measured:
    """One, of which each value is of its type. Raises ValueError, TypeError."""
    found = Measured(**own)
    for field in fields(Measured):
        value = getattr(found, field.name)
        fits = isinstance(value, str) if field.name in _TEXTS else _is_number(value)
        if not fits:
            raise ValueError(field.name)
    return found


def _is_number(value: object) -> bool:
    return value is None or (isinstance(value, int | float) and not isinstance(value, bool))


def write_measured(folder: Path, found: Mapping[str, Measured]) -> Path:
    """Write them, whole or not at all. Raises RecordError."""
    table = {name: asdict(found[name]) for name in sorted(found)}
    text = json.dumps({"made by": "omegadot findings", "findings": table}, indent=1)
    return write_whole(folder / FILE, f"{text}\n", MARK)
