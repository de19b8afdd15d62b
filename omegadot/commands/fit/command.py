"""The arguments of ``omegadot fit``."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from omegadot.commands.options import Format, Output, Text, Texts, option


def fit(
    trace: Annotated[Path, typer.Argument(metavar="TRACE", help="A CSV or Parquet file.")],
    column: Annotated[
        Texts,
        option(
            "ROLE=NAME",
            "The column that holds a quantity, such as wx=gyro_x, or a group: w=A,B,C; "
            "repeatable. omegadot score --help lists the quantities.",
        ),
    ] = None,
    map_file: Annotated[Path | None, option("FILE", "Columns and units in TOML.", "--map")] = None,
    time_unit: Annotated[Text, option("UNIT", "Unit of time: s, ms, us, ns, min or h.")] = None,
    angle_unit: Annotated[Text, option("UNIT", "Unit of angles: rad, deg, mrad, rev, ...")] = None,
    rate_unit: Annotated[Text, option("UNIT", "Unit of omega: rad/s, deg/s, rpm, ...")] = None,
    omega_frame: Annotated[Text, option("FRAME", "Frame of omega: body or world.")] = None,
    attitude_is: Annotated[
        Text, option("SENSE", "Sense of the attitude: world-from-body or body-from-world.")
    ] = None,
    euler: Annotated[
        Text, option("ZYX", "Sequence of Euler angles: ZYX intrinsic, zyx extrinsic.")
    ] = None,
    quaternion: Annotated[Text, option("ORDER", "Order of the columns of q: wxyz or xyzw.")] = None,
    world_axes: Annotated[
        Text, option("x,-y,-z", "The world axes x, y, z of the result, each as one of the trace.")
    ] = None,
    body_axes: Annotated[
        Text, option("x,-y,-z", "The body axes x, y, z of the result, each as one of the trace.")
    ] = None,
    rate: Annotated[
        float | None, option("HZ", "Sample rate of a trace without times, the first at zero.")
    ] = None,
    from_time: Annotated[Text, option("T", "Fit from this time of the trace on.", "--from")] = None,
    to_time: Annotated[Text, option("T", "Fit up to this time of the trace.", "--to")] = None,
    torque: Annotated[
        Text, option("X,Y,Z", "A known torque, N m, constant in the body's axes.")
    ] = None,
    moment: Annotated[
        Text,
        option(
            "WHICH=VALUE",
            "A known moment of inertia, kg m^2: smallest, middle or largest, or about x, y or z.",
        ),
    ] = None,
    mass: Annotated[float | None, option("KG", "The mass, for the scenario. Default: 1.")] = None,
    bias: Annotated[
        bool | None,
        typer.Option("--bias/--no-bias", help="Fit a constant gyro bias. Default: if supported."),
    ] = None,
    damping: Annotated[
        bool | None,
        typer.Option("--damping/--no-damping", help="Fit viscous damping. Default: if supported."),
    ] = None,
    name: Annotated[Text, option("NAME", "Name of the scenario. Default: the trace's.")] = None,
    out: Annotated[
        Path | None,
        option("FILE.toml", "Write the scenario to this file, and a picture next to it."),
    ] = None,
    output: Output = Format.text,
) -> None:
    """Fit moments of inertia, principal axes, bias and damping to a trace of omega.

    Exit codes: 0 fitted, also where the data leave something open, which is then printed, 2 wrong
    usage or input, 3 the system failed, as on a full disk.
    """
    given = {**locals()}
    del given["column"], given["output"]
    from omegadot.commands.fit.fit import fit as fit_trace
    from omegadot.commands.fit.print_fit import print_json, print_text

    result = fit_trace(**given, columns=column or [])
    if output is Format.json:
        print_json(result)
    else:
        print_text(result, out)
