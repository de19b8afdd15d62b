"""An error along a run on its axis: what is drawn, with which limits, over what range."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from omegadot.reference_impl.system import Array
from omegadot.reports.charts.bounds import Limits
from omegadot.reports.charts.deviations import Chart, Series
from omegadot.reports.charts.packing import FLOOR
from omegadot.reports.charts.sweeps import decades
from omegadot.reports.text.numbers import knob


def bounds_drawn(limits: Limits, deviation: Series, chart: Chart) -> list[list[float]]:
    """A list a channel: ``[fraction, bound, fraction, bound, ...]``."""
    return [
        [float(f"{v:.3g}") for step in limits.bound(deviation, channel, unit) for v in step]
        for channel, unit in chart.units.items()
    ]


def drawn(deviation: Series, channel: str) -> Array:
    """The errors as drawn: without the start, which is given and so has no error."""
    values = deviation.values[channel]
    start = (deviation.time == 0.0) & (values <= FLOOR)
    return np.where(start, np.nan, values)


def axis_of(chart: Chart, channel: str, limits: Limits) -> dict[str, Any]:
    """Decades that hold the errors of every step size, so that a change of step moves no axis.

    They hold the bounds and the floor too: what judges an error must be visible.
    """
    unit = chart.units[channel]
    values = np.concatenate([drawn(deviation, channel) for deviation in chart.deviations])
    floor = limits.floor(channel, unit)
    seen = [bound for c in chart.deviations for _, bound in limits.bound(c, channel, unit)]
    known = np.append(values[~np.isnan(values)], seen + ([] if floor is None else [floor]))
    shown = None if floor is None else float(f"{floor:.3g}")
    return {"channel": channel, "unit": unit, "resolvable": shown, **decades(known)}


def captions(rank: Mapping[tuple[float | None, float | None], int]) -> list[str]:
    """By rank: the steps and accuracies that it stands for, as text."""
    by_rank: dict[int, list[str]] = {}
    for (timestep, accuracy), place in rank.items():
        by_rank.setdefault(place, []).append(knob(timestep, accuracy))
    return [", ".join(filter(None, by_rank[place])) for place in sorted(by_rank)]
