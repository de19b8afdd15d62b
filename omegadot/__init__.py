"""omegadot: cross-validation of rigid-body engines against a Newton-Euler reference.

Each command is a function here, with the same arguments and a typed result; docs/python.md shows
them. What is named here is imported when it is first used.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

__version__ = "0.1.0"

if TYPE_CHECKING:  # "as": it is exported
    from omegadot.adapters.registry import AdapterError as AdapterError
    from omegadot.commands.check.check import check as check
    from omegadot.commands.check.check_result import CheckInterrupted as CheckInterrupted
    from omegadot.commands.check.check_result import CheckResult as CheckResult
    from omegadot.commands.check.result import Check as Check
    from omegadot.commands.check.result import Result as Result
    from omegadot.commands.choose.choose import choose as choose
    from omegadot.commands.choose.result import ChooseResult as ChooseResult
    from omegadot.commands.choose.result import Ranked as Ranked
    from omegadot.commands.compare.compare import compare as compare
    from omegadot.commands.engines.engines import EngineEntry as EngineEntry
    from omegadot.commands.engines.engines import engines as engines
    from omegadot.commands.exact.exact import ExactStates as ExactStates
    from omegadot.commands.exact.exact import exact as exact
    from omegadot.commands.faults.faults import FaultsResult as FaultsResult
    from omegadot.commands.faults.faults import faults as faults
    from omegadot.commands.findings.findings import FindingsResult as FindingsResult
    from omegadot.commands.findings.findings import findings as findings
    from omegadot.commands.fit.fit import fit as fit
    from omegadot.commands.fit.result import FitResult as FitResult
    from omegadot.commands.progress import Progress as Progress
    from omegadot.commands.report.report import report as report
    from omegadot.commands.run.result import RunInterrupted as RunInterrupted
    from omegadot.commands.run.result import RunResult as RunResult
    from omegadot.commands.run.run import run as run
    from omegadot.commands.schemes.schemes import SchemesResult as SchemesResult
    from omegadot.commands.schemes.schemes import schemes as schemes
    from omegadot.commands.score.detection.detect import Detected as Detected
    from omegadot.commands.score.detection.detect import detect as detect
    from omegadot.commands.score.judged import ChannelScore as ChannelScore
    from omegadot.commands.score.score import ScoreResult as ScoreResult
    from omegadot.commands.score.score import score as score
    from omegadot.commands.score.table import TraceError as TraceError
    from omegadot.commands.versions.result import VersionChange as VersionChange
    from omegadot.commands.versions.result import VersionsResult as VersionsResult
    from omegadot.commands.versions.versions import versions as versions
    from omegadot.harness.engines import NoTruthError as NoTruthError
    from omegadot.harness.usage import UsageError as UsageError
    from omegadot.reports.record.schema import RecordError as RecordError
    from omegadot.reports.run_record import RunRecord as RunRecord
    from omegadot.reports.run_record import TaskResult as TaskResult
    from omegadot.reports.run_record import read_record as read_record
    from omegadot.reports.two_runs.comparison import Comparison as Comparison
    from omegadot.scenarios import Scenario as Scenario
    from omegadot.scenarios import ScenarioError as ScenarioError
    from omegadot.scenarios import builtin_names as builtin_names
    from omegadot.scenarios import scenario as scenario

_PLACES = {
    "adapters.registry": ("AdapterError",),
    "commands.check.check": ("check",),
    "commands.check.check_result": ("CheckInterrupted", "CheckResult"),
    "commands.check.result": ("Check", "Result"),
    "commands.choose.choose": ("choose",),
    "commands.choose.result": ("ChooseResult", "Ranked"),
    "commands.compare.compare": ("compare",),
    "commands.engines.engines": ("EngineEntry", "engines"),
    "commands.exact.exact": ("ExactStates", "exact"),
    "commands.faults.faults": ("FaultsResult", "faults"),
    "commands.findings.findings": ("FindingsResult", "findings"),
    "commands.fit.fit": ("fit",),
    "commands.fit.result": ("FitResult",),
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

__all__ = ["__version__", *_MODULE_OF]


if not TYPE_CHECKING:  # a type checker sees the imports above, and no other name

    def __getattr__(name: str) -> Any:
        if name not in _MODULE_OF:
            raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
        found = globals()[name] = getattr(import_module(f"{__name__}.{_MODULE_OF[name]}"), name)
        return found


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
