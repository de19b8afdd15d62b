"""The charts that are not over time: omega-dot at identical states, and the Pareto front."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Any

from omegadot.reports.charts.bounds import Residual
from omegadot.reports.charts.front import FrontPoint
from omegadot.reports.charts.palette import colours
from omegadot.reports.summary.provenance import Sources
from omegadot.reports.text.numbers import engine_name


def _digits(value: float | None) -> float | None:
    return None if value is None else float(f"{value:.4g}")


def equation_payload(
    residuals: Iterable[Residual], sources: Sources, engines: Sequence[str]
) -> list[list[Any]]:
    """``[engine, label, colour, source, random, bound, path, bound]`` an engine, in their order.

    engines: all of the page, so that each has the colour that its lines have.
    """
    colour = colours(engines)
    return [
        [
            r.engine,
            engine_name(r.engine, setup=r.setup),
            colour[r.engine],
            sources.number({**vars(r), "engine_version": r.version}),
            *(_digits(value) for value in (*r.random, *r.path)),
        ]
        for r in residuals
        if r.engine != "exact"
    ]


def front_payload(front: Iterable[FrontPoint]) -> list[list[float | None]]:
    """``[cost, error]`` along the front, the cheapest first."""
    return [[_digits(p.cost), _digits(p.error)] for p in front]


def engines_drawn(lines: Iterable[Any], residuals: Mapping[str, Sequence[Residual]]) -> list[str]:
    """The engines that have a line, in the page's order, and those with a residual alone."""
    others = (r.engine for own in residuals.values() for r in own)
    return list(dict.fromkeys([*(line.engine for line in lines), *others]))
