"""``omegadot scenarios``: what is built in."""

from __future__ import annotations

import json

import typer

from omegadot.scenarios import builtin_names, load_builtin


def print_scenarios(as_json: bool) -> None:
    """Name, title, what it shows and the source of every built-in scenario."""
    found = [load_builtin(name) for name in builtin_names()]
    if as_json:
        typer.echo(json.dumps([scenario.to_dict() for scenario in found], indent=2))
        return
    from rich.console import Console
    from rich.markup import escape

    console = Console(highlight=False)
    for scenario in found:
        run = scenario.run
        steps = ", ".join(f"{step:g}" for step in run.timesteps)
        console.print(f"[bold]{scenario.name}[/]  {escape(scenario.title)}")
        console.print(f"  {escape(scenario.shows or '')}")
        console.print(f"  {run.duration:g} s at steps of {steps} s", style="dim")
        if scenario.source:
            console.print(f"  Source: {escape(scenario.source)}", style="dim")
