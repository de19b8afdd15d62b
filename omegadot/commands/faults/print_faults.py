"""What ``omegadot faults`` prints: a table for the terminal, the page, and values for JSON."""

from __future__ import annotations

import json
from collections.abc import Sequence
from typing import Any

import typer
from rich.table import Table

from omegadot.commands.faults.detect import GATES
from omegadot.commands.faults.detection import POSES, Detection, of_several
from omegadot.commands.faults.faults import FaultsResult
from omegadot.commands.faults.matrix import SOUND, EngineMatrix
from omegadot.commands.faults.published_checks import PUBLISHED
from omegadot.reports.text.text_grid import plain_console
from omegadot.written import written

HEADS = ("fault", "built-in", *GATES, "one system", "24 systems", "no scheme", "cause named")
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
    console = plain_console(WIDTH_WHEN_PIPED)
    for matrix in matrices:
        title = f"Per cent of the random systems on which each fault over {matrix.engine} is caught"
        table = Table(title=title, title_justify="left", title_style="bold", box=None)
        for number, head in enumerate(heads_of(matrix)):
            table.add_column(head, justify="right" if number else "left", overflow="fold")
        for row in matrix.rows:
            table.add_row(*line_of(row))
        console.print(table)
        for line in summary_of(matrix):
            console.print(line, markup=False)
        console.print()


def heads_of(matrix: EngineMatrix) -> tuple[str, ...]:
    """The heads of one engine's table."""
    checks = matrix.rows[0].published if matrix.rows else ()
    return (*HEADS, *checks)


def share(value: float | None) -> str:
    """A share in per cent, never rounded to all or nothing; a dash where there is none."""
    if value is None:
        return "–"
    text = f"{100 * value:.0f}"
    if text == "100" and value < 1.0:
        return ">99" if 100 * value < 99.95 else ">99.9"
    return "<1" if text == "0" and value > 0.0 else text


def line_of(row: Detection) -> tuple[str, ...]:
    """One fault's line."""
    found = (*row.gates.values(), row.any, row.at_default, of_several(row.no_scheme), row.named)
    shares = (*found, *row.published.values())
    return (row.fault.name, "yes" if row.built_in else "no", *map(share, shares))


def summary_of(matrix: EngineMatrix) -> list[str]:
    """The table in sentences, one a line."""
    rows = matrix.rows
    built_in = sum(bool(row.built_in) for row in rows)
    named = [row for row in rows if row.named is not None]
    lines = [
        f"{matrix.engine} {matrix.version}, {' and '.join(matrix.integrators)}: {len(rows)} "
        f"faults, of which {_caught(rows, [row for row in rows if row.caught])}",
        f"On the built-in scenarios alone, {built_in} are caught.",
        f"Without a declared scheme, "
        f"{_caught(rows, [row for row in rows if row.caught_without_scheme])}",
        f"The cause was named on every system diagnosed for "
        f"{sum(row.named == 1.0 for row in named)} of {len(named)}.",
        f"Without a fault, {len(matrix.accused)} of {matrix.sound} systems and scenarios were "
        f"accused, and without a declared scheme {len(matrix.accused_nameless)}.",
        f"This took {matrix.minutes:.0f} min of processor time.",
    ]
    more = {
        "Accused without a fault": (*matrix.accused, *matrix.accused_nameless),
        "Not tried, since no integrator is suitable": matrix.skipped,
        "On some systems the engine gave no answer": [r.fault.name for r in rows if r.broken],
        "Accused without a fault by": matrix.published_accuse,
    }
    return lines + [f"{what}: {', '.join(names)}." for what, names in more.items() if names]


def _caught(rows: Sequence[Detection], caught: Sequence[Detection]) -> str:
    """How many, and the names of the others."""
    missed = [row.fault.name for row in rows if row not in caught]
    share = 100 * len(caught) / max(1, len(rows))
    more = f"; missed: {', '.join(missed)}." if missed else "."
    return f"{len(caught)} are caught ({written(share, 3)} %){more}"


def plain(found: FaultsResult) -> dict[str, Any]:
    """Everything, for machines."""
    checks = [{"name": c.name, "bound": c.bound, "source": c.source} for c in PUBLISHED]
    engines = []
    for matrix in found.matrices:
        kept = {k: v for k, v in vars(matrix).items() if k != "rows"}
        engines.append({**kept, "faults": [_plain_row(row) for row in matrix.rows]})
    drawn = {"random": found.random, "seed": found.seed, "minutes": found.minutes}
    return {**drawn, "published": checks, "engines": engines}


