"""The arguments of ``omegadot scenarios``."""

from __future__ import annotations

from typing import Annotated

import typer

from omegadot.commands.options import Format


def scenarios(
    output: Annotated[Format, typer.Option("--format", help="Output format.")] = Format.text,
) -> None:
    """List the built-in scenarios and what each shows."""
    from omegadot.commands.scenarios.scenarios import print_scenarios

    print_scenarios(as_json=output is Format.json)
