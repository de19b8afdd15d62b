"""``omegadot.run``: scenarios on engines, judged, as a record."""

from __future__ import annotations

import os
import time
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from omegadot.adapters.protocol import Setup
from omegadot.commands.check.exceptions import exceptions_of
from omegadot.commands.progress import Count, Progress, Reporter, Reporting, reporting
from omegadot.commands.run.declare import with_declared
from omegadot.commands.run.record import record_of
from omegadot.harness.arguments import case_of, engine_choices, scenarios_of, several
from omegadot.harness.engine_target import EngineLike
from omegadot.harness.outcome import Outcome, RunRequest, tasks_of
from omegadot.harness.plan import EngineChoice
from omegadot.harness.runner import Runner
from omegadot.reports.record.record import check_folder
from omegadot.reports.run_record import RunRecord, TaskResult
from omegadot.scenarios import ScenarioLike


@dataclass(frozen=True, repr=False)
class RunResult:
    """A run. record: its tables and its page.  folder: where it was written, if anywhere.

    required: engines that were given by name; one of these that is missing counts against the run.
    """

    record: RunRecord
    folder: Path | None = None
    required: frozenset[str] = frozenset()

    @property
    def complete(self) -> bool:
        """Whether it was not interrupted."""
        return bool(self.record.run["complete"])

    @property
    def failures(self) -> tuple[TaskResult, ...]:
        """The runs of which a gate fails, or that diverged."""
        return tuple(task for task in self.record.tasks if task.failed)

    @property
    def unanswered(self) -> tuple[TaskResult, ...]:
        """The runs whose engine crashed, raised, timed out, or is missing though it was named."""
        return tuple(
            task
            for task in self.record.tasks
            if task.broken or (task.outcome == "not-installed" and task.engine in self.required)
        )

    @property
    def answered(self) -> bool:
        """Whether every engine answered: no run is without an answer, and no process died."""
        return not (self.unanswered or self.record.run["worker_deaths"])

    @property
    def stale_exceptions(self) -> tuple[str, ...]:
        """Why a declared exception does not hold any more, a sentence each."""
        return tuple(entry["problem"] for entry in self.record.run.get("stale_exceptions", ()))

    @property
    def passed(self) -> bool:
        """Whether the run is complete, every engine answered and every gate holds."""
        held = not self.failures and not self.stale_exceptions
        return self.complete and self.answered and held

    def __repr__(self) -> str:
        verdict = "passed" if self.passed else "not passed"
        return f"<omegadot run, {verdict}: {self.record.headline}>"

    def _repr_html_(self) -> str:
        return self.record._repr_html_()


class RunInterrupted(KeyboardInterrupt):
    """Ctrl-C during a run. result: what had come in until then, written where it was to be."""

    def __init__(self, result: RunResult) -> None:
        super().__init__("interrupted")
        self.result = result


def run(
    scenarios: ScenarioLike | Sequence[ScenarioLike] = (),
    engines: EngineLike | Sequence[EngineLike] = (),
    *,
    timesteps: float | Sequence[float] = (),
    out: str | os.PathLike[str] | None = None,
    setup: Setup = "physics",
    adapters: EngineLike | Sequence[EngineLike] = (),
    exceptions: Sequence[str | os.PathLike[str]] = (),
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
    timesteps: s, instead of the scenarios' own.  out: a folder to write record and page to.
    exceptions: files of declared exceptions.  timeout: s, for one request to an engine.
    jobs: requests at the same time; as many as cores without it.  memory: GiB that one engine may
    hold.  seed: of the random states.  command: what the record names as the command.
    Raises UsageError, ScenarioError, RecordError, NoTruthError, and RunInterrupted on Ctrl-C.
    """
    choices = engine_choices(several(engines), several(adapters))
    steps = several(timesteps)
    cases = [case_of(scenario, steps) for scenario in scenarios_of(several(scenarios))]
    known = exceptions_of(choices, map(Path, exceptions))
    if out is not None:
        check_folder(Path(out))
    cores = jobs or os.cpu_count() or 1
    request = RunRequest(cases, choices, setup, seed, timeout, cores, memory)
    started = time.perf_counter()
    with reporting(progress) as report:
        outcome = execute(request, report)
    outcome, stale = with_declared(outcome, known if setup == "physics" else (), cases)
    record = record_of(outcome, request, command, time.perf_counter() - started)
    record.run["stale_exceptions"] = stale
    result = result_of(RunRecord.of(record), choices, out)
    if outcome.interrupted:
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


def result_of(
    record: RunRecord, choices: Sequence[EngineChoice], out: str | os.PathLike[str] | None
) -> RunResult:
    """The result of a record, which is written where a folder is given. Raises RecordError."""
    folder = None if out is None else record.save(out)
    return RunResult(record, folder, frozenset(c.name for c in choices if c.required))
