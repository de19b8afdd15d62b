"""One name for an integrator out of what it matched on each probe."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from omegadot.reference_impl.schemes import SCHEMES


@dataclass(frozen=True)
class Naming:
    """scheme: None where nothing matches.  kinds: the probes on which it is that scheme.

    others: schemes that these probes cannot decide from it.
    """

    scheme: str | None
    kinds: tuple[str, ...]
    others: tuple[str, ...] = ()


def name_schemes(
    matched: Mapping[str, Sequence[str]], declared: Mapping[str, str | None]
) -> list[Naming]:
    """The fewest schemes that cover all probes, in the probes' order.

    matched and declared: by kind of probe. Where several schemes cover as much, one that is
    declared there is named, else the simplest, the order of SCHEMES being that of simplicity.
    """
    left = [kind for kind, found in matched.items() if found]
    named = []
    while left:
        covered = {s: tuple(kind for kind in left if s in matched[kind]) for s in SCHEMES}
        merits = {
            scheme: (len(kinds), any(declared.get(kind) == scheme for kind in kinds))
            for scheme, kinds in covered.items()
        }
        best = max(merits, key=merits.__getitem__)
        kinds = covered[best]
        others = tuple(s for s in SCHEMES if s != best and covered[s] == kinds)
        named.append(Naming(best, kinds, others))
        left = [kind for kind in left if kind not in kinds]
    unknown = tuple(kind for kind, found in matched.items() if not found)
    named += [Naming(None, unknown)] if unknown else []
    places = list(matched)
    return sorted(named, key=lambda naming: places.index(naming.kinds[0]))
