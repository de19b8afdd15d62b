"""What came of one engine's checks, all of them or those before an interruption."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

from omegadot.commands.check.result import Check, Result, Subject
from omegadot.commands.check.shrink import Failing

NOT_HELD = ("fail", "error")
# What an interruption meets.
CHECKING, EXPLAINING, SHRINKING = "checking", "looking for causes", "shrinking what fails"


@dataclass(frozen=True)
class CheckResult:
    """What came of one engine's checks.

    by_check: every check with its result.  subjects: the engine, its version and integrators; none
    where it did not start.  drawn: the random systems among the scenarios that were not named.
    only_skipped: a sentence where every check, or every one but those of the model, was skipped,
    which is no pass.  baselines: the files that were written.  failing: for each kind of failure,
    three at most, the simplest system found.  lost: a sentence for each engine that crashed or
    did not answer in an experiment on a cause.  planned: the checks that were to be made.
    interrupted: what was being done when Ctrl-C came; "" where nothing was.
    """

    by_check: Mapping[Check, Result]
    subjects: tuple[Subject, ...]
    drawn: frozenset[str] = frozenset()
    only_skipped: tuple[str, ...] = ()
    baselines: tuple[Path, ...] = ()
    failing: tuple[Failing, ...] = ()
    lost: tuple[str, ...] = ()
    planned: tuple[Check, ...] = ()
    interrupted: str = ""

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
        """Whether every check was made and holds, and there was at least one."""
        return not (self.failures or self.only_skipped or self.interrupted)

    def __repr__(self) -> str:
        counts = Counter(result.verdict for result in self.by_check.values())
        named = ", ".join(f"{count} {verdict}" for verdict, count in sorted(counts.items()))
        ended = "interrupted " * bool(self.interrupted)
        return f"<omegadot {ended}check of {len(self.by_check)}: {named}>"


class CheckInterrupted(KeyboardInterrupt):
    """Ctrl-C during the checks. result: what had come in until then; no baseline was written."""

    def __init__(self, result: CheckResult) -> None:
        super().__init__("interrupted")
        self.result = result
