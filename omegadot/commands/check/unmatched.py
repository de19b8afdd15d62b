"""Exceptions that refer to no check at all, not even of one that a narrowed run leaves out."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from omegadot.commands.check.baseline_file import Baseline
from omegadot.commands.check.compare import baseline_checks
from omegadot.commands.check.exceptions import DeclaredException
from omegadot.commands.check.generate import Subject, checks_of
from omegadot.commands.check.result import Check
from omegadot.gates.case import Case
from omegadot.harness.arguments import case_of
from omegadot.scenarios import builtin_names, load_builtin


def _known(subject: Subject, cases: Sequence[Case], stored: Baseline | None) -> list[Check]:
    """Every check that there may be: all integrators, on these scenarios and all built-in ones."""
    scenarios = [case.scenario for case in cases] + [load_builtin(n) for n in builtin_names()]
    whole = [*cases, *(case_of(scenario, ()) for scenario in scenarios)]
    checks = checks_of([subject.whole], whole)
    return [*checks, *baseline_checks(subject.whole, whole, stored)]


def unmatched(
    exceptions: Iterable[DeclaredException],
    subject: Subject,
    cases: Sequence[Case],
    stored: Baseline | None = None,
) -> list[DeclaredException]:
    """The exceptions of one engine that match nothing."""
    own = [exception for exception in exceptions if exception.engine == subject.name]
    known = _known(subject, cases, stored) if own else []
    return [e for e in own if not any(e.matches(check) for check in known)]
