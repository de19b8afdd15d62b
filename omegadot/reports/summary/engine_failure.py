"""A failing engine in words: which gate, where, by how much, why, and what it costs."""

from __future__ import annotations

from dataclasses import dataclass

from omegadot.reports.summary.next_command import is_check
from omegadot.reports.text.numbers import listed, times

# What each gate looks at, for readers who do not know their names.
LOOKS_AT = {
    "model": "the body that it holds",
    "equation": "omega-dot at given states",
    "scheme": "how it steps",
    "invariants": "what must stay constant",
    "trajectory": "the motion over time",
    "cost": "what a step costs",
}


@dataclass(frozen=True)
class EngineFailure:
    """An engine that fails: the first gate that does, and its worst measure there.

    run: the integrator and step that gave it, or whose runs fail where all share it.  stepless:
    whether the gate looks at no step.  scenarios: on how many of how many it fails.  runs: in how
    many of how many on the scenario.  later: the gates after it that fail as well.  unseen: that
    no run shows it, where none does.
    cause: the likeliest, "" where none is known, and then seen: what is known in its place.
    cost: what the failure means for the attitude, next to integrators that pass; "" where it is not
    known.  command: shrinks the failure and looks for its cause, or repeats it; "" without any.
    scope: where the same gate holds; "" where it does nowhere.  who: engine, version and setup.
    harm: how much of the attitude's error is beyond that of sound runs, rad.
    """

    engine: str
    gate: str
    scenario: str
    run: str
    measured: str
    stepless: bool
    scenarios: tuple[int, int]
    runs: tuple[int, int]
    cause: str
    cost: str
    unseen: str = ""
    later: tuple[str, ...] = ()
    seen: str = ""
    command: str = ""
    scope: str = ""
    who: tuple[str, ...] = ()
    harm: float = 0.0

    @property
    def looks_at(self) -> str:
        """What the gate looks at."""
        return LOOKS_AT[self.gate]

    @property
    def purpose(self) -> str:
        """What the command is for."""
        checks = is_check(self.command)
        return "finds the smallest system that fails" if checks else "runs it alone"

    @property
    def lead(self) -> str:
        """What stands before the scenario."""
        failing, total = self.scenarios
        return "on " if failing < 2 else f"on {failing} of {total} scenarios, worst on "

    @property
    def tail(self) -> str:
        """What stands after the scenario: in how many of the runs there, and which is worst."""
        failing, total = self.runs
        every = failing == total
        extent = f"all {total} runs" if every else f"{failing} of {times(total, 'run')}"
        extent = "its one run" if every and total == 1 else extent
        if self.stepless:
            so = ", so in" if every else ", and in"
            return ", before any step is taken" + (f"{so} {extent} there" if failing else "")
        worst = ", worst with" if failing > 1 and ", step" in self.run else ", with"
        by = f"{worst} {self.run}" if self.run else ""
        return (f", in {extent} there" if failing else "") + by

    @property
    def found(self) -> str:
        """What was measured, what fails besides, and whether a run shows it: in sentences."""
        later = f"{self.later_gates} as well" if self.later else ""
        unseen = self.unseen[:1].upper() + self.unseen[1:]
        return ". ".join(filter(None, (self.measured, later, unseen)))

    @property
    def head(self) -> str:
        """Which gate fails, and where: a sentence without its full stop."""
        gate = f"fails the {self.gate} gate ({self.looks_at})"
        return f"{self.engine} {gate} {self.lead}{self.scenario}{self.tail}"

    @property
    def labelled(self) -> list[tuple[str, str]]:
        """What is known of it, by name: as page and terminal list it."""
        known = self.cause or f"none was found; {self.seen or 'what fails is listed'}"
        found = [("likely cause", known), ("measured", self.found), ("what holds", self.scope)]
        found += [("what it costs", self.cost)]
        command = f"{self.command} ({self.purpose})" if self.command else ""
        return [(name, text) for name, text in (*found, ("next", command)) if text]

    @property
    def sentence(self) -> str:
        """All of it in a few sentences."""
        parts = [f"{self.head}: {self.found}"]
        parts += [f"Likely cause: {self.cause}"] if self.cause else []
        parts += [f"No cause was found: {self.seen}"] if self.seen else []
        parts += [f"Holds: {self.scope}"] if self.scope else []
        parts += [f"Cost: {self.cost}"] if self.cost else []
        text = ". ".join(parts) + "."
        return f"{text} Next: {self.command}" if self.command else text

    @property
    def later_gates(self) -> str:
        """The gates after the first that fail, as a clause."""
        one = len(self.later) == 1
        named = f"{listed(self.later)} {'gate fails' if one else 'gates fail'}"
        return f"Its {named}" if self.later else ""
