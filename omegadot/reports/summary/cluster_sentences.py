"""Clusters of identical trajectories in words."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from omegadot.reports.summary.clusters import Cluster
from omegadot.reports.text.numbers import first, listed, plain, times

_SCENARIOS_NAMED = 3


def label(member: str) -> str:
    """How a member is written in a sentence."""
    return member.replace(":", " ", 1)


def sentence(cluster: Cluster) -> str:
    """Which members are identical, and what follows."""
    members = listed([label(member) for member in cluster.members])
    count = "both" if len(cluster.members) == 2 else "all"
    scheme = f"{count} step {cluster.schemes[0]}" if cluster.schemes else _split(cluster, count)
    if len(cluster.schemes) > 1:
        scheme += f"; no scenario here tells it from {' or '.join(cluster.schemes[1:])}"
    return f"{members} produce identical trajectories ({scheme}), so they count as one witness."


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
    """On how many scenarios that holds, which others equal them on some, and which of all fail.

    Scenarios that all members follow exactly tell no schemes apart, and are not counted.
    """
    total = len(cluster.together) + len(cluster.apart)
    texts = [_on(len(cluster.together), total, cluster.apart)]
    for other, equals, differs in cluster.others:
        where = f"{len(equals)} of these, not on {_first(differs)}"
        texts.append(f"{label(other)} equals them on {where}.")
    if cluster.failing:
        verb = "fails a gate" if len(cluster.failing) == 1 else "fail"
        texts.append(f"Of these {listed(list(map(label, cluster.failing)))} {verb} all the same.")
    return " ".join(texts)


def _on(count: int, total: int, apart: Sequence[str]) -> str:
    if total == 1:
        return "They do so on the one scenario that tells schemes apart."
    counted = f"{total} scenarios that tell schemes apart"
    where = f"{count} of {counted}, not on {_first(apart)}" if apart else f"all {counted}"
    return f"They do so on {where}."


def _first(scenarios: Sequence[str]) -> str:
    several = len(scenarios) > _SCENARIOS_NAMED
    return first(scenarios, _SCENARIOS_NAMED) if several else listed(scenarios)


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
