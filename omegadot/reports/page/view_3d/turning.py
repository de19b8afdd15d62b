"""Which runs of a scenario turn the body over, and when: for the cells of the 3-D view."""

from __future__ import annotations

from dataclasses import dataclass, field

import polars as pl

from omegadot.reference_impl.system import Array, System
from omegadot.reports.charts.packing import rounded
from omegadot.reports.page.view_3d.opening import Key
from omegadot.reports.summary.flips import Flipping, Flips, flips_of, turned_over

_RUN = ("engine", "setup", "integrator", "timestep", "accuracy")
_OMEGA = ("wx", "wy", "wz")


@dataclass(frozen=True)
class Turning:
    """exact: s, the times of the exact flips; none where the exact motion turns nothing over.

    runs: by run, the times of its flips, s, and `never`, `late`, `early`, `yes` or None.
    """

    exact: list[float | None] = field(default_factory=list)
    runs: dict[Key, tuple[list[float | None], Flipping | None]] = field(default_factory=dict)


def turning_of(rows: pl.DataFrame, system: System, truth: str) -> Turning:
    """The flips of every run of one scenario, of all its stored samples.

    rows: its trajectories.  truth: the integrator of the exact solution, as the view shows it.
    """
    engine, integrator = pl.col("engine"), pl.col("integrator")
    exact = flips_of(*_motion(rows.filter((engine == "exact") & (integrator == truth))), system)
    if exact is None or not exact.flips:
        return Turning()
    found = {}
    others = rows.filter(engine != "exact").select(*_RUN, "time", *_OMEGA)
    for key, own in others.partition_by(_RUN, as_dict=True).items():
        flips = flips_of(*_motion(own), system)
        assert flips is not None  # the exact motion has an axis, and it is the system's
        found[key] = (_times(flips), turned_over(flips.times, flips.until, exact))
    return Turning(_times(exact), found)


def _motion(rows: pl.DataFrame) -> tuple[Array, Array]:
    rows = rows.select("time", *_OMEGA).sort("time").unique("time", maintain_order=True)
    table = rows.fill_null(float("nan")).to_numpy()
    return table[:, 0], table[:, 1:]


def _times(flips: Flips) -> list[float | None]:
    return [rounded(time, 5) for time in flips.times]
