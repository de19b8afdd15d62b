"""The pytest plugin: ``pytest --engine NAME`` runs an engine's checks, without any test file.

Without one of its options it does nothing and imports nothing. The long names,
``--omegadot-engine`` and so on, are always there. The short ones are added when they are used,
after every other plugin and conftest has added its own; where one of those has taken a name, it
keeps it.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import pytest

PREFIX = "--omegadot-"
OPTIONS: dict[str, dict[str, Any]] = {
    "engine": {
        "action": "append",
        "metavar": "NAME[:INTEGRATOR]",
        "help": "check this engine; repeatable",
    },
    "adapter": {
        "action": "append",
        "metavar": "FILE|module:Class",
        "help": "check an engine of your own; repeatable",
    },
    "require-engine": {
        "action": "append",
        "metavar": "NAME",
        "help": "check this engine, and fail where it is missing; repeatable",
    },
    "scenario": {
        "action": "append",
        "metavar": "NAME|FILE",
        "help": "check on this scenario; repeatable; default: every built-in",
    },
    "baseline": {"metavar": "DIR", "help": "compare with the figures stored in DIR"},
    "update-baseline": {"action": "store_true", "help": "store the figures in DIR instead"},
    "exceptions": {
        "action": "append",
        "metavar": "FILE",
        "help": "known failures, declared in TOML; repeatable",
    },
}
TIMEOUT = {"type": float, "metavar": "S", "default": 60.0}
HELP = ("-h", "--help")


def dest_of(name: str) -> str:
    """The name under which an option's value is kept."""
    return "omegadot_" + name.replace("-", "_")


def pytest_addoption(parser: pytest.Parser) -> None:
    """Add the long names."""
    group = parser.getgroup("omegadot", "checks of rigid-body engines")
    for name, how in OPTIONS.items():
        group.addoption(PREFIX + name, dest=dest_of(name), **how)
    said = "limit for one request to an engine in s (60)"
    group.addoption(PREFIX + "timeout", dest=dest_of("timeout"), help=said, **TIMEOUT)


def _is_among(option: str, args: list[str]) -> bool:
    return any(arg == option or arg.startswith(f"{option}=") for arg in args)


def _is_free(option: str, parser: pytest.Parser) -> bool:
    """Whether nobody has taken an option: it is then unknown to the parser."""
    try:
        return option in parser.parse_known_and_unknown_args([option, "0"])[1]
    except pytest.UsageError:  # somebody knows it, and does not like its value
        return False


@pytest.hookimpl(hookwrapper=True)
def pytest_load_initial_conftests(
    early_config: pytest.Config, parser: pytest.Parser, args: list[str]
) -> Iterator[None]:
    """Add the short names that are used, when all others have added theirs."""
    yield
    group = parser.getgroup("omegadot")
    asked_for_help = any(word in args for word in HELP)
    for name, how in OPTIONS.items():
        wanted = asked_for_help or _is_among(f"--{name}", args)
        if wanted and _is_free(f"--{name}", parser):
            group.addoption(f"--{name}", dest=dest_of(name), **how)


@pytest.hookimpl(trylast=True)
def pytest_configure(config: pytest.Config) -> None:
    """Start only where an option of ours is given."""
    if any(config.getoption(dest_of(name), None) for name in OPTIONS):
        from omegadot.harness.checks.pytest_door import open_door

        open_door(config)
