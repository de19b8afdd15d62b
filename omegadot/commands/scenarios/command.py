"""The arguments of ``omegadot scenarios``, and what it prints."""

from __future__ import annotations

import json

from omegadot.commands.options import Format, Output
from omegadot.written import written


def scenarios(output: Output = Format.text) -> None:
    """List the built-in scenarios and what each shows.

    Exit codes: 0 listed, 2 wrong usage.
    """
    from rich.console import Console
    from rich.markup import escape

    from omegadot.scenarios import builtin_names, load_builtin

    found = [load_builtin(name) for name in builtin_names()]
    if output is Format.json:
        print(json.dumps([scenario.to_dict() for scenario in found], indent=2))
        return
    console = Console(highlight=False)
    for scenario in found:
        run = scenario.run
        steps = ", ".join(written(step) for step in run.timesteps)
        console.print(f"[bold]{scenario.name}[/]  {escape(scenario.title)}")
        console.print(f"  {escape(scenario.shows or '')}")
        console.print(f"  {written(run.duration)} s at steps of {steps} s", style="dim")
        if scenario.source:
            console.print(f"  Source: {escape(scenario.source)}", style="dim")
