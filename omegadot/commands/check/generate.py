"""Which checks there are, before anything runs: from engines, their integrators and scenarios."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass

from omegadot.commands.check.result import Check
from omegadot.gates.case import Case

GATES_OF_A_SCENARIO = ("model", "equation")
GATES_OF_A_RUN = ("scheme", "invariants", "trajectory")
# The exact solution is not stepped: next to the first two gates it has its invariants to show.
GATES_OF_THE_EXACT = (*GATES_OF_A_SCENARIO, "invariants")


@dataclass(frozen=True)
class Subject:
    """An engine that started. integrators: those to check.  declared: all that it has."""

    name: str
    version: str
    integrators: tuple[str, ...]
    declared: tuple[str, ...]

    @property
    def whole(self) -> Subject:
        """The same engine with all of its integrators."""
        return Subject(self.name, self.version, self.declared, self.declared)


def gates_of(subject: Subject) -> tuple[str, ...]:
    """The gates that an engine is put through on every scenario."""
    exact = subject.name == "exact"
    return GATES_OF_THE_EXACT if exact else (*GATES_OF_A_SCENARIO, *GATES_OF_A_RUN)


def _checks_of_case(subject: Subject, case: Case) -> Iterator[Check]:
    if subject.name == "exact":
        yield from (Check(subject.name, case.name, gate) for gate in GATES_OF_THE_EXACT)
        return
    yield from (Check(subject.name, case.name, gate) for gate in GATES_OF_A_SCENARIO)
    for integrator in subject.integrators:
        for sweep in case.sweeps:
            for gate in GATES_OF_A_RUN:
                yield Check(subject.name, case.name, gate, integrator, sweep.timestep)


def checks_of(subjects: Iterable[Subject], cases: Sequence[Case]) -> list[Check]:
    """Every check, scenario by scenario, so that each is run once and then done with."""
    engines = list(subjects)
    return [c for case in cases for subject in engines for c in _checks_of_case(subject, case)]
