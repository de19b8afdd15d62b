"""From a finished run to the record that reports read: tasks, metrics, trajectories."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
import polars as pl

from omegadot import __version__
from omegadot.gates.case import Case
from omegadot.gates.exact_floor import floor_rows
from omegadot.gates.exact_rows import exact_rows
from omegadot.gates.rows import Row, worst
from omegadot.harness.judge import JudgedRun
from omegadot.harness.outcome import Cause, CausesOf, EngineCase, JudgedCase, Outcome
from omegadot.harness.plan import Engine, Task
from omegadot.reference_impl.system import Array, State
from omegadot.reports.record import schema
from omegadot.workers.wire import state_from

# Causes are tried by stepping again, which takes seconds: a run finds causes for so many failed
# integrators of an engine, in the order of the scenarios. `omegadot check` finds them for all.
MOST_CAUSES = 12
COLUMNS = {
    "orientation": ("qw", "qx", "qy", "qz"),
    "angular_velocity": ("wx", "wy", "wz"),
    "position": ("px", "py", "pz"),
    "linear_velocity": ("vx", "vy", "vz"),
}


def _task_entry(task: Task, version: str, outcome: str, reason: str) -> dict[str, Any]:
    return {
        "scenario": task.scenario,
        "engine": task.engine,
        "engine_version": version,
        "setup": task.setup,
        "integrator": task.integrator,
        "timestep": task.timestep,
        "accuracy": task.accuracy,
        "outcome": outcome,
        "reason": reason,
        "gates": {},
        "why": "",
        "scheme": None,
    }


def _gates(rows: list[Row]) -> dict[str, str]:
    found = {}
    for gate in schema.GATES:
        verdict = worst(row.verdict for row in rows if row.gate == gate)
        if verdict is not None:
            found[gate] = verdict
    return found


class _Causes:
    """Finds the likeliest causes, up to a number of diagnoses for each engine."""

    def __init__(self, causes_of: CausesOf, seed: int) -> None:
        self._causes_of, self._seed = causes_of, seed
        self._diagnosed: dict[str, set[tuple[str, str]]] = {}

    def of(self, case: JudgedCase, found: EngineCase) -> Cause:
        """The causes of one engine's runs on one case."""
        diagnose = self._causes_of(case, found, self._seed)
        diagnosed = self._diagnosed.setdefault(found.engine.name, set())

        def cause(run: JudgedRun | None) -> str:
            key = (case.case.name, run.integrator.name if run else "")
            if key not in diagnosed and len(diagnosed) >= MOST_CAUSES:
                return ""
            diagnosed.add(key)
            return diagnose(run)

        return cause


def _judged_entry(
    task: Task, version: str, found: EngineCase, judged: JudgedRun, cause: Cause
) -> dict[str, Any]:
    """A task that ran, or whose run failed; a failure before it counts where it ran well.

    Where a gate fails, the likeliest cause comes first among its reasons, if there is one.
    """
    earlier = found.result.first_failure()
    outcome, reason = judged.outcome, judged.reason
    if outcome == "ok" and earlier is not None:
        outcome, reason = earlier.outcome, earlier.reason
    entry = _task_entry(task, version, outcome, reason)
    entry["gates"] = _gates([*found.shared, *judged.rows])
    entry["why"] = judged.why
    likeliest = cause(judged) if "fail" in entry["gates"].values() else ""
    if likeliest:
        entry["why"] = f"likely cause: {likeliest}" + (f" ({judged.why})" if judged.why else "")
    entry["scheme"] = judged.integrator.scheme
    return entry


def _exact_tasks(case: JudgedCase, found: EngineCase, setup: str) -> Iterator[dict[str, Any]]:
    name = case.truth.source if case.truth else "series"
    task = Task(case.case.name, "exact", setup, name, None)
    version = found.engine.description.version
    if case.truth is None:
        yield _task_entry(task, version, _outcome_without_truth(case.reason), case.reason)
        return
    failure = found.result.first_failure()
    outcome, reason = (failure.outcome, failure.reason) if failure else ("ok", "")
    entry = _task_entry(task, version, outcome, reason)
    entry["gates"] = _gates([*found.shared, *exact_rows(case.case, case.truth)])
    entry["why"] = f"the exact solution itself, by {name}"
    yield entry


def _outcome_without_truth(reason: str) -> str:
    return "interrupted" if "interrupted" in reason else "raised"


def _engine_tasks(
    case: JudgedCase, found: EngineCase, setup: str, causes: _Causes
) -> Iterator[dict[str, Any]]:
    version, name = found.engine.description.version, found.engine.name
    if case.truth is None:
        for integrator in found.engine.integrators:
            for sweep in case.case.sweeps:
                task = Task(case.case.name, name, setup, integrator.name, sweep.timestep)
                outcome = _outcome_without_truth(case.reason)
                yield _task_entry(task, version, outcome, case.reason)
    cause = causes.of(case, found)
    for judged in found.runs:
        step = judged.sweep.timestep
        task = Task(case.case.name, name, setup, judged.integrator.name, step)
        yield _judged_entry(task, version, found, judged, cause)


