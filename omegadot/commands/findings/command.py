"""The arguments of ``omegadot findings``."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from omegadot.commands import options
from omegadot.commands.options import Texts, option


def findings(
    records: Annotated[
        list[Path] | None,
        typer.Argument(
            metavar="[RECORD]...",
            help="Folders of runs whose figures replace those measured before. Default: none.",
        ),
    ] = None,
    folder: Annotated[
        Path, option("DIR", "Folder of the scripts that declare the findings.")
    ] = Path("docs/findings"),
    names: Annotated[
        Texts, option("NAME", "A finding; repeatable. Default: all.", "--name")
    ] = None,
    reproduce: Annotated[
        bool, typer.Option("--reproduce", help="Run the script of each finding.")
    ] = False,
    timeout: Annotated[float, option("S", "Time limit in s for one script.", min=0.1)] = 300.0,
    output: options.PageOutput = options.PageFormat.text,
) -> None:
    """List where engines diverge: what a record shows, and a bare script shows again.

    Exit codes: 0 every finding stands, 1 one does not, 2 wrong usage or input.
    """
    arguments = options.given(locals())
    from omegadot.commands.findings.findings import findings as find
    from omegadot.commands.findings.print_findings import print_findings

    found = find(**arguments)
    print_findings(found, output.value)
    raise typer.Exit(1 if found.doubted else 0)
