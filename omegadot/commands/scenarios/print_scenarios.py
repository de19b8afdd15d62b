"""What ``omegadot scenarios`` prints: name, title, what it shows and the source of each."""

from __future__ import annotations

import json
from collections.abc import Sequence

import typer
from rich.console import Console
from rich.markup import escape

from omegadot.scenarios import Scenario


def print_json(found: Sequence[Scenario]) -> None:
    """Every scenario in full, for machines."""
    typer.echo(json.dumps([scenario.to_dict() for scenario in found], indent=2))


def print_text(found: Sequence[Scenario]) -> None:
    """A paragraph a scenario."""
    console = Console(highlight=False)
    for scenario in found:
        run = scenario.run
        steps = ", ".join(f"{step:g}" for step in run.timesteps)
        console.print(f"[bold]{scenario.name}[/]  {escape(scenario.title)}")
        console.print(f"  {escape(scenario.shows or '')}")
        console.print(f"  {run.duration:g} s at steps of {steps} s", style="dim")
        if scenario.source:
            console.print(f"  Source: {escape(scenario.source)}", style="dim")
