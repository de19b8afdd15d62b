"""``omegadot check``: one engine through every check, as a table or as JSON."""

from __future__ import annotations

import json
import sys
from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import typer

from omegadot.adapters.registry import registered
from omegadot.harness.checks.check import Check, Result
from omegadot.harness.checks.print_checks import print_checks
from omegadot.harness.checks.select import Selection, Words, select, target_of
from omegadot.harness.checks.store import store
from omegadot.harness.checks.suite import Suite
from omegadot.harness.checks.tally import Tally, coverage
from omegadot.harness.usage import adapters_named, nearest
from omegadot.harness.usage_error import UsageError

Results = dict[Check, Result]


def words_of(adapter: str, integrators: Sequence[str], words: Words) -> Words:
    """The words of the command line, with ADAPTER taken for a name or for a class.

    Raises UsageError.
    """
    known = registered()
    if adapter in known:
        name, adapters = adapter, []
    elif adapter.endswith(".py") or ":" in adapter:
        left, _, right = adapter.partition(":")
        if left in known:
            raise UsageError(f"{adapter}: give the integrator apart, as --integrator {right}.")
        adapters = [target_of(adapter)]
        name = next(iter(adapters_named(adapters)))
    else:
        raise UsageError(
            f"{adapter}: there is no engine {adapter!r}; {nearest(adapter, known)}, or give "
            "FILE.py:Class or module:Class."
        )
    engines = [f"{name}:{integrator}" for integrator in integrators] or [name]
    return replace(words, engines=engines, adapters=adapters, required=[name])


def _run(suite: Suite) -> Results:
    """Every check's result, with a bar on a terminal."""
    if not sys.stderr.isatty():
        return {check: suite.result_of(check) for check in suite.checks}
    from rich.console import Console
    from rich.progress import track

    console = Console(stderr=True)
    shown = track(suite.checks, "checking", console=console, transient=True)
    return {check: suite.result_of(check) for check in shown}


def exit_code(results: Results, tally: Tally, selection: Selection) -> int:
    """0 every check holds, 1 one fails or all were skipped, 3 an engine did not answer."""
    verdicts = {result.verdict for result in results.values()}
    if "error" in verdicts:
        return 3
    named = [choice.name for choice in selection.choices]
    return 1 if "fail" in verdicts or tally.only_skipped(named) else 0


def _json(suite: Suite, results: Results, skipped: list[str], code: int) -> dict[str, Any]:
    counts = dict.fromkeys(("pass", "fail", "declared", "skip", "error"), 0)
    for result in results.values():
        counts[result.verdict] += 1
    return {
        "schema": 1,
        "exit_code": code,
        "engines": [vars(subject) for subject in suite.roster.subjects],
        "verdicts": counts,
        "only_skipped": skipped,
        "checks": [{"id": c.id, **vars(c), **vars(r)} for c, r in results.items()],
    }


def check_engine(adapter: str, integrators: Sequence[str], words: Words, as_json: bool) -> int:
    """Put one engine through every check, print what came of it, and give the exit code."""
    selection = select(words_of(adapter, integrators, words))
    suite = Suite(selection)
    try:
        results = _run(suite)
    finally:
        suite.finish()
    tally = Tally()
    for check, result in results.items():
        tally.add(check.engine, result.verdict, result.message)
    skipped = tally.only_skipped(choice.name for choice in selection.choices)
    code = exit_code(results, tally, selection)
    written = []
    if selection.update and selection.baseline is not None:
        written = store(selection.baseline, suite.roster.subjects, suite.figures)
    if as_json:
        typer.echo(json.dumps(_json(suite, results, skipped, code), indent=2))
    else:
        lines = coverage(suite.roster.subjects, suite.checks)
        print_checks(lines, results, skipped + [f"Baseline written: {path}" for path in written])
    return code
