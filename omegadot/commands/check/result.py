"""A check and what comes of it, and how the checks of each engine ended."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable
from dataclasses import dataclass, field
from typing import Literal

from omegadot.reports.text.numbers import times

Verdict = Literal["pass", "fail", "declared", "skip", "error"]


@dataclass(frozen=True)
class Check:
    """One gate of one engine: on a scenario, and there of a run, or of the engine itself.

    scenario: "" for a check of the engine itself.  integrator, timestep: of a run, else None.
    """

    engine: str
    scenario: str
    gate: str
    integrator: str | None = None
    timestep: float | None = None

    @property
    def id(self) -> str:
        """Engine, integrator, scenario, step and gate, like mujoco-RK4-t-handle-0.01-scheme."""
        step = None if self.timestep is None else repr(float(self.timestep))
        parts = (self.engine, self.integrator, self.scenario, step, self.gate)
        return "-".join(part for part in parts if part)


@dataclass(frozen=True)
class Result:
    """What came of a check.

    verdict: "skip" has its reason in `message`, and is no pass; "declared" is a failure that an
    exception excuses; "error" is an engine that did not answer, and then
    outcome: crashed, timeout, raised or not-installed.
    """

    verdict: Verdict
    message: str = ""
    outcome: str = "ok"


PASSED = Result("pass")


def skipped(reason: str) -> Result:
    """A check that could not be made."""
    return Result("skip", reason)


def error(outcome: str, reason: str) -> Result:
    """An engine that did not answer."""
    return Result("error", f"{outcome}: {reason}", outcome)


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
