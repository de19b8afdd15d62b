"""Runs and figures as plain rows."""

from __future__ import annotations

import math
from typing import Any

from omegadot.commands.choose.candidate import Candidate
from omegadot.commands.choose.ranking import Spread
from omegadot.commands.choose.requirements import ACCURACY
from omegadot.commands.choose.search import order_between
from omegadot.commands.choose.trial import Trial

Row = dict[str, Any]
LIKE = (0.75, 1.35)  # an order within these of the declared one is trusted to go on


def trial_row(trial: Trial | None, limits: dict[str, float]) -> Row | None:
    """A run: its step, its errors and by how much each limit exceeds them."""
    if trial is None:
        return None
    errors = {
        key: {**vars(found), "margin": limits[key] / found.most if found.most > 0.0 else None}
        for key, found in trial.errors.items()
    }
    return {
        "timestep": trial.timestep,
        "steps": trial.steps,
        "samples": trial.samples,
        "seconds_per_step": trial.seconds_per_step,
        "errors": errors,
        "ratio": trial.ratio(limits),
        "passes": trial.passes(limits),
    }


def spread_row(spread: Spread | None) -> Row | None:
    """Median, quartiles, and every round."""
    if spread is None:
        return None
    return {"median": spread.median, "quartiles": [*spread.quartiles], "rounds": [*spread.rounds]}


def missed_rows(trial: Trial | None, limits: dict[str, float]) -> list[Row]:
    """The limits that a run misses, the worst first, and by what factor."""
    if trial is None:
        return []
    return [
        {"requirement": key, "limit": limits[key], "unit": ACCURACY[key][1]}
        | {"found": trial.errors[key].most if trial.errors else None}
        | {"factor": trial.errors[key].most / limits[key] if trial.errors else None}
        | {"timestep": trial.timestep, "steps": trial.steps}
        for key in trial.missed(limits)
    ]


def predicted_row(candidate: Candidate, limits: dict[str, float]) -> Row | None:
    """Where the order states the limits would be met: a guess, not a verdict.

    order: that of the two finest runs, or the declared one where there is but one.  seconds: what
    one such run would take. It lies beyond the search's budget.
    """
    trials = sorted(candidate.trials.values(), key=lambda t: t.steps)
    order, declared = None, candidate.declared_order(limits)
    if len(trials) > 1:
        order = order_between(trials[-2], trials[-1], limits)
    elif trials and math.isfinite(trials[0].ratio(limits)):
        order = declared
    if order is None or not LIKE[0] * declared <= order <= LIKE[1] * declared:
        return None  # the errors do not shrink at their order yet: the rest cannot be predicted
    finest = trials[-1]
    steps = finest.steps * finest.ratio(limits) ** (1.0 / order)
    timestep = finest.timestep * finest.steps / steps
    return {"timestep": timestep, "order": order, "seconds": steps * finest.seconds_per_step}
