"""``omegadot run``: from its arguments to a record and an exit code."""

from __future__ import annotations

import datetime
import sys
import time
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from omegadot import __version__
from omegadot.commands.check.exceptions import DeclaredException
from omegadot.commands.run.declare import with_declared
from omegadot.diagnosis.causes import causes_of
from omegadot.diagnosis.clusters import clusters_of_run
from omegadot.gates.case import Case
from omegadot.harness.collect import metrics_of_run, tasks_of_run, trajectories_of_run
from omegadot.harness.outcome import Outcome, RunRequest, tasks_of
from omegadot.harness.plan import EngineChoice
from omegadot.harness.runner import Runner
from omegadot.reports.page.page import draw_page
from omegadot.reports.record.record import Record, write_record
from omegadot.reports.record.schema import SCHEMA
from omegadot.workers.machine import describe_machine, package_versions

BROKEN = ("crashed", "timeout", "raised")
INTERRUPTED_EXIT = 130


@contextmanager
def progress_bar(runner: Runner, cases: Sequence[Case]) -> Iterator[None]:
    """A bar with an estimate on a terminal, nothing where standard error is piped."""
    if not sys.stderr.isatty():
        yield
        return
    from rich.console import Console
    from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn
    from rich.progress import TimeRemainingColumn as Remaining

    columns = (TextColumn("{task.description}"), BarColumn(), MofNCompleteColumn(), Remaining())
    with Progress(*columns, console=Console(stderr=True), transient=True) as bar:
        task = bar.add_task("starting the engines", total=None)

        def planned() -> None:
            total = sum(
                tasks_of(engine, case) for engine in runner.engines.started for case in cases
            )
            bar.update(task, total=total, description="running")

        runner.on_start = planned
        runner.on_advance = lambda count: bar.advance(task, count)
        yield


def record_of(outcome: Outcome, request: RunRequest, command: list[str], seconds: float) -> Record:
    """The record of a finished or interrupted run."""
    now = datetime.datetime.now(datetime.UTC).replace(microsecond=0)
    run = {
        "schema": SCHEMA,
        "omegadot": __version__,
        "created": now.isoformat(),
        "command": command,
        "seed": request.seed,
        "seconds": round(seconds, 3),
        "complete": not outcome.interrupted,
        "machine": describe_machine(),
        "versions": package_versions(),
        "engines": _engines(outcome),
        "scenarios": [_scenario(case) for case in request.cases],
        "worker_deaths": [{"engine": name, "how": how} for name, how in outcome.deaths],
        "clusters": [vars(cluster) for cluster in clusters_of_run(outcome.cases)],
        "tasks": tasks_of_run(outcome, list(request.cases), request.setup, request.seed, causes_of),
    }
    return Record(
        run,
        metrics_of_run(outcome, request.setup),
        trajectories_of_run(outcome, request.setup),
    )


def _engines(outcome: Outcome) -> list[dict[str, Any]]:
    found: list[dict[str, Any]] = []
    for engine in outcome.engines:
        fields = vars(engine.description)
        integrators = [vars(integrator) for integrator in engine.description.integrators]
        features = sorted(engine.description.features)
        found.append(
            {**fields, "installed": True, "reason": "", "integrators": integrators}
            | {"features": features}
        )
    for choice, answer in outcome.missing:
        found.append({"name": choice.name, "installed": False, "reason": answer.reason})
    return found


def _scenario(case: Case) -> dict[str, Any]:
    scenario, body, load = case.scenario, case.system.body, case.system.load
    return {
        "name": scenario.name,
        "title": scenario.title,
        "shows": scenario.shows,
        "source": scenario.source,
        "definition": scenario.to_dict(),
        "system": {
            "mass": float(body.mass),
            "center_of_mass": body.center_of_mass.tolist(),
            "inertia": body.inertia.tolist(),
            "gravity": load.gravity.tolist(),
            "pivot": None if load.pivot is None else load.pivot.tolist(),
            "damping": float(load.damping),
            "torque_body": load.torque_body.tolist(),
            "torque_world": load.torque_world.tolist(),
        },
    }


def exit_code(run: dict[str, Any], choices: Sequence[EngineChoice]) -> int:
    """0 every gate holds, 1 a gate fails or a declared exception does not hold any more, 3 an
    engine failed to answer or to start.

    An engine that is not installed counts only where it was requested by name.
    """
    required = {choice.name for choice in choices if choice.required}
    tasks = run["tasks"]
    if not run["complete"]:
        return INTERRUPTED_EXIT
    if run["worker_deaths"] or any(task["outcome"] in BROKEN for task in tasks):
        return 3
    if any(t["outcome"] == "not-installed" and t["engine"] in required for t in tasks):
        return 3
    failed = any("fail" in t["gates"].values() or _diverged(t) for t in tasks)
    return 1 if failed or run.get("stale_exceptions") else 0


def _diverged(task: dict[str, Any]) -> bool:
    declared = task["gates"].get("trajectory") == "declared"
    return task["outcome"] == "diverged" and not declared


def run_and_write(
    request: RunRequest,
    out: Path,
    command: list[str],
    exceptions: Sequence[DeclaredException] = (),
) -> tuple[Record, int]:
    """Run, write the record with its page, and state how it went.

    exceptions: known failures, of engines that are set up for physics.
    """
    started = time.perf_counter()
    runner = Runner(request)
    with progress_bar(runner, request.cases):
        outcome = runner.execute()
    known = exceptions if request.setup == "physics" else ()
    outcome, stale = with_declared(outcome, known, request.cases)
    record = record_of(outcome, request, command, time.perf_counter() - started)
    record.run["stale_exceptions"] = stale
    write_record(record, out, draw_page(record))
    return record, exit_code(record.run, request.choices)
