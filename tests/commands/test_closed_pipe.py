"""A reader that leaves before the end, as ``| head -1``: no message, and the true verdict."""

import os
import subprocess
from pathlib import Path

import pytest
from command_line import PROGRAM, WRONG, omegadot, quick_scenario

from omegadot.commands.cli import app
from omegadot.reports.record.record import FILES, read_record

COMMANDS = [command.callback.__name__ for command in app.registered_commands if command.callback]
TRACE = "t,qw,qx,qy,qz\n0,1,0,0,0\n0.5,0.9,0.4,0.1,0.1\n1,0.8,0.6,0,0\n"


def unread(*arguments: object, folder: Path, errors_too: bool = False) -> tuple[int, str]:
    """Exit code and standard error of a command whose output's reader has left before it starts."""
    reading, writing = os.pipe()
    os.close(reading)
    command = [*PROGRAM, *map(str, arguments)]
    errors = writing if errors_too else subprocess.PIPE
    try:
        done = subprocess.run(
            command, cwd=folder, stdout=writing, stderr=errors, text=True, check=False
        )
    finally:
        os.close(writing)
    return done.returncode, done.stderr or ""


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    quick_scenario(tmp_path)
    (tmp_path / "trace.csv").write_text(TRACE, encoding="utf-8")
    return tmp_path


@pytest.mark.parametrize("name", COMMANDS)
def test_every_command_ends_in_silence(name: str, tmp_path: Path) -> None:
    """Caught: exit code 3, an engine's failure, and 1, a failing gate, of what is no failure."""
    assert unread(name, "--help", folder=tmp_path) == (0, "")


@pytest.mark.parametrize(
    ("arguments", "code"),
    [
        (("run", "quick.toml", "--engine", "reference:lie-rk4", "--out", "out"), 0),
        (("run", "quick.toml", "--engine", f"{WRONG}:NoGyroscopic", "--out", "out"), 1),
        (("check", f"{WRONG}:NoGyroscopic", "--scenario", "quick.toml"), 1),
        (("check", "reference", "--integrator", "lie-rk4", "--scenario", "quick.toml"), 0),
        (("score", "trace.csv", "--scenario", "quick.toml", "--attitude", "1deg"), 1),
        (("engines",), 0),
        (("scenarios", "--format", "json"), 0),
    ],
    ids=str,
)
def test_the_exit_code_is_the_verdict(
    arguments: tuple[object, ...], code: int, folder: Path
) -> None:
    assert unread(*arguments, folder=folder) == (code, "")
    if arguments[0] == "run":
        assert {path.name for path in (folder / "out").iterdir()} == set(FILES)
        assert read_record(folder / "out").run["complete"]


def test_wrong_input_is_still_reported(folder: Path) -> None:
    code, errors = unread("run", "nowhere", folder=folder)
    assert code == 2
    assert errors.startswith("omegadot: 'nowhere' is neither")
    assert unread("run", "nowhere", folder=folder, errors_too=True) == (2, "")


def test_a_line_that_was_read_is_whole(folder: Path) -> None:
    script = '("$@"; echo $? >code) | head -1'
    shell = ["sh", "-c", script, "sh", *PROGRAM, "scenarios"]
    done = subprocess.run(shell, cwd=folder, capture_output=True, text=True, check=False)
    assert done.stdout.startswith("damped-tumble")
    assert done.stderr == ""
    assert (folder / "code").read_text() == "0\n"


def test_help_lists_the_codes_of_signals(folder: Path) -> None:
    for arguments in ((), *((name,) for name in COMMANDS)):
        shown = " ".join(omegadot(*arguments, "--help", folder=folder).out.split())
        assert "Exit codes: 0" in shown, arguments
        for code in ("130 interrupted", "143 terminated", "129 terminal closed"):
            assert code in shown, arguments
        if arguments:  # Caught: what all commands share, above a command's own arguments
            assert shown.index("Options:") < shown.index("130 interrupted")
