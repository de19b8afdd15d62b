"""What ``omegadot versions`` prints, and how it exits."""

from __future__ import annotations

import json

import typer

from omegadot.commands.versions.result import VersionsResult
from omegadot.reports.versions.sheet import sheet_of
from omegadot.reports.versions.text import markdown_of, print_sheet


def exit_code(found: VersionsResult) -> int:
    """0 done, 1 something is not as declared or nothing was found, 3 nothing to compare."""
    if not found.comparable:
        return 3
    return 0 if found.passed else 1


def print_versions(found: VersionsResult, form: str) -> None:
    """As "text", "json" or "markdown"."""
    if form == "json":
        typer.echo(json.dumps(found.record, indent=2))
    elif form == "markdown":
        typer.echo(markdown_of(sheet_of(found.record)), nl=False)
    else:
        print_sheet(sheet_of(found.record))
