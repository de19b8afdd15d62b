"""What ``omegadot schemes`` prints; docs/schemes.md is its Markdown."""

from __future__ import annotations

import json

import typer
from rich.text import Text

from omegadot.commands.schemes.schemes import SchemesResult
from omegadot.commands.schemes.table import remarks_of, tables_of
from omegadot.diagnosis.scheme_study.orders import COARSEST
from omegadot.diagnosis.scheme_study.record import Record
from omegadot.gates.errors.observed_order import ORDER_TOLERANCE
from omegadot.reports.text.text_grid import plain_console, text_grid
from omegadot.written import written

WIDTH_WHEN_PIPED = 240
_HEAD = """\
# Which scheme each integrator implements

<!-- Made by a command. Do not edit; run it again:
omegadot schemes --format markdown > docs/schemes.md -->

This page is the output of `omegadot schemes --format markdown > docs/schemes.md`.

**How to read it.** Every scheme of the reference runs from the same start as the engine, on these
systems:

{probes}

A scheme is named where the engine's whole trajectory equals the scheme's within the round-off
bound, in every channel. The engine's declaration is not used. *To 1e-13 over 1000 steps* bounds the
largest distance in attitude (rad) and in angular velocity (relative), over all systems. An
integrator may change its scheme with the system: the first name then holds unless another is given
for a kind. *Stepped in* names the coordinates of a free body that are stepped: position and
velocity of the centre of mass in the world (com-world), those of the body's origin (origin-world),
or the spatial velocity in body axes with the exponential of SE(3) (body-spatial). The errors of a
scheme depend on these coordinates.

An order is given as *declared (observed)*; orders that differ between systems are a range.
The observed order is the slope of log error over log step, against the exact solution. The step is
halved from {coarsest} rad until the slope has settled or the error is round-off. The observed order
must equal the declared one within {tolerance}. A channel that is *conserved* has no error but
round-off. The one-step defect is the error of a single step from an exact state: the root mean
square over several states, the largest over the systems, in rad for the attitude, m for the
position, relative for the others. Its order is one more than that of the accumulated error, or
higher still in a channel whose error comes from others.
"""


def markdown_of(record: Record) -> str:
    """The page; it has no dates and no timings, so the same engines give the same page."""
    probes = "\n".join(f"- *{probe['kind']}*: {probe['shows']}" for probe in record["probes"])
    coarsest, tolerance = written(COARSEST), written(ORDER_TOLERANCE)
    head = _HEAD.format(probes=probes, coarsest=coarsest, tolerance=tolerance)
    parts = [head]
    for table in tables_of(record):
        rows = (table.heads, ("---",) * len(table.heads), *table.rows)
        cells = [[cell.replace("|", "\\|") for cell in row] for row in rows]
        lines = "\n".join(f"| {' | '.join(row)} |" for row in cells)
        parts.append(f"## {table.title}\n\n{lines}\n")
    remarks = remarks_of(record)
    if remarks:
        parts.append("## Remarks\n\n" + "\n".join(f"- {line}" for line in remarks) + "\n")
    return "\n".join(parts)


def print_schemes(found: SchemesResult, form: str) -> None:
    """As "text", "json" or "markdown"."""
    if form == "json":
        typer.echo(json.dumps(found.record, indent=2))
        return
    if form == "markdown":
        typer.echo(markdown_of(found.record), nl=False)
        return
    console = plain_console(WIDTH_WHEN_PIPED)
    for table in tables_of(found.record):
        if table.rows:
            console.print(text_grid(table.title, table.heads, table.rows))
            console.print()
    for line in remarks_of(found.record):
        console.print(Text(line, style="yellow"))
