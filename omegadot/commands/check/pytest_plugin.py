"""The pytest plugin: ``pytest --engine NAME`` runs an engine's checks, without any test file.

Without one of its options it does nothing and imports nothing. The long names,
``--omegadot-engine`` and so on, are always there. The short ones are added when they are used,
after every other plugin and conftest has added its own; where one of those has taken a name, it
keeps it.
"""

from __future__ import annotations

from collections.abc import Iterator

import pytest

from omegadot.commands.check.pytest_options import OPTIONS, PREFIX, dest_of

TIMEOUT = {"type": float, "metavar": "S", "default": 60.0}
HELP = ("-h", "--help")


def pytest_addoption(parser: pytest.Parser) -> None:
    """Add the long names."""
    group = parser.getgroup("omegadot", "checks of rigid-body engines")
    for name, how in OPTIONS.items():
        group.addoption(PREFIX + name, dest=dest_of(name), **how)
    text = "limit for one request to an engine in s (60)"
    group.addoption(PREFIX + "timeout", dest=dest_of("timeout"), help=text, **TIMEOUT)


def _is_among(option: str, args: list[str]) -> bool:
    return any(arg == option or arg.startswith(f"{option}=") for arg in args)


def _is_free(option: str, parser: pytest.Parser) -> bool:
    """Whether no one has taken an option: it is then unknown to the parser."""
    try:
        return option in parser.parse_known_and_unknown_args([option, "0"])[1]
    except pytest.UsageError:  # the option is known, and its value is refused
        return False


@pytest.hookimpl(hookwrapper=True)
def pytest_load_initial_conftests(
    early_config: pytest.Config, parser: pytest.Parser, args: list[str]
) -> Iterator[None]:
    """Add the short names that are used, when all others have added theirs."""
    yield
    group = parser.getgroup("omegadot")
    help_requested = any(argument in args for argument in HELP)
    for name, how in OPTIONS.items():
        wanted = help_requested or _is_among(f"--{name}", args)
        if wanted and _is_free(f"--{name}", parser):
            group.addoption(f"--{name}", dest=dest_of(name), **how)


@pytest.hookimpl(trylast=True)
def pytest_configure(config: pytest.Config) -> None:
    """Start only where an option of ours is given."""
    if any(config.getoption(dest_of(name), None) for name in OPTIONS):
        from omegadot.commands.check.pytest_session import start_session

        start_session(config)
