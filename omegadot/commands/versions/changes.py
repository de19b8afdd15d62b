"""What is found of a version, and what changed between two: metric by metric, and paces."""

from __future__ import annotations

import math
import statistics
from collections.abc import Callable
from dataclasses import dataclass, field

from omegadot.commands.versions.metric import KINDS, Figure, Name, differ

# The place of the integrator in a metric's name, by the name's first term.
_INTEGRATOR_AT = {"scheme": 1, "order": 1, "drift": 2}


@dataclass
class Portrait:
    """One version. outcome: "ok", or why there is nothing of it, with the reason.

    version: as requested.  reported_version: of the engine itself.  faults: where it is not as
    its adapter declares, or wrong.  has: its integrators, those not looked at included.
    troubles: requests that it failed to answer.  unanswered: how many of them are not merely
    unsupported.  unreported: kinds of metric that it should report
    and did not.
    """

    version: str
    outcome: str = "ok"
    reason: str = ""
    origin: str = ""
    reported_version: str = ""
    integrators: list[str] = field(default_factory=list)
    has: list[str] = field(default_factory=list)
    figures: dict[Name, Figure] = field(default_factory=dict)
    faults: list[str] = field(default_factory=list)
    troubles: list[str] = field(default_factory=list)
    unanswered: int = 0
    unreported: frozenset[str] = frozenset()
    speeds: dict[str, list[float]] = field(default_factory=dict)

    @property
    def ok(self) -> bool:
        """Whether the version could be measured."""
        return self.outcome == "ok"


@dataclass(frozen=True)
class Change:
    """A metric before and after; None where a version does not have it."""

    name: Name
    before: Figure | None
    after: Figure | None

    @property
    def size(self) -> float:
        """By how many factors of e a number changed; infinite where a text did."""
        values = [figure.value if figure else None for figure in (self.before, self.after)]
        if not all(isinstance(value, float) for value in values):
            return math.inf
        floor = max(f.band for f in (self.before, self.after) if f) or 1e-300
        a, b = (max(abs(float(value or 0.0)), floor) for value in values)
        return abs(math.log(b / a))


def integrator_of(name: Name) -> str:
    """The integrator that a metric is about; empty where it is about none."""
    place = _INTEGRATOR_AT.get(name[0])
    return "" if place is None else name[place]


def changes_between(
    one: Portrait, other: Portrait, wanted: Callable[[Name], bool] = lambda name: True
) -> list[Change]:
    """Every metric that differs, in the order of kinds.

    Where an integrator is only in one of the two, no other change of it is reported.
    """
    both = set(one.integrators) & set(other.integrators)
    names = filter(wanted, dict.fromkeys([*one.figures, *other.figures]))
    found = []
    for name in names:
        integrator = integrator_of(name)
        if name[0] in one.unreported | other.unreported:
            continue
        if integrator and integrator not in both and wanted(("integrator", integrator)):
            continue
        before, after = one.figures.get(name), other.figures.get(name)
        if differ(before, after):
            found.append(Change(name, before, after))
    return sorted(found, key=lambda change: KINDS.index(change.name[0]))


@dataclass(frozen=True)
class Pace:
    """Seconds a step: the median of some timings, the least and the greatest."""

    median: float
    least: float
    most: float


def pace_of(timings: list[float]) -> Pace | None:
    """None of no timings."""
    return Pace(statistics.median(timings), min(timings), max(timings)) if timings else None


@dataclass(frozen=True)
class Ratio:
    """Time a step over that of an earlier version. apart: the two spreads do not touch."""

    value: float
    least: float
    most: float
    apart: bool


def ratio_of(earlier: Pace, later: Pace) -> Ratio:
    """The ratio of the medians, and the range that the spreads allow."""
    least, most = later.least / earlier.most, later.most / earlier.least
    apart = later.least > earlier.most or later.most < earlier.least
    return Ratio(later.median / earlier.median, least, most, apart)


def pace_changes(one: Portrait, other: Portrait) -> dict[str, Ratio]:
    """How time a step changed, by integrator."""
    found = {}
    for name in one.integrators:
        paces = [pace_of(portrait.speeds.get(name, [])) for portrait in (one, other)]
        if paces[0] and paces[1]:
            found[name] = ratio_of(paces[0], paces[1])
    return found
