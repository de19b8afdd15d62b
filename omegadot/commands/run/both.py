"""A run in both setups: after the one for physics the same as shipped, and its single settings."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from typing import Any

import polars as pl

from omegadot.commands.progress import Count, Reporter
from omegadot.commands.run.single_settings import SingleSettings
from omegadot.harness.outcome import Outcome, RunRequest
from omegadot.reports.record.record import Record
from omegadot.reports.record.schema import SETUPS, YARDSTICKS

AS_SHIPPED = SETUPS[1]


@dataclass(frozen=True)
class AsShipped:
    """The second half of a run in both setups.

    settings: runs with a single setting mended, as ``run.json`` holds them.  deaths: of these.
    """

    request: RunRequest
    outcome: Outcome
    settings: list[dict[str, Any]] = field(default_factory=list)
    deaths: list[tuple[str, str]] = field(default_factory=list)


def run_as_shipped(
    first: Outcome,
    request: RunRequest,
    execute: Callable[[RunRequest, Reporter], Outcome],
    report: Reporter,
) -> AsShipped | None:
    """The engines that started for physics, as shipped; None where there are none, or the first
    half was interrupted. The yardsticks have no setups.
    """
    choices = [engine.choice for engine in first.engines if engine.name not in YARDSTICKS]
    if first.interrupted or not choices:
        return None
    request = replace(request, choices=choices, setup=AS_SHIPPED)
    outcome = execute(request, report)
    if outcome.interrupted:
        return AsShipped(request, outcome)
    singles = SingleSettings(request, outcome)
    count = Count(report, "single settings", singles.total)
    try:
        return AsShipped(request, outcome, singles.execute(count.advance), singles.deaths)
    except KeyboardInterrupt:
        return AsShipped(request, replace(outcome, interrupted=True))


def joined(physics: Record, shipped: Record, own: AsShipped) -> Record:
    """One record of both halves.

    The exact solution stands there once, as for physics, and so do the entries of the engines.
    Clusters are those of the setup physics.
    """
    run = {**physics.run, "single_settings": own.settings}
    run["complete"] = physics.run["complete"] and shipped.run["complete"]
    run["tasks"] = [*physics.run["tasks"], *shipped.run["tasks"]]
    deaths = [{"engine": name, "how": how} for name, how in own.deaths]
    run["worker_deaths"] = [
        *physics.run["worker_deaths"],
        *shipped.run["worker_deaths"],
        *deaths,
    ]
    engines = ~pl.col("engine").is_in(YARDSTICKS)
    metrics = pl.concat([physics.metrics, shipped.metrics.filter(engines)])
    samples = pl.concat([physics.trajectories, shipped.trajectories.filter(engines)])
    return Record(run, metrics, samples)
