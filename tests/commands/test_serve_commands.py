"""A forked command is the program's: what it prints and where, how it ends, and what it finds."""

from __future__ import annotations

import os
import subprocess
from pathlib import Path

import pytest
from command_line import PROGRAM, Result, forked, may_be_forked

pytestmark = pytest.mark.skipif(not hasattr(os, "fork"), reason="there are no forks")


def started(line: str, folder: Path) -> Result:
    done = subprocess.run(
        [*PROGRAM, *line.split()], cwd=folder, capture_output=True, text=True, check=False
    )
    return Result(done.returncode, done.stdout, done.stderr)


@pytest.mark.parametrize(
    ("line", "code"), [("scenarios", 0), ("run nowhere.toml", 2), ("check own.py:Own", 3)]
)
def test_it_prints_and_ends_as_the_program_does(line: str, code: int, tmp_path: Path) -> None:
    """Caught: streams, folder or code of another process."""
    (tmp_path / "own.py").write_text("import os\nos._exit(7)\n")
    found = forked("omegadot", line.split(), tmp_path)
    assert found.code == code
    assert found == started(line, tmp_path)
    assert not forked("omegadot", ["--version"], tmp_path).err  # nothing of the one before


def test_nothing_is_forked_in_another_environment(monkeypatch: pytest.MonkeyPatch) -> None:
    """Caught: an interpreter that has read PYTHONIOENCODING or OMEGADOT_EXTENDED before."""
    monkeypatch.setenv("PYTHONIOENCODING", "ascii")
    assert not may_be_forked()


def test_a_fork_has_the_environment_of_now(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    """Caught: a command that sees what was set as the first one was forked."""
    (tmp_path / "own.py").write_text("import os\nraise ValueError(os.environ['CARRIED'])\n")
    for text in ("this", "that"):
        monkeypatch.setenv("CARRIED", text)
        assert f"ValueError: {text}" in forked("omegadot", ["check", "own.py:Own"], tmp_path).out
