"""The rows of "As shipped" as text, for the page and for a comment."""

from __future__ import annotations

import math
from collections.abc import Iterable
from itertools import groupby

from omegadot.reports.shipped.figures import Figures
from omegadot.reports.shipped.rows import ShippedRow
from omegadot.reports.summary.flips import Flipping
from omegadot.reports.text.numbers import knob, short
from omegadot.written import written

TITLE = "As shipped"
ALIKE = "nothing: both are alike"
WORDS: dict[Flipping, str] = {
    **{"never": "never flips", "late": "flips late", "early": "flips early"},
    "yes": "flips in time",
}
MOST = 12  # rows of the page; the others are folded away
_WHO, _LAST = ("engine", "integrator"), ("what mends most",)
_FLIPS = ("flips, as shipped", "flips, physics")
_ALWAYS = (
    "energy lost, as shipped",
    "energy lost, physics",
    "attitude error, as shipped",
    "attitude error, physics",
)
Cells = tuple[str, ...]
Order = tuple[bool, bool, bool, float]


def heads(rows: Iterable[ShippedRow]) -> Cells:
    """The heads of the columns; those of flips where the exact motion has some."""
    flips = _FLIPS if any(row.exact_flips for row in rows) else ()
    return (*_WHO, *flips, *_ALWAYS, *_LAST)


def cells(rows: Iterable[ShippedRow]) -> list[Cells]:
    """The texts of the table; integrators of an engine of which all texts are equal share a row.

    First those that flip otherwise as shipped, those that never do, and what differs the most.
    """
    found: list[tuple[Order, Cells]] = []
    for engine, own in groupby(rows, lambda row: row.engine):
        shared: dict[Cells, list[ShippedRow]] = {}
        for row in own:
            shared.setdefault(_texts(row), []).append(row)
        for texts, same in shared.items():
            names = ", ".join(row.integrator for row in same)
            found.append((_order(same[0]), (engine, names, *texts)))
    return [texts for _, texts in sorted(found, key=lambda pair: pair[0])]


def _order(row: ShippedRow) -> Order:
    """Of a row among the others: what comes first is smallest."""
    ratio = row.ratio(row.physics)
    shipped = row.flipping(row.as_shipped)
    same = shipped == row.flipping(row.physics)
    return same, shipped != "never", row.alike, math.inf if ratio is None else ratio


def note(rows: tuple[ShippedRow, ...]) -> str:
    """What the numbers of the table are of."""
    row = rows[0]
    knobs = " or ".join(dict.fromkeys(knob(one.timestep, one.accuracy) for one in rows))
    exact = ""
    if row.exact_flips:
        exact = f" The exact motion flips at {_times(row.exact_flips.times)}."
    return (
        f"On {row.scenario}, {knobs}.{exact} Energy lost is of the largest exact kinetic energy; "
        "less than zero is a gain. The attitude error is that at the end, with the mean over the "
        "run. What mends most is the one setting, in the engine's words, with which the engine as "
        "shipped has the smallest mean, in parts of that without it."
    )


def mends(row: ShippedRow) -> str:
    """The setting that mends most, with what it does; or why there is none."""
    most = row.mends_most
    if most:
        name, ratio = most
        flips = row.flipping(row.settings[name])
        flipping = f", {WORDS[flips]}" if flips else ""
        return f"{name}: error × {short(ratio)}{flipping}"
    if row.alike:
        return ALIKE
    return f"none of {len(row.settings)}" if row.settings else "–"


def _texts(row: ShippedRow) -> Cells:
    both = (row.as_shipped, row.physics)
    flips = tuple(_flips(row, run) for run in both) if row.exact_flips else ()
    return (*flips, *map(_lost, both), *map(_attitude, both), mends(row))


def _flips(row: ShippedRow, run: Figures) -> str:
    found = row.flipping(run)
    if found is None:
        return "–" if run.outcome == "ok" else run.outcome
    return WORDS[found] + (f": {_times(run.flips)}" if run.flips else "")


def _times(flips: tuple[float, ...]) -> str:
    shown = ", ".join(written(time, 3) for time in flips[:4])
    return f"{shown}{', …' * (len(flips) > 4)} s"


def _lost(run: Figures) -> str:
    if run.energy_lost is None:
        return "–" if run.outcome == "ok" else run.outcome
    return f"{short(100 * run.energy_lost)} %"


def _attitude(run: Figures) -> str:
    if run.attitude_end is None or run.attitude_mean is None:
        return "–" if run.outcome == "ok" else run.outcome
    return f"{short(run.attitude_end)} rad, mean {short(run.attitude_mean)}"
