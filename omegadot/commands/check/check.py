"""``omegadot.check``: one engine through every check."""

from __future__ import annotations

import shlex
import time
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path

from omegadot.commands.check.judge import CAUSE
from omegadot.commands.check.result import Check, Result, Subject, Tally
from omegadot.commands.check.select import Arguments, Selection, select
from omegadot.commands.check.shrink import SECONDS, Failing, kinds_of_failure
from omegadot.commands.check.shrink import shrink as shrink_check
from omegadot.commands.check.suite import SEED, Suite
from omegadot.commands.progress import Count, Reporter, Reporting, reporting
from omegadot.commands.typed import typed
from omegadot.harness.arguments import Via, adapters_named, several
from omegadot.harness.engine_target import EngineLike, is_target, target_of
from omegadot.harness.own_engines import known_engines
from omegadot.harness.usage import UsageError, nearest
from omegadot.scenarios import ScenarioLike

NOT_HELD = ("fail", "error")


@dataclass(frozen=True)
class CheckResult:
    """What came of one engine's checks.

    by_check: every check with its result.  subjects: the engine, its version and integrators; none
    where it did not start.  drawn: the random systems among the scenarios that were not named.
    only_skipped: a sentence where every check, or every one but those of the model, was skipped,
    which is no pass.  baselines: the files that were written.  failing: for each kind of failure,
    three at most, the simplest system found.
    """

    by_check: Mapping[Check, Result]
    subjects: tuple[Subject, ...]
    drawn: frozenset[str] = frozenset()
    only_skipped: tuple[str, ...] = ()
    baselines: tuple[Path, ...] = ()
    failing: tuple[Failing, ...] = ()

    @cached_property
    def results(self) -> dict[str, Result]:
        """The results by check id, such as ``mujoco-RK4-t-handle-0.01-scheme``."""
        return {check.id: result for check, result in self.by_check.items()}

    @property
    def failures(self) -> dict[str, Result]:
        """The checks that fail, and those that the engine did not answer."""
        return {i: result for i, result in self.results.items() if result.verdict in NOT_HELD}

    @property
    def answered(self) -> bool:
        """Whether the engine started and answered every check, not all of its motion by a skip."""
        lost = any(result.verdict == "error" for result in self.by_check.values())
        return not lost and not self.only_skipped

    @property
    def passed(self) -> bool:
        """Whether every check holds and at least one was made."""
        return not self.failures and not self.only_skipped

    def __repr__(self) -> str:
        counts = Counter(result.verdict for result in self.by_check.values())
        named = ", ".join(f"{count} {verdict}" for verdict, count in sorted(counts.items()))
        return f"<omegadot check of {len(self.by_check)}: {named}>"


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
    progress: Reporting = False,
) -> CheckResult:
    """Put one engine, built in or your own, through every check.

    engine: a name, ``FILE.py:Class``, ``module:Class`` or an adapter's class.  scenarios: built-in
    names, ``random-SEED-INDEX``, paths, scenarios or their tables; all built-in ones without any.
    random: so many random systems of this seed besides; None for 24, or for none where scenarios
    are given.  integrators: all without any.  via: how bodies go in, as of `omegadot.run`.
    exceptions: files of declared exceptions.  baseline: a folder of figures to compare with, or to
    store them in.  timeout: s, for one request to the engine.  shrink: look for the simplest
    systems that fail, where some do.
    Raises UsageError, ScenarioError, RecordError and NoTruthError.
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
        suite = Suite(selection)
        count = Count(report, "checking", len(suite.checks))
        results = {}
        try:
            for one in suite.checks:
                results[one] = suite.result_of(one)
                count.advance()
            results = suite.settled(results)
        finally:
            suite.finish()
        failing = _shrunk(engine, selection, results, report) if shrink else []
    tally = Tally()
    for one, result in results.items():
        tally.add(one.engine, one.gate, result.verdict, result.message)
    skipped = tally.only_skipped(choice.name for choice in selection.choices)
    return CheckResult(
        results,
        suite.registry.subjects,
        selection.drawn,
        tuple(skipped),
        tuple(suite.store()),
        tuple(failing),
    )


def _shrunk(
    engine: EngineLike, selection: Selection, results: Mapping[Check, Result], report: Reporter
) -> list[Failing]:
    """The simplest system for each kind of failure of the one engine."""
    cases = {case.name: case for case in selection.cases}
    given = engine if isinstance(engine, str) else target_of(engine)
    if (name := given.partition(":")[0]) in known_engines():
        given = name
    kinds, found = kinds_of_failure(results, cases), []
    deadline = time.monotonic() + SECONDS
    count = Count(report, "shrinking what fails", len(kinds)) if kinds else None
    for number, one in enumerate(kinds):
        line = ["omegadot", "check", given]
        line += ["--integrator", one.integrator] if one.integrator else []
        choice = next(choice for choice in selection.choices if choice.name == one.engine)
        how = (selection.arguments.timeout, SEED, shlex.join(line))
        share = max(0.0, deadline - time.monotonic()) / (len(kinds) - number)
        small = shrink_check(one, cases[one.scenario], choice, *how, seconds=share)
        cause = results[one].message.partition(CAUSE)[2]
        found.append(small and replace(small, cause=cause))
        if count:
            count.advance()
    return [one for one in found if one is not None]


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
        raise UsageError(
            f"{engine}: no such engine; {nearest(engine, known)}, or give "
            "FILE.py:Class, module:Class or a program with its arguments."
        )
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
