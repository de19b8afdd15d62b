"""Declared exceptions in a run: failing rows become "declared", and stale exceptions are named."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import replace
from typing import Any

from omegadot.commands.check.exceptions import (
    DeclaredException,
    matches_nothing,
    no_longer_fails,
    unmatched,
)
from omegadot.commands.check.result import Check, subject_of
from omegadot.gates.case import Case, knobs_of
from omegadot.gates.rows import Row, worst
from omegadot.harness.outcome import EngineCase, Outcome
from omegadot.scenarios import Scenario

Stale = list[dict[str, Any]]


def _declared(row: Row, exception: DeclaredException) -> Row:
    if row.verdict != "fail":
        return row
    note = f"{exception.reason} {exception.link}"
    return replace(row, verdict="declared", note=f"{note}; {row.note}" if row.note else note)


def _entry(exception: DeclaredException) -> dict[str, Any]:
    """An exception as the record holds it."""
    return {**vars(exception), "when": {c.key: c.limit for c in exception.when}}


class _Ledger:
    """Exceptions as they are used up: which hold, and which refer to a check that passes."""

    def __init__(self, exceptions: Iterable[DeclaredException]) -> None:
        self.exceptions = list(exceptions)
        self.passing: dict[DeclaredException, list[str]] = {}

    def rows(self, whole: Check, scenario: Scenario, rows: Sequence[Row]) -> list[Row]:
        """The rows of all gates, failures declared where an exception refers to their check."""
        found: list[Row] = []
        for gate in dict.fromkeys(row.gate for row in rows):
            own, check = [row for row in rows if row.gate == gate], replace(whole, gate=gate)
            exception = next((e for e in self.exceptions if e.matches(check, scenario)), None)
            if exception is not None:
                holds = worst(row.verdict for row in own) == "pass"
                if holds and not exception.may_pass(check):
                    self.passing.setdefault(exception, []).append(check.id)
                own = [_declared(row, exception) for row in own]
            found += own
        return found

    def engine(self, case: Case, found: EngineCase) -> EngineCase:
        """One engine on one case."""
        whole, runs = Check(found.engine.name, case.name, ""), []
        for run in found.runs:
            check = Check(whole.engine, case.name, "", run.integrator.name, **knobs_of(run.sweep))
            runs.append(replace(run, rows=self.rows(check, case.scenario, run.rows)))
        return replace(found, shared=self.rows(whole, case.scenario, found.shared), runs=runs)


def with_declared(
    outcome: Outcome, exceptions: Sequence[DeclaredException], cases: Sequence[Case]
) -> tuple[Outcome, Stale]:
    """The outcome with declared failures, and the exceptions that no longer hold, with the reason.

    An exception no longer holds where a check of its own passes, or where it matches none.
    """
    if not exceptions:
        return outcome, []
    ledger = _Ledger(exceptions)
    judged = [
        replace(judged, engines=[ledger.engine(judged.case, e) for e in judged.engines])
        for judged in outcome.cases
    ]
    stale = [
        {**_entry(e), "checks": ids, "problem": f"{ids[0]} {no_longer_fails(e)}"}
        for e, ids in ledger.passing.items()
    ]
    for engine in outcome.engines:
        stale += [
            {**_entry(e), "checks": [], "problem": matches_nothing(e)}
            for e in unmatched(exceptions, subject_of(engine), cases)
        ]
    return replace(outcome, cases=judged), stale
