"""``omegadot.check``: one engine through every check."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path

from omegadot.adapters.registry import registered
from omegadot.commands.check.result import Check, Result, Subject, Tally
from omegadot.commands.check.select import Arguments, select
from omegadot.commands.check.suite import Suite
from omegadot.commands.progress import Count, Reporting, reporting
from omegadot.harness.arguments import adapters_named, several
from omegadot.harness.engine_target import EngineLike, target_of
from omegadot.harness.usage import UsageError, nearest
from omegadot.scenarios import ScenarioLike

NOT_HELD = ("fail", "error")


@dataclass(frozen=True)
class CheckResult:
    """What came of one engine's checks.

    by_check: every check with its result.  subjects: the engine, its version and integrators; none
    where it did not start.  only_skipped: a sentence where every check was skipped, which is no
    pass.  baselines: the files that were written.
    """

    by_check: Mapping[Check, Result]
    subjects: tuple[Subject, ...]
    only_skipped: tuple[str, ...] = ()
    baselines: tuple[Path, ...] = ()

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
        """Whether the engine started and answered every check."""
        return all(result.verdict != "error" for result in self.by_check.values())

    @property
    def passed(self) -> bool:
        """Whether every check holds and at least one was made."""
        return not self.failures and not self.only_skipped

    def __repr__(self) -> str:
        counts = Counter(result.verdict for result in self.by_check.values())
        named = ", ".join(f"{count} {verdict}" for verdict, count in sorted(counts.items()))
        return f"<omegadot check of {len(self.by_check)}: {named}>"


def check(
    engine: EngineLike,
    *,
    scenarios: ScenarioLike | Sequence[ScenarioLike] = (),
    integrators: str | Sequence[str] = (),
    exceptions: str | Path | Sequence[str | Path] = (),
    baseline: str | Path | None = None,
    update_baseline: bool = False,
    timeout: float = 60.0,
    progress: Reporting = False,
) -> CheckResult:
    """Put one engine, built in or your own, through every check.

    engine: a name, ``FILE.py:Class``, ``module:Class`` or an adapter's class.  scenarios: built-in
    names, paths, scenarios or their tables; all built-in ones without any.  integrators: all
    without any.  exceptions: files of declared exceptions.  baseline: a folder of figures to
    compare with, or to store them in.  timeout: s, for one request to the engine.
    Raises UsageError, ScenarioError, RecordError and NoTruthError.
    """
    arguments = Arguments(
        scenarios=several(scenarios),
        exceptions=several(exceptions),
        baseline=baseline,
        update=update_baseline,
        timeout=timeout,
    )
    selection = select(arguments_of(engine, several(integrators), arguments))
    with reporting(progress) as report:
        suite = Suite(selection)
        count = Count(report, "checking", len(suite.checks))
        results = {}
        try:
            for one in suite.checks:
                results[one] = suite.result_of(one)
                count.advance()
        finally:
            suite.finish()
    results = {one: result.settled for one, result in results.items()}
    tally = Tally()
    for one, result in results.items():
        tally.add(one.engine, result.verdict, result.message)
    skipped = tally.only_skipped(choice.name for choice in selection.choices)
    return CheckResult(results, suite.registry.subjects, tuple(skipped), tuple(suite.store()))


def arguments_of(engine: EngineLike, integrators: Sequence[str], arguments: Arguments) -> Arguments:
    """The arguments for one engine, which is taken for a name or for a class.

    Raises UsageError.
    """
    known = registered()
    adapters: list[str] = []
    if isinstance(engine, str) and engine in known:
        name = engine
    elif not isinstance(engine, str) or engine.endswith(".py") or ":" in engine:
        left, _, right = engine.partition(":") if isinstance(engine, str) else ("", "", "")
        if left in known:
            raise UsageError(f"{engine}: give the integrator apart, as --integrator {right}.")
        adapters = [target_of(engine)]
        name = next(iter(adapters_named(adapters)))
    else:
        raise UsageError(
            f"{engine}: no such engine; {nearest(engine, known)}, or give "
            "FILE.py:Class or module:Class."
        )
    engines = [f"{name}:{integrator}" for integrator in integrators] or [name]
    return replace(arguments, engines=engines, adapters=adapters, required=[name])
