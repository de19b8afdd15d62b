"""The arguments of ``omegadot compare``."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from omegadot.commands.options import PageFormat, PageOutput


def compare(
    first: Annotated[
        Path, typer.Argument(metavar="EARLIER", help="The folder of the earlier run.")
    ],
    second: Annotated[Path, typer.Argument(metavar="LATER", help="The folder of the later run.")],
    output: PageOutput = PageFormat.text,
) -> None:
    """Compare two stored runs: what got better, got worse, appeared or vanished.

    Exit codes: 0 nothing got worse, 1 something did, 2 wrong usage or input.
    """
    from omegadot.commands.compare.compare import compare as compare_runs
    from omegadot.reports.record.run_json import dump_json
    from omegadot.reports.two_runs.text import as_json, as_markdown, as_text

    comparison = compare_runs(first, second)
    if output is PageFormat.json:
        typer.echo(dump_json(as_json(comparison)), nl=False)
    elif output is PageFormat.markdown:
        typer.echo(as_markdown(comparison).rstrip("\n"))
    else:
        typer.echo(as_text(comparison))
    raise typer.Exit(1 if comparison.regressed else 0)
