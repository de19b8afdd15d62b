"""The checks as a table, scenario by gate, and below it what failed and why; and as JSON."""

from __future__ import annotations

import json
import sys
from collections import Counter, defaultdict
from collections.abc import Mapping

import typer
from rich.console import Console
from rich.table import Table
from rich.text import Text

from omegadot.commands import options
from omegadot.commands.check.check_result import CHECKING, EXPLAINING, CheckResult
from omegadot.commands.check.coverage import coverage
from omegadot.commands.check.explained import explained
from omegadot.commands.check.judge import CAUSE, to_read
from omegadot.commands.check.print_failing import print_failing
from omegadot.commands.check.result import Check, Result, Verdict
from omegadot.commands.streams import on_one_line
from omegadot.reports.text.numbers import first, times

ORDER: tuple[Verdict, ...] = ("error", "fail", "declared", "pass", "skip")
STYLES = {"error": "bold magenta", "fail": "bold red", "declared": "yellow", "skip": "dim"}
NOUNS = {"error": "error", "fail": "failure", "declared": "declared failure"}
WIDTH_WHEN_PIPED = 200
# So many checks of a verdict are listed in full; of more, so many messages of one cause, or of
# those without one, and so many checks that share a message.
FEW, MESSAGES, UNEXPLAINED, ALIKE = 20, 3, 10, 3


def _cell(verdicts: Counter[Verdict]) -> Text:
    """The verdict that all checks share, or how many have each: 2 fail, 11 pass, 3 skip."""
    if not verdicts:
        return Text("-", "dim")
    worst, *others = [verdict for verdict in ORDER if verdicts[verdict]]
    sentence = _counted(verdicts) if others else worst
    return Text(sentence, STYLES.get(worst, "green"))


def _counted(verdicts: Counter[Verdict]) -> str:
    return ", ".join(f"{verdicts[verdict]} {verdict}" for verdict in ORDER if verdicts[verdict])


def _table(found: CheckResult) -> Table:
    """A row for a scenario, and one for all random systems that were not named."""
    together = f"{len(found.drawn)} random systems"
    results = {c: result for c, result in found.by_check.items() if c.scenario}
    names = {c.scenario: together if c.scenario in found.drawn else c.scenario for c in results}
    scenarios = list(dict.fromkeys(names.values()))
    gates = list(dict.fromkeys(check.gate for check in results))
    cells: dict[tuple[str, str], Counter[Verdict]] = defaultdict(Counter)
    for check, result in results.items():
        cells[names[check.scenario], check.gate][result.verdict] += 1
    table = Table(box=None, padding=(0, 2, 0, 0), header_style="bold")
    table.add_column("scenario", no_wrap=True)
    for gate in gates:  # which wraps on a narrow terminal: no count is cut off
        table.add_column(gate)
    for scenario in scenarios:
        row = [_cell(cells[scenario, gate]) for gate in gates]
        table.add_row(Text(scenario), *row)
    return table


def _grouped(results: Mapping[Check, Result], verdict: str) -> dict[str, list[Check]]:
    """The checks of one verdict by their message."""
    found: dict[str, list[Check]] = {}
    for check, result in results.items():
        if result.verdict == verdict:
            found.setdefault(result.message, []).append(check)
    return found


def _skipped(results: Mapping[Check, Result]) -> list[str]:
    """The reasons for skips, each with its checks: how many, and on which scenarios.

    A reason may end in figures of its run, which make no reason of their own.
    """
    found: dict[str, list[Check]] = {}
    for reason, checks in _grouped(results, "skip").items():
        found.setdefault(reason.partition(": observed order")[0], []).extend(checks)
    lines = []
    for reason, checks in found.items():
        names = list(dict.fromkeys(check.scenario for check in checks if check.scenario))
        where = f" (on {first(names, ALIKE)})" if names else ""
        lines.append(f"skip  {times(len(checks), 'check')}: {reason}{where}")
    return lines


def exit_code(found: CheckResult) -> int:
    """0 every check holds, 1 one does not, 3 the engine did not answer, 130 interrupted."""
    if found.interrupted:
        return options.INTERRUPTED
    return options.exit_code(found.passed, found.answered)


