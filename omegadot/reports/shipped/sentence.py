"""The table "As shipped" in one sentence, for a terminal."""

from __future__ import annotations

from collections import Counter
from itertools import groupby

from omegadot.reports.shipped.rows import ShippedRow
from omegadot.reports.shipped.table import TITLE, WORDS
from omegadot.reports.text.numbers import listed, short, times

_WORST = ("never", None, "late", "early", "yes")


def in_one_sentence(rows: tuple[ShippedRow, ...]) -> str:
    """One sentence for a terminal; "" of a run in one setup."""
    if not rows:
        return ""
    engines = [list(own) for _, own in groupby(rows, lambda row: row.engine)]
    text = f"{TITLE}, on {rows[0].scenario}"
    if rows[0].exact_flips:
        shipped, physics = (_counted(engines, setup) for setup in ("as_shipped", "physics"))
        number = times(len(engines), "engine")
        text += f": of {number}, by the worst integrator, {shipped}; set up for physics {physics}"
    mended = "; ".join(filter(None, map(_mended, engines)))
    return f"{text}. What mends most: {mended or 'no single setting'}."


def _counted(engines: list[list[ShippedRow]], setup: str) -> str:
    """How many engines flip in time, late, early or never, each by the worst of its integrators."""
    worst: Counter[str | None] = Counter()
    for own in engines:
        found = {row.flipping(getattr(row, setup)) for row in own}
        worst[next(verdict for verdict in _WORST if verdict in found)] += 1
    counts = [
        f"{worst[verdict]} {words if worst[verdict] == 1 else words.replace('flips', 'flip')}"
        for verdict, words in WORDS.items()
        if worst[verdict]
    ]
    counts += [f"{worst[None]} without an answer"] if worst[None] else []
    return listed(counts)


def _mended(rows: list[ShippedRow]) -> str:
    """An engine with the setting that mends most of all that its integrators have; "" for none."""
    found = [most for row in rows if (most := row.mends_most)]
    if not found:
        return ""
    name, ratio = min(found, key=lambda most: most[1])
    return f"{rows[0].engine} {name}, error × {short(ratio)}"
