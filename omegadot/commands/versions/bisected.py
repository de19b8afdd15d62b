"""A metric's name as text, followed through the releases to where it changed."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence

from packaging.version import Version

from omegadot.commands.versions.bisection import Bisection, bisect
from omegadot.commands.versions.changes import Change, changes_between
from omegadot.commands.versions.figures import Wanted
from omegadot.commands.versions.gallery import Gallery
from omegadot.commands.versions.measure import Portrait
from omegadot.commands.versions.metric import (
    KINDS,
    Name,
    matching,
    terms_of,
    title,
    unknown_metric,
)
from omegadot.commands.versions.product import Product
from omegadot.commands.versions.record import Record, bisection_record
from omegadot.diagnosis.scheme_study.probes import PROBES
from omegadot.gates.measured_run import CHANNELS
from omegadot.harness.usage import UsageError, nearest


def bisect_metric(
    query: str,
    product: Product,
    gallery: Gallery,
    versions: Sequence[str],
    seen: Callable[[Portrait], object],
) -> tuple[list[Portrait], Record]:
    """The versions looked at, rising, and the releases in which a metric changed.

    Raises UsageError where no metric has all of these terms.
    """
    known: dict[Name, None] = {}

    def is_meant(name: Name) -> bool:
        return bool(matching(query, [name], product.engine))

    def choose(names: list[Name]) -> Wanted:
        if not known:  # the lower end names what there is, the upper end may add to it
            first.extend(names)
        known.update(dict.fromkeys(filter(is_meant, names)))
        return is_meant

    def look(version: str) -> Portrait:
        portrait = gallery.look(version, choose)
        if portrait.ok and known and not _reported(portrait, known):
            portrait.outcome = "raised"
            portrait.reason = (
                portrait.troubles[0] if portrait.troubles else "it could not be determined"
            )
        seen(portrait)
        return portrait

    def compare(one: Portrait, other: Portrait) -> list[Change]:
        if not known:
            raise UsageError(_no_such(query, first))
        return changes_between(one, other, is_meant)

    first: list[Name] = []
    found: Bisection = bisect(versions, look, compare)
    portraits = sorted(found.looked_at, key=lambda p: Version(p.version))
    return portraits, bisection_record(query, list(known), found)


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
