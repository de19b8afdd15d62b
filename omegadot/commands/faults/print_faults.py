"""What ``omegadot faults`` prints: a table for the terminal, the page, and values for JSON."""

from __future__ import annotations

import json
import sys
from collections.abc import Sequence
from typing import Any

import typer
from rich.console import Console
from rich.table import Table

from omegadot.commands.faults.detect import GATES
from omegadot.commands.faults.faults import FaultsResult
from omegadot.commands.faults.matrix import Detection, EngineMatrix
from omegadot.commands.faults.published_checks import PUBLISHED

HEADS = ("fault", *GATES, "any gate", "cause named", "no scheme", *(c.name for c in PUBLISHED))
WIDTH_WHEN_PIPED = 200


def print_faults(found: FaultsResult, form: str) -> None:
    """As "text", "json" or "markdown"."""
    if form == "json":
        typer.echo(json.dumps(plain(found), indent=2))
    elif form == "markdown":
        typer.echo(markdown(found), nl=False)
    else:
        _print_text(found.matrices)


def _print_text(matrices: Sequence[EngineMatrix]) -> None:
    console = Console(width=None if sys.stdout.isatty() else WIDTH_WHEN_PIPED, highlight=False)
    for matrix in matrices:
        title = f"Per cent of the bodies on which each fault over {matrix.engine} is caught"
        table = Table(title=title, title_justify="left", title_style="bold", box=None)
        for number, head in enumerate(HEADS):
            table.add_column(head, justify="right" if number else "left", overflow="fold")
        for row in matrix.rows:
            table.add_row(*line_of(row))
        console.print(table)
        for line in summary_of(matrix):
            console.print(line, markup=False)
        console.print()


def share(value: float | None) -> str:
    """A share in per cent; a dash where there is none to report."""
    return "–" if value is None else f"{100 * value:.0f}"


def line_of(row: Detection) -> tuple[str, ...]:
    """One fault's line."""
    shares = (*row.gates.values(), row.any, row.named, row.no_scheme, *row.published.values())
    return (row.fault.name, *map(share, shares))


def summary_of(matrix: EngineMatrix) -> list[str]:
    """The table in sentences, one a line."""
    rows = matrix.rows
    unseen = [row.fault.name for row in rows if row.judged and row.no_scheme < 1.0]
    named = sum(row.judged > 0 and row.named == 1.0 for row in rows)
    integrators = " and ".join(matrix.integrators)
    lines = [
        f"{matrix.engine} {matrix.version}, {integrators}: {len(rows)} faults, of which "
        f"{_caught(matrix, matrix.missed)}",
        f"The cause was named on every body for {named} of them.",
        f"Without a declared scheme, {_caught(matrix, unseen)}",
        f"Without a fault, {matrix.accused} of {matrix.sound} bodies were accused, and without a "
        f"declared scheme {matrix.accused_nameless}.",
    ]
    more = {
        "Not tried, since no integrator is suitable": matrix.skipped,
        "On some bodies the engine gave no answer": [r.fault.name for r in rows if r.broken],
        "Accused without a fault by": matrix.published_accuse,
    }
    return lines + [f"{what}: {', '.join(names)}." for what, names in more.items() if names]


def _caught(matrix: EngineMatrix, missed: list[str]) -> str:
    more = f"; not always: {', '.join(missed)}." if missed else "."
    return f"{len(matrix.rows) - len(missed)} were caught on every body{more}"


def plain(found: FaultsResult) -> dict[str, Any]:
    """Everything, for machines."""
    checks = [{"name": c.name, "bound": c.bound, "source": c.source} for c in PUBLISHED]
    engines = []
    for matrix in found.matrices:
        kept = {k: v for k, v in vars(matrix).items() if k != "rows"}
        engines.append({**kept, "faults": [_plain_row(row) for row in matrix.rows]})
    drawn = {"bodies": found.bodies, "seed": found.seed}
    return {**drawn, "published": checks, "engines": engines}


def _plain_row(row: Detection) -> dict[str, Any]:
    fault = row.fault
    columns = {k: v for k, v in vars(row).items() if k != "fault"}
    return {
        "name": fault.name,
        "sentence": fault.sentence,
        "kind": fault.kind,
        "needs": sorted(fault.needs),
        "expected": list(fault.gates),
        **columns,
    }


HEAD = """\
# Wrong engines, and what catches them

<!-- Made by a command. Do not edit; run it again:
{command} > docs/faults.md -->

This page is the output of `{command}`.

**How to read it.** Each fault is injected into a sound engine, and the gates judge the engine on
{bodies} random bodies on which the fault can show. Masses and rates range over two decades, sizes
over one. The tensors are in any axes, the centres of mass at the origin or off it, the bodies free,
driven, damped or pivoted. A number is the percentage of these bodies on which a gate fails. *Any
gate* is the detection rate; runs that need a finer step to be decided do not count. *Cause named*
is the percentage on which `omegadot` names the true cause. *No scheme* is *any gate* for the same
engine with integrators that declare their orders only, so that no run of the reference is compared
with them. A fault that gives another scheme of the same order is no fault then
(`PositionByFirstVelocity` in an engine of order 1). Each engine runs with one integrator of order 1
and, where it has one, one of order 4.

**The published checks** in the last columns are tests that engines ship with. They are applied to
the same faulty engines unchanged: the same body, rates, step, length and bounds, from {bodies}
random attitudes. A dash means that the check's scenarios, or the engine's integrators, lack what
the fault needs, or that the sound engine fails the check itself. The figures of Drake's check are
from its repository (`free_body.h`, in the folder of the test, gives the moments). Its integrator is
of order 3 with error control and starts from one attitude; here an integrator of order 4 takes its
largest step.
"""


def markdown(found: FaultsResult) -> str:
    """The page."""
    named = " ".join(f"--engine {matrix.engine}" for matrix in found.matrices)
    drawn = f"--bodies {found.bodies} --seed {found.seed}"
    command = f"omegadot faults {named} {drawn} --format markdown"
    parts = [HEAD.format(command=command, bodies=found.bodies)]
    parts.append("\n".join(f"- **{c.name}**: {c.bound} (`{c.source}`)." for c in PUBLISHED) + "\n")
    for matrix in found.matrices:
        parts.append(f"## Over {matrix.engine}\n")
        parts.append("\n".join(summary_of(matrix)) + "\n")
        lines = [HEADS, ("---", *("---:",) * (len(HEADS) - 1)), *map(line_of, matrix.rows)]
        parts.append("\n".join(f"| {' | '.join(line)} |" for line in lines) + "\n")
    parts.append("## The faults\n")
    faults = {row.fault.name: row.fault for matrix in found.matrices for row in matrix.rows}
    described = [("fault", "what is wrong", "kind", "needs"), ("---",) * 4]
    for fault in faults.values():
        needs = ", ".join(sorted(fault.needs)) or "nothing"
        described.append((fault.name, fault.sentence, fault.kind, needs))
    parts.append("\n".join(f"| {' | '.join(line)} |" for line in described) + "\n")
    return "\n".join(parts)
