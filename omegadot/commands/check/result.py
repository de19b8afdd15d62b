"""Checks: which there are before any is made, what comes of each, and how an engine's ended."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, field, replace
from itertools import product
from typing import Literal

from pydantic import TypeAdapter

from omegadot.gates.case import Case, Sweep, knobs_of
from omegadot.harness.plan import Engine
from omegadot.reports.summary.reasons import MODEL_ALONE
from omegadot.reports.text.numbers import times

GATES_OF_A_SCENARIO = ("model", "equation")
GATES_OF_A_RUN = ("scheme", "invariants", "trajectory")
OF_MOTION = ("equation", *GATES_OF_A_RUN)
Verdict = Literal["pass", "fail", "declared", "skip", "error"]


@dataclass(frozen=True)
class Check:
    """One gate of one engine: on a scenario, and there of a run, or of the engine itself.

    scenario: "" for a check of the engine itself.  integrator: of a run, else None, and with it
    timestep or accuracy.
    """

    engine: str
    scenario: str
    gate: str
    integrator: str | None = None
    timestep: float | None = None
    accuracy: float | None = None

    @property
    def id(self) -> str:
        """Engine, integrator, scenario, step and gate, like mujoco-RK4-t-handle-0.01-scheme.

        In place of a step stands an accuracy, like accuracy-1e-09.
        """
        step = None if self.timestep is None else repr(float(self.timestep))
        if self.accuracy is not None:
            step = f"accuracy-{float(self.accuracy)!r}"
        parts = (self.engine, self.integrator, self.scenario, step, self.gate)
        return "-".join(part for part in parts if part)


@dataclass(frozen=True)
class Result:
    """What came of a check.

    verdict: "skip" has its reason in `message`, and is no pass; "declared" is a failure that an
    exception excuses; "error" is an engine that did not answer, and then
    outcome: crashed, timeout, raised or not-installed.
    excess: how many times its bound the value is that the message names first; None without one.
    explained: the message with its cause, which is surer the more scenarios are known.
    """

    verdict: Verdict
    message: str = ""
    outcome: str = "ok"
    excess: float | None = None
    explained: Callable[[], str] | None = field(default=None, compare=False, repr=False)

    @property
    def settled(self) -> Result:
        """The same with a cause that holds on all scenarios that have been run."""
        if self.verdict != "fail" or self.explained is None:
            return self
        return replace(self, message=self.explained(), explained=None)


PASSED = Result("pass")


def skipped(reason: str) -> Result:
    """A check that could not be made."""
    return Result("skip", reason)


def error(outcome: str, reason: str) -> Result:
    """An engine that did not answer."""
    return Result("error", f"{outcome}: {reason}", outcome)


@dataclass
class Tally:
    """Verdicts by engine, apart those of gates that test its motion, and the first reason for a
    skip.
    """

    verdicts: dict[str, Counter[str]] = field(default_factory=dict)
    motion: dict[str, Counter[str]] = field(default_factory=dict)
    reasons: dict[str, str] = field(default_factory=dict)

    def add(self, engine: str, gate: str, verdict: str, message: str = "") -> None:
        """Count one check."""
        self.verdicts.setdefault(engine, Counter())[verdict] += 1
        if gate in OF_MOTION:
            self.motion.setdefault(engine, Counter())[verdict] += 1
        if verdict == "skip":
            self.reasons.setdefault(engine, message)

    def only_skipped(self, named: Iterable[str]) -> list[str]:
        """A sentence for each engine requested by name of which every check was skipped, or every
        one but those of its model.
        """
        found = []
        for engine in dict.fromkeys(named):
            why = f"({self.reasons.get(engine, '')})"
            if set(self.verdicts.get(engine, ())) == {"skip"}:
                count = sum(self.verdicts[engine].values())
                were = f"{times(count, 'check')} {'was' if count == 1 else 'were'} skipped"
                found.append(f"{engine}: all of its {were}, and a skip is not a pass {why}.")
            elif set(self.motion.get(engine, ())) == {"skip"}:
                found.append(f"{engine}: {MODEL_ALONE} {why}.")
        return found


@dataclass(frozen=True)
class Subject:
    """An engine that started. integrators: those to check.  declared: all that it has.

    by_accuracy: those of all that are swept over accuracies, with the finest that each follows.
    """

    name: str
    version: str
    integrators: tuple[str, ...]
    declared: tuple[str, ...]
    by_accuracy: dict[str, float] = field(default_factory=dict)

    @property
    def whole(self) -> Subject:
        """The same engine with all of its integrators."""
        return replace(self, integrators=self.declared)


def checks_of(subjects: Iterable[Subject], cases: Sequence[Case]) -> list[Check]:
    """Every check, scenario by scenario, so that each is run once and then done with."""
    found = []
    for case, subject in product(cases, subjects):
        where = (subject.name, case.name)
        found += [Check(*where, gate) for gate in GATES_OF_A_SCENARIO]
        if subject.name == "exact":  # it is not stepped, and has its invariants to show
            found.append(Check(*where, "invariants"))
            continue
        for name in subject.integrators:
            knobs = [knobs_of(sweep) for sweep in sweeps_of(subject, name, case)]
            runs = product(knobs, GATES_OF_A_RUN)
            found += [Check(*where, gate, name, **own) for own, gate in runs]
    return found


def sweeps_of(subject: Subject, integrator: str, case: Case) -> tuple[Sweep, ...]:
    """What an integrator of an engine is swept over."""
    finest = subject.by_accuracy.get(integrator)
    return case.sweeps if finest is None else case.swept_by_accuracy(finest)


def subject_of(engine: Engine) -> Subject:
    """What is to be known of an engine that started."""
    return Subject(
        engine.name,
        engine.description.version,
        tuple(i.name for i in engine.integrators),
        tuple(i.name for i in engine.description.integrators),
        {i.name: i.finest_accuracy for i in engine.description.integrators if i.knob == "accuracy"},
    )


@dataclass(frozen=True)
class Registry:
    """Engines that started, and those that did not, with outcome and reason."""

    subjects: tuple[Subject, ...]
    missing: dict[str, tuple[str, str]]


REGISTRY = TypeAdapter(Registry)
"""Makes a registry a text, and again a registry of the text in another process."""
