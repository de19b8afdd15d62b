"""Integrators whose trajectories are identical: their agreement is not independent evidence."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from itertools import combinations
from typing import Any

from omegadot.reports.text.numbers import first, listed, plain, times

_SCENARIOS_NAMED = 3


@dataclass(frozen=True)
class Cluster:
    """Members whose trajectories are identical, to rounding, on most scenarios.

    members: as ``engine:integrator``.  together and apart: the scenarios on which all of them
    agree, and on which some do not.
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

    @property
    def engines(self) -> int:
        """How many engines are among them."""
        return len({member.partition(":")[0] for member in self.members})


def label(member: str) -> str:
    """How a member is written in a sentence."""
    return member.replace(":", " ", 1)


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
    found = [_cluster(group, agreed, clusters) for group in groups if len(group) > 1]
    return sorted(found, key=lambda own: (-own.engines, -len(own.members)))


def _mostly(agreed: Mapping[frozenset[str], dict[str, bool]], one: str, other: str) -> bool:
    seen = agreed.get(frozenset((one, other)), {}).values()
    return sum(seen) > 0.5 * len(seen) if seen else False


def _cluster(
    group: Sequence[str],
    agreed: Mapping[frozenset[str], dict[str, bool]],
    clusters: Iterable[Mapping[str, Any]],
) -> Cluster:
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
    return Cluster(tuple(group), tuple(every), together, apart, split)


def _by_scheme(equal: Mapping[str, Sequence[str]]) -> tuple[tuple[str, tuple[str, ...]], ...]:
    """The scenarios by a scheme that holds at all their steps, as few schemes as that takes."""
    left, found = dict(equal), list[tuple[str, tuple[str, ...]]]()
    while count := Counter(name for own in left.values() for name in own):
        scheme = count.most_common(1)[0][0]
        found.append((scheme, tuple(s for s, own in left.items() if scheme in own)))
        left = {s: own for s, own in left.items() if scheme not in own}
    return (*found, ("", tuple(left))) if left else tuple(found)


def sentence(cluster: Cluster) -> str:
    """Which members are identical, and what follows."""
    members = listed([label(member) for member in cluster.members])
    count = "both" if len(cluster.members) == 2 else "all"
    scheme = f"{count} step {cluster.schemes[0]}" if cluster.schemes else _split(cluster, count)
    if len(cluster.schemes) > 1:
        scheme += f" or {' or '.join(cluster.schemes[1:])}, which no scenario here distinguishes"
    return (
        f"{members} produce identical trajectories ({scheme}), so their agreement is not "
        "independent evidence."
    )


def _split(cluster: Cluster, count: str) -> str:
    """Which scheme they step where, as no scheme is that of all scenarios."""
    none = "no scheme of the reference"
    if not any(scheme for scheme, _ in cluster.by_scheme):
        return none
    places = [
        f"{scheme or none} on {_places(scenarios)}" for scheme, scenarios in cluster.by_scheme
    ]
    return f"{count} step {listed(places)}"


def _places(scenarios: Sequence[str]) -> str:
    several = len(scenarios) > _SCENARIOS_NAMED
    return times(len(scenarios), "scenario") if several else listed(scenarios)


def extent(cluster: Cluster) -> str:
    """On how many scenarios that holds, and the first ones on which it does not.

    Scenarios that all members follow exactly distinguish no schemes, and are not counted.
    """
    total = len(cluster.together) + len(cluster.apart)
    if total == 1:
        return "On 1 scenario that distinguishes schemes."
    counted = f"{total} scenarios that distinguish schemes"
    if not cluster.apart:
        return f"On all {counted}."
    several = len(cluster.apart) > _SCENARIOS_NAMED
    shown = first(cluster.apart, _SCENARIOS_NAMED) if several else listed(cluster.apart)
    return f"On {len(cluster.together)} of {counted}; the trajectories differ on {shown}."


def on_scenario(run: Mapping[str, Any], scenario: str) -> str:
    """One scenario's clusters at its finest step, and how many different trajectories there are."""
    own = [c for c in run.get("clusters") or [] if c["scenario"] == scenario]
    if not own:
        return ""
    step = min(cluster["timestep"] for cluster in own)
    finest = [cluster["members"] for cluster in own if cluster["timestep"] == step]
    equal = [" = ".join(map(label, members)) for members in finest if len(members) > 1]
    runs = times(sum(map(len, finest)), "run")
    different = "1 trajectory" if len(finest) == 1 else f"{len(finest)} different trajectories"
    message = f"{runs} at step {plain(step)} s produce {different}"
    return f"{message}: {'; '.join(equal)}." if equal else f"{message}."