def tasks_of_run(
    outcome: Outcome, cases: list[Case], setup: str, seed: int, causes_of: CausesOf
) -> list[dict[str, Any]]:
    """Every task with its outcome; engines that did not start have one task a scenario.

    seed: that of the run, from which the evaluation states were drawn.
    causes_of: names the likeliest causes of an engine's failures.
    """
    found: list[dict[str, Any]] = []
    causes = _Causes(causes_of, seed)
    for case in outcome.cases:
        for engine in case.engines:
            if engine.engine.name == "exact":
                found += _exact_tasks(case, engine, setup)
            else:
                found += _engine_tasks(case, engine, setup, causes)
    for choice, answer in outcome.missing:
        for prepared in cases:
            wanted = choice.integrators or ("",)
            for integrator in wanted:
                task = Task(prepared.name, choice.name, setup, integrator, None)
                found.append(_task_entry(task, "", answer.outcome, answer.reason))
    return found


def _metric(
    row: Row, case: str, engine: Engine, setup: str, task: JudgedRun | None, exact: str
) -> dict[str, Any]:
    return {
        "scenario": case,
        "engine": engine.name,
        "engine_version": engine.description.version,
        "setup": setup,
        "integrator": task.integrator.name if task else exact or None,
        "timestep": task.sweep.timestep if task else None,
        "accuracy": None,
        **vars(row),
    }


def _floors(case: JudgedCase, setup: str) -> list[dict[str, Any]]:
    """The exact solution's resolvable floors, which stand there whatever engines were requested."""
    if case.truth is None:
        return []
    labels = _labels(case.case.name, "exact", setup, case.truth.source, None)
    labels["engine_version"] = __version__
    return [{**labels, **vars(row)} for row in floor_rows(case.truth)]


def metrics_of_run(outcome: Outcome, setup: str) -> pl.DataFrame:
    """One value a row; rows that belong to engine and scenario have no integrator and step."""
    rows = []
    for case in outcome.cases:
        for found in case.engines:
            name, engine = case.case.name, found.engine
            rows += [_metric(row, name, engine, setup, None, "") for row in found.shared]
            for task in found.runs:
                rows += [_metric(row, name, engine, setup, task, "") for row in task.rows]
            if engine.name == "exact" and case.truth is not None:
                source = case.truth.source
                for row in exact_rows(case.case, case.truth):
                    rows.append(_metric(row, name, engine, setup, None, source))
        rows += _floors(case, setup)
    columns = {name: f.dtype for name, f in schema.METRICS.items()}
    return (
        pl.DataFrame(rows, schema=columns, orient="row") if rows else schema.empty(schema.METRICS)
    )


def _samples(labels: dict[str, Any], time: Array, state: State, omega_dot: Array) -> pl.DataFrame:
    columns: dict[str, Array] = {"time": time}
    for field, names in COLUMNS.items():
        columns |= {name: getattr(state, field)[:, i] for i, name in enumerate(names)}
    columns |= {name: omega_dot[:, i] for i, name in enumerate(("ax", "ay", "az"))}
    numbers = {name: np.ascontiguousarray(values) for name, values in columns.items()}
    texts = [pl.lit(v, dtype=schema.TRAJECTORIES[k].dtype).alias(k) for k, v in labels.items()]
    return pl.DataFrame(numbers).with_columns(texts).select(list(schema.TRAJECTORIES))


def _labels(
    case: str, engine: str, setup: str, integrator: str, timestep: float | None
) -> dict[str, Any]:
    return {
        "scenario": case,
        "engine": engine,
        "setup": setup,
        "integrator": integrator,
        "timestep": timestep,
        "accuracy": None,
    }


def trajectories_of_run(outcome: Outcome, setup: str) -> pl.DataFrame:
    """Every run's samples, and the exact trajectory of every case."""
    frames = []
    for case in outcome.cases:
        name, truth = case.case.name, case.truth
        if truth is None:
            continue
        labels = _labels(name, "exact", setup, truth.source, None)
        frames.append(_samples(labels, truth.times, truth.state, truth.omega_dot))
        for found in case.engines:
            for (integrator, timestep), answer in found.result.runs.items():
                if answer.ok:
                    labels = _labels(name, found.engine.name, setup, integrator, timestep)
                    run = answer.result
                    state = state_from(run["state"])
                    frames.append(_samples(labels, run["time"], state, run["omega_dot"]))
    return pl.concat(frames) if frames else schema.empty(schema.TRAJECTORIES)
