"""What is to be checked: engines, scenarios, exceptions and a baseline, from the arguments."""

from __future__ import annotations

import os
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path

from omegadot.commands.check.exceptions import DeclaredException, exceptions_of
from omegadot.gates.case import Case
from omegadot.harness.arguments import (
    adapters_named,
    by_ways,
    case_of,
    engine_choices,
    scenarios_of,
)
from omegadot.harness.engine_target import EngineLike
from omegadot.harness.own_engines import known_engines
from omegadot.harness.plan import EngineChoice
from omegadot.harness.usage import UsageError, check_count
from omegadot.reports.record.whole_file import path_of
from omegadot.scenarios import Scenario, ScenarioLike, scenario
from omegadot.scenarios.random_systems import LARGEST_SEED, MOST_SYSTEMS, random_names
from omegadot.scenarios.random_traits import BLOCK


@dataclass(frozen=True)
class Arguments:
    """What a user gives, as it was typed or passed."""

    engines: Sequence[str] = ()
    adapters: Sequence[EngineLike] = ()
    required: Sequence[str] = ()
    scenarios: Sequence[ScenarioLike] = ()
    via: Sequence[str] = ()
    exceptions: Sequence[str | Path] = ()
    baseline: str | Path | None = None
    update: bool = False
    timeout: float = 60.0
    random: int | None = None
    seed: int = 0


@dataclass(frozen=True)
class Selection:
    """What to check. unknown: engines that are required and unknown.  baseline: a folder.

    drawn: names of the random systems that were drawn, not named. They have no baseline.
    """

    arguments: Arguments

    choices: list[EngineChoice]
    cases: list[Case]
    exceptions: list[DeclaredException]
    unknown: tuple[str, ...]
    baseline: Path | None
    drawn: frozenset[str] = frozenset()
    jobs: int = field(default_factory=lambda: os.cpu_count() or 1)


def select(arguments: Arguments) -> Selection:
    """Make ready what was requested. Raises UsageError and ScenarioError.

    Without an argument about engines these are all that are registered; otherwise those that are
    named, given by an adapter, or required. Without one about scenarios these are all built-in ones
    and 24 random systems.
    """
    if arguments.update and arguments.baseline is None:
        raise UsageError("--update-baseline: give the folder of the baselines with --baseline DIR.")
    baseline = None if arguments.baseline is None else path_of(arguments.baseline)
    if baseline is not None and not arguments.update and not os.path.isdir(baseline):
        raise UsageError(
            f"--baseline {baseline}: no such folder; store the values there first with "
            "--update-baseline, or check the path."
        )
    adapters = adapters_named(arguments.adapters)
    known = {**known_engines(), **adapters}
    unknown = tuple(name for name in arguments.required if name not in known)
    wanted = list(arguments.engines)
    for name in (*adapters, *arguments.required):
        if name in known and name not in {argument.partition(":")[0] for argument in wanted}:
            wanted.append(name)
    choices = [] if unknown and not wanted else engine_choices(wanted, arguments.adapters)
    choices = by_ways(choices, arguments.via)
    named = scenarios_of(arguments.scenarios)
    drawn = _drawn(arguments, {scenario.name for scenario in named})
    return Selection(
        arguments,
        choices,
        cases=[case_of(scenario, ()) for scenario in (*named, *drawn)],
        exceptions=exceptions_of(choices, map(path_of, arguments.exceptions)),
        unknown=unknown,
        baseline=baseline,
        drawn=frozenset(scenario.name for scenario in drawn),
    )


def _drawn(arguments: Arguments, named: set[str]) -> list[Scenario]:
    """The random systems besides those named: 24 unless a scenario is named. Raises UsageError."""
    count = arguments.random
    if count is None:
        count = 0 if arguments.scenarios else BLOCK
    check_count("--random", count, 0, MOST_SYSTEMS)
    check_count("--seed", arguments.seed, 0, LARGEST_SEED)
    if arguments.seed and not count:
        raise UsageError(
            f"--seed {arguments.seed}: no random system is drawn; give their number with --random."
        )
    names = random_names(arguments.seed, count)
    return [scenario(name) for name in names if name not in named]
