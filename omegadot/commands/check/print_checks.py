"""The checks as a table, scenario by gate, and below it what failed and why; and as JSON."""

from __future__ import annotations

import json
import sys
from collections import Counter, defaultdict
from collections.abc import Mapping, Sequence

import typer
from rich.console import Console
from rich.table import Table
from rich.text import Text

from omegadot.commands.check.check import CheckResult
from omegadot.commands.check.failing_state import state_text
from omegadot.commands.check.judge import CAUSE
from omegadot.commands.check.result import Check, Result, Verdict, coverage
from omegadot.commands.check.shrink import Failing
from omegadot.commands.options import exit_code
from omegadot.commands.streams import on_one_line
from omegadot.reports.text.numbers import listed, times

ORDER: tuple[Verdict, ...] = ("error", "fail", "declared", "pass", "skip")
STYLES = {"error": "bold magenta", "fail": "bold red", "declared": "yellow", "skip": "dim"}
NOUNS = {"error": "error", "fail": "failure", "declared": "declared failure"}
WIDTH_WHEN_PIPED = 200
MOST_CAUSES = 8
# So many checks of a verdict are listed in full; of more, so many messages of one cause, or of
# those without one, and so many checks that share a message.
FEW, MESSAGES, UNEXPLAINED, ALIKE = 20, 3, 10, 3


def _cell(verdicts: Counter[Verdict]) -> Text:
    """The worst verdict, with how many checks share it where there are several kinds."""
    if not verdicts:
        return Text("-", "dim")
    worst = next(verdict for verdict in ORDER if verdicts[verdict])
    total = sum(verdicts.values())
    sentence = worst if verdicts[worst] == total else f"{worst} {verdicts[worst]}/{total}"
    return Text(sentence, STYLES.get(worst, "green"))


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
    for name in ("scenario", *gates):
        table.add_column(name, no_wrap=True)
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


def _causes(failures: Mapping[str, Sequence[Check]]) -> list[str]:
    """How many failures each cause explains, and in which integrators; none where all are alike.

    failures: the checks by their message.
    """
    if len(failures) < 2:
        return []
    explained: dict[str, list[Check]] = {}
    for message, checks in failures.items():
        cause = message.partition(CAUSE)[2].rstrip(".") or "no cause found"
        explained.setdefault(cause, []).extend(checks)
    ranked = sorted(explained.items(), key=lambda item: -len(item[1]))
    lines = [f"What explains the {sum(map(len, explained.values()))} failures:"]
    for cause, checks in ranked[:MOST_CAUSES]:
        names = listed(sorted({check.integrator or check.gate for check in checks}))
        lines.append(f"    {len(checks):4d}  {cause} ({names})")
    rest = [checks for _, checks in ranked[MOST_CAUSES:]]
    return lines + [f"    {sum(map(len, rest)):4d}  others, named below"] * bool(rest)


def print_json(found: CheckResult) -> None:
    """Every check and its result, for machines."""
    counts = Counter(result.verdict for result in found.by_check.values())
    printed = {
        "schema": 1,
        "exit_code": exit_code(found.passed, found.answered),
        "engines": [vars(subject) for subject in found.subjects],
        "verdicts": {v: counts[v] for v in ("pass", "fail", "declared", "skip", "error")},
        "only_skipped": found.only_skipped,
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
    for line in coverage(found.subjects, list(results)):
        console.print(Text(line, "bold"))
    if any(check.scenario for check in results):
        console.print(_table(found))
    for line in _causes(_grouped(results, "fail")):
        console.print(Text(line))
    shown: tuple[Verdict, ...] = ("error", "fail", "declared")
    for verdict in shown:
        messages = _grouped(results, verdict)
        whole = verbose or sum(map(len, messages.values())) <= FEW
        for own in _by_cause(messages).values():
            _print_listed(console, verdict, own, whole)
    for reason, checks in _grouped(results, "skip").items():
        console.print(Text(f"skip  {times(len(checks), 'check')}: {reason}", "dim"))
    for line in (
        *found.only_skipped,
        *(f"Baseline written: {on_one_line(path)}" for path in found.baselines),
    ):
        console.print(Text(line))
    for one in found.failing:
        _print_failing(console, one)
    counts = Counter(result.verdict for result in results.values())
    parts = ", ".join(f"{counts[verdict]} {verdict}" for verdict in ORDER if counts[verdict])
    total = f"{times(len(results), 'check')}: {parts}."
    console.print(Text(total if parts else "There is nothing to check.", "bold"))


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
        console.print(Text(f"    {message if once else message.partition(CAUSE)[0].rstrip()}"))
        left -= len(checks)
    if left:
        of = " of this cause" if cause else ""
        more = f"    and {times(left, f'more {NOUNS[verdict]}')}{of}: --verbose lists them."
        console.print(Text(more, "dim"))


def _print_failing(console: Console, found: Failing) -> None:
    """The simplest failing system as a file, what is left in it, and how to run it alone."""
    left = listed(list(found.has)) if found.has else "a free body on which nothing acts"
    searched = "" if found.finished else f" (the search ended after {found.trials} systems)"
    console.print(Text(f"Smallest failing system of {found.check.id}{searched}:", "bold"))
    console.print(Text(f"    It has {left}. {found.message}"))
    if found.at:
        what = "the equation is wrong" if found.check.gate == "equation" else "a single step fails"
        line = f"Its own motion does not show it: {what} at {state_text(found.at)}."
        console.print(Text(f"    {line}"))
    if found.cause:
        console.print(Text(f"    Likely cause, found on {found.check.scenario}: {found.cause}"))
    console.print(Text(f"    Save as {found.scenario.name}.toml, then: {found.command}"))
    console.print(Text(found.toml))
