"""``omegadot score``: a trace against the exact solution of a scenario."""

from __future__ import annotations

import sys
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import typer
from rich.console import Console

from omegadot.harness.command_run import BROKEN, exit_code
from omegadot.harness.plan import Case, EngineChoice
from omegadot.harness.score.columns import Columns, columns_of, words_of
from omegadot.harness.score.convention import (
    Convention,
    axes_of,
    check_convention,
    check_sequence,
)
from omegadot.harness.score.judged import Judged, Making, Reading, judge_trace
from omegadot.harness.score.map_file import read_map
from omegadot.harness.score.record import scored_record
from omegadot.harness.score.require import requirements_of
from omegadot.harness.score.rows import rows_of
from omegadot.harness.score.table import Table, read_table
from omegadot.harness.score.tell import WIDTH_WHEN_PIPED, machine_words, print_score
from omegadot.harness.usage import case_of, engine_choices, scenarios_of
from omegadot.harness.usage_error import UsageError
from omegadot.reports.page import draw_page
from omegadot.reports.record import PAGE, Record, check_folder, write_record
from omegadot.reports.run_json import dump_json

RESERVED = ("exact", "reference")
DEFAULT_ORDER = "wxyz"


@dataclass(frozen=True)
class Words:
    """What stands on the command line. settings: by option name; None where nothing is said."""

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


def settings_of(words: Words) -> tuple[list[tuple[str, list[str]]], dict[str, Any]]:
    """Columns and settings, the command line's before the map's. Raises UsageError."""
    own = words_of(words.columns)
    given = {key: value for key, value in words.settings.items() if value is not None}
    if words.map_file is None:
        return own, given
    mapped = read_map(words.map_file)
    said = {role for role, _ in own}
    kept = [(role, names) for role, names in mapped.columns if role not in said]
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


def reading_of(words: Words, table: Table) -> Reading:
    """The trace's columns and convention. Raises UsageError and TraceError."""
    columns, settings = settings_of(words)
    how = convention_of(settings)
    check_sequence(how.euler)
    order = settings.get("quaternion", DEFAULT_ORDER)
    found: Columns = columns_of(table, columns, order, how.euler)
    return Reading(table, found, how)


def case_named(scenario: str) -> Case:
    """The scenario to score by. Raises ScenarioError."""
    return case_of(scenarios_of([scenario])[0], [])


def _choices(words: Words) -> list[EngineChoice]:
    choices = engine_choices(words.engines) if words.engines else []
    taken = (*RESERVED, *(choice.name for choice in choices))
    if words.name in taken or not words.name.strip():
        raise UsageError(f"--name {words.name}: an engine is called so; give the trace another.")
    return choices


def score(words: Words, as_json: bool) -> int:
    """Score the trace, write its record, print what was found, and give the exit code."""
    case, choices = case_named(words.scenario), _choices(words)
    check_folder(words.out)
    requirements = tuple(requirements_of(words.requirements))
    reading = reading_of(words, read_table(words.trace))
    found = judge_trace(case, reading, Making(words.scheme, words.timestep, requirements))
    rows = rows_of(found)
    record = scored_record(found, rows, words.name, choices, ["omegadot", *sys.argv[1:]])
    write_record(record, words.out, draw_page(record))
    code = exit_code(record.run, choices)
    if as_json:
        _print_json(found, record, words, code)
    else:
        width = None if sys.stdout.isatty() else WIDTH_WHEN_PIPED
        print_score(found, rows, words.name, Console(width=width, highlight=False))
        _print_others(record, words.name)
        typer.echo(f"Report: {words.out / PAGE}")
    return code


def _print_others(record: Record, name: str) -> None:
    others = [task for task in record.run["tasks"] if task["engine"] != name]
    failed = [t for t in others if "fail" in t["gates"].values() or t["outcome"] in BROKEN]
    if others:
        engines = ", ".join(dict.fromkeys(task["engine"] for task in others))
        ended = f"{len(failed)} of them failed" if failed else "none failed"
        typer.echo(f"Run beside it: {engines}, {len(others)} runs, {ended}.")


def _print_json(found: Judged, record: Record, words: Words, code: int) -> None:
    said = machine_words(found, rows_of(found), words.name)
    result = {
        "schema": record.run["schema"],
        "exit_code": code,
        "folder": str(words.out),
        "report": str(words.out / PAGE),
        **said,
        "tasks": record.run["tasks"],
    }
    typer.echo(dump_json(result))
