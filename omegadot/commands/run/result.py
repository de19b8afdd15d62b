"""What comes of a run, for a script: its record, and what of it fails or has no answer."""

from __future__ import annotations

import os
import tempfile
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from omegadot.commands.run.uninterrupted import uninterrupted
from omegadot.harness.plan import EngineChoice
from omegadot.reports.record.interrupted import (
    Written,
    place_of_complete,
    place_of_interrupted,
)
from omegadot.reports.record.record import RUN
from omegadot.reports.record.schema import RecordError
from omegadot.reports.run_record import RunRecord, TaskResult
from omegadot.reports.summary.reasons import tests_motion


@dataclass(frozen=True, repr=False)
class RunResult:
    """A run. record: its tables and its page.  folder: where it was written, if anywhere.

    required: engines that were given by name; one of these that is missing counts against the run.
    note: where the record of an interrupted run is and what becomes of an earlier one, or why a
    record is not where it was requested; "" else.
    """

    record: RunRecord
    folder: Path | None = None
    required: frozenset[str] = frozenset()
    note: str = ""

    @property
    def complete(self) -> bool:
        """Whether it was not interrupted."""
        return bool(self.record.run["complete"])

    @property
    def failures(self) -> tuple[TaskResult, ...]:
        """The runs of which a gate fails."""
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
    def untested(self) -> tuple[str, ...]:
        """The engines of which the model was judged and nothing else, or nothing at all.

        Those without integrators, and those that were given by name. A trace is none of them: it
        has no model, and with no scheme declared it is measured alone.
        """
        tasks = self.record.run["tasks"]
        moved = {task["engine"] for task in tasks if tests_motion(task)}
        modelled = [t["engine"] for t in tasks if not t["integrator"] and "model" in t["gates"]]
        named = [task["engine"] for task in tasks if task["engine"] in self.required]
        return tuple(e for e in dict.fromkeys([*modelled, *named]) if e not in moved)

    @property
    def answered(self) -> bool:
        """Whether every engine answered: no run is without an answer, no process died, and of no
        engine was the model alone judged, nor nothing of one that was given by name.
        """
        return not (self.unanswered or self.untested or self.record.run["worker_deaths"])

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


def unwritten(out: str | os.PathLike[str] | None) -> str:
    """What is left where a run is interrupted before its record could be written: a sentence."""
    folder = None if out is None else Path(out)
    earlier = folder is not None and os.path.lexists(folder / RUN)
    kept = f" The earlier record in {folder} is kept." if earlier else ""
    return f"Interrupted: no record of this run was written.{kept}"


class RunInterrupted(KeyboardInterrupt):
    """Ctrl-C during a run. result: what had come in until then, written where it was to be; the
    whole run where Ctrl-C came as it was written.
    """

    def __init__(self, result: RunResult) -> None:
        super().__init__("interrupted")
        self.result = result


def result_of(
    record: RunRecord,
    choices: Sequence[EngineChoice],
    out: str | os.PathLike[str] | None,
    earlier: Written,
) -> RunResult:
    """The result of a record, which is written where a folder is given. Raises RecordError.

    earlier: the record that was in the folder as the run began (`written_in`). Where another run
    wrote there meanwhile, both are kept (`place_of_complete`).
    An interrupted run goes to the folder only where there is no earlier record, else beside it (see
    `place_of_interrupted`). What finds no place, or is refused by the disk, is written to the
    system's folder for temporary files. Ctrl-C waits until it is written.
    """
    required = frozenset(c.name for c in choices if c.required)
    if out is None:
        return RunResult(record, None, required)
    with uninterrupted() as came:
        folder, note = _written(record, Path(out), earlier)
    result = RunResult(record, folder, required, note)
    if came:
        raise RunInterrupted(result)
    return result


def _written(record: RunRecord, requested: Path, earlier: Written) -> tuple[Path, str]:
    """Write the record; its folder, and the note on it."""
    folder: Path | None
    complete = bool(record.run["complete"])
    if complete:
        folder, note = place_of_complete(requested, earlier)
    else:
        folder, note = place_of_interrupted(record.run, requested)
    replaced = folder is not None and os.path.lexists(folder / RUN)
    try:
        if folder is not None:
            record.save(folder)
    except RecordError as error:
        if folder == requested and not isinstance(error.__cause__, OSError):
            raise
        folder, note = None, str(error)
    if folder is None:
        folder = record.save(Path(tempfile.mkdtemp(prefix="omegadot-")) / "run")
    elif complete and not note:
        return folder, ""
    elif replaced and not complete:
        note = f"{note} The record of an interrupted run in {folder} is replaced."
    return folder, f"{note or 'Interrupted.'} This run's record is in {folder}.".strip()
