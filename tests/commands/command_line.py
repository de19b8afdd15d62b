"""The command line as a user has it: a process of its own, and what it leaves behind."""

from __future__ import annotations

import json
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path
from typing import Any

ENGINES = Path(__file__).parent.parent / "wrong_engines"
FAULTY = ENGINES / "faulty.py"
WRONG = ENGINES / "wrong.py"
PROGRAM = [sys.executable, "-c", "from omegadot.commands.cli import main; main()"]


@dataclass(frozen=True)
class Result:
    """How a command ended and what it printed."""

    code: int
    out: str
    err: str

    @property
    def json(self) -> Any:
        """What it printed, as JSON."""
        return json.loads(self.out)


def omegadot(*arguments: object, folder: Path) -> Result:
    """Run ``omegadot`` in `folder`."""
    command = [*PROGRAM, *map(str, arguments)]
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)
    return Result(done.returncode, done.stdout, done.stderr)


QUICK = """
schema = 1
name = "quick"
title = "A quick tumble"
[body]
mass = 2.0
inertia = [1.0, 2.0, 2.5]
[initial]
angular_velocity = [0.3, 2.0, 0.1]
[run]
duration = 1.0
timesteps = [0.02, 0.01, 0.005]
sample = 0.02
"""


def quick_scenario(folder: Path, text: str = QUICK, name: str = "quick.toml") -> Path:
    """A small scenario file in `folder`."""
    path = folder / name
    path.write_text(text, encoding="utf-8")
    return path
