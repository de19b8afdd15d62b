"""``omegadot.fit``: a body and its motion from a trace of omega."""

from __future__ import annotations

import os
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from omegadot.commands.fit import picture
from omegadot.commands.fit.compared import Terms
from omegadot.commands.fit.determined import determined
from omegadot.commands.fit.estimates import Estimates
from omegadot.commands.fit.models import compare_models
from omegadot.commands.fit.other_units import check_fit, samples_in_units
from omegadot.commands.fit.result import FitResult
from omegadot.commands.fit.scale import known_of, torque_of
from omegadot.commands.fit.scenario_file import MARK, scenario_of_fit, text_of
from omegadot.commands.fit.sentences import sentences
from omegadot.commands.score.read_table import read_table
from omegadot.commands.score.settings import GivenColumns, Reading, reading_of, settings_of
from omegadot.commands.typed import typed
from omegadot.harness.usage import UsageError, check_number
from omegadot.reports.record.record import check_no_record
from omegadot.reports.record.whole_file import check_target, path_of, write_whole
from omegadot.scenarios import scenario
from omegadot.written import written


@typed
def fit(
    trace: str | os.PathLike[str],
    *,
    columns: GivenColumns = (),
    map_file: str | os.PathLike[str] | None = None,
    time_unit: str | None = None,
    angle_unit: str | None = None,
    rate_unit: str | None = None,
    omega_frame: str | None = None,
    attitude_is: str | None = None,
    euler: str | None = None,
    quaternion: str | None = None,
    world_axes: str | None = None,
    body_axes: str | None = None,
    rate: float | None = None,
    from_time: float | str | None = None,
    to_time: float | str | None = None,
    torque: str | Sequence[float] | None = None,
    moment: str | None = None,
    mass: float | None = None,
    bias: bool | None = None,
    damping: bool | None = None,
    name: str | None = None,
    out: str | os.PathLike[str] | None = None,
) -> FitResult:
    """Fit a free rigid body's motion to a trace of omega, or of omega and attitude.

    trace: a CSV or Parquet file.  columns, map_file, and the settings from time_unit to to_time:
    how it is to be read, and what part of it, as of `score`.
    torque: N m, constant in the body's axes.  moment: one that is known, ``"largest=0.0123"`` in
    kg m^2, where there is no torque.  mass: kg, for the scenario.  bias, damping: True to fit it,
    False not to, None where the data decide.  name, out: of the scenario, and its file; beside that
    a picture of the same name, ``.svg``.
    Raises UsageError, TraceError (a UsageError), ScenarioError for the name and RecordError for the
    file.
    """
    given: dict[str, Any] = locals()
    settings = {option: given[key] for key, option in SETTINGS.items()}
    load, known, terms = torque_of(torque), known_of(moment), Terms(bias, damping)
    if known is not None and np.any(load):
        raise UsageError("--moment: the scale is given by --torque already; give one of the two.")
    if mass is not None:
        check_number("--mass", mass, 0.0)
    if name is not None:
        scenario("sphere", name=name)  # refuses what is no name, before the work
    target = None if out is None else _target(path_of(out))
    mapped = path_of(map_file) if map_file else None
    reading = reading_of(read_table(path_of(trace)), columns, mapped, settings)
    samples = samples_in_units(reading, load, terms)
    digits = (samples.digits[0] / samples.size, samples.digits[1])
    compared = compare_models(samples.data(load), digits, terms)
    check_fit(compared.noise, reading, load, terms)
    known_by = determined(samples, compared, known, load)
    own, scale = known_by.own, known_by.scale
    found_out = sentences(known_by, own, terms)
    found = scenario_of_fit(samples, own, load, mass or 1.0, name)
    result = FitResult(
        samples,
        own,
        scale,
        compared,
        found_out,
        found,
        [*_options(columns, mapped, settings, reading), *_bias(own, reading)],
    )
    if target is not None:
        write_whole(target, text_of(found, found_out), MARK)
        write_whole(picture.beside(target), picture.picture(result), picture.MARK)
    return result


def _target(out: Path) -> Path:
    """The scenario's file. Raises UsageError for another ending, RecordError where it is taken."""
    if out.suffix != ".toml":  # nothing else is read as a scenario
        raise UsageError(f"--out {out}: a scenario's file ends in .toml; give {_with_toml(out)}.")
    check_no_record(out.parent, out.name)
    check_target(out, MARK)
    check_target(picture.beside(out), picture.MARK)
    return out


def _with_toml(out: Path) -> str:
    return f"{out}.toml" if out.name.strip(".") else "one such as fitted.toml"


def _options(
    columns: GivenColumns, map_file: Path | None, settings: dict[str, Any], reading: Reading
) -> list[str]:
    """What `score` needs to read the trace as it was read here, and to begin where it begins."""
    own, given = settings_of(columns, map_file, settings)
    given |= {"time-offset": reading.stamps.text(0)}
    found = [text for role, names in own for text in ("--column", f"{role}={','.join(names)}")]
    for key, value in given.items():
        if key != "time-offset" or value != "0":
            found += [f"--{key}", repr(value) if isinstance(value, float) else str(value)]
    return found


def _bias(own: Estimates, reading: Reading) -> list[str]:
    """The option by which `score` subtracts a bias, in the unit and the axes of the trace."""
    how = reading.how
    if not np.any(own.bias) or how.omega_frame == "world":
        return []
    inner = own.bias @ how.body_axes / how.scale_of("rate")
    return ["--omega-bias=" + ",".join(written(part) for part in inner)]


_READING = (
    *("time_unit", "angle_unit", "rate_unit", "omega_frame", "attitude_is", "euler", "quaternion"),
    *("world_axes", "body_axes", "rate"),
)
SETTINGS = {key: key.replace("_", "-") for key in _READING} | {"from_time": "from", "to_time": "to"}
"""Those of `score` that matter to a fit, by their options."""
