"""The arguments of ``omegadot choose``."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from omegadot.commands.options import Format, command_line, on_a_terminal


def choose(
    scenarios: Annotated[
        list[str] | None, typer.Argument(metavar="[SCENARIO]...", help="Built-in names or paths.")
    ] = None,
    scenario: Annotated[
        list[str] | None,
        typer.Option(metavar="NAME", help="A built-in name or a path; repeatable."),
    ] = None,
    body: Annotated[
        str | None,
        typer.Option(
            metavar="FILE#LINK",
            help="A body: a link of a URDF, MJCF or SDF file, or a TOML file. "
            "Without a scenario also give --angular-velocity and --duration.",
        ),
    ] = None,
    allow_impossible_inertia: Annotated[
        bool,
        typer.Option(
            "--allow-impossible-inertia",
            help="Accept an inertia with one principal moment above the sum of the other two.",
        ),
    ] = False,
    angular_velocity: Annotated[
        tuple[float, float, float] | None,
        typer.Option(metavar="X Y Z", help="Initial angular velocity, rad/s, body axes."),
    ] = None,
    orientation: Annotated[
        tuple[float, float, float, float] | None,
        typer.Option(
            metavar="W X Y Z", help="Initial orientation, a unit quaternion, world from body."
        ),
    ] = None,
    duration: Annotated[
        str | None,
        typer.Option(
            metavar="T", help="Simulated time, such as 60 or 1min. Default: the scenario's."
        ),
    ] = None,
    requirements: Annotated[
        Path | None,
        typer.Option(metavar="FILE", help="Requirements in TOML; options given here override it."),
    ] = None,
    attitude: Annotated[
        str | None,
        typer.Option(metavar="ANGLE", help="Largest attitude error, such as 0.1deg."),
    ] = None,
    omega: Annotated[
        str | None,
        typer.Option(metavar="RATE", help="Largest error of omega, such as 0.01rad/s."),
    ] = None,
    energy_drift: Annotated[
        str | None,
        typer.Option(metavar="RATIO", help="Largest relative drift of energy, such as 1e-6."),
    ] = None,
    momentum_drift: Annotated[
        str | None,
        typer.Option(metavar="RATIO", help="Largest relative drift of angular momentum."),
    ] = None,
    linear_momentum_drift: Annotated[
        str | None, typer.Option(metavar="RATIO", help="Largest relative drift of linear momentum.")
    ] = None,
    flip_time: Annotated[
        str | None,
        typer.Option(metavar="TIME", help="Largest error of a flip's time, such as 1ms."),
    ] = None,
    real_time_factor: Annotated[
        str | None,
        typer.Option(metavar="X", help="Smallest ratio of simulated to elapsed time."),
    ] = None,
    precision: Annotated[
        str | None, typer.Option(metavar="P", help="Floating-point precision: double or single.")
    ] = None,
    feature: Annotated[
        list[str] | None,
        typer.Option(
            metavar="NAME",
            help="A required feature: pivot, batch, inverse-dynamics; repeatable.",
        ),
    ] = None,
    licence: Annotated[
        list[str] | None,
        typer.Option(metavar="SPDX", help="An allowed licence by its SPDX name; repeatable."),
    ] = None,
    python: Annotated[
        str | None,
        typer.Option(metavar="3.N", help="Python version that the package must support."),
    ] = None,
    engine: Annotated[
        list[str] | None,
        typer.Option(metavar="NAME[:INTEGRATOR]", help="Consider only these engines; repeatable."),
    ] = None,
    adapter: Annotated[
        list[str] | None,
        typer.Option(metavar="FILE.py:CLASS", help="An engine of your own; repeatable."),
    ] = None,
    budget: Annotated[
        float,
        typer.Option(metavar="S", min=0.01, help="Time limit in s for one run of the search."),
    ] = 2.0,
    timeout: Annotated[
        float,
        typer.Option(metavar="S", min=0.1, help="Time limit in s for one request to an engine."),
    ] = 60.0,
    jobs: Annotated[
        int | None,
        typer.Option(
            metavar="N",
            min=1,
            help="Number of engines that run at the same time. Default: all cores.",
        ),
    ] = None,
    out: Annotated[
        Path | None,
        typer.Option(
            metavar="DIR",
            help="Folder for the choice; in a run's folder it becomes part of its report.",
        ),
    ] = None,
    output: Annotated[Format, typer.Option("--format", help="Output format.")] = Format.text,
) -> None:
    """Find the engines, integrators and largest steps that meet requirements, cheapest first.

    Exit codes: 0 something qualifies, 1 nothing does, 2 wrong usage or input, 3 an engine crashed,
    timed out or could not be started.
    """
    from omegadot.commands.choose.choose import choose as choose_engine
    from omegadot.commands.choose.choose import exit_code
    from omegadot.reports.choice.tables import print_choice
    from omegadot.reports.record.run_json import dump_json
    from omegadot.reports.text.numbers import listed

    found = choose_engine(
        [*(scenarios or []), *(scenario or [])],
        engine or [],
        body=body,
        allow_impossible_inertia=allow_impossible_inertia,
        angular_velocity=angular_velocity,
        orientation=orientation,
        duration=duration,
        requirements=requirements,
        attitude=attitude,
        omega=omega,
        energy_drift=energy_drift,
        momentum_drift=momentum_drift,
        linear_momentum_drift=linear_momentum_drift,
        flip_time=flip_time,
        real_time_factor=real_time_factor,
        precision=precision,
        features=feature or [],
        licences=licence or [],
        python=python,
        adapters=adapter or [],
        budget=budget,
        timeout=timeout,
        jobs=jobs,
        out=out,
        command=command_line(),
        progress=on_a_terminal(),
    )
    if output is Format.json:
        typer.echo(dump_json(found.document), nl=False)
    else:
        print_choice(found.document)
        if found.written:
            typer.echo(f"Written to {listed([str(path) for path in found.written])}.")
    raise typer.Exit(exit_code(found))
