"""Commands that are printed can be copied: how omegadot was started, and what an engine needs."""

import io
import os
import shlex
import subprocess
import sys
from pathlib import Path

import pytest
from command_line import WRONG, omegadot, quick_scenario

from omegadot.commands import options
from omegadot.commands.streams import ERRORS
from omegadot.harness.arguments import engine_choices
from omegadot.harness.engine_target import is_target
from omegadot.harness.python_path import VARIABLE, setting_for
from omegadot.reports.summary.next_command import is_check
from omegadot.reports.summary.provenance import program_of, requested_scenarios

ENGINE = f"""
import sys
sys.path.append({str(WRONG.parent)!r})
from wrong import NoGyroscopic
"""


def started(monkeypatch: pytest.MonkeyPatch, *words: str) -> list[str]:
    monkeypatch.setattr(sys, "argv", [*words, "check", "mine"])
    return options.program()


def test_a_command_begins_as_omegadot_was_started(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Caught: "omegadot check", which no shell finds where it was typed as .venv/bin/omegadot."""
    script = tmp_path / ".venv" / "bin" / "omegadot"
    script.parent.mkdir(parents=True)
    script.write_text("#!/bin/sh\n")
    script.chmod(0o755)
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("PATH", os.defpath)
    assert started(monkeypatch, ".venv/bin/omegadot") == [".venv/bin/omegadot"]
    assert started(monkeypatch, str(script)) == [".venv/bin/omegadot"]
    monkeypatch.chdir(tmp_path / ".venv" / "bin")
    monkeypatch.setenv("PATH", str(script.parent))
    assert started(monkeypatch, str(script)) == ["omegadot"]
    assert options.command_line() == ["omegadot", "check", "mine"]
    *python, dash, name = started(monkeypatch, "/where/omegadot/__main__.py")
    assert (dash, name, len(python)) == ("-m", "omegadot", 1)
    assert started(monkeypatch, "-c") == started(monkeypatch, "my_script.py") == ["omegadot"]


def test_what_of_pythonpath_an_engine_needs(tmp_path: Path) -> None:
    for name in ("lib", "more", "other"):
        (tmp_path / name).mkdir()
    (tmp_path / "lib" / "mine.py").write_text("class Mine: pass\n")
    (tmp_path / "more" / "table").mkdir()
    (tmp_path / "engine.py").write_text("import numpy\nfrom table.numbers import x\n")
    folders = [str(tmp_path / name) for name in ("lib", "more", "other")]
    path = {VARIABLE: os.pathsep.join(folders)}
    assert setting_for("mine:Mine", path) == [f"{VARIABLE}={folders[0]}"]
    assert setting_for(f"{tmp_path / 'engine.py'}:Mine", path) == [f"{VARIABLE}={folders[1]}"]
    assert setting_for("elsewhere:Mine", path) == []
    assert setting_for("mine:Mine", {}) == []
    assert setting_for("command:node mine.js", path) == []


def test_the_printed_command_fails_as_the_check_did(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Caught: a command without --via, --timeout or PYTHONPATH, which checks another thing."""
    lib = tmp_path / "lib"
    lib.mkdir()
    (lib / "mine.py").write_text(ENGINE)
    monkeypatch.setenv(VARIABLE, os.pathsep.join(filter(None, ["lib", os.environ.get(VARIABLE)])))
    how = ("--integrator", "semi-implicit-euler", "--timeout", "50", "--format", "json")
    quick = quick_scenario(tmp_path)
    found = omegadot("check", "mine:NoGyroscopic", "--scenario", quick, *how, folder=tmp_path)
    assert found.code == 1, found.err
    (one, *_) = found.json["failing"]
    setting, *words = shlex.split(one["command"])
    assert setting == f"{VARIABLE}=lib"
    assert words[:3] == ["omegadot", "check", "mine:NoGyroscopic"]
    assert words[-2:] == ["--scenario", "quick-shrunk.toml"]
    assert words[words.index("--timeout") + 1] == "50"
    assert words[words.index("--integrator") + 1] == "semi-implicit-euler"
    (tmp_path / "quick-shrunk.toml").write_text(one["scenario"])
    again = omegadot(*words[1:], "--no-shrink", folder=tmp_path)
    assert again.code == 1, again.err
    assert "the gyroscopic term is missing" in again.out


def test_a_module_of_the_current_folder_is_an_engine(tmp_path: Path) -> None:
    """Caught: "no such engine" of the installed command, whose own folder alone is searched."""
    (tmp_path / "mine.py").write_text(ENGINE)
    code = "from omegadot.commands.cli import main; main()"
    how = ["check", "mine:NoGyroscopic", "--no-shrink", "--scenario", str(quick_scenario(tmp_path))]
    command = [sys.executable, "-P", "-c", code, *how]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, check=False)
    assert (done.returncode, done.stderr) == (1, "")
    assert "the gyroscopic term is missing" in done.stdout


def test_a_file_called_as_its_engine_takes_no_integrators_name(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Caught: toy:rk4 of toy.py:ToyAdapter taken for a class rk4 of a module toy."""
    (tmp_path / "toy.py").write_text("class ToyAdapter: pass\n")
    monkeypatch.chdir(tmp_path)
    assert is_target("toy:ToyAdapter", ())
    (choice,) = engine_choices(["toy:rk4"], ["toy.py:ToyAdapter"])
    assert (choice.name, choice.integrators) == ("toy", ("rk4",))


def test_the_scenarios_of_a_run_are_those_of_its_options_too() -> None:
    """Caught: the name of a scenario in place of its file, which the next command needs."""
    words = ["PYTHONPATH=lib", "bin/omegadot", "run", "one.toml", "--scenario", "two.toml"]
    run = {"command": words, "scenarios": [{"name": "one"}, {"name": "two"}]}
    assert requested_scenarios(run) == {"one": "one.toml", "two": "two.toml"}
    assert program_of(run) == ["PYTHONPATH=lib", "bin/omegadot"]
    assert program_of({"command": []}) == ["omegadot"]
    assert is_check("python -m omegadot check run.py:Run")
    assert not is_check("omegadot run check")


def test_bytes_that_were_typed_are_printed_as_typed() -> None:
    """Caught: a path of a terminal without its letters as question marks, which no shell finds."""
    typed, out = os.fsencode("İlk.py").decode("ascii", "surrogateescape"), io.BytesIO()
    stream = io.TextIOWrapper(out, encoding="ascii", errors=ERRORS)
    stream.write(f"{typed} – 3 × ω")
    stream.flush()
    assert out.getvalue() == "İlk.py".encode() + b" - 3 x ?"