def _plain_row(row: Detection) -> dict[str, Any]:
    fault = row.fault
    columns = {k: v for k, v in vars(row).items() if k != "fault"}
    found = {
        "caught": row.caught,
        "at_24": row.at_default,
        "at_24_no_scheme": of_several(row.no_scheme),
    }
    return {
        "name": fault.name,
        "sentence": fault.sentence,
        "kind": fault.kind,
        "needs": sorted(fault.needs),
        "expected": list(fault.gates),
        **found,
        **columns,
    }


HEAD = """\
# Wrong engines, and what catches them

<!-- Made by a command. Do not edit; run it again:
{command} > docs/faults.md -->

This page is the output of `{command}`.

**How to read it.** Each fault is injected into a sound engine, and the engine is put through
what `omegadot check` puts an engine through: the built-in scenarios, and the first {random} of the
random systems that `check` draws with `--seed {seed}`. A system need not have what a fault needs to
show: most faults show on some systems only.

- *Built-in*: whether a built-in scenario catches the fault. Faults that are stepped by the
  reference's schemes are tried on these over the reference alone: its dynamics are those of every
  sound engine to rounding.
- The five gates: the percentage of the random systems on which this gate is the first to fail,
  alone or with others. An engine is examined in the order model and equation, then one integrator
  after another, and no further than the first failure.
- *One system*: the percentage of the random systems on which any gate fails. It estimates the
  probability p that one random system catches the fault.
- *24 systems*: ``1 - (1 - p)^24`` in per cent, the probability that the 24 random systems of a
  plain `check` catch it. `check` draws its systems so that every pair of features occurs, so that
  it is higher for a fault that needs two rare features.
- *No scheme*: the same for the engine with integrators that declare their orders only, so that no
  run of the reference is compared with them. A fault that gives another scheme of the same order
  is no fault then.
- *Cause named*: whether `omegadot` names the true cause, 100 or 0, on the shortest of the systems
  that catch the fault.

Each engine runs with one integrator of order 1 and, where it has one, one of order 4; `check` runs
all. Without a fault, the gates judge each engine on {sound} random systems and on the built-in
scenarios. A fault is caught if a built-in scenario or one of the {random} systems catches it.

**What a plain check does not see.** A fault that shows only beyond what the systems have in them:
masses of 0.1 g to 1000 t, sizes of 1 mm to 100 km, rates of 0.1 mrad/s to 1000 rad/s, speeds up to
10 km/s and places up to 1000 km, turns of 1.8 rad in a step, some 1000 steps in a run, 200 states
in a batch. A fault in one run of a process alone, such as the fortieth: the first samples of one
run of each integrator are requested three times, and the other runs once; one of these that is
wrong by less than the error of its scheme passes. A fault that rounding hides: in single precision,
a term that is 0.1 % off in the steps alone, where the integrator is of order 1 or 2.

**The published checks** in the last columns of the first table are tests that engines ship with.
They are applied to the same faulty engines unchanged: the same body, rates, step, length and
bounds, from {poses} random attitudes. A dash means that the check's scenarios, or the engine's
integrators, lack what the fault needs, or that the sound engine fails the check itself. The figures
of Drake's check are from its repository (`free_body.h`, in the folder of the test, gives the
moments). Its integrator is of order 3 with error control and starts from one attitude; here an
integrator of order 4 takes its largest step.
"""


def markdown(found: FaultsResult) -> str:
    """The page."""
    named = " ".join(f"--engine {matrix.engine}" for matrix in found.matrices)
    drawn = f"--random {found.random} --seed {found.seed}"
    command = f"omegadot faults {named} {drawn} --format markdown"
    counts = {"random": found.random, "seed": found.seed, "sound": SOUND * found.random}
    parts = [HEAD.format(command=command, poses=POSES, **counts)]
    parts.append("\n".join(f"- **{c.name}**: {c.bound} (`{c.source}`)." for c in PUBLISHED) + "\n")
    for matrix in found.matrices:
        parts.append(f"## Over {matrix.engine}\n")
        parts.append("\n".join(summary_of(matrix)) + "\n")
        heads = heads_of(matrix)
        lines = [heads, ("---", *("---:",) * (len(heads) - 1)), *map(line_of, matrix.rows)]
        parts.append("\n".join(f"| {' | '.join(line)} |" for line in lines) + "\n")
    parts.append("## The faults\n")
    faults = {row.fault.name: row.fault for matrix in found.matrices for row in matrix.rows}
    described = [("fault", "what is wrong", "kind", "needs"), ("---",) * 4]
    for fault in faults.values():
        needs = ", ".join(sorted(fault.needs)) or "nothing"
        described.append((fault.name, fault.sentence, fault.kind, needs))
    parts.append("\n".join(f"| {' | '.join(line)} |" for line in described) + "\n")
    return "\n".join(parts)
