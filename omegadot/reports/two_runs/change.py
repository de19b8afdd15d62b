"""One change: what it was and what it is."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass
from operator import attrgetter

from omegadot.reports.page.tables import channel_name
from omegadot.reports.text.metric_names import measure_name
from omegadot.reports.text.numbers import engine_name, quantity, short
from omegadot.reports.two_runs.sides import RunKey

# Verdicts and outcomes as a sentence has them.
_WORDS = {
    "pass": "passes",
    "fail": "fails",
    "info": "not judged",
    "declared": "fails as declared",
    "ok": "ran to its end",
    "not-installed": "not installed",
    "timeout": "timed out",
}


@dataclass(frozen=True)
class Measure:
    """A value of both records, and how far apart rounding alone may take the two."""

    was: float
    now: float
    band: float
    unit: str

    @property
    def factor(self) -> float:
        """How many times as large it is now; NaN where it was, or is, not finite."""
        if not math.isfinite(self.was) or not math.isfinite(self.now):
            return math.nan
        return abs(self.now / self.was) if self.was else math.inf

    @property
    def weight(self) -> float:
        """For ordering: how large the change is, whichever way."""
        factor = self.factor
        return abs(math.log(factor)) if 0.0 < factor < math.inf else math.inf


@dataclass(frozen=True)
class Change:
    """One run, or one engine on one scenario (integrator ""), that got worse or better.

    gate, channel, metric: "" where the change is of the whole run, or of a whole gate.
    was, now: its outcomes or its verdicts.  measure: of a metric that both records measured.
    moved: whether the measure left its band; a verdict may change without.
    """

    key: RunKey
    worse: bool
    gate: str
    channel: str
    metric: str
    was: str
    now: str
    measure: Measure | None = None
    moved: bool = False
    why: str = ""

    @property
    def weight(self) -> tuple[int, float]:
        """For ordering: outcomes first, then verdicts, then the largest change of a figure."""
        kind = 0 if self.was == self.now else 2 if not self.gate else 1
        return kind, self.measure.weight if self.measure else 0.0

    @property
    def what(self) -> str:
        """The gate and the figure: trajectory: attitude error max."""
        name = measure_name(channel_name(self.channel), self.metric.replace("_", " "))
        return ": ".join(filter(None, (self.gate, name))) or "outcome"


def of_factor(measure: Measure) -> str:
    """The change as text: 3.1 times, 24100 times less."""
    factor = measure.factor
    if math.isnan(factor):
        return "no longer finite" if not math.isfinite(measure.now) else "finite again"
    if math.isinf(factor):
        return "was zero"
    if factor == 0.0:
        return "vanished"
    return f"{_times(factor)} times" if factor >= 1.0 else f"{_times(1.0 / factor)} times less"


def _times(factor: float) -> str:
    """1.05, 24100, 3.1e9: three digits, and written out where that is short."""
    return short(factor, 3)


def from_to(change: Change) -> str:
    """What it was and is: verdicts or outcomes where they differ, and the figures."""
    was, now = (_WORDS.get(term, term) for term in (change.was, change.now))
    message = f"{was} → {now}" if was != now else ""
    measure = change.measure
    if measure is None:
        return message
    figures = f"{short(measure.was, 3)} → {quantity(measure.now, measure.unit, 3)}"
    if change.moved:
        band = quantity(measure.band, measure.unit)
        figures += f" ({of_factor(measure)}; rounding allows {band})"
    return f"{message}: {figures}" if message else figures


def name_of(key: RunKey) -> str:
    """Engine, its version where there are several, its setup where it is not the usual one."""
    return engine_name(key.engine, key.version, key.setup)


def grouped(changes: Iterable[Change]) -> list[list[Change]]:
    """Changes of one engine, integrator, gate and channel, the largest first.

    Outcomes and verdicts come first, then the groups by how large their largest change is.
    """
    groups: dict[tuple[object, ...], list[Change]] = {}
    for change in changes:
        key, kind = change.key, change.weight[0]
        name = (key.engine, key.version, key.setup, key.integrator, change.gate, change.channel)
        groups.setdefault((*name, kind, change.was, change.now), []).append(change)
    found = [sorted(own, key=attrgetter("weight"), reverse=True) for own in groups.values()]
    return sorted(found, key=lambda own: own[0].weight, reverse=True)
