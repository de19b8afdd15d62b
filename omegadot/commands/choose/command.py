"""The arguments of ``omegadot choose``."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from omegadot.commands import options
from omegadot.commands.options import Text, Texts, option


def choose(
    scenarios: Annotated[
        Texts, typer.Argument(metavar="[SCENARIO]...", help="Built-in names or paths.")
    ] = None,
    scenario: Annotated[Texts, option("NAME", "A built-in name or a path; repeatable.")] = None,
    body: Annotated[
        Text,
        option(
            "FILE#LINK",
            "A body: FILE#LINK of a URDF, MJCF or SDF file, or FILE for a TOML file. "
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
        option("X Y Z", "Initial angular velocity, rad/s, body axes."),
    ] = None,
    orientation: Annotated[
        tuple[float, float, float, float] | None,
        option("W X Y Z", "Initial orientation, a unit quaternion, world from body."),
    ] = None,
    duration: Annotated[
        Text, option("T", "Simulated time, such as 60 or 1min. Default: the scenario's.")
    ] = None,
    requirements: Annotated[
        Path | None, option("FILE", "Requirements in TOML; options given here override it.")
    ] = None,
    attitude: Annotated[Text, option("ANGLE", "Largest attitude error, such as 0.1deg.")] = None,
    omega: Annotated[Text, option("RATE", "Largest error of omega, such as 0.01rad/s.")] = None,
    energy_drift: Annotated[
        Text, option("RATIO", "Largest relative drift of energy, such as 1e-6.")
    ] = None,
    momentum_drift: Annotated[
        Text, option("RATIO", "Largest relative drift of angular momentum.")
    ] = None,
    linear_momentum_drift: Annotated[
        Text, option("RATIO", "Largest relative drift of linear momentum.")
    ] = None,
    flip_time: Annotated[
        Text, option("TIME", "Largest error of a flip's time, such as 1ms.")
    ] = None,
    real_time_factor: Annotated[
        Text, option("X", "Smallest ratio of simulated to elapsed time.")
    ] = None,
    precision: Annotated[Text, option("P", "Floating-point precision: double or single.")] = None,
    features: Annotated[
        Texts,
        option(
            "NAME", "A required feature: pivot, batch, inverse-dynamics; repeatable.", "--feature"
        ),
    ] = None,
    licences: Annotated[
        Texts, option("SPDX", "An allowed licence by its SPDX name; repeatable.", "--licence")
    ] = None,
    python: Annotated[Text, option("3.N", "Python version that the package must support.")] = None,
    engines: Annotated[
        Texts, option("NAME[:INTEGRATOR]", "Consider only these engines; repeatable.", "--engine")
    ] = None,
    adapters: options.Adapters = None,
    budget: Annotated[
        float,
        option(
            "S",
            "Longest time in s for one trial run; what would take longer is not tried.",
            min=0.01,
        ),
    ] = 2.0,
    timeout: options.Timeout = 60.0,
    jobs: options.Jobs = None,
    out: Annotated[
        Path | None,
        option("DIR", "Folder for the result; with a run's folder, it is added to its report."),
    ] = None,
    output: options.Output = options.Format.text,
) -> None:
    """Find the engines, integrators and largest steps that meet requirements, cheapest first.

    Exit codes: 0 something qualifies, 1 nothing does, 2 wrong usage or input, 3 an engine crashed,
    timed out or could not be started.
    """
    arguments = options.given(locals())
    named = [*arguments.pop("scenarios", []), *arguments.pop("scenario", [])]
    from omegadot.commands.choose.choose import choose as choose_engine
    from omegadot.commands.streams import on_one_line
    from omegadot.reports.choice.tables import print_choice
    from omegadot.reports.record.run_json import dump_json
    from omegadot.reports.text.numbers import listed

    found = choose_engine(named or None, **arguments, command=options.command_line())
    if output is options.Format.json:
        typer.echo(dump_json(found.document), nl=False)
    else:
        print_choice(found.document)
        if found.written:
            typer.echo(f"Written to {listed([on_one_line(path) for path in found.written])}.")
    raise typer.Exit(found.document["exit_code"])
