"""Checks as pytest's items: ``omegadot::SCENARIO::CHECK``."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

import pytest

from omegadot.commands.check.judge import to_read
from omegadot.commands.check.result import Check
from omegadot.commands.check.suite import Suite

ROOT = "omegadot"
OF_THE_ENGINE = "engines"
ENGINE, GATE, VERDICT, MESSAGE = "engine", "gate", "verdict", "message"


class CheckFailedError(Exception):
    """A check failed, or the engine did not answer; the message is complete."""


class ScenarioNode(pytest.Collector):
    """The checks of one scenario, which is run once for all of them."""

    def __init__(self, *, checks: Sequence[Check], suite: Suite, **rest: Any) -> None:
        super().__init__(**rest)
        self.checks, self.suite = checks, suite

    def collect(self) -> Iterator[CheckItem]:
        """An item for every check."""
        grouped = self.config.pluginmanager.hasplugin("xdist")
        for check in self.checks:
            item = CheckItem.from_parent(self, name=check.id, check=check, suite=self.suite)
            if grouped:
                item.add_marker(pytest.mark.xdist_group(self.name))
            yield item


class CheckItem(pytest.Item):
    """One check."""

    def __init__(self, *, check: Check, suite: Suite, **rest: Any) -> None:
        super().__init__(**rest)
        self.check, self.suite = check, suite

    def runtest(self) -> None:
        """Request the result: the scenario is run when its first check is."""
        result = self.suite.result_of(self.check).settled
        # Properties travel with the report, also from another process, and stand in JUnit's file.
        named = ((ENGINE, self.check.engine), (GATE, self.check.gate))
        self.user_properties += (*named, (VERDICT, result.verdict))
        if result.verdict == "skip":
            self.user_properties.append((MESSAGE, result.message))
            pytest.skip(result.message)
        if result.verdict == "declared":
            pytest.xfail(result.message)
        if result.verdict != "pass":
            raise CheckFailedError(to_read(result.message))

    def repr_failure(self, excinfo: pytest.ExceptionInfo[BaseException], style: Any = None) -> Any:
        """The message alone: where in the harness it was raised helps no reader."""
        if isinstance(excinfo.value, CheckFailedError):
            return str(excinfo.value)
        return super().repr_failure(excinfo, style)

    def reportinfo(self) -> tuple[Path, None, str]:
        """Where it is, and the head above its failure."""
        return Path(ROOT), None, f"check {self.check.id}"


def collect(suite: Suite, session: pytest.Session) -> Iterator[CheckItem]:
    """Every check, below the node of its scenario, and reported as collected."""
    grouped: dict[str, list[Check]] = {}
    for check in suite.checks:
        grouped.setdefault(check.scenario or OF_THE_ENGINE, []).append(check)
    for name, checks in grouped.items():
        where = {"name": name, "nodeid": f"{ROOT}::{name}"}
        node = ScenarioNode.from_parent(session, **where, checks=checks, suite=suite)
        items: list[CheckItem] = list(node.collect())
        report = pytest.CollectReport(node.nodeid, "passed", None, [*items])
        session.ihook.pytest_collectreport(report=report)
        yield from items
