"""What comes of a choice, for a script: the ranking, row by row, and the whole as tables."""

from __future__ import annotations

import os
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from omegadot.commands.report.report import redraw
from omegadot.reports.choice.page import draw_choice, write_choice
from omegadot.reports.notebook import framed
from omegadot.reports.record.record import RUN
from omegadot.reports.record.whole_file import path_of
from omegadot.written import written


@dataclass(frozen=True)
class Ranked:
    """An engine and integrator that qualifies on a scenario, with its largest step.

    rank: 1 for the cheapest; tied: others share it.  timestep: s, None where there is an accuracy:
    that of an error-controlled integrator, whose steps are nominal.  errors: by requirement, SI.
    real_time_factor: simulated over elapsed seconds, the median.  memory: bytes, None if unknown.
    """

    scenario: str
    rank: int
    tied: bool
    engine: str
    version: str
    integrator: str
    timestep: float | None
    steps: int
    errors: Mapping[str, float]
    real_time_factor: float
    memory: int | None
    accuracy: float | None = None

    @property
    def setting(self) -> str:
        """The step or the accuracy, as text."""
        if self.timestep is None:
            return f"an accuracy of {written(self.accuracy, 2)}"
        return f"{written(self.timestep)} s"


@dataclass(frozen=True, repr=False)
class ChooseResult:
    """A choice. document: all that was found, as in ``choice.json``.  written: files, if any.

    answered: every engine started and answered.
    """

    document: Mapping[str, Any]
    answered: bool
    written: tuple[Path, ...] = ()

    @property
    def ranking(self) -> tuple[Ranked, ...]:
        """Those that qualify, scenario by scenario, the cheapest first."""
        return tuple(
            Ranked(
                scenario=case["name"],
                rank=row["rank"],
                tied=row["tied"],
                engine=row["engine"],
                version=row["version"],
                integrator=row["integrator"],
                timestep=row["found"]["timestep"],
                steps=row["found"]["steps"],
                errors={name: error["value"] for name, error in row["found"]["errors"].items()},
                real_time_factor=row["real_time_factor"]["median"],
                memory=row["memory"],
                accuracy=row["found"]["accuracy"],
            )
            for case in self.document["scenarios"]
            for row in case["candidates"]
            if row["status"] == "qualifies"
        )

    @property
    def best(self) -> Ranked | None:
        """The cheapest; of several scenarios, of those that qualify in all, as on the first."""
        if len(self.document["scenarios"]) < 2:
            return next(iter(self.ranking), None)
        names = [row["candidate"] for row in self.document["everywhere"]]
        first = self.document["scenarios"][0]["name"]
        known = {f"{r.engine}:{r.integrator}": r for r in self.ranking if r.scenario == first}
        return known[names[0]] if names else None

    @property
    def qualifies(self) -> bool:
        """Whether something qualifies, on every scenario."""
        return self.best is not None

    def page(self) -> str:
        """The page: one HTML text that needs no other file."""
        return draw_choice(self.document)

    def save(self, folder: str | os.PathLike[str]) -> tuple[Path, ...]:
        """Write ``choice.html`` and ``choice.json``; in a run's folder into its page too.

        Raises RecordError.
        """
        out = path_of(folder)
        write_choice(self.document, out)
        paths = (out / "choice.html", out / "choice.json")
        return (*paths, redraw(out)) if (out / RUN).is_file() else paths

    def __repr__(self) -> str:
        best = self.best
        if best is None:
            return "<omegadot choice: nothing qualifies>"
        step = f"{best.engine}:{best.integrator} at {best.setting}"
        return f"<omegadot choice: {step}, of {len(self.ranking)} that qualify>"

    def _repr_html_(self) -> str:
        return framed(self.page(), repr(self).strip("<>"))
