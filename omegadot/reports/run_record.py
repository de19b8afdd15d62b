"""A record as a script or a notebook has it: its tables, its runs, its page."""

from __future__ import annotations

import os
from collections.abc import Mapping
from dataclasses import dataclass, fields
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING

from omegadot.reports.notebook import framed
from omegadot.reports.record import record as stored
from omegadot.reports.record.record import Record, write_record
from omegadot.reports.record.whole_file import path_of
from omegadot.reports.summary.reasons import cause_of

if TYPE_CHECKING:
    from omegadot.reports.shipped.rows import ShippedRow

_BROKEN = ("crashed", "timeout", "raised")


@dataclass(frozen=True)
class TaskResult:
    """One run: a scenario on an engine with an integrator and a step (s), and what came of it.

    outcome: ok, unsupported, not-installed, diverged, raised, crashed, timeout or interrupted, with
    the reason.  gates: pass, fail, declared or info by gate.  why: what explains the verdict.
    scheme: that it is declared to equal, if any.  cause: the likely one where a gate fails and one
    is found, else "".
    """

    scenario: str
    engine: str
    engine_version: str
    setup: str
    integrator: str
    timestep: float | None
    accuracy: float | None
    outcome: str
    reason: str
    gates: Mapping[str, str]
    why: str
    scheme: str | None
    cause: str = ""

    @property
    def failed(self) -> bool:
        """Whether a gate fails. A run that diverged fails none where its scheme does so, too."""
        return "fail" in self.gates.values()

    @property
    def broken(self) -> bool:
        """Whether the engine crashed, raised, or did not answer in time."""
        return self.outcome in _BROKEN


class RunRecord(Record):
    """run: what ``run.json`` holds.  metrics and trajectories: the contract's tables, in polars.

    In a notebook it shows its page: verdicts, charts, 3-D view.
    """

    @classmethod
    def of(cls, record: Record) -> RunRecord:
        """The same record."""
        return cls(record.run, record.metrics, record.trajectories)

    @cached_property
    def tasks(self) -> tuple[TaskResult, ...]:
        """Every run."""
        names = [field.name for field in fields(TaskResult) if field.name != "cause"]
        return tuple(
            TaskResult(**{name: task.get(name) for name in names}, cause=cause_of(task))
            for task in self.run["tasks"]
        )

    @cached_property
    def headline(self) -> str:
        """The verdict in one sentence."""
        from omegadot.reports.summary.headline import headline
        from omegadot.reports.summary.summary import summarise

        return str(self.run.get("headline") or headline(summarise(self)))

    @cached_property
    def as_shipped(self) -> tuple[ShippedRow, ...]:
        """Each engine as shipped beside the same set up for physics; () of a run in one setup."""
        from omegadot.reports.shipped.rows import shipped_rows

        return shipped_rows(self)

    def page(self) -> str:
        """The report: one HTML text that needs nothing else."""
        from omegadot.reports.page.page import draw_page

        return draw_page(self)

    def save(self, folder: str | os.PathLike[str]) -> Path:
        """Write the record and its page, ``report.html``, whole or not at all.

        Raises RecordError where the folder holds anything but an earlier record.
        """
        write_record(self, path_of(folder), self.page())
        return Path(folder)

    def markdown(self) -> str:
        """A summary for a pull request's comment."""
        from omegadot.reports.text.markdown import markdown_of

        return markdown_of(self).rstrip("\n")

    def figures(self, folder: str | os.PathLike[str]) -> list[Path]:
        """Write the charts as SVG and PNG, for papers; the paths. Raises RecordError.

        A record's folder is refused: no run could replace the record that has them in it.
        """
        from omegadot.reports.charts.static.write import write_figures

        target = path_of(folder)
        stored.check_no_record(target, "figures")
        return write_figures(self, target)

    def __repr__(self) -> str:
        return f"<omegadot record of {len(self.tasks)} runs: {self.headline}>"

    def _repr_html_(self) -> str:
        """What a notebook shows."""
        return framed(self.page(), self.headline)


def read_record(folder: str | os.PathLike[str]) -> RunRecord:
    """Read the record that a run has stored in a folder. Raises RecordError."""
    return RunRecord.of(stored.read_record(path_of(folder)))
