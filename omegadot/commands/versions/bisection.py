"""In which release a metric changed, in about log2 of them."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

from omegadot.commands.versions.changes import Change, changes_between
from omegadot.commands.versions.measure import Portrait

Look = Callable[[str], Portrait]
Compare = Callable[[Portrait, Portrait], list[Change]]


@dataclass(frozen=True)
class Step:
    """A release in which something changed. skipped: releases between the two that did not run."""

    before: Portrait
    after: Portrait
    changes: list[Change]
    skipped: list[str]


@dataclass
class Bisection:
    """steps: the changes found, rising.  looked_at: the releases measured, in that order."""

    low: Portrait | None = None
    high: Portrait | None = None
    steps: list[Step] = field(default_factory=list)
    looked_at: list[Portrait] = field(default_factory=list)


def bisect(versions: Sequence[str], look: Look, compare: Compare = changes_between) -> Bisection:
    """Halve the releases between two that differ until neighbours do.

    Every release found does differ from the one before it. That it is the only one is assumed
    between two releases that are alike; where the release found is not like the upper end, the
    search goes on from it. An end that does not run gives way to the next that does.
    """
    found = Bisection()
    seen: dict[str, Portrait] = {}

    def at(version: str) -> Portrait:
        if version not in seen:
            seen[version] = look(version)
            found.looked_at.append(seen[version])
        return seen[version]

    low = next((n for n, version in enumerate(versions) if at(version).ok), None)
    if low is None:
        return found
    found.low = at(versions[low])
    high = next(n for n in range(len(versions) - 1, low - 1, -1) if at(versions[n]).ok)
    if high == low:
        return found
    found.high = at(versions[high])
    while compare(at(versions[low]), found.high):
        before, after = _narrowed(versions, low, high, at, compare)
        one, other = at(versions[before]), at(versions[after])
        skipped = list(versions[before + 1 : after])
        found.steps.append(Step(one, other, compare(one, other), skipped))
        low = after
    return found


def _narrowed(
    versions: Sequence[str], low: int, high: int, at: Look, compare: Compare
) -> tuple[int, int]:
    """Two releases with none that runs between them, the lower like `low`, the upper not."""
    start, broken = at(versions[low]), set[int]()
    while True:
        middle = (low + high) / 2
        left = [n for n in range(low + 1, high) if n not in broken]
        if not left:
            return low, high
        chosen = min(left, key=lambda n: abs(n - middle))
        portrait = at(versions[chosen])
        if not portrait.ok:
            broken.add(chosen)
        elif compare(start, portrait):
            high = chosen
        else:
            low = chosen
