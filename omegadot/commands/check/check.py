"""``omegadot.check``: one engine through every check."""

from __future__ import annotations

import shlex
import time
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path

from omegadot.commands.check.check_result import (
    CHECKING,
    EXPLAINING,
    SHRINKING,
    CheckInterrupted,
    CheckResult,
)
from omegadot.commands.check.judge import CAUSE
from omegadot.commands.check.result import Check, Result, Tally
from omegadot.commands.check.select import Arguments, Selection, select
from omegadot.commands.check.shrink import SECONDS, Failing, kinds_of_failure
from omegadot.commands.check.shrink import shrink as shrink_check
from omegadot.commands.check.suite import SEED, Suite
from omegadot.commands.progress import Count, Reporter, Reporting, reporting
from omegadot.commands.typed import typed
from omegadot.harness.arguments import Via, adapters_named, several
from omegadot.harness.engine_target import GIVE, EngineLike, is_target, target_of
from omegadot.harness.own_engines import known_engines, nearest_engine
from omegadot.harness.python_path import setting_for
from omegadot.harness.usage import UsageError
from omegadot.scenarios import ScenarioLike
from omegadot.written import written


@typed
def check(
    engine: EngineLike,
    *,
    scenarios: ScenarioLike | Sequence[ScenarioLike] | None = None,
    random: int | None = None,
    seed: int = 0,
    integrators: str | Sequence[str] | None = None,
    via: Via | Sequence[Via] | None = None,
    exceptions: str | Path | Sequence[str | Path] = (),
    baseline: str | Path | None = None,
    update_baseline: bool = False,
    timeout: float = 60.0,
    shrink: bool = True,
    program: str | Sequence[str] = "omegadot",
    progress: Reporting = False,
) -> CheckResult:
    """Put one engine, built in or your own, through every check.

    engine: a name, ``FILE.py:Class``, ``module:Class`` or an adapter's class.  scenarios: built-in
    names, ``random-SEED-INDEX``, paths, scenarios or their tables; all built-in ones without any.
    random: so many random systems of this seed besides; None for 24, or for none where scenarios
    are given.  integrators: all without any.  via: how bodies go in, as of `omegadot.run`.
    exceptions: files of declared exceptions.  baseline: a folder of figures to compare with, or to
    store them in.  timeout: s, for one request to the engine.  shrink: look for the simplest
    systems that fail, where some do.  program: with which the commands begin that run these.
    Raises UsageError, ScenarioError, RecordError, NoTruthError, and CheckInterrupted on Ctrl-C.
    """
    arguments = Arguments(
        scenarios=several(scenarios, "scenarios"),
        random=random,
        seed=seed,
        via=several(via, "via"),
        exceptions=several(exceptions),
        baseline=baseline,
        update=update_baseline,
        timeout=timeout,
    )
    selection = select(arguments_of(engine, several(integrators, "integrators"), arguments))
    with reporting(progress) as report:
        start = [program] if isinstance(program, str) else program
        return _checked(selection, [*start, "check", *_typed(engine)], shrink, report)


def _checked(
    selection: Selection, command: Sequence[str], shrink: bool, report: Reporter
) -> CheckResult:
    """Every check of a selection. Raises CheckInterrupted with what there is by then.

    command: the one that checks the engine.
    """
    suite = Suite(selection)
    results: dict[Check, Result] = {}
    failing: list[Failing] = []
    doing = CHECKING
    try:
        try:
            count = Count(report, "checking", len(suite.checks))
            for one in suite.checks:
                results[one] = suite.result_of(one)
                count.advance()
            doing = EXPLAINING
            results = suite.settled(results)
        finally:
            suite.finish()
        doing = SHRINKING
        failing = _shrunk(command, selection, results, report) if shrink else []
    except KeyboardInterrupt:
        plain = {one: replace(result, explained=None) for one, result in results.items()}
        raise CheckInterrupted(_result(suite, plain, interrupted=doing)) from None
    return _result(suite, results, failing)


def _result(
    suite: Suite,
    results: Mapping[Check, Result],
    failing: Sequence[Failing] = (),
    interrupted: str = "",
) -> CheckResult:
    tally = Tally()
    for one, result in results.items():
        tally.add(one.engine, one.gate, result.verdict, result.message)
    choices = suite.selection.choices if not interrupted else ()
    return CheckResult(
        results,
        suite.registry.subjects,
        suite.selection.drawn,
        tuple(tally.only_skipped(choice.name for choice in choices)),
        () if interrupted else tuple(suite.store()),
        tuple(failing),
        suite.lost,
        tuple(suite.checks),
        interrupted,
    )


def _shrunk(
    command: Sequence[str],
    selection: Selection,
    results: Mapping[Check, Result],
    report: Reporter,
) -> list[Failing]:
    """The simplest system for each kind of failure of the one engine."""
    cases = {case.name: case for case in selection.cases}
    kinds, found = kinds_of_failure(results, cases), []
    deadline = time.monotonic() + SECONDS
    count = Count(report, "shrinking what fails", len(kinds)) if kinds else None
    for number, one in enumerate(kinds):
        choice = next(choice for choice in selection.choices if choice.name == one.engine)
        line = [*setting_for(choice.target), *command]
        chosen = [one.integrator] if one.integrator else choice.integrators
        line += [word for name in chosen for word in ("--integrator", name)]
        line += ["--via", choice.via] if choice.via else []
        timeout = selection.arguments.timeout
        line += ["--timeout", written(timeout)] if timeout != Arguments.timeout else []
        how = (timeout, SEED, shlex.join(line))
        share = max(0.0, deadline - time.monotonic()) / (len(kinds) - number)
        small = shrink_check(one, cases[one.scenario], choice, *how, seconds=share)
        cause = results[one].message.partition(CAUSE)[2]
        found.append(small and replace(small, cause=cause))
        if count:
            count.advance()
    return [one for one in found if one is not None]


def _typed(engine: EngineLike) -> list[str]:
    """The engine as it was typed, without an integrator in its name."""
    given = engine if isinstance(engine, str) else target_of(engine)
    name = given.partition(":")[0]
    return [name if name in known_engines() else given]


def arguments_of(engine: EngineLike, integrators: Sequence[str], arguments: Arguments) -> Arguments:
    """The arguments for one engine, which is taken for a name or for a class.

    Raises UsageError.
    """
    known = known_engines()
    adapters: list[str] = []
    if isinstance(engine, str) and engine in known:
        name = engine
    elif not isinstance(engine, str) or is_target(engine, known) or ":" in engine:
        left, _, right = engine.partition(":") if isinstance(engine, str) else ("", "", "")
        if left in known:
            return _of_one_integrator(left, right, integrators, arguments)
        adapters = [target_of(engine)]
        name = next(iter(adapters_named(adapters)))
    else:
        raise UsageError(f"{engine}: no such engine; {nearest_engine(engine, known)}; or {GIVE}.")
    engines = [f"{name}:{integrator}" for integrator in integrators] or [name]
    return replace(arguments, engines=engines, adapters=adapters, required=[name])


def _of_one_integrator(
    name: str, integrator: str, others: Sequence[str], arguments: Arguments
) -> Arguments:
    """Of ``NAME:INTEGRATOR``, as `run` takes it. Raises UsageError."""
    if not integrator:
        raise UsageError(f"{name}:: no integrator is named; give {name}, or {name}:INTEGRATOR.")
    if others:
        raise UsageError(
            f"{name}:{integrator}: --integrator is given too; give {name}, and --integrator for "
            "each."
        )
    return replace(arguments, engines=[f"{name}:{integrator}"], required=[name])
