"""The words of ``omegadot versions``."""

from __future__ import annotations

from enum import StrEnum
from pathlib import Path
from typing import Annotated

import typer

from omegadot.commands.options import PageFormat, Setup


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
        list[str] | None,
        typer.Argument(
            metavar="VERSION...",
            help="1.2.3, a range 1.2.0..1.4.0 of the releases that there are, or 1.2.3=PYTHON, "
            "an interpreter that has it already.",
        ),
    ] = None,
    scenario: Annotated[
        list[str] | None,
        typer.Option(metavar="NAME", help="A built-in's name, or a path; repeatable."),
    ] = None,
    integrator: Annotated[
        list[str] | None,
        typer.Option(metavar="NAME", help="An integrator; repeatable. Default: all."),
    ] = None,
    timestep: Annotated[
        float | None,
        typer.Option(metavar="S", help="A step in s, instead of each scenario's middle one."),
    ] = None,
    bisect: Annotated[
        str | None,
        typer.Option(metavar="METRIC", help="Find the release in which it changed."),
    ] = None,
    out: Annotated[
        Path | None, typer.Option(metavar="DIR", help="Write versions.json and versions.html.")
    ] = None,
    output: Annotated[
        PageFormat, typer.Option("--format", help="What to print.")
    ] = PageFormat.text,
    cache: Annotated[
        Path | None, typer.Option(metavar="DIR", help="Where environments are kept.")
    ] = None,
    offline: Annotated[bool, typer.Option("--offline", help="Use the cache alone.")] = False,
    installer: Annotated[
        With, typer.Option(help="What makes environments; auto: uv where there is one.")
    ] = With.auto,
    setup: Annotated[Setup, typer.Option(help="How engines are configured.")] = Setup.physics,
    adapter: Annotated[
        str | None,
        typer.Option(metavar="FILE.py:CLASS", help="The adapter of an engine of your own."),
    ] = None,
    package: Annotated[
        str | None,
        typer.Option(metavar="NAME", help="With --adapter: what its releases are installed from."),
    ] = None,
    speed: Annotated[bool, typer.Option(help="Time the steps too.")] = True,
    timeout: Annotated[
        float, typer.Option(metavar="S", min=0.1, help="Limit for one request to an engine.")
    ] = 60.0,
    jobs: Annotated[
        int | None,
        typer.Option(metavar="N", min=1, help="Versions at the same time. Default: cores."),
    ] = None,
) -> None:
    """Tell what changed between releases of an engine, each in an environment of its own.

    Exit codes: 0 done, whatever changed, 1 some version is not as its adapter declares, or the
    ends of --bisect do not differ, 2 wrong usage, 3 fewer than two versions could be asked.
    """
    import os

    from omegadot.commands.versions.versions import Arguments, compare_versions

    arguments = Arguments(
        engine=engine,
        releases=releases or [],
        scenarios=scenario or [],
        integrators=integrator or [],
        timestep=timestep,
        bisect=bisect,
        cache=cache,
        installer=None if offline else installer.value,
        setup=setup.value,
        adapter=adapter or "",
        package=package or "",
        speed=speed,
        timeout=timeout,
        jobs=jobs or os.cpu_count() or 1,
    )
    raise typer.Exit(compare_versions(arguments, output.value, out))
