"""``omegadot score``: a trace against the exact solution of a scenario."""

from __future__ import annotations

import sys
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import typer
from rich.console import Console

from omegadot.commands.run.run import BROKEN, exit_code
from omegadot.commands.score.columns import Columns, arguments_of, columns_of
from omegadot.commands.score.convention import (
    Convention,
    axes_of,
    check_convention,
    check_sequence,
)
from omegadot.commands.score.judged import Judged, Making, Reading, judge_trace
from omegadot.commands.score.map_file import read_map
from omegadot.commands.score.print_score import WIDTH_WHEN_PIPED, machine_readable, print_score
from omegadot.commands.score.read_table import read_table
from omegadot.commands.score.record import scored_record
from omegadot.commands.score.require import requirements_of
from omegadot.commands.score.rows import rows_of
from omegadot.commands.score.table import Table
from omegadot.gates.case import Case
from omegadot.harness.arguments import case_of, engine_choices, scenarios_of
from omegadot.harness.plan import EngineChoice
from omegadot.harness.usage import UsageError
from omegadot.reports.page.page import draw_page
from omegadot.reports.record.record import PAGE, Record, check_folder, write_record
from omegadot.reports.record.run_json import dump_json

RESERVED = ("exact", "reference")
DEFAULT_ORDER = "wxyz"


@dataclass(frozen=True)
class Arguments:
    """What stands on the command line. settings: by option name; None where nothing is reported."""

    trace: Path
    scenario: str
    columns: Sequence[str] = ()
    map_file: Path | None = None
    settings: Mapping[str, Any] = field(default_factory=dict)
    scheme: str | None = None
    timestep: float | None = None
    requirements: Mapping[str, str | None] = field(default_factory=dict)
    name: str = "trace"
    engines: Sequence[str] = ()
    out: Path = Path("omegadot-score")


def settings_of(terms: Arguments) -> tuple[list[tuple[str, list[str]]], dict[str, Any]]:
    """Columns and settings, the command line's before the map's. Raises UsageError."""
    own = arguments_of(terms.columns)
    given = {key: value for key, value in terms.settings.items() if value is not None}
    if terms.map_file is None:
        return own, given
    mapped = read_map(terms.map_file)
    judgement = {role for role, _ in own}
    kept = [(role, names) for role, names in mapped.columns if role not in judgement]
    return own + kept, {**mapped.settings, **given}


def convention_of(settings: Mapping[str, Any]) -> Convention:
    """The convention that the settings declare. Raises UsageError."""
    names = {
        key.replace("-", "_"): value
        for key, value in settings.items()
        if key not in ("quaternion", "world-axes", "body-axes", "attitude-is")
    }
    if "attitude-is" in settings:
        names["attitude"] = settings["attitude-is"]
    for key in ("world", "body"):
        if f"{key}-axes" in settings:
            names[key] = axes_of(settings[f"{key}-axes"], f"--{key}-axes")
    return check_convention(Convention(**names))


def reading_of(terms: Arguments, table: Table) -> Reading:
    """The trace's columns and convention. Raises UsageError and TraceError."""
    columns, settings = settings_of(terms)
    how = convention_of(settings)
    check_sequence(how.euler)
    order = settings.get("quaternion", DEFAULT_ORDER)
    found: Columns = columns_of(table, columns, order, how.euler)
    return Reading(table, found, how)


def case_named(scenario: str) -> Case:
    """The scenario to score by. Raises ScenarioError."""
    return case_of(scenarios_of([scenario])[0], [])


def _choices(terms: Arguments) -> list[EngineChoice]:
    choices = engine_choices(terms.engines) if terms.engines else []
    taken = (*RESERVED, *(choice.name for choice in choices))
    if terms.name in taken or not terms.name.strip():
        raise UsageError(f"--name {terms.name}: an engine is called so; give the trace another.")
    return choices


def score(terms: Arguments, as_json: bool) -> int:
    """Score the trace, write its record, print what was found, and give the exit code."""
    case, choices = case_named(terms.scenario), _choices(terms)
    check_folder(terms.out)
    requirements = tuple(requirements_of(terms.requirements))
    reading = reading_of(terms, read_table(terms.trace))
    found = judge_trace(case, reading, Making(terms.scheme, terms.timestep, requirements))
    rows = rows_of(found)
    record = scored_record(found, rows, terms.name, choices, ["omegadot", *sys.argv[1:]])
    write_record(record, terms.out, draw_page(record))
    code = exit_code(record.run, choices)
    if as_json:
        _print_json(found, record, terms, code)
    else:
        width = None if sys.stdout.isatty() else WIDTH_WHEN_PIPED
        print_score(found, rows, terms.name, Console(width=width, highlight=False))
        _print_others(record, terms.name)
        typer.echo(f"Report: {terms.out / PAGE}")
    return code


def _print_others(record: Record, name: str) -> None:
    others = [task for task in record.run["tasks"] if task["engine"] != name]
    failed = [t for t in others if "fail" in t["gates"].values() or t["outcome"] in BROKEN]
    if others:
        engines = ", ".join(dict.fromkeys(task["engine"] for task in others))
        ended = f"{len(failed)} of them failed" if failed else "none failed"
        typer.echo(f"Run beside it: {engines}, {len(others)} runs, {ended}.")


def _print_json(found: Judged, record: Record, terms: Arguments, code: int) -> None:
    judgement = machine_readable(found, rows_of(found), terms.name)
    result = {
        "schema": record.run["schema"],
        "exit_code": code,
        "folder": str(terms.out),
        "report": str(terms.out / PAGE),
        **judgement,
        "tasks": record.run["tasks"],
    }
    typer.echo(dump_json(result))
