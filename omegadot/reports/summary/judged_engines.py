"""The engines that a headline is about: each once, whether it ran in one setup or in both."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass, field

from omegadot.reports.record.schema import YARDSTICKS
from omegadot.reports.summary.summary import Cell, Summary


@dataclass(frozen=True)
class JudgedEngines:
    """cells: by the label of a column.  labels: by engine, those of its columns.

    An engine with columns in two setups has the label of that for physics.
    """

    cells: dict[str, list[Cell]] = field(default_factory=dict)
    labels: dict[str, list[str]] = field(default_factory=dict)

    def __len__(self) -> int:
        return len(self.labels)

    @property
    def failing(self) -> list[str]:
        """The labels with a cell that fails."""
        return [n for n, cells in self.cells.items() if any(c.status == "fail" for c in cells)]

    def named(self, labels: Collection[str]) -> dict[str, list[str]]:
        """These columns by the names of their engines, with the setup where not all are among them.

        The order is that of the labels.
        """
        engines = {label: engine for engine, own in self.labels.items() for label in own}
        found: dict[str, list[str]] = {}
        for label in labels:
            engine = engines[label]
            if all(own in labels for own in self.labels[engine]):
                found.setdefault(engine, []).append(label)
            else:
                found[f"{label} set up for physics" if label == engine else label] = [label]
        return found

    def whole(self, labels: Collection[str]) -> int:
        """Of how many engines all columns are among these."""
        return sum(all(own in labels for own in found) for found in self.labels.values())


def judged_engines(summary: Summary) -> JudgedEngines:
    """The yardsticks are left out unless they alone ran or they fail."""
    every = [(column, cell) for (_, column), cell in summary.cells.items()]
    judged = [(c, cell) for c, cell in every if c.engine not in YARDSTICKS or cell.status == "fail"]
    found = JudgedEngines()
    for column, cell in judged or every:
        found.cells.setdefault(column.label, []).append(cell)
    setups: dict[str, dict[str, None]] = {}
    for column, _ in judged or every:
        setups.setdefault(column.label.removesuffix(f" {column.setup}"), {})[column.label] = None
    for engine, own in setups.items():
        found.labels[engine if len(own) > 1 else next(iter(own))] = list(own)
    return found
