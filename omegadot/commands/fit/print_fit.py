"""A fit, for a person and for machines."""

from __future__ import annotations

import json
import shlex
from pathlib import Path

import numpy as np
import typer
from numpy.typing import NDArray
from rich.table import Table
from rich.text import Text

from omegadot.commands.fit.estimates import SET
from omegadot.commands.fit.picture import beside
from omegadot.commands.fit.result import FitResult
from omegadot.commands.fit.sentences import direction
from omegadot.commands.streams import on_one_line
from omegadot.reference_impl.system import Array
from omegadot.reports.text.text_grid import plain_console
from omegadot.written import written

WIDTH_WHEN_PIPED = 200
UNKNOWN = "not determined"
NONE = "–"


def print_json(result: FitResult) -> None:
    """Everything as numbers, SI units."""
    typer.echo(json.dumps(result.as_dict(), indent=2, allow_nan=False))


def print_text(result: FitResult, out: Path | None) -> None:
    """Moments and axes, the other numbers, the models, the sentences, and how to go on."""
    console = plain_console(WIDTH_WHEN_PIPED)
    samples = result.samples
    console.print(
        Text(
            f"{on_one_line(samples.file)}: {len(samples.times)} samples from "
            f"{written(samples.times[0])} to {written(samples.times[-1])} s, in which the body "
            f"turns by {written(samples.data(np.zeros(3)).turned[-1], 3)} rad"
        )
    )
    if not result.errors_hold:  # before the numbers that it is about
        console.print(Text(result.sentences[0]))
    if result.shape_determined:
        console.print(_moments(result))
        if np.all(result.estimates.moments_known):
            console.print(_tensor(result))
    console.print(_others(result))
    console.print(_models(result))
    for sentence in result.sentences[0 if result.errors_hold else 1 :]:
        console.print(Text(sentence))
    if out is not None:
        for line in _next(result, out):
            console.print(Text(line), soft_wrap=True)


def _grid(*heads: str) -> Table:
    table = Table(box=None, padding=(0, 2, 0, 0), header_style="bold")
    for head in heads:
        table.add_column(head, no_wrap=True)
    return table


def _moments(result: FitResult) -> Table:
    own, hold = result.estimates, result.errors_hold
    unit = result.unit or "of the largest"
    table = _grid("principal moment", unit, "+-", "axis (body)", "+- deg")
    rows = zip(
        own.moments, own.moment_errors, own.moments_known, own.axes.T, own.axis_errors,
        own.axes_known, strict=True,
    )  # fmt: skip
    for letter, (moment, error, sure, axis, turn, fixed) in zip("xyz", rows, strict=True):
        value, sigma = _pair(moment, error)
        shown = (value, sigma if hold else NONE) if sure else (UNKNOWN, "")
        angle = written(np.rad2deg(turn), 2) if hold else NONE
        table.add_row(
            f"near {letter}", *shown, *((direction(axis), angle) if fixed else (UNKNOWN, ""))
        )
    return table


def _tensor(result: FitResult) -> Table:
    own, unit = result.estimates, result.unit or "of the largest"
    table = _grid("inertia tensor", f"x, {unit}", "y", "z")
    for letter, row, errors in zip("xyz", own.inertia, own.inertia_errors, strict=True):
        pairs = zip(row, errors, strict=True)
        cells = (_shown(*pair, result.errors_hold) for pair in pairs)
        table.add_row(letter, *cells)
    return table


def _others(result: FitResult) -> Table:
    own, hold = result.estimates, result.errors_hold
    table = _grid("quantity", "x", "y", "z", "unit")
    _row(table, "omega, first sample", own.omega, own.omega_errors, "rad/s", hold, own.omega_known)
    if not np.all(own.omega_known):
        _row(table, "omega + bias, first sample", own.reading, own.reading_errors, "rad/s", hold)
    if own.orientation is not None:
        q = ", ".join(f"{part:.6f}" for part in own.orientation)
        table.add_row("attitude, first sample", f"w x y z = {q}", "", "", "")
    if "bias" in result.terms:
        _row(table, "gyro bias", own.bias, own.bias_errors, "rad/s", hold, own.bias_known)
    if "damping" in result.terms:
        moment = "the largest moment" if result.compared.chosen.shape else "the moment about omega"
        unit = "N m s/rad" if result.unit else f"1/s, over {moment}"
        table.add_row("damping", _shown(own.damping, own.damping_error, hold), "", "", unit)
    _row(table, "residual, rms", result.rms, None, "rad/s")
    if result.rms_attitude is not None:
        table.add_row("residual of attitude, rms", written(result.rms_attitude, 3), "", "", "rad")
    return table


def _row(
    table: Table,
    name: str,
    values: Array,
    errors: Array | None,
    unit: str,
    hold: bool = True,
    known: NDArray[np.bool_] | None = None,
) -> None:
    if errors is None:
        table.add_row(name, *(written(value, 3) for value in values), unit)
        return
    sure = [True] * len(values) if known is None else known
    rows = zip(values, errors, sure, strict=True)
    cells = (_shown(value, error, hold) if fixed else UNKNOWN for value, error, fixed in rows)
    table.add_row(name, *cells, unit)


def _models(result: FitResult) -> Table:
    table = _grid("model", "moments", "residual, rad/s rms", "")
    for model in result.models:
        shown = ", ".join(f"{moment:.3f}" for moment in model.moments)
        terms = " and ".join(("plain", *model.terms)[bool(model.terms) :])
        table.add_row(terms, shown, written(model.rms, 3), "chosen" if model.chosen else "")
    return table


def _shown(value: float, error: float, hold: bool) -> str:
    """A number with its standard error, where that holds."""
    return " +- ".join(_pair(value, error)[: 2 if hold else 1])


def _pair(value: float, error: float) -> tuple[str, str]:
    """A number to the second digit of its standard error, and that."""
    if error <= SET * abs(value):
        return written(value), "0"
    decimals = 1 - int(np.floor(np.log10(error)))
    if decimals > 12 or decimals < 0 or abs(value) < 1e-3 or abs(value) >= 1e6:
        digits = max(1, int(np.floor(np.log10(max(abs(value), error)))) + decimals + 1)
        return written(value, min(digits, 12)), written(error, 2)
    return f"{value:.{decimals}f}", written(error, 2)


def _next(result: FitResult, out: Path) -> list[str]:
    """Where the file is, and the command that scores the trace by it."""
    samples = result.samples
    line = ["omegadot", "score", samples.file, "--scenario", str(out), *result.options]
    return [f"Scenario: {out}; picture: {beside(out)}", f"Score the trace: {shlex.join(line)}"]
