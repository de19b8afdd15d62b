"""The words of ``omegadot choose``."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from omegadot.commands.options import Format


def choose(
    scenarios: Annotated[
        list[str] | None, typer.Argument(metavar="[SCENARIO]...", help="Built-in names or paths.")
    ] = None,
    scenario: Annotated[
        list[str] | None, typer.Option(metavar="NAME", help="The same; repeatable.")
    ] = None,
    body: Annotated[
        str | None,
        typer.Option(
            metavar="FILE#LINK", help="Your own body: a link of a URDF, MJCF or SDF, or a TOML."
        ),
    ] = None,
    angular_velocity: Annotated[
        tuple[float, float, float] | None,
        typer.Option(metavar="X Y Z", help="The start, rad/s in body axes."),
    ] = None,
    orientation: Annotated[
        tuple[float, float, float, float] | None,
        typer.Option(metavar="W X Y Z", help="The start, a quaternion."),
    ] = None,
    duration: Annotated[
        str | None,
        typer.Option(metavar="T", help="The horizon: 60, 1min. Default: the scenario's."),
    ] = None,
    requirements: Annotated[
        Path | None,
        typer.Option(metavar="FILE", help="The options below in TOML; those given here win."),
    ] = None,
    attitude: Annotated[
        str | None,
        typer.Option(metavar="ANGLE", help="Greatest error of attitude: 0.1deg."),
    ] = None,
    omega: Annotated[
        str | None,
        typer.Option(metavar="RATE", help="Greatest error of omega: 0.01rad/s."),
    ] = None,
    energy_drift: Annotated[
        str | None, typer.Option(metavar="RATIO", help="Greatest drift of energy: 1e-6.")
    ] = None,
    momentum_drift: Annotated[
        str | None,
        typer.Option(metavar="RATIO", help="Greatest drift of angular momentum."),
    ] = None,
    linear_momentum_drift: Annotated[
        str | None, typer.Option(metavar="RATIO", help="Greatest drift of momentum.")
    ] = None,
    flip_time: Annotated[
        str | None,
        typer.Option(metavar="TIME", help="Greatest error of a flip: 1ms."),
    ] = None,
    real_time_factor: Annotated[
        str | None,
        typer.Option(metavar="X", help="Least simulated over elapsed seconds."),
    ] = None,
    precision: Annotated[
        str | None, typer.Option(metavar="P", help="What it computes in: double or single.")
    ] = None,
    feature: Annotated[
        list[str] | None,
        typer.Option(
            metavar="NAME",
            help="What it must have: pivot, batch, inverse-dynamics; repeatable.",
        ),
    ] = None,
    licence: Annotated[
        list[str] | None,
        typer.Option(metavar="SPDX", help="One that is allowed, by its SPDX name; repeatable."),
    ] = None,
    python: Annotated[
        str | None, typer.Option(metavar="3.N", help="A Python that its package must not refuse.")
    ] = None,
    engine: Annotated[
        list[str] | None,
        typer.Option(metavar="NAME[:INTEGRATOR]", help="Choose among these; repeatable."),
    ] = None,
    adapter: Annotated[
        list[str] | None,
        typer.Option(metavar="FILE.py:CLASS", help="An engine of your own; repeatable."),
    ] = None,
    budget: Annotated[
        float, typer.Option(metavar="S", min=0.01, help="What one run of the search may take.")
    ] = 2.0,
    timeout: Annotated[
        float, typer.Option(metavar="S", min=0.1, help="Limit for one request to an engine.")
    ] = 60.0,
    jobs: Annotated[
        int | None,
        typer.Option(metavar="N", min=1, help="Engines at the same time. Default: cores."),
    ] = None,
    out: Annotated[
        Path | None,
        typer.Option(
            metavar="DIR",
            help="Write the choice there; in the folder of a run, into its report too.",
        ),
    ] = None,
    output: Annotated[Format, typer.Option("--format", help="What to print.")] = Format.text,
) -> None:
    """Find the engines, integrators and largest steps that meet requirements, cheapest first.

    Exit codes: 0 something qualifies, 1 nothing does, 2 wrong usage or input, 3 an engine crashed,
    hung or could not be started.
    """
    from omegadot.commands.choose.choose import Arguments, choose_and_print

    requested = {
        "attitude": attitude,
        "omega": omega,
        "energy-drift": energy_drift,
        "momentum-drift": momentum_drift,
        "linear-momentum-drift": linear_momentum_drift,
        "flip-time": flip_time,
        "real-time-factor": real_time_factor,
        "precision": precision,
        "feature": feature,
        "licence": licence,
        "python": python,
        "duration": duration,
    }
    arguments = Arguments(
        scenarios=[*(scenarios or []), *(scenario or [])],
        body=body,
        angular_velocity=angular_velocity,
        orientation=orientation,
        requirements=requirements,
        requested=requested,
        engines=engine or [],
        adapters=adapter or [],
        budget=budget,
        timeout=timeout,
        jobs=jobs,
    )
    raise typer.Exit(choose_and_print(arguments, out, as_json=output is Format.json))
