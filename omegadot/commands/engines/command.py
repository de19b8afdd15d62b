"""The arguments of ``omegadot engines``, and what it prints."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Annotated

import typer

from omegadot.commands.options import Adapters, PageFormat, PageOutput, Text, option

if TYPE_CHECKING:
    from omegadot.adapters.protocol import Integrator
    from omegadot.commands.engines.engines import EngineEntry


def engines(
    output: PageOutput = PageFormat.text,
    adapters: Adapters = None,
    install: Annotated[
        Text, option("node", "Install the engines that run through Node, with npm, then list all.")
    ] = None,
) -> None:
    """List the engines: installed or not, versions, integrators, conventions, what is off.

    Exit codes: 0 listed, installed or not, 2 wrong usage or input.
    """
    from omegadot.commands.engines.engines import engines as installed_engines

    entries = installed_engines(adapters or (), install)
    if output is PageFormat.json:
        print_json(entries)
    elif output is PageFormat.markdown:
        from omegadot.commands.engines.page import markdown_of

        typer.echo(markdown_of(entries), nl=False)
    else:
        print_text(entries)


def print_json(entries: Sequence[EngineEntry]) -> None:
    """Everything, for machines."""
    from omegadot.reports.record.run_json import dump_json

    typer.echo(dump_json([_row(entry) for entry in entries]), nl=False)


def _row(entry: EngineEntry) -> dict[str, object]:
    own = entry.description
    head = {"name": entry.name, "installed": entry.installed, "reason": entry.reason}
    if own is None:
        return head
    return {**vars(own), "integrators": [vars(i) for i in own.integrators], **head}


def print_text(entries: Sequence[EngineEntry]) -> None:
    """A paragraph an engine."""
    from rich.console import Console
    from rich.markup import escape

    console = Console(highlight=False, soft_wrap=True)
    for entry in entries:
        own = entry.description
        if own is None:
            console.print(f"[bold]{escape(entry.name)}[/]  not available: {escape(entry.reason)}")
            continue
        head = f"[bold]{escape(entry.name)}[/] {escape(own.version)}"
        console.print(f"{head}  {own.precision}  {escape(own.licence)}")
        for integrator in own.integrators:
            console.print(f"  {escape(_integrator_line(integrator))}")
        clauses_of = {
            "convention": own.conventions,
            "switched off": own.switched_off,
            "reads": own.importers,
        }
        for title, clauses in clauses_of.items():
            for clause in clauses:
                console.print(f"  {title}: {escape(clause)}", style="dim")


def _integrator_line(integrator: Integrator) -> str:
    """Its name, the scheme that it is declared to equal, and its order, once where it is one."""
    from omegadot.commands.engines.page import order_of

    if not integrator.orders:
        return f"{integrator.name}: {integrator.note}"
    same = integrator.scheme in (None, integrator.name)
    order = f"{integrator.name}: order {order_of(integrator)}"
    return order if same else f"{order}, {integrator.scheme}"
