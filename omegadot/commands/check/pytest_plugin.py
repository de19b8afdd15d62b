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


def _repeatable(metavar: str, text: str) -> dict[str, Any]:
    return {"action": "append", "metavar": metavar, "help": text}


PREFIX = "--omegadot-"
OPTIONS: dict[str, dict[str, Any]] = {
    "engine": _repeatable("NAME[:INTEGRATOR]", "check this engine; repeatable"),
    "adapter": _repeatable("FILE|module:Class", "check an engine of your own; repeatable"),
    "require-engine": _repeatable(
        "NAME", "check this engine, and fail where it is missing; repeatable"
    ),
    "scenario": _repeatable(
        "NAME|FILE",
        "check on this scenario; repeatable; default: every built-in, and random systems",
    ),
    "baseline": {"metavar": "DIR", "help": "compare with the values stored in DIR"},
    "update-baseline": {"action": "store_true", "help": "store the measured values in DIR instead"},
    "exceptions": _repeatable("FILE", "known failures, declared in TOML; repeatable"),
}
# With long names only, and no reason to start.
SETTINGS: dict[str, dict[str, Any]] = {
    "timeout": {
        "type": float,
        "metavar": "S",
        "default": 60.0,
        "help": "limit for one request to an engine in s (60)",
    },
    "random": {
        "type": int,
        "metavar": "N",
        "help": "random systems (24, or none where a scenario is given)",
    },
    "seed": {"type": int, "metavar": "N", "default": 0, "help": "seed of random systems (0)"},
}
HELP = ("-h", "--help")


def dest_of(name: str) -> str:
    """The name under which an option's value is kept."""
    return "omegadot_" + name.replace("-", "_")


def pytest_addoption(parser: pytest.Parser) -> None:
    """Add the long names."""
    group = parser.getgroup("omegadot", "checks of rigid-body engines")
    for name, how in {**OPTIONS, **SETTINGS}.items():
        group.addoption(PREFIX + name, dest=dest_of(name), **how)


def _is_free(option: str, parser: pytest.Parser) -> bool:
    """Whether no one has taken an option: it is then unknown to the parser."""
    try:
        return option in parser.parse_known_and_unknown_args([option, "0"])[1]
    except pytest.UsageError:  # the option is known, and its value is refused
        return False


def _is_typed(config: pytest.Config) -> bool:
    """Whether an option of ours was typed, and does not come from a configuration file."""
    options = tuple(f"{start}{name}" for name in OPTIONS for start in ("--", PREFIX))
    typed = [str(arg).partition("=")[0] for arg in config.invocation_params.args]
    return any(argument in options for argument in typed)


@pytest.hookimpl(hookwrapper=True)
def pytest_load_initial_conftests(
    early_config: pytest.Config, parser: pytest.Parser, args: list[str]
) -> Iterator[None]:
    """Add the short names that are used, when all others have added theirs."""
    yield
    group = parser.getgroup("omegadot")
    help_requested = any(argument in args for argument in HELP)
    for name, how in OPTIONS.items():
        used = any(argument.partition("=")[0] == f"--{name}" for argument in args)
        if (help_requested or used) and _is_free(f"--{name}", parser):
            group.addoption(f"--{name}", dest=dest_of(name), **how)


@pytest.hookimpl(trylast=True)
def pytest_configure(config: pytest.Config) -> None:
    """Start only where an option of ours is given."""
    given = {name: config.getoption(dest_of(name), None) for name in (*OPTIONS, *SETTINGS)}
    if any(given[name] for name in OPTIONS):
        from omegadot.commands.check.pytest_session import start_session

        start_session(config, given, _is_typed(config))
