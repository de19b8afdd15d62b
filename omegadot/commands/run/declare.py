"""Declared exceptions in a run: failing rows become "declared", and stale exceptions are named."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import replace
from typing import Any

from omegadot.commands.check.exceptions import (
    DeclaredException,
    matches_nothing,
    no_longer_fails,
)
from omegadot.commands.check.registry import subject_of
from omegadot.commands.check.result import Check
from omegadot.commands.check.unmatched import unmatched
from omegadot.gates.case import Case
from omegadot.gates.rows import Row
from omegadot.harness.outcome import EngineCase, JudgedCase, Outcome

Stale = list[dict[str, Any]]


def _declared(row: Row, exception: DeclaredException) -> Row:
    note = f"{exception.reason} {exception.link}"
    return replace(row, verdict="declared", note=f"{note}; {row.note}" if row.note else note)


class _Ledger:
    """Exceptions as they are used up: which hold, and which refer to a check that passes."""

    def __init__(self, exceptions: Iterable[DeclaredException]) -> None:
        self.exceptions = list(exceptions)
        self.passing: dict[DeclaredException, list[str]] = {}

    def rows(self, check: Check, rows: Sequence[Row]) -> list[Row]:
        """The rows of one check, its failures declared where an exception refers to it."""
        exception = next((e for e in self.exceptions if e.matches(check)), None)
        if exception is None:
            return list(rows)
        verdicts = {row.verdict for row in rows}
        if "fail" not in verdicts and "pass" in verdicts:
            self.passing.setdefault(exception, []).append(check.id)
        return [_declared(row, exception) if row.verdict == "fail" else row for row in rows]

    def by_gate(self, check: Check, rows: Sequence[Row]) -> list[Row]:
        """The rows of several gates, in the order that they came in."""
        found: list[Row] = []
        for gate in dict.fromkeys(row.gate for row in rows):
            own = [row for row in rows if row.gate == gate]
            found += self.rows(replace(check, gate=gate), own)
        return found

    def engine(self, case: Case, found: EngineCase) -> EngineCase:
        """One engine on one case."""
        name = found.engine.name
        shared = self.by_gate(Check(name, case.name, ""), found.shared)
        runs = [
            replace(
                run,
                rows=self.by_gate(
                    Check(name, case.name, "", run.integrator.name, run.sweep.timestep), run.rows
                ),
            )
            for run in found.runs
        ]
        return replace(found, shared=shared, runs=runs)

    def case(self, judged: JudgedCase) -> JudgedCase:
        """All engines on one case."""
        return replace(judged, engines=[self.engine(judged.case, e) for e in judged.engines])


def with_declared(
    outcome: Outcome, exceptions: Sequence[DeclaredException], cases: Sequence[Case]
) -> tuple[Outcome, Stale]:
    """The outcome with declared failures, and the exceptions that no longer hold, with the reason.

    An exception no longer holds where a check of its own passes, or where it matches none.
    """
    if not exceptions:
        return outcome, []
    ledger = _Ledger(exceptions)
    judged = replace(outcome, cases=[ledger.case(case) for case in outcome.cases])
    stale = [
        {**vars(e), "checks": ids, "problem": f"{ids[0]} {no_longer_fails(e)}"}
        for e, ids in ledger.passing.items()
    ]
    for engine in outcome.engines:
        stale += [
            {**vars(e), "checks": [], "problem": matches_nothing(e)}
            for e in unmatched(exceptions, subject_of(engine), cases)
        ]
    return judged, stale
