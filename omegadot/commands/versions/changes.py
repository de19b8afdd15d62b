"""What changed between versions: metric by metric, and pace by pace."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from itertools import pairwise

from omegadot.commands.versions.measure import Portrait
from omegadot.commands.versions.metric import KINDS, Figure, Name, differ
from omegadot.commands.versions.speed import Ratio, pace_of, ratio_of

# The place of the integrator in a metric's name, by the name's first term.
_INTEGRATOR_AT = {"scheme": 1, "order": 1, "drift": 2}


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


def neighbours(portraits: Iterable[Portrait]) -> list[tuple[Portrait, Portrait]]:
    """Each version that could be measured with the next one that could."""
    known = [portrait for portrait in portraits if portrait.ok]
    return list(pairwise(known))


def pace_changes(one: Portrait, other: Portrait) -> dict[str, Ratio]:
    """How time a step changed, by integrator."""
    found = {}
    for name in one.integrators:
        paces = [pace_of(portrait.speeds.get(name, [])) for portrait in (one, other)]
        if paces[0] and paces[1]:
            found[name] = ratio_of(paces[0], paces[1])
    return found


def all_changes(portraits: Sequence[Portrait]) -> list[tuple[Portrait, Portrait, list[Change]]]:
    """The changes from each version to the next."""
    return [(one, other, changes_between(one, other)) for one, other in neighbours(portraits)]
