"""``omegadot check``: one engine through every check, as a table or as JSON."""

from __future__ import annotations

import json
import sys
from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import typer

from omegadot.adapters.registry import registered
from omegadot.commands.check.print_checks import print_checks
from omegadot.commands.check.result import Check, Result
from omegadot.commands.check.select import Arguments, Selection, select, target_of
from omegadot.commands.check.store import store
from omegadot.commands.check.suite import Suite
from omegadot.commands.check.tally import Tally, coverage
from omegadot.harness.arguments import adapters_named
from omegadot.harness.usage import UsageError, nearest

Results = dict[Check, Result]


def arguments_of(adapter: str, integrators: Sequence[str], names: Arguments) -> Arguments:
    """The arguments of the command line, with ADAPTER taken for a name or for a class.

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
    return replace(names, engines=engines, adapters=adapters, required=[name])


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
        "engines": [vars(subject) for subject in suite.registry.subjects],
        "verdicts": counts,
        "only_skipped": skipped,
        "checks": [{"id": c.id, **vars(c), **vars(r)} for c, r in results.items()],
    }


def check_engine(adapter: str, integrators: Sequence[str], names: Arguments, as_json: bool) -> int:
    """Put one engine through every check, print what came of it, and give the exit code."""
    selection = select(arguments_of(adapter, integrators, names))
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
        written = store(selection.baseline, suite.registry.subjects, suite.figures)
    if as_json:
        typer.echo(json.dumps(_json(suite, results, skipped, code), indent=2))
    else:
        lines = coverage(suite.registry.subjects, suite.checks)
        print_checks(lines, results, skipped + [f"Baseline written: {path}" for path in written])
    return code
