"""The arguments of ``omegadot score``."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, cast

import typer

from omegadot.commands.options import Format, command_line, on_a_terminal

if TYPE_CHECKING:
    from omegadot.commands.score.score import ScoreResult


Text = str | None


def _option(metavar: str, text: str, *names: str) -> Any:
    return typer.Option(*names, metavar=metavar, help=text)


def score(
    context: typer.Context,
    trace: Annotated[Path, typer.Argument(metavar="TRACE", help="A CSV or Parquet file.")],
    scenario: Annotated[
        str, _option("SCENARIO", "The scenario of the motion: a built-in name or a path.")
    ],
    column: Annotated[
        list[str] | None,
        _option(
            "ROLE=NAME",
            "The column that holds a quantity, such as wx=gyro_x, or a group: w=A,B,C. A name "
            "may be a number: #3; with no name, v=, the group is left out. Quantities: t; wx wy wz "
            "(omega); ax ay az (omega-dot); qw qx qy "
            "qz; e1 e2 e3 or yaw pitch roll; r11 to r33; px py pz; vx vy vz. Repeatable.",
        ),
    ] = None,
    map_file: Annotated[Path | None, _option("FILE", "Columns and units in TOML.", "--map")] = None,
    time_unit: Annotated[Text, _option("UNIT", "Unit of time: s, ms, us, ns, min or h.")] = None,
    angle_unit: Annotated[Text, _option("UNIT", "Unit of angles: rad, deg, mrad, rev, ...")] = None,
    rate_unit: Annotated[Text, _option("UNIT", "Unit of omega: rad/s, deg/s, rpm, ...")] = None,
    length_unit: Annotated[
        Text, _option("UNIT", "Unit of lengths: m, ft, in, cm, mm or km.")
    ] = None,
    omega_frame: Annotated[Text, _option("FRAME", "Frame of omega: body or world.")] = None,
    attitude_is: Annotated[
        Text, _option("SENSE", "Sense of the attitude: world-from-body or body-from-world.")
    ] = None,
    euler: Annotated[
        Text, _option("ZYX", "Sequence of Euler angles: ZYX intrinsic, zyx extrinsic.")
    ] = None,
    quaternion: Annotated[
        Text, _option("ORDER", "Order of the columns of q: wxyz or xyzw.")
    ] = None,
    point: Annotated[
        Text, _option("POINT", "Point of the position: center-of-mass or origin.")
    ] = None,
    world_axes: Annotated[
        Text, _option("x,-y,-z", "The scenario's world axes x, y, z, each as an axis of the trace.")
    ] = None,
    body_axes: Annotated[
        Text, _option("x,-y,-z", "The scenario's body axes x, y, z, each as an axis of the trace.")
    ] = None,
    time_offset: Annotated[
        Text, _option("S", "Time in the trace, s or a date, at which the scenario starts.")
    ] = None,
    rate: Annotated[
        float | None, _option("HZ", "Sample rate of a trace without times, the first at zero.")
    ] = None,
    from_time: Annotated[
        Text, _option("S", "First time in the trace, s or a date, that is used.", "--from")
    ] = None,
    to_time: Annotated[
        Text, _option("S", "Last time in the trace, s or a date, that is used.", "--to")
    ] = None,
    world_rate: Annotated[
        Text,
        _option("X,Y,Z", "How fast the trace's world turns, in the unit of omega and its axes."),
    ] = None,
    world_origin: Annotated[
        Text, _option("X,Y,Z", "The scenario's world origin, as a position of the trace.")
    ] = None,
    omega_bias: Annotated[
        Text,
        _option("X,Y,Z", "A constant of the gyro, subtracted from omega, in its unit and axes."),
    ] = None,
    integrator_scheme: Annotated[
        Text, _option("NAME", "Integration scheme that produced the trace.")
    ] = None,
    timestep: Annotated[float | None, _option("S", "Time step that produced the trace, s.")] = None,
    attitude: Annotated[Text, _option("0.1deg", "Required: the largest attitude error.")] = None,
    omega: Annotated[Text, _option("1e-3deg/s", "Required: the largest omega error.")] = None,
    position: Annotated[Text, _option("1mm", "Required: the largest position error.")] = None,
    energy: Annotated[Text, _option("1e-6", "Required: the largest relative energy error.")] = None,
    momentum: Annotated[Text, _option("1e-6", "Required: largest relative momentum error.")] = None,
    flip_time: Annotated[
        Text, _option("1ms", "Required: the largest error of a flip time.")
    ] = None,
    name: Annotated[str, _option("NAME", "Name of the trace in the report.")] = "trace",
    with_engine: Annotated[
        list[str] | None,
        _option(
            "NAME[:INTEGRATOR]", "An engine to run on the same scenario; repeatable.", "--with"
        ),
    ] = None,
    out: Annotated[
        Path,
        _option(
            "DIR",
            "Folder for the record and its report; with --detect, a FILE.toml for what fits, as "
            "--map takes it.",
        ),
    ] = Path("omegadot-score"),
    detect: Annotated[
        bool, typer.Option("--detect", help="Report which conventions fit, and score nothing.")
    ] = False,
    output: Annotated[Format, typer.Option("--format", help="Output format.")] = Format.text,
) -> None:
    """Score a trajectory of any simulator against the exact solution of a scenario.

    Exit codes: 0 nothing fails, 1 a requirement is missed, a declared scheme is not the one that
    produced the trace, or (--detect) no single convention fits, 2 wrong usage or input, 3 an engine
    run with it crashed, timed out or could not be started.
    """
    given = {**locals()}
    for name_apart in ("context", "column", "with_engine", "detect", "output"):
        del given[name_apart]
    if detect:
        _refuse_beside_detect(context)
        file = _file_for_a_map(context, out)
        from omegadot.commands.score.detection.detect import detect as detect_conventions
        from omegadot.commands.score.detection.reading import MARK
        from omegadot.commands.score.print_score import print_detected
        from omegadot.reports.record.whole_file import write_whole

        window = {key: given[key] for key in ("rate", "from_time", "to_time")}
        fits = detect_conventions(
            trace, scenario, columns=column or [], map_file=map_file, **window
        )
        code = print_detected(fits, trace, scenario, as_json=output is Format.json)
        if file is not None and code == 0:
            write_whole(file, fits.fitting[0].map_text(), MARK)
        raise typer.Exit(code)
    from omegadot.commands.run.print_run import exit_code
    from omegadot.commands.run.result import RunInterrupted, unwritten
    from omegadot.commands.score.print_score import print_json, print_text
    from omegadot.commands.score.score import score as score_trace

    try:
        result = score_trace(
            **given,
            columns=column or [],
            engines=with_engine or None,
            command=command_line(),
            progress=on_a_terminal(),
        )
    except RunInterrupted as interrupted:
        result = cast("ScoreResult", interrupted.result)
    except KeyboardInterrupt:
        typer.echo(unwritten(out), err=True)
        raise
    if output is Format.json:
        print_json(result)
    else:
        print_text(result)
    raise typer.Exit(exit_code(result))


# What a search for conventions takes; it finds the rest, and judges nothing.
_OF_DETECT = {"trace", "scenario", "column", "map_file", "rate", "from_time", "to_time"}


def _file_for_a_map(context: typer.Context, out: Path) -> Path | None:
    """The file that is to be written beside --detect, if one is. Raises UsageError, RecordError."""
    from omegadot.commands.score.detection.reading import MARK
    from omegadot.harness.usage import UsageError
    from omegadot.reports.record.record import check_no_record
    from omegadot.reports.record.whole_file import check_target

    if not _typed(context, "out"):
        return None
    if out.suffix != ".toml":
        raise UsageError(f"--out {out}: with --detect it is a map that is written; give FILE.toml.")
    check_no_record(out.parent, out.name)
    check_target(out, MARK)
    return out


def _typed(context: typer.Context, name: str) -> bool:
    source = context.get_parameter_source(name)
    return source is not None and source.name == "COMMANDLINE"


def _refuse_beside_detect(context: typer.Context) -> None:
    """Raise UsageError for an option that would be ignored."""
    from omegadot.harness.usage import UsageError

    for parameter in context.command.params:
        typed = _typed(context, str(parameter.name))
        if typed and parameter.name not in _OF_DETECT | {"detect", "output", "out"}:
            raise UsageError(
                f"{parameter.opts[0]}: --detect finds how the trace is to be read, and takes no "
                "other setting; leave one of the two out."
            )
