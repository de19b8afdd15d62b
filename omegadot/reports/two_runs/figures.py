"""Figures that both records measured: which left their bands, and whose verdict changed.

A band accounts for rounding alone. Each of two runs of one scheme lies within its round-off bound
of the trajectory that the scheme has in exact arithmetic, so their errors differ by at most the sum
of the two bounds.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import polars as pl

from omegadot.reports.text.numbers import engine_name, magnitude
from omegadot.reports.two_runs.change import Change, Measure
from omegadot.reports.two_runs.sides import RunKey, Side

_KEY = list(RunKey._fields)
_NAME = ["gate", "channel", "metric", "nth"]
# The bound of an order is the declared one; that of everything else that has one is rounding.
_NOT_ROUNDING = "observed_order"
CHANCE = 1e-3
# Measured at states drawn by the seed.
_DRAWN = ("residual", "state")
# From the worst to the best; what is not judged is no pass.
VERDICT_RANK = {"fail": 0, "declared": 1, "info": 2, "pass": 3}


def figures_by_run(side: Side, versioned: set[str]) -> pl.DataFrame:
    """The metrics, under the keys of `tasks_of`; nth: of equal names."""
    engine = pl.col("engine")
    version = pl.when(engine.is_in(sorted(versioned))).then(pl.col("engine_version"))
    integrator = pl.when(engine != "exact").then(pl.col("integrator"))
    frame = side.record.metrics.with_columns(
        version=version.otherwise(pl.lit("")).fill_null(""),
        integrator=integrator.otherwise(pl.lit("")).fill_null(""),
    )
    nth = pl.int_range(pl.len()).over(*_KEY, "gate", "channel", "metric")
    kept = ("unit", "value", "bound", "verdict", "note")
    return frame.with_columns(nth=nth).select(*_KEY, *_NAME, *kept)


def paired(was: Side, now: Side, versioned: set[str]) -> pl.DataFrame:
    """Every figure that both records hold, the second one's with the suffix ``_now``."""
    one, other = (figures_by_run(side, versioned) for side in (was, now))
    keys = _KEY + _NAME
    return one.join(other, keys, nulls_equal=True, suffix="_now", maintain_order="right")


def _held(same_seed: bool, redefined: set[str]) -> pl.Expr:
    """Whether a figure has a band: its bounds are finite, and both are of the same motion."""
    drawn = pl.col("gate").is_in(["model", "equation"]) & pl.col("metric").is_in(_DRAWN)
    bounds = pl.col("bound").is_finite() & pl.col("bound_now").is_finite()
    return (
        bounds.fill_null(value=False)
        & (pl.col("metric") != _NOT_ROUNDING)
        & (pl.col("unit") == pl.col("unit_now"))
        & ~pl.col("scenario").is_in(sorted(redefined))
        & (pl.lit(same_seed) | ~drawn)
    )


def changed_figures(pairs: pl.DataFrame, same_seed: bool, redefined: set[str]) -> Iterator[Change]:
    """The figures that left their bands, and those whose verdict changed.

    pairs: of `paired`.  redefined: scenarios that are others now, of which only verdicts compare.
    An order that a sweep resolves and another does not is no change of verdict.
    """
    finite = pl.col("value").is_finite() & pl.col("value_now").is_finite()
    apart = (pl.col("value_now") - pl.col("value")).abs() > pl.col("band")
    ordinary = pl.col("metric") != _NOT_ROUNDING
    judged = ~pl.col("verdict").is_in(["pass", "info"])
    judged_now = ~pl.col("verdict_now").is_in(["pass", "info"])
    found = (
        pairs.with_columns(pl.col("value", "value_now").fill_null(float("nan")))
        .with_columns(band=pl.col("bound") + pl.col("bound_now"))
        .with_columns(
            moved=_held(same_seed, redefined)
            & pl.when(finite).then(apart).otherwise(pl.col("value").ne(pl.col("value_now"))),
            turned=(pl.col("verdict") != pl.col("verdict_now")) & (ordinary | judged | judged_now),
        )
        .filter(pl.col("moved") | pl.col("turned"))
    )
    for row in found.iter_rows(named=True):
        yield _change(row)


def _change(row: dict[str, Any]) -> Change:
    measure = Measure(row["value"], row["value_now"], row["band"], row["unit"])
    was, now = row["verdict"], row["verdict_now"]
    grew = magnitude(measure.now) >= magnitude(measure.was)
    # A verdict outranks a size: an error that passes now is no worse for being larger.
    worse = grew if was == now else VERDICT_RANK[now] < VERDICT_RANK[was]
    key = RunKey(*(row[name] for name in _KEY))
    gate, channel, metric, _ = (row[name] for name in _NAME)
    moved, why = row["moved"], row["note_now"] or ""
    return Change(key, worse, gate, channel, metric, was, now, measure, moved, why)


@dataclass(frozen=True)
class Cost:
    """Time per step now over that before, over the runs that both records timed.

    median; low and high: quartiles.  runs: how many there are.
    """

    engine: str
    integrator: str
    median: float
    low: float
    high: float
    runs: int


def _chance(scenarios: Sequence[pl.DataFrame]) -> float:
    """How likely it is that equal costs are ordered as these timings are; 1 where some overlap.

    Of n and m timings of one cost, 1 of (n + m choose n) orders has all of the one below the other.
    A value that stands at several steps was timed once.
    """
    odds, rising = 2.0, set[bool]()
    for own in scenarios:
        was, now = own.get_column("value"), own.get_column("value_now")
        rising.add(slower := bool(now.min() > was.max()))  # type: ignore[operator]
        if len(rising) > 1 or not (slower or now.max() < was.min()):  # type: ignore[operator]
            return 1.0
        odds /= math.comb(was.n_unique() + now.n_unique(), was.n_unique())
    return min(1.0, odds)


def costs(pairs: pl.DataFrame) -> list[Cost]:
    """One entry an engine and integrator whose cost changed, in the order of the second record.

    The steps of a scenario repeat one computation, so their timings show the noise. Listed is what
    is slower, or faster, on every scenario beyond all of it: the timings of the two records do not
    overlap, and equal costs would be ordered so in one of 1 000 cases at most.
    pairs: of `paired`.
    """
    before, now = pl.col("value"), pl.col("value_now")
    timed = pairs.filter(
        pl.col("metric") == "time_per_step",
        *(value.is_finite() & (value > 0.0) for value in (before, now)),
    )
    ratio, names = now / before, ("engine", "version", "setup", "integrator")
    rows = [
        key
        for key, own in timed.group_by(names, maintain_order=True)
        if _chance(own.partition_by("scenario")) <= CHANCE
    ]
    kept = pl.DataFrame(rows, {name: timed.schema[name] for name in names}, orient="row")
    timed = timed.join(kept, names, nulls_equal=True, how="semi", maintain_order="left")
    found = timed.group_by(names, maintain_order=True).agg(
        ratio.median().alias("median"),
        ratio.quantile(0.25, "linear").alias("low"),
        ratio.quantile(0.75, "linear").alias("high"),
        pl.len().alias("runs"),
    )
    return [
        Cost(engine_name(engine, version, setup), integrator, *spread)
        for engine, version, setup, integrator, *spread in found.rows()
    ]
