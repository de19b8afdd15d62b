"""The arguments of ``omegadot versions``."""

from __future__ import annotations

import json
import sys
from collections.abc import Callable
from enum import StrEnum
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from omegadot.commands import options
from omegadot.commands.options import Setup, Text, Texts, option

if TYPE_CHECKING:
    from omegadot.commands.versions.result import VersionsResult


class With(StrEnum):
    """What environments are made with."""

    auto = "auto"
    uv = "uv"
    pip = "pip"


def versions(
    engine: Annotated[
        str, typer.Argument(metavar="ENGINE", help="mujoco, dart (dartpy) or pinocchio (pin).")
    ],
    releases: Annotated[
        Texts,
        typer.Argument(
            metavar="VERSION...",
            help="1.2.3, a range 1.2.0..1.4.0 of published releases, or 1.2.3=PYTHON, an "
            "interpreter that has this version.",
        ),
    ] = None,
    scenarios: Annotated[
        Texts, option("NAME", "A built-in's name, or a path; repeatable.", "--scenario")
    ] = None,
    integrators: options.Integrators = None,
    timestep: Annotated[
        float | None, option("S", "A time step in s instead of each scenario's middle one.")
    ] = None,
    bisect: Annotated[
        Text,
        option(
            "METRIC",
            "Find the release in which METRIC changed: words of its name, as 'order attitude RK4'. "
            "It begins with convention, default, setup, integrator, scheme, order, drift or "
            "equation.",
        ),
    ] = None,
    out: Annotated[Path | None, option("DIR", "Write versions.json and versions.html.")] = None,
    output: options.PageOutput = options.PageFormat.text,
    cache: Annotated[Path | None, option("DIR", "Folder of the environments.")] = None,
    offline: Annotated[
        bool, typer.Option("--offline", help="Use only environments in the cache.")
    ] = False,
    yes: Annotated[
        bool, typer.Option("--yes", help="Install more than 1 GB without a question.")
    ] = False,
    installer: Annotated[
        With, typer.Option(help="Installer of the environments; auto: uv where it is installed.")
    ] = With.auto,
    setup: Annotated[Setup, typer.Option(help="How engines are configured.")] = Setup.physics,
    via: Annotated[
        Text,
        option(
            "WAY",
            "How bodies go in: api (default), or urdf or mjcf through the engine's own "
            "reader of such files.",
        ),
    ] = None,
    adapter: Annotated[Text, option("FILE.py:CLASS", "The adapter of your own engine.")] = None,
    package: Annotated[
        Text, option("NAME", "With --adapter: the package whose releases are installed.")
    ] = None,
    speed: Annotated[bool, typer.Option(help="Measure the time per step.")] = True,
    timeout: options.Timeout = 60.0,
    jobs: Annotated[
        int | None,
        option("N", "Number of versions measured at the same time. Default: all cores.", min=1),
    ] = None,
) -> None:
    """Find what changed between releases of an engine, each in an environment of its own.

    Exit codes: 0 done, with changes or without, 1 a version is not as its adapter declares or
    failed a query, or the first and the last version have the same METRIC, 2 wrong usage, 3 fewer
    than two versions could be measured.
    """
    arguments = {"releases": [], **options.given(locals())}
    from omegadot.commands.versions.versions import versions as compare_versions

    found = compare_versions(**arguments, ask=_ask_where_somebody_reads())
    print_versions(found, output)
    raise typer.Exit(options.exit_code(found.passed, found.comparable))


def _ask_where_somebody_reads() -> Callable[[str], bool] | None:
    if sys.stdin is None or not sys.stdin.isatty():
        return None
    return lambda question: typer.confirm(question, err=True)


def print_versions(found: VersionsResult, output: options.PageFormat) -> None:
    """Print what was found, as text, JSON or Markdown."""
    from omegadot.reports.versions.sheet import sheet_of
    from omegadot.reports.versions.text import markdown_of, print_sheet

    if output is options.PageFormat.json:
        typer.echo(json.dumps(found.record, indent=2))
    elif output is options.PageFormat.markdown:
        typer.echo(markdown_of(sheet_of(found.record)), nl=False)
    else:
        print_sheet(sheet_of(found.record))
