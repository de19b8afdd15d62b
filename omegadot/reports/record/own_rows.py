"""Whether the rows of a record hold by themselves: each verdict by its value and its bound."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping
from typing import Any

import polars as pl

from omegadot.written import exactly, written

# Of an error over time: larger than rounding, and accepted for a reason that its note begins with.
_REASONS = ("explained by ", "consistent", "follows ", "keeps ")
_OVER_TIME = ("trajectory", "invariants")
_BY_SIZE = ("model", "equation")  # these fail for nothing but their size
# One row for each of several systems that are alike but for one number.
_REPEATED = "residual_of_sibling"
_TASK = ("scenario", "engine", "engine_version", "setup", "integrator")
_ORDER = "observed_order"  # more of it is better, and a scheme may explain less


def row_problems(metrics: pl.DataFrame) -> Iterator[str]:
    """What contradicts itself in the metrics: a clause each.

    A row that passes has a value of at most its bound. Else it is an order, which is a number, or
    an error over time whose note gives the reason. A row of the model or the equation gate that
    fails has a value above its bound. No row stands there twice.
    """
    value, bound, verdict = pl.col("value"), pl.col("bound"), pl.col("verdict")
    # Polars compares NaN as larger than every number.
    within = (value <= bound) & ~value.is_nan()
    note, order = pl.col("note").fill_null(""), pl.col("metric") == _ORDER
    reasoned = pl.any_horizontal(note.str.starts_with(text) for text in _REASONS)
    # What has blown up with its scheme has neither a value nor a bound.
    known = pl.col("gate").is_in(_OVER_TIME) & reasoned & ~(value.is_nan() & bound.is_not_null())
    held = within.fill_null(False) | known | (order & ~value.is_nan())
    passes = (verdict == "pass") & ~held.fill_null(False)
    by_size = pl.col("gate").is_in(_BY_SIZE) & verdict.is_in(["fail", "declared"])
    wrong = metrics.filter(passes | (by_size & within.fill_null(False)))
    for row in wrong.head(1).iter_rows(named=True):
        value_text, bound_text = _number(row, "value"), _number(row, "bound")
        limit = f"with a bound of {bound_text}" if bound_text else "without a bound"
        yield (
            f"{row['metric']} of {row['channel']} of {whose(row)} is {value_text} "
            f"{limit}, and its verdict is {row['verdict']!r}"
        )
    single = metrics.filter(pl.col("metric") != _REPEATED)
    for row in single.filter(single.is_duplicated()).head(1).iter_rows(named=True):
        yield f"{row['metric']} of {row['channel']} of {whose(row)} is there twice"


def entry_problems(run: Mapping[str, Any]) -> Iterator[str]:
    """What is listed twice in ``run.json``: a clause each."""
    keys = {
        "engines": ("name", "version", "via"),
        "scenarios": ("name",),
        "tasks": (*_TASK, "timestep", "accuracy"),
    }
    for kind, names in keys.items():
        counted = Counter(tuple(entry.get(name) for name in names) for entry in run[kind])
        for entry in run[kind]:
            if counted[tuple(entry.get(name) for name in names)] > 1:
                named = entry["name"] if "name" in entry else f"the run {whose(entry)}"
                yield f"{named} is among the {kind} twice"
                return


def _number(row: Mapping[str, Any], name: str) -> str:
    return "" if row[name] is None else written(row[name], 3)


def whose(row: Mapping[str, Any]) -> str:
    """A run in a sentence, such as ``mujoco RK4 on sphere at 0.01``."""
    name = " ".join(filter(None, (row["engine"], row.get("integrator"))))
    knob = row.get("timestep") or row.get("accuracy")
    return f"{name} on {row['scenario']}" + (f" at {exactly(knob)}" if knob else "")
