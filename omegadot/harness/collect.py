"""From a finished run to the record that reports read: tasks, metrics, trajectories."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Iterator
from functools import partial
from typing import Any

import numpy as np
import polars as pl

from omegadot import __version__
from omegadot.gates.bounds.scales import eps_of
from omegadot.gates.case import Case, Sweep, knobs_of
from omegadot.gates.rows import Row, worst
from omegadot.gates.runs.exact import exact_rows, floor_rows
from omegadot.gates.runs.trajectory import time_row
from omegadot.harness.judging.judged_run import JudgedRun
from omegadot.harness.outcome import Cause, CausesOf, EngineCase, JudgedCase, Outcome
from omegadot.reference_impl.system import Array, State
from omegadot.reports.record import schema

# Causes are tried by stepping again, which takes seconds: a run finds causes for so many failed
# integrators of an engine, in the order of the scenarios. `omegadot check` finds them for all.
MOST_CAUSES = 12
COLUMNS = {
    "orientation": ("qw", "qx", "qy", "qz"),
    "angular_velocity": ("wx", "wy", "wz"),
    "position": ("px", "py", "pz"),
    "linear_velocity": ("vx", "vy", "vz"),
}
MOST = float(np.finfo(float).max)
Labels = dict[str, Any]


def _labels(
    setup: str,
    case: str,
    engine: str,
    version: str,
    integrator: str | None,
    sweep: Sweep | None = None,
) -> Labels:
    """The columns that name a task."""
    return {
        "scenario": case,
        "engine": engine,
        "engine_version": version,
        "setup": setup,
        "integrator": integrator,
        **knobs_of(sweep),
    }


def _entry(
    labels: Labels, outcome: str, reason: str, rows: Iterable[Row] = (), why: str = ""
) -> dict[str, Any]:
    verdicts = defaultdict(list)
    for row in rows:
        verdicts[row.gate].append(row.verdict)
    gates = {gate: worst(verdicts[gate]) for gate in schema.GATES if verdicts[gate]}
    own = {"outcome": outcome, "reason": reason, "gates": gates, "why": why, "scheme": None}
    return {**labels, **own}


def _answered_entry(
    labels: Labels, found: EngineCase, outcome: str, reason: str, rows: Iterable[Row], why: str
) -> dict[str, Any]:
    """A task that ran, or whose run failed; a failure before it counts where it ran well."""
    earlier = found.result.first_failure()
    if outcome == "ok" and earlier is not None:
        outcome, reason = earlier.outcome, earlier.reason
    return _entry(labels, outcome, reason, [*found.shared, *rows], why)


def _judged_entry(
    labels: Labels, found: EngineCase, judged: JudgedRun, cause: Cause, diagnosed: set[Any]
) -> dict[str, Any]:
    """A run's task; where a gate fails, with the likeliest cause, if there is one.

    diagnosed: the scenarios and integrators of the engine for which causes were looked for.
    """
    outcome, reason = judged.outcome, judged.reason
    entry = _answered_entry(labels, found, outcome, reason, judged.rows, judged.why)
    entry["scheme"] = judged.integrator.scheme
    key, likeliest = (labels["scenario"], labels["integrator"]), ""
    if "fail" in entry["gates"].values() and (key in diagnosed or len(diagnosed) < MOST_CAUSES):
        diagnosed.add(key)
        likeliest = cause(judged)
    if likeliest:
        entry["cause"] = likeliest
    return entry


def _unstepped_entry(labels: Labels, found: EngineCase, cause: Cause) -> dict[str, Any]:
    """The one task of an engine without integrators: its model and its equations."""
    model = found.result.model
    entry = _answered_entry(labels, found, model.outcome, model.reason, (), "it has no integrator")
    likeliest = cause(None) if "fail" in entry["gates"].values() else ""
    return {**entry, "cause": likeliest} if likeliest else entry


def _unjudged_entries(
    label: partial[Labels], case: JudgedCase, found: EngineCase
) -> Iterator[dict[str, Any]]:
    """The tasks of a case without an exact solution."""
    outcome = "interrupted" if "interrupted" in case.reason else "raised"
    if found.engine.name == "exact":
        yield _entry(label("series"), outcome, case.reason)
        return
    for integrator in found.engine.integrators:
        for sweep in case.case.sweeps_of(integrator):
            yield _entry(label(integrator.name, sweep), outcome, case.reason)


def tasks_of_run(
    outcome: Outcome, cases: list[Case], setup: str, causes_of: CausesOf
) -> list[dict[str, Any]]:
    """Every task with its outcome; engines that did not start have one task a scenario.

    causes_of: names the likeliest causes of an engine's failures.
    """
    entries: list[dict[str, Any]] = []
    diagnosed: dict[str, set[Any]] = defaultdict(set)
    for case in outcome.cases:
        for found in case.engines:
            label = _label_of(setup, case, found)
            if case.truth is None:
                entries += _unjudged_entries(label, case, found)
            elif found.engine.name == "exact":
                source, rows = case.truth.source, exact_rows(case.case, case.truth)
                why = f"the exact solution itself, by {source}"
                entries.append(_answered_entry(label(source), found, "ok", "", rows, why))
            else:
                cause, known = causes_of(case, found), diagnosed[found.engine.name]
                for run in found.runs:
                    labels = label(run.integrator.name, run.sweep)
                    entries.append(_judged_entry(labels, found, run, cause, known))
                if not found.engine.integrators:
                    entries.append(_unstepped_entry(label(""), found, cause))
    for choice, answer in outcome.missing:
        for prepared in cases:
            for integrator in choice.integrators or ("",):
                labels = _labels(setup, prepared.name, choice.name, "", integrator)
                entries.append(_entry(labels, answer.outcome, answer.reason))
    return entries


def _label_of(setup: str, case: JudgedCase, found: EngineCase) -> partial[Labels]:
    """The labels of an engine's tasks on a case, of integrator and step."""
    engine = found.engine
    return partial(_labels, setup, case.case.name, engine.name, engine.description.version)


