"""How a ranking changes when a requirement is halved or doubled."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence

from omegadot.commands.choose.candidate import Candidate
from omegadot.commands.choose.ranking import Place, ranked
from omegadot.commands.choose.requirements import ACCURACY, Requirements
from omegadot.commands.choose.search import Edge
from omegadot.commands.choose.spread import Spread
from omegadot.commands.choose.trial_rows import Row

Edges = Mapping[str, Edge]
Qualified = Callable[[Edges], dict[str, Spread]]


def variant_rows(
    candidates: Sequence[Candidate],
    wanted: Requirements,
    qualified: Qualified,
    places: Mapping[str, Place[str]],
    duration: float,
) -> list[Row]:
    """One row for each limit and factor that was tried.

    qualified: seconds a horizon of those that qualify with given edges.  places: the usual ranking.
    """
    found = []
    usual = sorted((place.key, place.rank) for place in places.values())
    keys = sorted({key for candidate in candidates for key in candidate.variants}, key=str)
    for requirement, factor in keys:
        edges = {
            c.name: c.variants.get((requirement, factor), Edge(None, None)) for c in candidates
        }
        costs = qualified(edges)
        order = ranked(costs)
        ranks = {place.key: place.rank for place in order}
        found.append(
            {
                "requirement": requirement,
                "factor": factor,
                "limit": wanted.limits[requirement] * factor,
                "unit": ACCURACY[requirement][1],
                "order": [_place(place, edges[place.key], costs, duration) for place in order],
                "same": sorted(ranks.items()) == usual,
                "joined": [name for name in ranks if name not in places],
                "left": [name for name in places if name not in ranks],
            }
        )
    return found


def _place(place: Place[str], edge: Edge, costs: Mapping[str, Spread], duration: float) -> Row:
    trial = edge.passing
    assert trial is not None  # it would not be ranked
    return {
        "candidate": place.key,
        "rank": place.rank,
        "tied": place.tied,
        "timestep": trial.timestep,
        "steps": trial.steps,
        "real_time_factor": duration / costs[place.key].median,
    }
