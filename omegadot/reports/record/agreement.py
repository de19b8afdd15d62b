"""Whether the two halves of a record agree: a task's verdicts are those of its rows."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

import polars as pl

from omegadot.reports.record.own_rows import entry_problems, row_problems, whose
from omegadot.reports.record.schema import VERDICTS, RecordError

# Rows of engine and scenario, without integrator and step, belong to each of its tasks.
_WHOLE = ("scenario", "engine", "engine_version", "setup")
_RUN = (*_WHOLE, "integrator", "timestep", "accuracy")
_JUDGED = ("fail", "declared", "pass")
Key = tuple[Any, ...]
Gates = dict[str, str]


def check_agreement(run: Mapping[str, Any], metrics: pl.DataFrame, where: str) -> None:
    """Raise RecordError, one sentence, where ``run.json`` contradicts the rows of the metrics.

    Each task's engine and scenario must be listed, the verdict of each of its gates must be the
    worst of its rows, and every row must belong to a task. What was only measured has no verdict.
    Nothing is listed twice, and each row's verdict follows from its value and its bound.
    where: the record's folder.
    """
    for file, problems in (
        ("run.json", entry_problems(run)),
        ("metrics.parquet", row_problems(metrics)),
    ):
        for problem in problems:
            raise RecordError(f"{where}: {file} contradicts itself: {problem}; run again.")
    for problem in _problems(run, metrics):
        raise RecordError(f"{where}: run.json and metrics.parquet disagree: {problem}; run again.")


def _problems(run: Mapping[str, Any], metrics: pl.DataFrame) -> Iterator[str]:
    found, tasks = _gates_of_rows(metrics), run["tasks"]
    scenarios, versions = {entry["name"] for entry in run["scenarios"]}, _versions(run)
    for task in tasks:
        whole, key = _keys(task)
        if task["scenario"] not in scenarios:
            yield f"a run on {task['scenario']} is stored, which is not among the scenarios"
        if task["engine"] not in versions:
            yield f"a run of {task['engine']} is stored, which is not among the engines"
        elif (own := task.get("engine_version")) and own not in versions[task["engine"]]:
            yield f"{whose(task)} is of version {own}, which is not among the engines"
        due = _worst_of(found.get(key, {}), found.get(whole, {}))
        gates = {g: v for g, v in (task.get("gates") or {}).items() if v in _JUDGED}
        for gate in dict.fromkeys([*gates, *due]):
            if gates.get(gate) != due.get(gate):
                one, other = gates.get(gate, "no verdict"), due.get(gate, "no verdict")
                yield f"the {gate} gate of {whose(task)} is {one!r}, and by its rows {other!r}"
    known = {key for task in tasks for key in _keys(task)}
    for key in found:
        # The exact solution has rows wherever it was computed, whether or not it was requested.
        if key not in known and key[1] != "exact":
            yield f"{whose(dict(zip(_RUN, key, strict=True)))} has rows and no run"


def _versions(run: Mapping[str, Any]) -> dict[str, set[str]]:
    """The versions of each engine that is listed."""
    found: dict[str, set[str]] = {}
    for entry in run["engines"]:
        found.setdefault(entry["name"], set()).add(str(entry.get("version") or ""))
    return found


def _gates_of_rows(metrics: pl.DataFrame) -> dict[Key, Gates]:
    """By what names a task, the worst verdict of each gate that is judged."""
    rank = pl.col("verdict").replace_strict(VERDICTS, range(len(VERDICTS)), return_dtype=pl.Int8)
    judged = metrics.filter(pl.col("verdict").is_in(_JUDGED))
    worst = judged.group_by(*_RUN, "gate", maintain_order=True).agg(rank.min())
    found: dict[Key, Gates] = {}
    for *key, gate, verdict in worst.select(*_RUN, "gate", "verdict").iter_rows():
        found.setdefault((*key[:4], key[4] or None, *key[5:]), {})[gate] = VERDICTS[verdict]
    return found


def _keys(task: Mapping[str, Any]) -> tuple[Key, Key]:
    """What names the task's engine on its scenario, and what names the task."""
    engine = task["engine"], task.get("engine_version") or "", task.get("setup") or "physics"
    run = task.get("integrator") or None, task.get("timestep"), task.get("accuracy")
    return (task["scenario"], *engine, None, None, None), (task["scenario"], *engine, *run)


def _worst_of(own: Gates, shared: Gates) -> Gates:
    both = {**shared, **own}
    for gate in own.keys() & shared.keys():
        both[gate] = min(own[gate], shared[gate], key=VERDICTS.index)
    return both
