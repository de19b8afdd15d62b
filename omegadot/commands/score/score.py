"""``omegadot.score``: a trace against the exact solution of a scenario."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

from omegadot.commands.progress import Reporting, reporting
from omegadot.commands.run.result import RunInterrupted, RunResult, result_of
from omegadot.commands.score.convention import SETTINGS
from omegadot.commands.score.judged import ChannelScore, Judged, judge_trace
from omegadot.commands.score.read_table import read_table
from omegadot.commands.score.record import scored_record
from omegadot.commands.score.require import KINDS, requirements_of
from omegadot.commands.score.rows import rows_of
from omegadot.commands.score.sentences import sentences
from omegadot.commands.score.settings import GivenColumns, reading_of
from omegadot.commands.score.shift import Shift
from omegadot.commands.typed import typed
from omegadot.gates.case import Case
from omegadot.gates.rows import Row
from omegadot.harness.arguments import case_of, engine_choices, scenarios_of, several
from omegadot.harness.engine_target import EngineLike
from omegadot.harness.own_engines import known_engines
from omegadot.harness.plan import EngineChoice
from omegadot.harness.usage import UsageError
from omegadot.reports.record.interrupted import written_in
from omegadot.reports.record.record import check_folder
from omegadot.reports.record.whole_file import path_of
from omegadot.reports.run_record import RunRecord
from omegadot.scenarios import ScenarioLike


@dataclass(frozen=True, repr=False, kw_only=True)
class ScoreResult(RunResult):
    """A trace scored, and the record it stands in, with the engines that were run with it.

    name: the trace's, among the engines.  found: everything that was found.  rows: its measures.
    """

    name: str
    found: Judged
    rows: tuple[Row, ...]

    @cached_property
    def channels(self) -> Mapping[str, ChannelScore]:
        """The errors by channel, of those that the trace gives."""
        return {channel: self.found.in_si(channel) for channel in self.found.error}

    @property
    def not_given(self) -> Mapping[str, str]:
        """The channels that the trace does not give, and why."""
        return self.found.absent

    @property
    def shift(self) -> Shift | None:
        """How late or early the trace is, where that can be seen."""
        return self.found.shift

    @property
    def requirements(self) -> tuple[Row, ...]:
        """A row for every requirement: its value, bound and verdict."""
        return tuple(row for row in self.rows if row.metric == "requirement")

    @property
    def sentences(self) -> list[str]:
        """What else was found, one sentence each."""
        return sentences(self.found, list(self.rows))


@typed
def score(
    trace: str | os.PathLike[str],
    scenario: ScenarioLike,
    *,
    columns: GivenColumns = (),
    map_file: str | os.PathLike[str] | None = None,
    time_unit: str | None = None,
    angle_unit: str | None = None,
    rate_unit: str | None = None,
    length_unit: str | None = None,
    omega_frame: str | None = None,
    attitude_is: str | None = None,
    euler: str | None = None,
    quaternion: str | None = None,
    point: str | None = None,
    world_axes: str | None = None,
    body_axes: str | None = None,
    time_offset: float | str | None = None,
    rate: float | None = None,
    from_time: float | str | None = None,
    to_time: float | str | None = None,
    world_rate: str | None = None,
    world_origin: str | None = None,
    omega_bias: str | None = None,
    integrator_scheme: str | None = None,
    timestep: float | None = None,
    attitude: str | None = None,
    omega: str | None = None,
    position: str | None = None,
    energy: str | None = None,
    momentum: str | None = None,
    flip_time: str | None = None,
    name: str = "trace",
    engines: EngineLike | Sequence[EngineLike] | None = None,
    out: str | os.PathLike[str] | None = None,
    command: Sequence[str] = (),
    progress: Reporting = False,
) -> ScoreResult:
    """Score a trajectory of any simulator, or a log, against a scenario's exact solution.

    trace: a CSV or Parquet file.  scenario: what it is a motion of.
    columns, map_file, and the settings from time_unit to omega_bias: how it is to be read,
    as of the command.  integrator_scheme, timestep (s): how it was stepped, where that is known.
    attitude to flip_time: the largest errors allowed, each a text with its unit (``"0.1deg"``).
    name: what the trace is called in the record.  engines: to be run in addition, by name.
    out, command, progress: as of `run`.
    Raises UsageError, TraceError (a UsageError), ScenarioError, RecordError, NoTruthError, and
    RunInterrupted on Ctrl-C.
    """
    given = locals()
    settings = {key: given[field] for key, field in SETTINGS.items()}
    required = {key: given[key.replace("-", "_")] for key in KINDS}
    case, choices = case_given(scenario), _choices(name, several(engines, "engines"))
    if out is not None:
        check_folder(path_of(out))
    earlier = None if out is None else written_in(path_of(out))
    requirements = requirements_of(required)
    mapped = path_of(map_file) if map_file else None
    reading = reading_of(read_table(path_of(trace)), columns, mapped, settings)
    found = judge_trace(case, reading, integrator_scheme, timestep)
    rows = rows_of(found, requirements)
    with reporting(progress) as report:
        record = scored_record(found, rows, name, choices, command, report)
    interrupted = False
    try:
        held = result_of(RunRecord.of(record), choices, out, earlier)
    except RunInterrupted as came:  # as it was written
        held, interrupted = came.result, True
    result = ScoreResult(**vars(held), name=name, found=found, rows=tuple(rows))
    if interrupted or not result.complete:
        raise RunInterrupted(result)
    return result


def case_given(scenario: ScenarioLike) -> Case:
    """The scenario to score by. Raises ScenarioError."""
    return case_of(scenarios_of([scenario])[0], [])


def _choices(name: str, engines: Sequence[EngineLike]) -> list[EngineChoice]:
    choices = engine_choices(engines, option="--with") if engines else []
    if not name.strip():
        raise UsageError("--name is empty; give the trace a name.")
    if not name.isprintable():
        raise UsageError(f"--name {name!r}: give the trace a name of printable characters.")
    if name in (*known_engines(), *(choice.name for choice in choices)):
        raise UsageError(f"--name {name}: an engine has this name; give the trace another.")
    return choices
