"""Integrators whose trajectories are identical: their agreement is not independent evidence."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from itertools import combinations
from typing import Any

from omegadot.reports.summary.reasons import failing_gates


@dataclass(frozen=True)
class Cluster:
    """Members whose trajectories are identical, to rounding, on most scenarios.

    members: as ``engine:integrator``; where some differ from the rest on some scenarios, the rest.
    together and apart: the scenarios on which all of these agree, and on which some do not.
    others: those left out of the members, each with the scenarios on which it equals them and those
    on which it does not.  failing: of all, those of which a gate fails where it equals the rest.
    schemes: those of the reference that they equal on every scenario of `together` that shows it;
    more than one where no motion tells these apart, none where no scheme is that of all of them.
    by_scheme: with none, the scheme of each scenario, ``(scheme, scenarios)``, that of the most
    first; "" for those on which they equal none of the reference at every step.
    """

    members: tuple[str, ...]
    schemes: tuple[str, ...]
    together: tuple[str, ...]
    apart: tuple[str, ...]
    by_scheme: tuple[tuple[str, tuple[str, ...]], ...] = ()
    others: tuple[tuple[str, tuple[str, ...], tuple[str, ...]], ...] = ()
    failing: tuple[str, ...] = ()

    @property
    def all(self) -> tuple[str, ...]:
        """The members, and those that differ on some scenarios."""
        return (*self.members, *(other for other, *_ in self.others))

    @property
    def engines(self) -> int:
        """How many engines are among them."""
        return len({member.partition(":")[0] for member in self.all})


def _homes(clusters: Iterable[Mapping[str, Any]]) -> dict[str, dict[str, dict[float, int]]]:
    """By scenario and member: the number of the cluster that it is in, step by step."""
    homes: dict[str, dict[str, dict[float, int]]] = {}
    for number, cluster in enumerate(clusters):
        for member in cluster["members"]:
            own = homes.setdefault(cluster["scenario"], {}).setdefault(member, {})
            own[cluster["timestep"]] = number
    return homes


def _agree(one: Mapping[float, int], other: Mapping[float, int], exact: set[int]) -> bool | None:
    """Whether two members are together at every step that both ran.

    None where there is none, or where they are together because both are exact.
    """
    shared = one.keys() & other.keys()
    if any(one[step] != other[step] for step in shared):
        return False
    return True if any(one[step] not in exact for step in shared) else None


def clusters_over_scenarios(run: Mapping[str, Any]) -> list[Cluster]:
    """Clusters of two or more over all scenarios, from those of ``run.json``; the largest first.

    Each two members agree on more than half of the scenarios that both ran: a special load may
    separate schemes that are otherwise equal. A motion that both follow exactly does not count, as
    it distinguishes no schemes.
    """
    clusters = run.get("clusters") or []
    homes = _homes(clusters)
    exact = {number for number, cluster in enumerate(clusters) if cluster.get("exact")}
    members = list(dict.fromkeys(member for home in homes.values() for member in home))
    agreed: dict[frozenset[str], dict[str, bool]] = {}
    for scenario, home in homes.items():
        for one, other in combinations(home, 2):
            same = _agree(home[one], home[other], exact)
            if same is not None:
                agreed.setdefault(frozenset((one, other)), {})[scenario] = same
    groups: list[list[str]] = []
    for member in members:
        home_group = next((g for g in groups if all(_mostly(agreed, member, m) for m in g)), None)
        if home_group is None:
            groups.append([member])
        else:
            home_group.append(member)
    failing = _failing(run)
    found = [_cluster(group, agreed, clusters, failing) for group in groups if len(group) > 1]
    return sorted(found, key=lambda own: (-own.engines, -len(own.all)))


def _failing(run: Mapping[str, Any]) -> dict[str, set[str]]:
    """By member the scenarios on which a gate of it fails."""
    found: dict[str, set[str]] = {}
    for task in run.get("tasks") or ():
        if failing_gates(task):
            member = f"{task['engine']}:{task.get('integrator') or ''}"
            found.setdefault(member, set()).add(task["scenario"])
    return found


def _core(group: Sequence[str], agreed: Mapping[frozenset[str], dict[str, bool]]) -> list[str]:
    """Those of a group that agree on every scenario; all where no two do."""

    def differences(one: str) -> int:
        pairs = (agreed[frozenset((one, other))] for other in group if other != one)
        return sum(not same for pair in pairs for same in pair.values())

    core: list[str] = []
    for one in sorted(group, key=differences):
        if all(all(agreed[frozenset((one, other))].values()) for other in core):
            core.append(one)
    return [one for one in group if one in core] if len(core) > 1 else list(group)


def _mostly(agreed: Mapping[frozenset[str], dict[str, bool]], one: str, other: str) -> bool:
    seen = agreed.get(frozenset((one, other)), {}).values()
    return sum(seen) > 0.5 * len(seen) if seen else False


def _cluster(
    group: Sequence[str],
    agreed: Mapping[frozenset[str], dict[str, bool]],
    clusters: Iterable[Mapping[str, Any]],
    failing: Mapping[str, set[str]],
) -> Cluster:
    whole, group = group, _core(group, agreed)
    pairs = [agreed[frozenset(pair)] for pair in combinations(group, 2)]
    scenarios = list(dict.fromkeys(scenario for pair in pairs for scenario in pair))
    apart = tuple(s for s in scenarios if not all(pair.get(s, True) for pair in pairs))
    together = tuple(s for s in scenarios if s not in apart)
    equal: dict[str, list[str]] = {}
    for cluster in clusters:
        name = cluster["scenario"]
        if name in together and not cluster.get("exact") and set(group) <= set(cluster["members"]):
            named = [n for n in (cluster["scheme"], *cluster.get("also", ())) if n is not None]
            equal[name] = [n for n in equal.get(name, named) if n in named]
    every = [n for n in next(iter(equal.values()), []) if all(n in own for own in equal.values())]
    split = () if every else _by_scheme(equal)
    others = []
    for other in (one for one in whole if one not in group):
        own = [agreed[frozenset((other, one))] for one in group]
        seen = [s for s in scenarios if any(s in pair for pair in own)]
        equals = tuple(s for s in seen if all(pair.get(s, True) for pair in own))
        others.append((other, equals, tuple(s for s in seen if s not in equals)))
    shared = dict.fromkeys(group, together) | {other: equals for other, equals, _ in others}
    hidden = tuple(one for one in whole if failing.get(one, set()) & set(shared[one]))
    return Cluster(tuple(group), tuple(every), together, apart, split, tuple(others), hidden)


def _by_scheme(equal: Mapping[str, Sequence[str]]) -> tuple[tuple[str, tuple[str, ...]], ...]:
    """The scenarios by a scheme that holds at all their steps, as few schemes as that takes."""
    left, found = dict(equal), list[tuple[str, tuple[str, ...]]]()
    while count := Counter(name for own in left.values() for name in own):
        scheme = count.most_common(1)[0][0]
        found.append((scheme, tuple(s for s, own in left.items() if scheme in own)))
        left = {s: own for s, own in left.items() if scheme not in own}
    return (*found, ("", tuple(left))) if left else tuple(found)
