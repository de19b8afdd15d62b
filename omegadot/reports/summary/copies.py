"""Who is a copy of whom: the sentences about engines that step one scheme, and count once."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from itertools import combinations
from typing import Any

from omegadot.reports.text.numbers import listed, plain, times

_WORDS = ("no", "one", "two", "three", "four", "five", "six", "seven", "eight", "nine")
_SCENARIOS_NAMED = 3


@dataclass(frozen=True)
class Copies:
    """Members that turn alike, to rounding, on most scenarios.

    members: as ``engine:integrator``.  scheme: None where the reference knows none like it.
    together and apart: the scenarios on which all of them agree, and on which some do not.
    """

    members: tuple[str, ...]
    scheme: str | None
    together: tuple[str, ...]
    apart: tuple[str, ...]

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


def _agree(one: Mapping[float, int], other: Mapping[float, int]) -> bool | None:
    """Whether two members are together at every step that both ran; None where there is none."""
    shared = one.keys() & other.keys()
    return all(one[step] == other[step] for step in shared) if shared else None


def copies_of(run: Mapping[str, Any]) -> list[Copies]:
    """The groups of two or more, by the clusters of ``run.json``: those most in number first.

    In a group each two members are together on more than half of the scenarios that both ran:
    simple motions do not tell schemes apart, and a special load may part what is else the same.
    """
    clusters = run.get("clusters") or []
    homes = _homes(clusters)
    members = list(dict.fromkeys(member for home in homes.values() for member in home))
    agreed: dict[frozenset[str], dict[str, bool]] = {}
    for scenario, home in homes.items():
        for one, other in combinations(home, 2):
            same = _agree(home[one], home[other])
            if same is not None:
                agreed.setdefault(frozenset((one, other)), {})[scenario] = same
    groups: list[list[str]] = []
    for member in members:
        home_group = next((g for g in groups if all(_mostly(agreed, member, m) for m in g)), None)
        if home_group is None:
            groups.append([member])
        else:
            home_group.append(member)
    found = [_copies(group, agreed, clusters) for group in groups if len(group) > 1]
    return sorted(found, key=lambda copies: (-copies.engines, -len(copies.members)))


def _mostly(agreed: Mapping[frozenset[str], dict[str, bool]], one: str, other: str) -> bool:
    seen = agreed.get(frozenset((one, other)), {}).values()
    return sum(seen) > 0.5 * len(seen) if seen else False


def _copies(
    group: Sequence[str],
    agreed: Mapping[frozenset[str], dict[str, bool]],
    clusters: Iterable[Mapping[str, Any]],
) -> Copies:
    pairs = [agreed[frozenset(pair)] for pair in combinations(group, 2)]
    scenarios = list(dict.fromkeys(scenario for pair in pairs for scenario in pair))
    apart = tuple(s for s in scenarios if not all(pair.get(s, True) for pair in pairs))
    together = tuple(s for s in scenarios if s not in apart)
    names = Counter(
        cluster["scheme"]
        for cluster in clusters
        if cluster["scenario"] in together and set(group) & set(cluster["members"])
    )
    scheme = names.most_common(1)[0][0] if names else None
    return Copies(tuple(group), scheme, together, apart)


def sentence(copies: Copies) -> str:
    """Who is one scheme, how many votes they have, and where they part."""
    count = len(copies.members)
    term = _WORDS[count] if count < len(_WORDS) else str(count)
    scheme = f", {copies.scheme}" if copies.scheme else " that the reference does not know"
    who = listed([label(member) for member in copies.members])
    return f"{who} are one scheme{scheme}: {term} copies, one vote."


def where(copies: Copies) -> str:
    """On how many scenarios that holds, and the first ones on which it does not."""
    total = len(copies.together) + len(copies.apart)
    if not copies.apart:
        return f"On all of {times(total, 'scenario')}."
    named = list(copies.apart[:_SCENARIOS_NAMED])
    more = len(copies.apart) - len(named)
    shown = listed([*named, f"{more} more"] if more else named)
    return f"On {len(copies.together)} of {times(total, 'scenario')}; they part on {shown}."


def votes(run: Mapping[str, Any], scenario: str) -> str:
    """One scenario's copies at its finest step, and how many different courses are left."""
    own = [c for c in run.get("clusters") or [] if c["scenario"] == scenario]
    if not own:
        return ""
    step = min(cluster["timestep"] for cluster in own)
    finest = [cluster["members"] for cluster in own if cluster["timestep"] == step]
    equal = [" = ".join(map(label, members)) for members in finest if len(members) > 1]
    total = sum(map(len, finest))
    deviations = times(len(finest), "different course")
    message = f"{times(total, 'run')} at step {plain(step)} s make {deviations}"
    return f"{message}: {'; '.join(equal)}." if equal else f"{message}."
