"""One case's part of a choice: the candidates that qualify, and why the others do not."""

from __future__ import annotations

from collections.abc import Mapping

from omegadot.commands.choose.candidate import Candidate
from omegadot.commands.choose.chooser import CaseChoice, Choice
from omegadot.commands.choose.ranking import Place, Point, Spread, front, ranked
from omegadot.commands.choose.requirements import ACCURACY
from omegadot.commands.choose.search import Edge
from omegadot.commands.choose.trial import Row, Trial

_NOTHING: Row = {"median": 0.0}
Costs = dict[str, Spread]


def _too_slow_row(least: float, factor: float) -> Row:
    """The real-time factor as a requirement that is missed."""
    return {
        "requirement": "real-time-factor", "limit": least, "unit": "1",
        "found": factor, "factor": least / factor,
    }  # fmt: skip


class CaseDocument:
    """One case's part of the document."""

    def __init__(self, choice: Choice, found: CaseChoice) -> None:
        self._choice, self._found, self._wanted = choice, found, choice.requirements
        self._duration = found.case.scenario.run.duration

    def _per_step(self, candidate: Candidate) -> Spread | None:
        return self._choice.costs.get((self._found.case.name, candidate.name))

    def _seconds(self, candidate: Candidate, trial: Trial | None) -> Spread | None:
        """What the whole horizon takes in as many steps as a run had."""
        spread = self._per_step(candidate)
        return spread.scaled(trial.steps) if spread and trial else None

    def _too_slow(self, seconds: Spread) -> bool:
        least = self._wanted.real_time_factor
        return least is not None and self._duration / seconds.median < least

    def qualified(self, edges: Mapping[str, Edge] | None = None) -> Costs:
        """Seconds a horizon of those that meet everything, by candidate; `edges` for their own."""
        qualified = {}
        for candidate in self._found.candidates:
            edge = edges[candidate.name] if edges else candidate.edge
            seconds = self._seconds(candidate, edge.passing)
            if candidate.outcome == "ok" and seconds and not self._too_slow(seconds):
                qualified[candidate.name] = seconds
        return qualified

    def knobs(self, name: str) -> Row:
        """The largest step of a candidate, in s, or its coarsest accuracy."""
        found = next(c.edge.passing for c in self._found.candidates if c.name == name)
        return found.knobs if found else {"timestep": None, "accuracy": None}

    def row(self) -> Row:
        """Everything about the case; `candidates` in order of rank, those out of it after."""
        case, ruler = self._found.case, self._found.ruler
        costs = self.qualified()
        places = {place.candidate: place for place in ranked(costs)}
        on_front = self._front(costs)
        rows = [self._candidate(c, places, on_front) for c in self._found.candidates]
        last = len(rows) + 1
        rows.sort(key=lambda r: (r["rank"] or last, -(r["real_time_factor"] or _NOTHING)["median"],
                                 (r["nearest"] or {}).get("ratio", float("inf"))))  # fmt: skip
        return {
            "name": case.name,
            "title": case.scenario.title,
            "definition": case.scenario.to_dict(),
            "duration": self._duration,
            "truth": ruler.source if ruler else None,
            "reason": self._found.reason,
            "floor": dict(ruler.floor) if ruler else {},
            "unverifiable": list(self._found.unverifiable),
            "qualifying": len(costs),
            "candidates": rows,
            "variants": self._variants(places),
        }

    def _candidate(
        self, candidate: Candidate, places: Mapping[str, Place], on_front: set[str]
    ) -> Row:
        limits, edge = self._wanted.limits, candidate.edge
        found, broken = edge.passing, candidate.outcome != "ok"
        place = places.get(candidate.name)
        seconds = self._seconds(candidate, found)
        factor = seconds.under(self._duration) if seconds and not broken else None
        nearest = found or candidate.nearest(limits)
        missed = nearest.missed_rows(limits) if nearest and not found else []
        missed = [{**one, "shown": self._wanted.shown(one["requirement"])} for one in missed]
        least = self._wanted.real_time_factor
        if found and seconds and factor and least and self._too_slow(seconds):
            missed.append(_too_slow_row(least, factor.median) | found.knobs)

        def row(trial: Trial | None) -> Row | None:
            return trial.row(limits) if trial else None

        per_step = self._per_step(candidate)
        return {
            "engine": candidate.engine.name,
            "version": candidate.engine.description.version,
            "integrator": candidate.integrator.name,
            "scheme": candidate.integrator.scheme,
            "status": candidate.outcome if broken else ("qualifies" if place else "out"),
            "reason": candidate.reason,
            "rank": place.rank if place else None,
            "tied": bool(place and place.tied),
            "found": row(None if broken else found),
            "larger": row(edge.failing),
            "passes_again": row(edge.again),
            "nearest": row(nearest),
            "missed": missed,
            "real_time_factor": factor and factor.row(),
            "time_per_step": per_step and per_step.row(),
            "memory": self._choice.memory.get(candidate.engine.name),
            "on_front": candidate.name in on_front,
            "predicted": None if found or broken else self._predicted(candidate),
            "tried": [trial.row(limits) for _, trial in sorted(candidate.trials.items())],
        }

    def _predicted(self, candidate: Candidate) -> Row | None:
        """Where the limits would be met, and what is missed there all the same."""
        guess, least = candidate.predicted(self._wanted.limits), self._wanted.real_time_factor
        if guess is None:
            return None
        missed = []
        if least is not None and self._duration < least * guess["seconds"]:
            missed.append(_too_slow_row(least, self._duration / guess["seconds"]))
        return {**guess, "missed": missed}

    def _front(self, costs: Costs) -> set[str]:
        """Those with a run that none beats in cost, error and memory at once."""
        points = []
        for candidate in self._found.candidates:
            if candidate.name not in costs:
                continue
            memory = float(self._choice.memory.get(candidate.engine.name) or 0.0)
            for trial in candidate.trials.values():
                seconds = self._seconds(candidate, trial)
                if seconds and trial.passes(self._wanted.limits):
                    error = trial.ratio(self._wanted.limits)
                    points.append(Point(candidate.name, (seconds.median, error, memory)))
        return {point.key for point in front(points)}

    def _variants(self, places: Mapping[str, Place]) -> list[Row]:
        """How the ranking changes when a requirement is halved or doubled, one row for each."""
        rows, candidates = [], self._found.candidates
        usual = sorted((name, place.rank) for name, place in places.items())
        for key, factor in sorted({changed for c in candidates for changed in c.variants}, key=str):
            edges = {c.name: c.variants.get((key, factor), Edge(None, None)) for c in candidates}
            costs = self.qualified(edges)
            order = ranked(costs)
            ranks = {place.candidate: place.rank for place in order}
            rows.append(
                {
                    "requirement": key,
                    "factor": factor,
                    "limit": self._wanted.limits[key] * factor,
                    "unit": ACCURACY[key][1],
                    "shown": self._wanted.shown(key),
                    "order": [self._place(place, edges, costs) for place in order],
                    "same": sorted(ranks.items()) == usual,
                    "joined": [name for name in ranks if name not in places],
                    "left": [name for name in places if name not in ranks],
                }
            )
        return rows

    def _place(self, place: Place, edges: Mapping[str, Edge], costs: Costs) -> Row:
        trial = edges[place.candidate].passing
        assert trial is not None  # it would not be ranked
        factor = self._duration / costs[place.candidate].median
        return {**vars(place), **trial.knobs, "real_time_factor": factor}
