"""What is checked: engines, scenarios, exceptions and a baseline, from the arguments."""

from __future__ import annotations

import ast
import os
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path

from omegadot.adapters.registry import registered
from omegadot.commands.check.exceptions import DeclaredException, exceptions_of
from omegadot.gates.case import Case
from omegadot.harness.arguments import adapters_named, case_of, engine_choices, scenarios_of
from omegadot.harness.plan import EngineChoice
from omegadot.harness.usage import UsageError


@dataclass(frozen=True)
class Arguments:
    """The selection as it was typed."""

    engines: Sequence[str] = ()
    adapters: Sequence[str] = ()
    required: Sequence[str] = ()
    scenarios: Sequence[str] = ()
    exceptions: Sequence[str] = ()
    baseline: str | None = None
    update: bool = False
    timeout: float = 60.0


@dataclass(frozen=True)
class Selection:
    """What to check. unknown: engines that are required and unknown."""

    choices: list[EngineChoice]
    cases: list[Case]
    exceptions: list[DeclaredException]
    required: frozenset[str] = frozenset()
    unknown: tuple[str, ...] = ()
    baseline: Path | None = None
    update: bool = False
    timeout: float = 60.0
    jobs: int = field(default_factory=lambda: os.cpu_count() or 1)


def _class_of(path: Path) -> str:
    """The adapter in a file: the only class that is called ...Adapter, or the only one."""
    try:
        body = ast.parse(path.read_text(encoding="utf-8")).body
    except OSError:
        raise UsageError(f"{path}: no such adapter file; check the path.") from None
    except (SyntaxError, ValueError):
        raise UsageError(f"{path}: not a Python file; give FILE.py:Class.") from None
    names = [node.name for node in body if isinstance(node, ast.ClassDef)]
    named = [name for name in names if name.endswith("Adapter")] or names
    if len(named) != 1:
        found = ", ".join(named) or "no class"
        raise UsageError(f"{path}: which class is the adapter? It has {found}; give FILE.py:Class.")
    return named[0]


def target_of(argument: str) -> str:
    """``FILE.py:Class`` or ``module:Class``; a file alone is given its adapter's class."""
    return f"{argument}:{_class_of(Path(argument))}" if argument.endswith(".py") else argument


def select(terms: Arguments) -> Selection:
    """Make ready what was requested. Raises UsageError and ScenarioError.

    Without an argument about engines these are all that are registered; otherwise those that are
    named, given by an adapter, or required.
    """
    if terms.update and terms.baseline is None:
        raise UsageError("--update-baseline: give the folder of the baselines with --baseline DIR.")
    adapters = [target_of(argument) for argument in terms.adapters]
    known = {**registered(), **adapters_named(adapters)}
    unknown = tuple(name for name in terms.required if name not in known)
    wanted = list(terms.engines)
    for name in (*adapters_named(adapters), *terms.required):
        if name in known and name not in {argument.partition(":")[0] for argument in wanted}:
            wanted.append(name)
    choices = [] if unknown and not wanted else engine_choices(wanted, adapters)
    return Selection(
        choices=choices,
        cases=[case_of(scenario, ()) for scenario in scenarios_of(terms.scenarios)],
        exceptions=exceptions_of(choices, map(Path, terms.exceptions)),
        required=frozenset(terms.required),
        unknown=unknown,
        baseline=None if terms.baseline is None else Path(terms.baseline),
        update=terms.update,
        timeout=terms.timeout,
    )
