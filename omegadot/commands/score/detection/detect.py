"""``omegadot.detect``: the conventions of a trace that fit a scenario."""

from __future__ import annotations

import os
from collections.abc import Sequence
from pathlib import Path

from omegadot.commands.score.detection.search import Detected, time_column
from omegadot.commands.score.detection.search import detect as search
from omegadot.commands.score.read_table import read_table
from omegadot.commands.score.score import case_given
from omegadot.commands.score.settings import GivenColumns, settings_of
from omegadot.commands.score.table import Table, find_column
from omegadot.scenarios import ScenarioLike


def detect(
    trace: str | os.PathLike[str],
    scenario: ScenarioLike,
    *,
    columns: GivenColumns = (),
    map_file: str | os.PathLike[str] | None = None,
) -> Detected:
    """Which conventions a trace can be read in so that it is the scenario's motion.

    ``fitting`` holds one reading where the conventions are found; its ``arguments()`` are those to
    score with, ``score(trace, scenario, **reading.arguments())``.
    columns, map_file: as of `score`; of columns that are named, these alone are tried.
    Raises UsageError, TraceError (a UsageError) and ScenarioError.
    """
    case, table = case_given(scenario), read_table(Path(trace))
    assigned, _ = settings_of(columns, Path(map_file) if map_file else None, {})
    column, names = _looked_at(table, assigned)
    return search(case, table, column, names)


def _looked_at(
    table: Table, mapped: Sequence[tuple[str, Sequence[str]]]
) -> tuple[str, Sequence[str]]:
    """The time's column, and the others to try: those that are named, if any are; else all."""
    named = {role.lower(): [find_column(table, n, role) for n in names] for role, names in mapped}
    times = named.pop("t", []) + named.pop("time", [])
    others = {name for names in named.values() for name in names}
    tried = [name for name in table.names if name in others] if others else table.names
    return time_column(table, times[0] if times else None), tried
