"""pytest as a user has it who has installed omegadot: a process of its own in a folder."""

from __future__ import annotations

import subprocess
import sys
from importlib.metadata import entry_points
from pathlib import Path
from xml.etree import ElementTree

from command_line import Result, environment, forked, may_be_forked

PLUGIN = "omegadot.commands.check.pytest_plugin"


def plugin_arguments() -> list[str]:
    """What loads the plugin: nothing where its entry point is installed."""
    installed = any(point.value == PLUGIN for point in entry_points(group="pytest11"))
    return [] if installed else ["-p", PLUGIN]


def pytest_command() -> list[str]:
    """How pytest is started with this interpreter."""
    return [sys.executable, "-m", "pytest", *plugin_arguments()]


def run_pytest(*arguments: object, folder: Path, fresh: bool = False) -> Result:
    """Run pytest in `folder`, without a cache there.

    fresh: in an interpreter that has imported nothing yet.
    """
    words = ["-p", "no:cacheprovider", *map(str, arguments)]
    if may_be_forked() and not fresh:
        return forked("pytest", [*plugin_arguments(), *words], folder)
    done = subprocess.run(
        [*pytest_command(), *words],
        cwd=folder,
        capture_output=True,
        text=True,
        check=False,
        env=environment(),
    )
    return Result(done.returncode, done.stdout, done.stderr)


def outcomes(junit: Path) -> dict[str, str]:
    """Every test case of a JUnit file with its outcome: passed, failure, error, skipped, xfail."""
    found = {}
    for case in ElementTree.parse(junit).getroot().iter("testcase"):
        marks = [child for child in case if child.tag in ("failure", "error", "skipped")]
        outcome = marks[0].tag if marks else "passed"
        if marks and marks[0].get("type") == "pytest.xfail":
            outcome = "xfail"
        found[f"{case.get('classname')}.{case.get('name')}"] = outcome
    return found
