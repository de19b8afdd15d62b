"""What ``omegadot findings`` prints: a line a finding, values for JSON, or the page."""

from __future__ import annotations

from dataclasses import asdict
from typing import Any

import typer

from omegadot.commands.findings.findings import FindingsResult
from omegadot.commands.findings.page import figure, markdown_of, record_command
from omegadot.commands.findings.verdict import Finding


def print_findings(found: FindingsResult, form: str) -> None:
    """As "text", "json" or "markdown"."""
    if form == "json":
        from omegadot.reports.record.run_json import dump_json

        typer.echo(dump_json([_plain(one) for one in found.findings]), nl=False)
    elif form == "markdown":
        typer.echo(markdown_of(found), nl=False)
    else:
        for one in found.findings:
            entry = one.entry
            state = figure(one) if one.stands else f"not reproduced: {one.doubt}"
            typer.echo(
                f"{entry.name}: {entry.engine} {one.measured.release}, {entry.title}: {state}"
            )
        typer.echo(f"{len(found.standing)} of {len(found.findings)} findings stand.")


def _plain(one: Finding) -> dict[str, Any]:
    entry = {**asdict(one.entry), "script": one.entry.script.as_posix()}
    state = {"name": one.entry.name, "stands": one.stands, "doubt": one.doubt}
    return {**state, **entry, **asdict(one.measured), "command": record_command(one)}