def print_json(found: CheckResult) -> None:
    """Every check and its result, for machines."""
    counts = Counter(result.verdict for result in found.by_check.values())
    printed = {
        "schema": 1,
        "exit_code": exit_code(found),
        "complete": not found.interrupted,
        "planned": len(found.planned or found.by_check),
        "engines": [vars(subject) for subject in found.subjects],
        "verdicts": {v: counts[v] for v in ("pass", "fail", "declared", "skip", "error")},
        "only_skipped": found.only_skipped,
        "lost": found.lost,
        "failing": [
            {
                "check": one.check.id,
                "message": one.message,
                "cause": one.cause,
                "has": one.has,
                "at": one.at,
                "scenario": one.toml,
                "command": one.command,
                "trials": one.trials,
                "finished": one.finished,
            }
            for one in found.failing
        ],
        "checks": [{"id": c.id, **vars(c), **vars(r)} for c, r in found.by_check.items()],
    }
    typer.echo(json.dumps(printed, indent=2))


def print_checks(found: CheckResult, verbose: bool = False) -> None:
    """Print the table and what explains the failures, then errors, failures and declared exceptions
    cause by cause, then why some checks are left.

    verbose: every check that fails; else the first few of each cause, where there are many.
    """
    width, results = None if sys.stdout.isatty() else WIDTH_WHEN_PIPED, found.by_check
    console = Console(width=width, highlight=False, soft_wrap=True)
    for line in coverage(found.subjects, found.planned or list(results)):
        console.print(Text(line, "bold"))
    if any(check.scenario for check in results):
        console.print(_table(found))
        if found.failing:  # whose files push the last line off the screen
            console.print(Text(_total(found), "bold"))
    sought = found.interrupted not in (CHECKING, EXPLAINING)
    for line in explained(results, found.failing) if sought else ():
        console.print(Text(line))
    shown: tuple[Verdict, ...] = ("error", "fail", "declared")
    for verdict in shown:
        messages = _grouped(results, verdict)
        whole = verbose or sum(map(len, messages.values())) <= FEW
        for own in _by_cause(messages).values():
            _print_listed(console, verdict, own, whole)
    for line in _skipped(results):
        console.print(Text(line, "dim"))
    for line in (
        *found.only_skipped,
        *found.lost,
        *(f"Baseline written: {on_one_line(path)}" for path in found.baselines),
    ):
        console.print(Text(line))
    causes = {r.message.partition(CAUSE)[2] for r in results.values() if r.verdict == "fail"}
    print_failing(console, found.failing, of_several=len(causes) > 1)
    console.print(Text(_total(found), "bold"))


def _total(found: CheckResult) -> str:
    results = found.by_check
    parts = _counted(Counter(result.verdict for result in results.values()))
    of = f"{len(results)} of " if found.interrupted else ""
    made = f"{of}{times(len(found.planned if of else results), 'check')}"
    total = f"{made}: {parts}." if parts else "There is nothing to check."
    return (
        f"Partial, interrupted: {made}{f': {parts}' * bool(parts)}. {_left(found)}" if of else total
    )


def _left(found: CheckResult) -> str:
    """What an interruption has left out."""
    doing = found.interrupted
    left = ["causes"] if doing in (CHECKING, EXPLAINING) else []
    left += ["the smallest systems that fail"]
    missing = f"{' and '.join(left).capitalize()} were not looked for"
    return f"{missing}." if doing != CHECKING else f"{missing}, nor was any other check made."


def _by_cause(messages: Mapping[str, list[Check]]) -> dict[str, dict[str, list[Check]]]:
    """The checks by their message, and these by the cause that ends it; "" for none."""
    found: dict[str, dict[str, list[Check]]] = {}
    for message, checks in messages.items():
        found.setdefault(message.partition(CAUSE)[2], {})[message] = checks
    return found


def _print_listed(
    console: Console, verdict: Verdict, messages: Mapping[str, list[Check]], whole: bool
) -> None:
    """The checks of one cause: all of them, or a few, the first of each gate before others."""
    cause = next(iter(messages)).partition(CAUSE)[2]
    firsts = {checks[0].gate: message for message, checks in reversed(list(messages.items()))}
    order = sorted(messages, key=lambda message: message not in firsts.values())
    shown = list(messages) if whole else order[: MESSAGES if cause else UNEXPLAINED]
    left = sum(map(len, messages.values()))
    for number, message in enumerate(shown):
        checks = messages[message] if whole else messages[message][:ALIKE]
        for check in checks:
            console.print(Text(f"{verdict.upper()}  {check.id}", STYLES[verdict]))
        once = whole or number == 0  # one cause need not be read three times
        text = to_read(message) if once else message.partition(CAUSE)[0].rstrip()
        console.print(Text(f"    {text}"))
        left -= len(checks)
    if left:
        of = " of this cause" if cause else ""
        more = f"    and {times(left, f'more {NOUNS[verdict]}')}{of}: --verbose lists them."
        console.print(Text(more, "dim"))
