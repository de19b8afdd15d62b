"""In which release a metric changed, in about log2 of them."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, field, replace
from functools import cache

from packaging.version import Version

from omegadot.commands.versions.changes import Change, Portrait, changes_between
from omegadot.commands.versions.figures import Wanted
from omegadot.commands.versions.gallery import Gallery
from omegadot.commands.versions.metric import KINDS, Name, matching, terms_of, title, unknown_metric
from omegadot.diagnosis.scheme_study.probes import PROBES
from omegadot.gates.errors.measured_run import CHANNELS
from omegadot.harness.usage import UsageError, nearest

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
    """steps: the changes found, rising.  looked_at: the releases measured, in that order.

    query: the terms of the metric, if any.  metrics: those that have these terms.
    """

    query: str = ""
    metrics: list[Name] = field(default_factory=list)
    low: Portrait | None = None
    high: Portrait | None = None
    steps: list[Step] = field(default_factory=list)
    looked_at: list[Portrait] = field(default_factory=list)

    @property
    def portraits(self) -> list[Portrait]:
        """The releases measured, rising."""
        return sorted(self.looked_at, key=lambda portrait: Version(portrait.version))


def bisect(versions: Sequence[str], look: Look, compare: Compare = changes_between) -> Bisection:
    """Halve the releases between two that differ until neighbours do.

    Every release found does differ from the one before it. That it is the only one is assumed
    between two releases that are alike; where the release found is not like the upper end, the
    search goes on from it. An end that does not run gives way to the next that does.
    """
    found = Bisection()

    @cache
    def at(version: str) -> Portrait:
        found.looked_at.append(look(version))
        return found.looked_at[-1]

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


def bisect_metric(
    query: str, gallery: Gallery, versions: Sequence[str], seen: Callable[[Portrait], object]
) -> Bisection:
    """The releases in which a metric changed.

    Raises UsageError where no metric has all of these terms.
    """
    known: dict[Name, None] = {}

    def is_meant(name: Name) -> bool:
        return bool(matching(query, [name], gallery.product.engine))

    def choose(names: list[Name]) -> Wanted:
        if not known:  # the lower end names what there is, the upper end may add to it
            first.extend(names)
        known.update(dict.fromkeys(filter(is_meant, names)))
        return is_meant

    def look(version: str) -> Portrait:
        portrait = gallery.look(version, choose)
        if portrait.ok and known and not _reported(portrait, known):
            portrait.outcome = "raised"
            portrait.reason = next(iter(portrait.troubles), "it could not be determined")
        seen(portrait)
        return portrait

    def compare(one: Portrait, other: Portrait) -> list[Change]:
        if not known:
            raise UsageError(_no_such(query, first))
        return changes_between(one, other, is_meant)

    first: list[Name] = []
    return replace(bisect(versions, look, compare), query=query, metrics=list(known))


def _reported(portrait: Portrait, names: Iterable[Name]) -> bool:
    """Whether a version reports any of the metrics, be it that it does not have them."""
    figures = [portrait.figures.get(name) for name in names if name[0] not in portrait.unreported]
    return any(figure is None or figure.value is not None for figure in figures)


def _no_such(query: str, names: Sequence[Name]) -> str:
    """Which term is in no metric's name, and what metrics are called."""
    there = {term for name in names for term in terms_of(title(name))}
    unknown = unknown_metric(query, names)
    kinds = ", ".join(kind for kind in KINDS if any(name[0] == kind for name in names))
    what = (
        f"no metric has {unknown[0]!r} in its name"
        if unknown
        else "no metric has all of these terms in its name"
    )
    hint = nearest(unknown[0], there) if unknown else ""
    close = f"; {hint}" if hint.startswith("write") else ""
    example = next((title(n) for n in names if n[0] == "order"), title(names[0]) if names else "")
    systems = ", ".join(probe.kind for probe in PROBES)
    return (
        f"--bisect {query}: {what}{close}; give terms of a name such as {example}: a kind "
        f"({kinds}), an integrator, a system ({systems}) or a scenario, "
        f"a channel ({', '.join(channel.replace('_', ' ') for channel in CHANNELS)})."
    )
