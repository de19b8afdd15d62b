"""The arguments of ``omegadot engines``."""

from __future__ import annotations

from typing import Annotated

import typer

from omegadot.commands.options import Format


def engines(
    output: Annotated[Format, typer.Option("--format", help="Output format.")] = Format.text,
    adapter: Annotated[
        list[str] | None,
        typer.Option(metavar="FILE.py:CLASS", help="An engine of your own; repeatable."),
    ] = None,
) -> None:
    """List the engines: installed or not, versions, integrators, conventions, what is off."""
    from omegadot.commands.engines.engines import engines as installed_engines
    from omegadot.commands.engines.print_engines import print_json, print_text

    entries = installed_engines(adapter or [])
    if output is Format.json:
        print_json(entries)
    else:
        print_text(entries)