def _rows_of(case: JudgedCase, setup: str) -> Iterator[tuple[Labels, Iterable[Row]]]:
    """Rows with their labels; those of engine and scenario have no integrator and step.

    The exact solution's resolvable floors stand there whatever engines were requested.
    """
    for found in case.engines:
        label = _label_of(setup, case, found)
        yield label(None), found.shared
        for run in found.runs:
            yield label(run.integrator.name, run.sweep), run.rows
        if found.engine.name == "exact" and case.truth is not None:
            yield label(case.truth.source), exact_rows(case.case, case.truth)
    if case.truth is not None:
        source = case.truth.source
        labels = _labels(setup, case.case.name, "exact", __version__, source)
        yield labels, floor_rows(case.truth)


def metrics_of_run(outcome: Outcome, setup: str) -> pl.DataFrame:
    """One value a row; rows that belong to engine and scenario have no integrator and step."""
    rows = [
        {**labels, **vars(row)}
        for case in outcome.cases
        for labels, found in _rows_of(case, setup)
        for row in found
    ]
    columns = {name: f.dtype for name, f in schema.METRICS.items()}
    return pl.DataFrame(rows, schema=columns, orient="row")


def _samples(labels: Labels, time: Array, state: State, omega_dot: Array) -> pl.DataFrame:
    columns: dict[str, Array] = {"time": time}
    for field, names in COLUMNS.items():
        columns |= {name: getattr(state, field)[:, i] for i, name in enumerate(names)}
    columns |= {name: omega_dot[:, i] for i, name in enumerate(("ax", "ay", "az"))}
    numbers = {name: np.ascontiguousarray(values) for name, values in columns.items()}
    texts = [
        pl.lit(labels[name], dtype=field.dtype).alias(name)
        for name, field in schema.TRAJECTORIES.items()
        if name in labels
    ]
    return pl.DataFrame(numbers).with_columns(texts).select(list(schema.TRAJECTORIES))


def trajectories_of_run(outcome: Outcome, setup: str) -> pl.DataFrame:
    """Every run's samples, and the exact trajectory of every case."""
    frames = []
    for case in outcome.cases:
        truth = case.truth
        if truth is None:
            continue
        labels = _labels(setup, case.case.name, "exact", __version__, truth.source)
        frames.append(_samples(labels, truth.times, truth.state, truth.omega_dot))
        for found in case.engines:
            label, eps = _label_of(setup, case, found), eps_of(found.result.precision)
            for judged in found.runs:
                answer = found.result.runs.get((judged.integrator.name, judged.sweep.knob))
                if answer is not None and answer.ok:
                    run, labels = answer.result, label(judged.integrator.name, judged.sweep)
                    state, time = State(**run["state"]), run["time"]
                    # A clock may be rounded, and its samples stand where the exact solution's do.
                    if time_row(judged.sweep, time, eps).verdict == "pass":
                        time = judged.sweep.times
                    samples = _samples(labels, time, state, run["omega_dot"])
                    # One of no time, or of one before the start, has no place in a trajectory.
                    frames.append(samples.filter(pl.col("time").is_between(0.0, MOST)))
    return pl.concat(frames) if frames else schema.empty(schema.TRAJECTORIES)
