"""``omegadot.run``: scenarios on engines, judged, as a record."""

from __future__ import annotations

import os
import time
from collections.abc import Sequence
from dataclasses import replace
from typing import Literal

from omegadot.adapters.protocol import Setup
from omegadot.commands.check.exceptions import exceptions_of
from omegadot.commands.progress import Count, Progress, Reporter, Reporting, reporting
from omegadot.commands.run.both import joined, run_as_shipped
from omegadot.commands.run.declare import with_declared
from omegadot.commands.run.record import record_of
from omegadot.commands.run.result import RunInterrupted, RunResult, result_of
from omegadot.commands.typed import typed
from omegadot.harness.arguments import Via, by_ways, case_of, engine_choices, scenarios_of, several
from omegadot.harness.engine_target import EngineLike
from omegadot.harness.outcome import Outcome, RunRequest, tasks_of
from omegadot.harness.runner import Runner
from omegadot.harness.usage import UsageError, check_setup
from omegadot.reports.record.interrupted import written_in
from omegadot.reports.record.record import Record, check_folder
from omegadot.reports.record.whole_file import path_of
from omegadot.reports.run_record import RunRecord
from omegadot.scenarios import ScenarioLike


@typed
def run(
    scenarios: ScenarioLike | Sequence[ScenarioLike] | None = None,
    engines: EngineLike | Sequence[EngineLike] | None = None,
    *,
    timesteps: float | Sequence[float] | None = None,
    accuracies: float | Sequence[float] | None = None,
    out: str | os.PathLike[str] | None = None,
    setup: Setup | Literal["both"] = "physics",
    via: Via | Sequence[Via] | None = None,
    adapters: EngineLike | Sequence[EngineLike] = (),
    exceptions: str | os.PathLike[str] | Sequence[str | os.PathLike[str]] = (),
    timeout: float = 60.0,
    jobs: int | None = None,
    memory: float | None = None,
    seed: int = 0,
    command: Sequence[str] = (),
    progress: Reporting = False,
) -> RunResult:
    """Run scenarios on engines, judge them, and give the record.

    scenarios: built-in names, paths, scenarios or their tables; all built-in ones without any.
    engines: ``NAME``, ``NAME:INTEGRATOR``, ``FILE.py:Class`` or an adapter's class; all that are
    registered without any.  adapters: engines of your own in addition, by class.
    timesteps: s, instead of the scenarios' own.  accuracies: relative, of error-controlled
    integrators, likewise.  out: a folder to write record and page to.
    setup: "both" runs every engine for physics and as shipped, and as shipped with single settings.
    via: how bodies go in: "api", or "urdf" or "mjcf" for each engine's own reader of such files.
    exceptions: files of declared exceptions.  timeout: s, for one request to an engine.
    jobs: requests at the same time; as many as cores without it.  memory: GiB that one engine may
    hold.  seed: of the random states.  command: what the record names as the command.
    Raises UsageError, ScenarioError, RecordError, NoTruthError, and RunInterrupted on Ctrl-C.
    """
    choices = by_ways(
        engine_choices(several(engines, "engines"), several(adapters)), several(via, "via")
    )
    knobs = several(timesteps, "timesteps"), several(accuracies, "accuracies")
    cases = [
        case_of(scenario, *knobs) for scenario in scenarios_of(several(scenarios, "scenarios"))
    ]
    files: list[str | os.PathLike[str]] = several(exceptions)
    check_setup(setup, "both")
    if files and setup == "as-shipped":
        raise UsageError("--exceptions: they are of --setup physics; leave one of the two out.")
    known = exceptions_of(choices, map(path_of, files))
    if out is not None:
        check_folder(path_of(out))
    earlier = None if out is None else written_in(path_of(out))
    cores = (os.cpu_count() or 1) if jobs is None else jobs
    first: Setup = "physics" if setup == "both" else setup
    request = RunRequest(cases, choices, first, seed, timeout, cores, memory)
    started = time.perf_counter()
    with reporting(progress) as report:
        outcome = execute(request, report)
        shipped = None
        if setup == "both":
            shipped = run_as_shipped(outcome, request, execute, report)
    outcome, stale = with_declared(outcome, known if first == "physics" else (), cases)
    seconds = time.perf_counter() - started

    def made(causes: bool) -> Record:
        record = record_of(outcome, request, command, seconds, causes)
        if shipped is None:
            return record
        other = record_of(shipped.outcome, shipped.request, command, seconds, causes)
        return joined(record, other, shipped)

    try:
        record = made(causes=True)
    except KeyboardInterrupt:  # as causes are sought, which may take long: without them
        outcome = replace(outcome, interrupted=True)
        record = made(causes=False)
    record.run["stale_exceptions"] = stale
    result = result_of(RunRecord.of(record), choices, out, earlier)
    if not result.complete:
        raise RunInterrupted(result)
    return result


def execute(request: RunRequest, report: Reporter) -> Outcome:
    """Run everything that is requested, and report how far it is."""
    runner = Runner(request)
    report(Progress("starting the engines"))

    def planned() -> None:
        started = runner.engines.started
        total = sum(tasks_of(engine, case) for engine in started for case in request.cases)
        count = Count(report, "running", total)
        runner.on_advance = count.advance

    runner.on_start = planned
    return runner.execute()
