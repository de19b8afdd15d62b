"""Two records compared."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable
from dataclasses import dataclass

import polars as pl

from omegadot.reports.record.record import Record
from omegadot.reports.text.numbers import first, listed, times
from omegadot.reports.two_runs.change import Change, name_of
from omegadot.reports.two_runs.figures import Cost, changed_figures, costs, paired
from omegadot.reports.two_runs.runs import changed_runs, pair_runs, without_repetition
from omegadot.reports.two_runs.settings import Difference, differences
from omegadot.reports.two_runs.sides import Side, Task, redefined, several_versions, tasks_of

_NAMED = 4


@dataclass(frozen=True)
class Comparison:
    """What changed from the first record to the second.

    worse, better: the largest change first.  appeared, vanished: runs that one record alone has.
    runs, figures: how many of each both records have, and so were compared.
    """

    was: Side
    now: Side
    worse: tuple[Change, ...]
    better: tuple[Change, ...]
    appeared: tuple[Task, ...]
    vanished: tuple[Task, ...]
    settings: tuple[Difference, ...]
    costs: tuple[Cost, ...]
    runs: int
    figures: int
    redefined: frozenset[str]

    @property
    def regressed(self) -> bool:
        """Whether anything that both records have got worse."""
        return bool(self.worse)

    @property
    def headline(self) -> str:
        """What got worse, better, vanished and appeared, and how much was compared."""
        if not self.runs:
            return "Nothing to compare: the two records have no run in common."
        message = [
            f"{term}: {_engines(changes)}."
            for changes, term in ((self.worse, "Worse"), (self.better, "Better"))
            if changes
        ]
        for tasks, term in ((self.vanished, "vanished"), (self.appeared, "appeared")):
            if tasks:
                message.append(f"{times(len(tasks), 'run')} {term}.")
        if not self.worse and not self.better:
            message.insert(0, "No change.")
        compared = f"{times(self.runs, 'run')} and {times(self.figures, 'value')} compared."
        return " ".join([*message, compared])


def _engines(changes: Iterable[Change]) -> str:
    """The engines and integrators of some changes and how many, the largest change first."""
    found: dict[str, Counter[str]] = {}
    for change in changes:
        name = " ".join(filter(None, (name_of(change.key), change.key.integrator)))
        found.setdefault(name, Counter())["value" if change.metric else "run"] += 1
    shown = [
        f"{name} ({listed([times(count, noun) for noun, count in counts.items()])})"
        for name, counts in found.items()
    ]
    return first(shown, _NAMED) if len(shown) > _NAMED else listed(shown)


def compare_records(was: Record, now: Record, labels: tuple[str, str] = ("A", "B")) -> Comparison:
    """Compare the second record with the first.

    Runs are the same where scenario, engine, setup, integrator and step are; the engine's version
    may differ. A figure that has a round-off bound got worse, or better, where it moved by more
    than the bounds of both records together; a scenario that is another one under its old name
    compares by outcome and verdict alone.
    """
    one, other = Side(labels[0], was), Side(labels[1], now)
    versioned = several_versions((one, other))
    runs, vanished, appeared = pair_runs(*(tasks_of(side, versioned) for side in (one, other)))
    others = redefined(one, other)
    pairs = paired(one, other, versioned)
    same_seed = was.run.get("seed") == now.run.get("seed")
    figures = pairs.filter(pl.col("gate") != "cost")
    found = changed_figures(figures, same_seed, others)
    changes = without_repetition(changed_runs(runs), found)
    changes.sort(key=lambda change: change.weight, reverse=True)
    return Comparison(
        one,
        other,
        tuple(change for change in changes if change.worse),
        tuple(change for change in changes if not change.worse),
        tuple(appeared),
        tuple(vanished),
        tuple(differences(one, other)),
        tuple(costs(pairs)),
        len(runs),
        len(figures.drop_nulls(["bound", "bound_now"])),
        frozenset(others),
    )
