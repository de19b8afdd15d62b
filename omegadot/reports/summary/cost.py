"""What a failure costs: the attitude's error of the runs that fail, next to sound runs."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass
from math import inf, isfinite
from typing import Any

import polars as pl

from omegadot.reports.record.record import Record
from omegadot.reports.record.schema import YARDSTICKS
from omegadot.reports.summary.failed_gate import worst_row
from omegadot.reports.summary.orders import declared_orders
from omegadot.reports.text.numbers import angle, angles, plain

WHO = ("engine", "engine_version", "setup")
RUN = ("scenario", "integrator", "timestep")
# Of an error: where a sound run has less than this share of it, most of it is the fault's.
MOST = 0.5
Row = Mapping[str, Any]


@dataclass(frozen=True)
class Cost:
    """text: in words; "" where it is not known.  size: how much of the attitude's error is beyond
    that of sound runs, rad; infinite where the attitude is no number.
    """

    text: str = ""
    size: float = 0.0


@dataclass(frozen=True)
class _Compared:
    """A failing run's row, the sound rows of its scenario and step, and those of its order."""

    row: Row
    order: float | None
    sound: Sequence[Row]
    same: Sequence[Row]

    @property
    def is_costly(self) -> bool:
        """Whether its error is more than a sound one's.

        Two that are equal but for rounding differ by their round-off bounds at most.
        """
        if self.row["verdict"] == "pass":  # the truncation error of its order, or rounding
            return False
        largest = max((one["value"] + (one["bound"] or 0.0) for one in self.same), default=-1.0)
        return bool(self.row["value"] - (self.row["bound"] or 0.0) > largest)

    @property
    def rank(self) -> tuple[bool, float]:
        """Before others where most of the error is the fault's; then by how much of it is."""
        normal = max((one["value"] for one in self.same), default=0.0)
        return normal < MOST * self.row["value"], self.row["value"] - normal


def cost_of(record: Record, who: tuple[str, ...], rows: Sequence[Row]) -> Cost:
    """What the failing rows of an engine mean for its attitude.

    A failing run costs something where its error neither passes, as an error of its order does, nor
    lies within what sound integrators of its order have at the same step. Of these runs, each at
    its finest step, that is named of whose error the fault has the most: on a motion on which a
    sound run errs as much it cannot be seen. Where none costs anything, the worst of the scenario
    of the worst measure is.
    """
    stepped = [row for row in rows if row["integrator"] is not None]
    if not stepped:
        judged = record.metrics.filter(pl.col("gate") == "trajectory").filter(
            pl.col(key).eq_missing(value) for key, value in zip(WHO, who, strict=True)
        )
        passes = "pass" in judged["verdict"]
        return Cost("nothing in its trajectories, which pass" if passes else "")
    failing = {tuple(map(row.get, RUN)) for row in stepped}
    errors = _errors(record.metrics, {row["scenario"] for row in stepped})
    own = [row for row in errors if _who(row) == who and tuple(map(row.get, RUN)) in failing]
    broken = any(not _is_number(row) for row in own)
    known = _compared(record, who, filter(_is_number, own), filter(_is_number, errors))
    if not known:
        return Cost("", inf if broken else 0.0)
    costly = [one for one in known if one.is_costly]
    if costly:
        dearest = max(_finest(costly), key=lambda one: one.rank)
        return Cost(_costs(dearest, costly), inf if broken else dearest.rank[1])
    where = worst_row(rows)["scenario"]
    here = [one for one in known if one.row["scenario"] == where] or known
    return Cost(_costs_nothing(max(_finest(here), key=lambda one: one.row["value"])))


def _who(row: Row) -> tuple[Any, ...]:
    return tuple(map(row.get, WHO))


def _is_number(row: Row) -> bool:
    return row["value"] is not None and isfinite(row["value"])


def _compared(
    record: Record, who: tuple[str, ...], own: Iterable[Row], errors: Iterable[Row]
) -> list[_Compared]:
    """Each of an engine's rows beside those of sound runs at its scenario and step."""
    orders = declared_orders(record.run["engines"])
    sound: dict[tuple[str, float], list[Row]] = {}
    for row in errors:
        if row["verdict"] == "pass" and _who(row) != who:
            sound.setdefault((row["scenario"], row["timestep"]), []).append(row)
    found = []
    for row in own:
        order = orders.get((row["engine"], row["integrator"]))
        beside = sound.get((row["scenario"], row["timestep"]), [])
        same = [
            one
            for one in beside
            if order is not None and orders.get((one["engine"], one["integrator"])) == order
        ]
        found.append(_Compared(row, order, beside, same))
    return found


def _costs(one: _Compared, costly: Sequence[_Compared]) -> str:
    row, step = one.row, f"step {plain(one.row['timestep'])} s"
    own = angle(row["value"])
    text = f"attitude wrong by {own} on {row['scenario']} with {row['integrator']}, {step}"
    if one.sound:
        whose = "sound integrators"
        if one.same:
            whose += f" of order {plain(one.order)}"
        elif one.order is not None:
            whose += " of other orders"
        text += f"; {whose}: {angles([other['value'] for other in one.same or one.sound])}"
    run = row["scenario"], row["integrator"]
    steps = (other.row for other in costly)
    coarse = max(
        (r for r in steps if (r["scenario"], r["integrator"]) == run), key=lambda r: r["timestep"]
    )
    if coarse["value"] > row["value"] and angle(coarse["value"]) != own:
        text += f"; at step {plain(coarse['timestep'])} s wrong by {angle(coarse['value'])}"
    return text


def _costs_nothing(one: _Compared) -> str:
    row = one.row
    step = f"step {plain(row['timestep'])} s"
    text = (
        f"nothing in the attitude on {row['scenario']}: {row['integrator']}, {step}, has an error "
        f"of {angle(row['value'])} there"
    )
    if one.same:
        values = angles([other["value"] for other in one.same])
        return f"{text}, as sound integrators of order {plain(one.order)} have: {values}"
    return f"{text}, which passes as the truncation error of its order"


def _finest(known: Sequence[_Compared]) -> list[_Compared]:
    """Of each scenario and integrator the run at the finest of these steps."""
    found: dict[tuple[str, str], _Compared] = {}
    for one in known:
        key = one.row["scenario"], one.row["integrator"]
        if key not in found or one.row["timestep"] < found[key].row["timestep"]:
            found[key] = one
    return list(found.values())


def _errors(metrics: pl.DataFrame, scenarios: Collection[str]) -> list[dict[str, Any]]:
    """The attitude's largest errors of every engine on some scenarios, by step."""
    of_attitude = (pl.col("channel") == "attitude") & (pl.col("metric") == "error_max")
    here = (pl.col("gate") == "trajectory") & pl.col("scenario").is_in(list(scenarios))
    rows = metrics.filter(here & of_attitude & ~pl.col("engine").is_in(YARDSTICKS)).to_dicts()
    return [row for row in rows if row["timestep"]]
