"""An EOFError, as of a compiled module that is cut off, is no interruption."""

import py_compile
import subprocess
import sys
from pathlib import Path

import pytest
from command_line import omegadot

IN_THE_COMMAND = """
import sys

class CutOff:
    def find_spec(self, name, path, target=None):
        if name == "omegadot.commands.check.check":
            raise EOFError("marshal data too short")

sys.meta_path.insert(0, CutOff())
from omegadot.commands.cli import main
main()
"""
AS_IT_STARTS = IN_THE_COMMAND.replace("commands.check.check", "commands.cli").replace(
    "from omegadot.commands.cli", "from omegadot.__main__"
)
ADAPTER = """
from omegadot.adapters.reference import ReferenceAdapter

class Early(ReferenceAdapter):
    def forward_dynamics(self, states):
        raise EOFError("the table ends early")
"""


@pytest.mark.parametrize(
    ("program", "start"),
    [
        (IN_THE_COMMAND, "omegadot: raised: EOFError: marshal data too short at "),
        (AS_IT_STARTS, "omegadot: could not be started: EOFError: marshal data too short; "),
    ],
)
def test_a_module_of_ours_that_is_cut_off(program: str, start: str) -> None:
    """Caught: "interrupted.", which the parser makes of it."""
    command = [sys.executable, "-c", program, "check", "reference", "--scenario", "sphere"]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 3
    assert done.stderr.strip().startswith(start)
    assert "__pycache__" in done.stderr
    assert "interrupted" not in done.stderr


def test_an_adapter_that_raises_it(tmp_path: Path) -> None:
    (tmp_path / "early.py").write_text(ADAPTER)
    how = ("--scenario", "sphere", "--integrator", "lie-rk4")
    result = omegadot("check", "early.py:Early", *how, folder=tmp_path)
    assert result.code == 3
    assert "raised: EOFError: the table ends early (early.py:6)" in result.out


def test_a_module_of_the_engine_that_is_cut_off(tmp_path: Path) -> None:
    """Caught: a line of Python's own machinery, which names no file of the reader's."""
    (tmp_path / "table.py").write_text("NUMBERS = list(range(3))\n")
    compiled = Path(py_compile.compile(str(tmp_path / "table.py")) or "")
    compiled.write_bytes(compiled.read_bytes()[:40])
    (tmp_path / "early.py").write_text(f"import table\n{ADAPTER}")
    result = omegadot("check", "early.py:Early", "--scenario", "sphere", folder=tmp_path)
    assert result.code == 3
    assert "ERROR  early-start\n    raised: EOFError: " in result.out
    assert "(early.py:1)" in result.out
