"""omegadot: cross-validation of rigid-body engines against a Newton-Euler reference.

Each command is a function here, with the same arguments and a typed result; docs/python.md shows
them. What is named here is imported when it is first used.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

__version__ = "0.1.0"

if TYPE_CHECKING:
    from omegadot.adapters.registry import AdapterError
    from omegadot.commands.check.check import CheckResult, check
    from omegadot.commands.check.result import Check, Result
    from omegadot.commands.choose.choose import choose
    from omegadot.commands.choose.result import ChooseResult, Ranked
    from omegadot.commands.compare.compare import compare
    from omegadot.commands.engines.engines import EngineEntry, engines
    from omegadot.commands.exact.exact import ExactStates, exact
    from omegadot.commands.faults.faults import FaultsResult, faults
    from omegadot.commands.progress import Progress
    from omegadot.commands.report.report import report
    from omegadot.commands.run.result import RunInterrupted, RunResult
    from omegadot.commands.run.run import run
    from omegadot.commands.schemes.schemes import SchemesResult, schemes
    from omegadot.commands.score.detection.detect import Detected, detect
    from omegadot.commands.score.judged import ChannelScore
    from omegadot.commands.score.score import ScoreResult, score
    from omegadot.commands.score.table import TraceError
    from omegadot.commands.versions.result import VersionChange, VersionsResult
    from omegadot.commands.versions.versions import versions
    from omegadot.harness.engines import NoTruthError
    from omegadot.harness.usage import UsageError
    from omegadot.reports.record.schema import RecordError
    from omegadot.reports.run_record import RunRecord, TaskResult, read_record
    from omegadot.reports.two_runs.comparison import Comparison
    from omegadot.scenarios import Scenario, ScenarioError, builtin_names, scenario

_PLACES = {
    "adapters.registry": ("AdapterError",),
    "commands.check.check": ("CheckResult", "check"),
    "commands.check.result": ("Check", "Result"),
    "commands.choose.choose": ("choose",),
    "commands.choose.result": ("ChooseResult", "Ranked"),
    "commands.compare.compare": ("compare",),
    "commands.engines.engines": ("EngineEntry", "engines"),
    "commands.exact.exact": ("ExactStates", "exact"),
    "commands.faults.faults": ("FaultsResult", "faults"),
    "commands.progress": ("Progress",),
    "commands.report.report": ("report",),
    "commands.run.result": ("RunInterrupted", "RunResult"),
    "commands.run.run": ("run",),
    "commands.schemes.schemes": ("SchemesResult", "schemes"),
    "commands.score.detection.detect": ("Detected", "detect"),
    "commands.score.judged": ("ChannelScore",),
    "commands.score.score": ("ScoreResult", "score"),
    "commands.score.table": ("TraceError",),
    "commands.versions.result": ("VersionChange", "VersionsResult"),
    "commands.versions.versions": ("versions",),
    "harness.engines": ("NoTruthError",),
    "harness.usage": ("UsageError",),
    "reports.record.schema": ("RecordError",),
    "reports.run_record": ("RunRecord", "TaskResult", "read_record"),
    "reports.two_runs.comparison": ("Comparison",),
    "scenarios": ("Scenario", "ScenarioError", "builtin_names", "scenario"),
}
_MODULE_OF = {name: module for module, names in _PLACES.items() for name in names}

__all__ = [
    "AdapterError",
    "ChannelScore",
    "Check",
    "CheckResult",
    "ChooseResult",
    "Comparison",
    "Detected",
    "EngineEntry",
    "ExactStates",
    "FaultsResult",
    "NoTruthError",
    "Progress",
    "Ranked",
    "RecordError",
    "Result",
    "RunInterrupted",
    "RunRecord",
    "RunResult",
    "Scenario",
    "ScenarioError",
    "SchemesResult",
    "ScoreResult",
    "TaskResult",
    "TraceError",
    "UsageError",
    "VersionChange",
    "VersionsResult",
    "__version__",
    "builtin_names",
    "check",
    "choose",
    "compare",
    "detect",
    "engines",
    "exact",
    "faults",
    "read_record",
    "report",
    "run",
    "scenario",
    "schemes",
    "score",
    "versions",
]


if not TYPE_CHECKING:  # a type checker sees the imports above, and no other name

    def __getattr__(name: str) -> Any:
        if name not in _MODULE_OF:
            raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
        found = globals()[name] = getattr(import_module(f"{__name__}.{_MODULE_OF[name]}"), name)
        return found


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
