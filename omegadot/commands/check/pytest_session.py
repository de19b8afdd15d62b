"""The pytest session of a suite: collect its checks, share its engines, and sum it up."""

from __future__ import annotations

import os
from dataclasses import replace
from typing import Any

import pytest

from omegadot.adapters.registry import AdapterError
from omegadot.commands.check.baseline_file import from_text, to_text
from omegadot.commands.check.coverage import coverage
from omegadot.commands.check.pytest_items import ENGINE, GATE, MESSAGE, ROOT, VERDICT, collect
from omegadot.commands.check.result import REGISTRY, Tally
from omegadot.commands.check.select import Arguments, select
from omegadot.commands.check.suite import Suite
from omegadot.harness.usage import UsageError
from omegadot.scenarios import ScenarioError

# What xdist carries from the session that hands out the work to those that do it, and back.
SHARED = "omegadot"


def _arguments(given: dict[str, Any]) -> Arguments:
    return Arguments(
        engines=given["engine"] or (),
        adapters=given["adapter"] or (),
        required=given["require-engine"] or (),
        scenarios=given["scenario"] or (),
        random=given["random"],
        seed=given["seed"],
        via=given["via"] or (),
        exceptions=given["exceptions"] or (),
        baseline=given["baseline"],
        update=bool(given["update-baseline"]),
        timeout=given["timeout"],
    )


def _take_paths(config: pytest.Config, typed: bool) -> tuple[tuple[str, ...], bool]:
    """The checks named among the paths, and whether nothing besides checks is to be collected.

    Checks stand alone where they were requested on the command line and no path was.
    """
    named = tuple(arg for arg in config.args if arg.startswith(f"{ROOT}::"))
    config.args = [arg for arg in config.args if arg not in named]
    pathless = config.args_source is not pytest.Config.ArgsSource.ARGS or not config.args
    alone = pathless and (bool(named) or typed)
    if alone:
        config.args = []
    return named, alone


def start_session(config: pytest.Config, given: dict[str, Any], typed: bool) -> None:
    """Select, start the engines, and register the session. Wrong usage ends pytest.

    given: the options, by name.  typed: whether one of them stands on the command line.
    """
    shared: dict[str, Any] = getattr(config, "workerinput", {})
    named, alone = _take_paths(config, typed)
    if alone and getattr(config.option, "dist", "no") == "load":
        config.option.dist = "loadscope"  # a scenario's checks stay together, and it is run once
    try:
        selection = select(_arguments(given))
        workers = int(os.environ.get("PYTEST_XDIST_WORKER_COUNT", "1"))
        selection = replace(selection, jobs=max(1, selection.jobs // workers))
        registry = REGISTRY.validate_json(shared[SHARED]) if SHARED in shared else None
        suite = Suite(selection, registry)
    except (AdapterError, ScenarioError, UsageError) as problem:
        raise pytest.UsageError(f"omegadot: {problem}") from None
    config.pluginmanager.register(PytestSession(config, suite, named), "omegadot-session")


class PytestSession:
    """One session. named: node ids, or the beginnings of some, that are to be run alone."""

    def __init__(self, config: pytest.Config, suite: Suite, named: tuple[str, ...]) -> None:
        self.config, self.suite, self.named = config, suite, named
        self.tally = Tally()
        self.remarks: list[str] = []

    def pytest_report_header(self) -> list[str]:
        """Engines, versions and coverage."""
        lines = coverage(self.suite.registry.subjects, self.suite.checks)
        lines += [f"{name}: {how}" for name, (how, _) in self.suite.registry.missing.items()]
        return [f"omegadot: {line}" for line in lines]

    @pytest.hookimpl(tryfirst=True)
    def pytest_collection_modifyitems(
        self, session: pytest.Session, items: list[pytest.Item]
    ) -> None:
        """Add the checks, before the options that select among items look at them."""
        below = tuple(f"{name}::" for name in self.named)
        for item in collect(self.suite, session):
            if not self.named or f"{item.nodeid}::".startswith(below):
                items.append(item)

    @pytest.hookimpl(optionalhook=True)
    def pytest_configure_node(self, node: Any) -> None:
        """Give what the engines reported to a worker of xdist, so that all collect the same."""
        node.workerinput[SHARED] = REGISTRY.dump_json(self.suite.registry).decode()

    @pytest.hookimpl(optionalhook=True)
    def pytest_testnodedown(self, node: Any) -> None:
        """Take the figures that a worker of xdist has measured."""
        for engine, text in getattr(node, "workeroutput", {}).get(SHARED, {}).items():
            self.suite.figures.setdefault(engine, {}).update(from_text(text, engine))

    def pytest_runtest_logreport(self, report: pytest.TestReport) -> None:
        """Count a check by its engine."""
        properties = dict(report.user_properties)
        if report.when == "call" and report.nodeid.startswith(f"{ROOT}::") and ENGINE in properties:
            verdict, message = str(properties[VERDICT]), str(properties.get(MESSAGE, ""))
            self.tally.add(str(properties[ENGINE]), str(properties[GATE]), verdict, message)

    @pytest.hookimpl(tryfirst=True)
    def pytest_sessionfinish(self, session: pytest.Session) -> None:
        """End the engines, store the figures, and fail where an engine was skipped throughout."""
        self.suite.finish()
        if hasattr(self.config, "workeroutput"):
            texts = {name: to_text(name, found) for name, found in self.suite.figures.items()}
            self.config.workeroutput[SHARED] = texts
            return
        self.remarks += [f"baseline written: {path}" for path in self.suite.store()]
        named = [choice.name for choice in self.suite.selection.choices if choice.required]
        idle = self.tally.only_skipped(named)
        self.remarks += idle
        if idle and session.exitstatus in (pytest.ExitCode.OK, pytest.ExitCode.NO_TESTS_COLLECTED):
            session.exitstatus = pytest.ExitCode.TESTS_FAILED

    def pytest_terminal_summary(self, terminalreporter: Any) -> None:
        """State what was stored, and which engine was skipped throughout."""
        if self.remarks:
            terminalreporter.section("omegadot")
            for remark in self.remarks:
                terminalreporter.line(remark)

    def pytest_unconfigure(self) -> None:
        """End the engines, however the session ended."""
        self.suite.finish()
