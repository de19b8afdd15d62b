"""The arguments of ``omegadot scenarios``."""

from __future__ import annotations

from typing import Annotated

import typer

from omegadot.commands.options import Format


def scenarios(
    output: Annotated[Format, typer.Option("--format", help="Output format.")] = Format.text,
) -> None:
    """List the built-in scenarios and what each shows."""
    from omegadot.commands.scenarios.print_scenarios import print_json, print_text
    from omegadot.scenarios import builtin_names, load_builtin

    found = [load_builtin(name) for name in builtin_names()]
    if output is Format.json:
        print_json(found)
    else:
        print_text(found)
