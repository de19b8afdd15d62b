"""Declared exceptions: known failures of an engine, each with its reason and link, held strictly.

A check that an exception matches must fail: one that passes again, and an exception that matches no
check at all, fail the run. A crash or a time-out is never excused.
"""

from __future__ import annotations

import importlib.util
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from fnmatch import fnmatchcase
from pathlib import Path
from typing import Any

from omegadot.adapters.registry import OURS
from omegadot.commands.check.baseline_file import Baseline
from omegadot.commands.check.compare import baseline_checks
from omegadot.commands.check.exception_conditions import Condition, all_hold, read_conditions
from omegadot.commands.check.result import Check, Result, Subject, checks_of
from omegadot.gates.case import Case
from omegadot.harness.arguments import case_of
from omegadot.harness.engine_target import file_of
from omegadot.harness.plan import EngineChoice
from omegadot.harness.usage import UsageError, nearest
from omegadot.scenarios import Scenario, ScenarioError, builtin_names, load_builtin
from omegadot.scenarios.files import read_toml
from omegadot.scenarios.random_systems import NAME, random_scenario

OWN_FOLDER = Path(__file__).with_name("known")
SUFFIX = ".exceptions.toml"
KEYS = ("check", "reason", "link")


@dataclass(frozen=True)
class DeclaredException:
    """A known failure.

    check: a pattern of check ids, with * for any characters.
    when: limits of the body and its motion; it is about those scenarios alone of which all hold.
    """

    engine: str
    check: str
    reason: str
    link: str
    source: str
    when: tuple[Condition, ...] = ()

    def matches(self, check: Check, scenario: Scenario | None = None) -> bool:
        """Whether it refers to this check, of this scenario; without one, whether it may."""
        if check.engine != self.engine or not fnmatchcase(check.id, self.check):
            return False
        return scenario is None or all_hold(self.when, scenario)

    def may_pass(self, check: Check) -> bool:
        """Whether a check that it matches may hold: of all random systems, none is named."""
        return NAME.fullmatch(check.scenario) is not None and check.scenario not in self.check


def _refuse_unknown(table: dict[str, Any], known: Sequence[str], where: str) -> None:
    for key in table:
        if key not in known:
            raise UsageError(f"{where}: unknown key {key!r}; {nearest(key, known)}.")


def read_exceptions(path: Path) -> list[DeclaredException]:
    """The exceptions of one file: ``engine``, and ``[[exception]]`` with check, reason and link.

    An exception may have a table ``when``, see `omegadot.commands.check.exception_conditions`.
    Raises UsageError.
    """
    try:
        data = read_toml(path, str(path))
    except ScenarioError as error:
        raise UsageError(str(error)) from None
    _refuse_unknown(data, ("engine", "exception"), str(path))
    engine, entries = data.get("engine"), data.get("exception", [])
    if not isinstance(engine, str) or not isinstance(entries, list):
        raise UsageError(f'{path}: give engine = "NAME" and its [[exception]] tables.')
    found = []
    for number, entry in enumerate(entries, 1):
        where = f"{path}: exception {number}"
        if not isinstance(entry, dict):
            raise UsageError(f"{where} is {entry!r}; write it as a table, [[exception]].")
        _refuse_unknown(entry, (*KEYS, "when"), where)
        for key in KEYS:
            if not isinstance(entry.get(key), str) or not entry[key].strip():
                raise UsageError(f"{where}: {key} is missing or empty; give it as a string.")
        when = read_conditions(entry["when"], where) if "when" in entry else ()
        found.append(DeclaredException(engine, **{**entry, "source": str(path), "when": when}))
    return found


def _next_to(target: str) -> Path | None:
    """Where an adapter's own exceptions stand: module.exceptions.toml next to module.py."""
    file = file_of(target)
    if file is not None:
        return file.with_suffix(SUFFIX)
    package, *rest = target.rpartition(":")[0].split(".")
    spec = importlib.util.find_spec(package)  # the package alone: nothing of it is imported
    if spec is None or spec.origin is None:
        return None
    folder = Path(spec.origin).parent
    return folder.joinpath(*(rest or [package])).with_suffix(SUFFIX)


def exceptions_of(
    choices: Sequence[EngineChoice], files: Iterable[Path]
) -> list[DeclaredException]:
    """The exceptions of some engines: the project's own, those next to an adapter, those of files.

    Raises UsageError.
    """
    names, own = {choice.name for choice in choices}, list[Path]()
    for choice in choices:
        built_in = OURS.get(choice.name) == choice.target
        path = OWN_FOLDER / f"{choice.name}.toml" if built_in else _next_to(choice.target)
        if path is not None and path.is_file():
            own.append(path)
    found = [exception for path in (*own, *files) for exception in read_exceptions(path)]
    return [exception for exception in found if exception.engine in names]


def no_longer_fails(exception: DeclaredException) -> str:
    """What is reported of a declared exception whose check passes."""
    return (
        f"passes, though {exception.source} declares that it fails ({exception.reason}): "
        "take the exception out, or narrow its pattern."
    )


def matches_nothing(exception: DeclaredException) -> str:
    """What is reported of a declared exception that refers to no check."""
    return f"{exception.source}: {exception.check!r} matches no check; correct it or remove it."


def with_exceptions(
    check: Check,
    result: Result,
    exceptions: Iterable[DeclaredException],
    scenario: Scenario | None = None,
) -> Result:
    """A failure that is declared becomes "declared"; a pass that is declared to fail fails.

    scenario: that of the check, which an exception's limits are about.
    """
    exception = next((e for e in exceptions if e.matches(check, scenario)), None)
    if exception is None:
        return result
    if result.verdict == "fail":
        text = f"{exception.reason} ({exception.link}): {result.settled.message}"
        return Result("declared", text, result.outcome)
    if result.verdict == "pass" and not exception.may_pass(check):
        return Result("fail", no_longer_fails(exception))
    return result


def unmatched(
    exceptions: Iterable[DeclaredException],
    subject: Subject,
    cases: Sequence[Case],
    stored: Baseline | None = None,
) -> list[DeclaredException]:
    """The exceptions of one engine that match nothing, not even a check that is left out here."""
    own = [exception for exception in exceptions if exception.engine == subject.name]
    if not own:
        return []
    # All that there may be: its integrators, on these scenarios, on all built-in ones, and on one
    # that stands for those that are drawn: a run draws none, and a pattern may be about them all.
    scenarios = [case.scenario for case in cases] + [load_builtin(n) for n in builtin_names()]
    scenarios.append(random_scenario(0, 0))
    whole = [*cases, *(case_of(scenario, ()) for scenario in scenarios)]
    known = [*checks_of([subject.whole], whole), *baseline_checks(subject.whole, whole, stored)]
    return [e for e in own if not any(e.matches(check) for check in known)]
