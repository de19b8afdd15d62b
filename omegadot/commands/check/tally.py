"""How the checks of each engine ended, and what follows for the whole."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field

from omegadot.commands.check.generate import Subject, gates_of
from omegadot.commands.check.result import Check
from omegadot.reports.text.numbers import times


@dataclass
class Tally:
    """Verdicts by engine, and the first reason for a skip."""

    verdicts: dict[str, Counter[str]] = field(default_factory=dict)
    reasons: dict[str, str] = field(default_factory=dict)

    def add(self, engine: str, verdict: str, message: str = "") -> None:
        """Count one check."""
        self.verdicts.setdefault(engine, Counter())[verdict] += 1
        if verdict == "skip":
            self.reasons.setdefault(engine, message)

    def only_skipped(self, named: Iterable[str]) -> list[str]:
        """A sentence for each engine requested by name of which every check was skipped."""
        return [
            f"{engine}: all of its {times(sum(self.verdicts[engine].values()), 'check')} "
            f"{'was' if sum(self.verdicts[engine].values()) == 1 else 'were'} skipped, and a skip "
            f"is not a pass ({self.reasons[engine]})."
            for engine in dict.fromkeys(named)
            if set(self.verdicts.get(engine, ())) == {"skip"}
        ]


def coverage(subjects: Sequence[Subject], checks: Sequence[Check]) -> list[str]:
    """Engine, version, and how many scenarios, gates and checks; a line an engine."""
    lines = []
    for subject in subjects:
        own = [check for check in checks if check.engine == subject.name]
        scenarios = len({check.scenario for check in own if check.scenario})
        gates = len({check.gate for check in own} & {*gates_of(subject), "baseline"})
        chosen = set(subject.integrators) != set(subject.declared)
        name = f"{subject.name} {subject.version}" + (
            f" ({', '.join(subject.integrators)})" if chosen else ""
        )
        covered = f"{times(scenarios, 'scenario')} x {times(gates, 'gate')}"
        lines.append(f"{name}: {covered}, {times(len(own), 'check')}")
    return lines
