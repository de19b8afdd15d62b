"""One case's part of a choice: the candidates that qualify, and why the others do not."""

from __future__ import annotations

from typing import Any

from omegadot.commands.choose.candidate import Candidate
from omegadot.commands.choose.chooser import CaseChoice, Choice
from omegadot.commands.choose.ranking import Point, front, ranked
from omegadot.commands.choose.requirements import Requirements
from omegadot.commands.choose.spread import Spread
from omegadot.commands.choose.trial import Trial
from omegadot.commands.choose.trial_rows import (
    Row,
    missed_rows,
    nearest_trial,
    predicted_row,
    spread_row,
    trial_row,
)
from omegadot.commands.choose.variants import Edges, variant_rows

_NOTHING: Row = {"median": 0.0}


class CaseDocument:
    """One case's part of the document."""

    def __init__(self, choice: Choice, found: CaseChoice, wanted: Requirements) -> None:
        self._choice, self._found, self._wanted = choice, found, wanted
        self._duration = found.case.scenario.run.duration

    def _seconds(self, candidate: Candidate, steps: int) -> Spread | None:
        """What the whole horizon takes in so many steps."""
        spread = self._choice.costs.get((self._found.case.name, candidate.name))
        return None if spread is None else spread.scaled(steps)

    def _fast_enough(self, candidate: Candidate, trial: Trial) -> bool:
        """Whether the median speed meets the requirement, if there is one."""
        least, seconds = self._wanted.real_time_factor, self._seconds(candidate, trial.steps)
        if seconds is None:
            return False
        return least is None or self._duration / seconds.median >= least

    def qualified(self, edges: Edges | None = None) -> dict[str, Spread]:
        """Seconds a horizon of those that meet everything, by candidate; `edges` for their own."""
        edges = edges or {c.name: c.edge for c in self._found.candidates}
        qualified = {}
        for candidate in self._found.candidates:
            edge = edges[candidate.name]
            if candidate.outcome != "ok" or edge.passing is None:
                continue
            seconds = self._seconds(candidate, edge.passing.steps)
            if seconds is not None and self._fast_enough(candidate, edge.passing):
                qualified[candidate.name] = seconds
        return qualified

    def timestep(self, name: str) -> float | None:
        """The largest step of a candidate, in s."""
        found = next(c.edge.passing for c in self._found.candidates if c.name == name)
        return found.timestep if found else None

    def row(self) -> Row:
        """Everything about the case; `candidates` in order of rank, those out of it after."""
        case, ruler = self._found.case, self._found.ruler
        costs = self.qualified()
        places = {place.key: place for place in ranked(costs)}
        on_front = self._front(costs)
        rows = [self._candidate(c, costs, places, on_front) for c in self._found.candidates]
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
            "variants": variant_rows(
                self._found.candidates, self._wanted, self.qualified, places, self._duration
            ),
        }

    def _candidate(
        self, candidate: Candidate, costs: dict[str, Spread], places: Any, on_front: set[str]
    ) -> Row:
        limits, edge = self._wanted.limits, candidate.edge
        place = places.get(candidate.name)
        seconds = self._seconds(candidate, edge.passing.steps) if edge.passing else None
        nearest = edge.passing or nearest_trial(candidate, limits)
        broken = candidate.outcome != "ok"
        missed = [] if edge.passing else missed_rows(nearest, limits)
        factor = seconds.under(self._duration) if seconds else None
        least = self._wanted.real_time_factor
        if factor is not None and least is not None and factor.median < least and not broken:
            missed.append(
                {"requirement": "real-time-factor", "limit": least, "unit": "1"}
                | {"found": factor.median, "factor": least / factor.median}
                | {"timestep": nearest.timestep if nearest else None}
                | {"steps": nearest.steps if nearest else None}
            )
        return {
            "engine": candidate.engine.name,
            "version": candidate.engine.description.version,
            "integrator": candidate.integrator.name,
            "scheme": candidate.integrator.scheme,
            "status": candidate.outcome if broken else ("qualifies" if place else "out"),
            "reason": candidate.reason,
            "rank": place.rank if place else None,
            "tied": bool(place and place.tied),
            "found": None if broken else trial_row(edge.passing, limits),
            "larger": trial_row(edge.failing, limits),
            "passes_again": trial_row(edge.again, limits),
            "nearest": trial_row(nearest, limits),
            "missed": missed,
            "real_time_factor": spread_row(factor) if factor and not broken else None,
            "time_per_step": self._time_per_step(candidate),
            "memory": self._choice.memory.get(candidate.engine.name),
            "on_front": candidate.name in on_front,
            "predicted": None if edge.passing or broken else predicted_row(candidate, limits),
            "tried": [trial_row(trial, limits) for _, trial in sorted(candidate.trials.items())],
        }

    def _time_per_step(self, candidate: Candidate) -> Row | None:
        spread = self._choice.costs.get((self._found.case.name, candidate.name))
        return spread_row(spread) if spread else None

    def _front(self, costs: dict[str, Spread]) -> set[str]:
        """Those with a run that none beats in cost, error and memory at once."""
        points = []
        for candidate in self._found.candidates:
            if candidate.name not in costs:
                continue
            memory = float(self._choice.memory.get(candidate.engine.name) or 0.0)
            for trial in candidate.trials.values():
                seconds = self._seconds(candidate, trial.steps)
                if seconds is not None and trial.passes(self._wanted.limits):
                    error = trial.ratio(self._wanted.limits)
                    points.append(Point(candidate.name, (seconds.median, error, memory)))
        return {point.key for point in front(points)}
