"""The arguments of ``omegadot versions``."""

from __future__ import annotations

from enum import StrEnum
from pathlib import Path
from typing import Annotated

import typer

from omegadot.commands.options import PageFormat, Setup, on_a_terminal


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
            help="1.2.3, a range 1.2.0..1.4.0 of published releases, or 1.2.3=PYTHON, an "
            "interpreter that has this version.",
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
        typer.Option(metavar="S", help="A time step in s instead of each scenario's middle one."),
    ] = None,
    bisect: Annotated[
        str | None,
        typer.Option(metavar="METRIC", help="Find the release in which METRIC changed."),
    ] = None,
    out: Annotated[
        Path | None, typer.Option(metavar="DIR", help="Write versions.json and versions.html.")
    ] = None,
    output: Annotated[
        PageFormat, typer.Option("--format", help="Output format.")
    ] = PageFormat.text,
    cache: Annotated[
        Path | None, typer.Option(metavar="DIR", help="Folder of the environments.")
    ] = None,
    offline: Annotated[
        bool, typer.Option("--offline", help="Use only environments in the cache.")
    ] = False,
    installer: Annotated[
        With, typer.Option(help="Installer of the environments; auto: uv where it is installed.")
    ] = With.auto,
    setup: Annotated[Setup, typer.Option(help="How engines are configured.")] = Setup.physics,
    adapter: Annotated[
        str | None,
        typer.Option(metavar="FILE.py:CLASS", help="The adapter of your own engine."),
    ] = None,
    package: Annotated[
        str | None,
        typer.Option(
            metavar="NAME", help="With --adapter: the package whose releases are installed."
        ),
    ] = None,
    speed: Annotated[bool, typer.Option(help="Measure the time per step.")] = True,
    timeout: Annotated[
        float,
        typer.Option(metavar="S", min=0.1, help="Time limit in s for one request to an engine."),
    ] = 60.0,
    jobs: Annotated[
        int | None,
        typer.Option(
            metavar="N",
            min=1,
            help="Number of versions measured at the same time. Default: all cores.",
        ),
    ] = None,
) -> None:
    """Find what changed between releases of an engine, each in an environment of its own.

    Exit codes: 0 done, whatever changed, 1 some version is not as its adapter declares, or the
    ends of --bisect do not differ, 2 wrong usage, 3 fewer than two versions could be measured.
    """
    from omegadot.commands.versions.print_versions import exit_code, print_versions
    from omegadot.commands.versions.versions import versions as compare_versions

    found = compare_versions(
        engine,
        releases or [],
        scenarios=scenario or [],
        integrators=integrator or [],
        timestep=timestep,
        bisect=bisect,
        cache=cache,
        offline=offline,
        installer=installer.value,
        setup=setup.value,
        adapter=adapter,
        package=package,
        speed=speed,
        timeout=timeout,
        jobs=jobs,
        out=out,
        progress=on_a_terminal(),
    )
    print_versions(found, output.value)
    raise typer.Exit(exit_code(found))
