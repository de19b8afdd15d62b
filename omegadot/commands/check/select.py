"""What is to be checked: engines, scenarios, exceptions and a baseline, from the arguments."""

from __future__ import annotations

import os
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path

from omegadot.adapters.registry import registered
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
from omegadot.harness.plan import EngineChoice
from omegadot.harness.usage import UsageError
from omegadot.scenarios import ScenarioLike


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


@dataclass(frozen=True)
class Selection:
    """What to check. unknown: engines that are required and unknown.  baseline: a folder."""

    arguments: Arguments

    choices: list[EngineChoice]
    cases: list[Case]
    exceptions: list[DeclaredException]
    unknown: tuple[str, ...]
    baseline: Path | None
    jobs: int = field(default_factory=lambda: os.cpu_count() or 1)


def select(arguments: Arguments) -> Selection:
    """Make ready what was requested. Raises UsageError and ScenarioError.

    Without an argument about engines these are all that are registered; otherwise those that are
    named, given by an adapter, or required.
    """
    if arguments.update and arguments.baseline is None:
        raise UsageError("--update-baseline: give the folder of the baselines with --baseline DIR.")
    adapters = adapters_named(arguments.adapters)
    known = {**registered(), **adapters}
    unknown = tuple(name for name in arguments.required if name not in known)
    wanted = list(arguments.engines)
    for name in (*adapters, *arguments.required):
        if name in known and name not in {argument.partition(":")[0] for argument in wanted}:
            wanted.append(name)
    choices = [] if unknown and not wanted else engine_choices(wanted, arguments.adapters)
    choices = by_ways(choices, arguments.via)
    return Selection(
        arguments,
        choices,
        cases=[case_of(scenario, ()) for scenario in scenarios_of(arguments.scenarios)],
        exceptions=exceptions_of(choices, map(Path, arguments.exceptions)),
        unknown=unknown,
        baseline=None if arguments.baseline is None else Path(arguments.baseline),
    )
