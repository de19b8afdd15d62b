"""The cards of the matrix: each number of a cell with the run that gave it."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from omegadot.reports.summary.figures import Figure
from omegadot.reports.summary.matrix import named, origin_of, shown, text
from omegadot.reports.summary.provenance import Sources
from omegadot.reports.summary.summary import Cell, Summary


def cards(summary: Summary, sources: Sources, anchors: Mapping[str, str]) -> list[list[Any]]:
    """The card of each cell: ``[address, verdict, part, [[what, value, source], ...]]``.

    In the order of the matrix, row by row.
    """
    return [
        [
            anchors[name],
            text(summary.cells[name, column].status),
            shown(summary.cells[name, column]).part,
            [
                [what, named(figure)[0], sources.number(origin_of(column, figure))]
                for what, figure in _figures(summary.cells[name, column])
            ],
            sources.number(origin_of(column)),
        ]
        for name in summary.scenarios
        for column in summary.columns
    ]


def _figures(cell: Cell) -> list[tuple[str, Figure]]:
    found = [("worst omega-dot residual, relative", cell.residual)]
    for what, span in (
        ("angular-momentum drift, relative", cell.drift),
        ("attitude error", cell.attitude),
    ):
        if span is not None:
            found += [(f"{what}: best integrator, finest step", span.best)]
            found += [(f"{what}: worst integrator, finest step", span.worst)]
    return [(what, figure) for what, figure in found if figure is not None]
