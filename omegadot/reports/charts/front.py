"""The Pareto front of a work-precision diagram: the runs that no other beats in both."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from omegadot.reports.charts.sweeps import Sweep
from omegadot.reports.record.schema import YARDSTICKS
from omegadot.reports.text.numbers import angle, plain, short


@dataclass(frozen=True)
class FrontPoint:
    """One run on the front. cost: s of wall time per simulated second.  error: rad."""

    engine: str
    setup: str
    integrator: str
    timestep: float
    cost: float
    error: float


def pareto_front(sweeps: Sequence[Sweep], floor: float = 0.0) -> list[FrontPoint]:
    """The runs than which none is both cheaper and more accurate, the cheapest first.

    Below `floor`, rad, errors cannot be distinguished, and the cheaper run stands for all of them.
    The reference is left out: it is the yardstick, not a candidate.
    """
    points = sorted(
        (
            (p.cost, max(p.error, floor), FrontPoint(*_of(sweep), p.timestep, p.cost, p.error))
            for sweep in sweeps
            if sweep.engine not in YARDSTICKS
            for p in sweep.points
            if p.cost is not None and p.error is not None
        ),
        key=lambda entry: entry[:2],
    )
    front, best = [], float("inf")
    for _, error, point in points:
        if error < best:
            front.append(point)
            best = error
    return front


def _of(sweep: Sweep) -> tuple[str, str, str]:
    return sweep.engine, sweep.setup, sweep.integrator


def named(point: FrontPoint) -> tuple[str, str]:
    """The run of a point of the front, and its error and cost, as text."""
    setup = "" if point.setup == "physics" else f" ({point.setup})"
    return (
        f"{point.engine} {point.integrator}{setup} at step {plain(point.timestep)} s",
        f"{angle(point.error)} for {short(point.cost)} s per simulated second",
    )
