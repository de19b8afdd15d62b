"""The command line as a user has it: a process of its own, and what it leaves behind."""

from __future__ import annotations

import atexit
import json
import os
import socket
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from functools import cache
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
    """Run ``omegadot`` in `folder`: as a fork of a process that has imported it, where one may.

    What is wrong with the imports themselves is seen by the tests that start `PROGRAM`.
    """
    words = list(map(str, arguments))
    if may_be_forked():
        return forked("omegadot", words, folder)
    command = [*PROGRAM, *words]
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)
    return Result(done.returncode, done.stdout, done.stderr)


def environment() -> dict[str, str]:
    """What a command is started with: nothing of what pytest tells the programs of its tests."""
    return {name: text for name, text in os.environ.items() if not name.startswith("PYTEST_")}


def _read_at_start() -> dict[str, str]:
    """Variables that the interpreter and the package read as they start; a fork has read them."""
    first = ("PYTHON", "OMEGADOT", "LC_", "LANG", "COV")
    return {name: text for name, text in os.environ.items() if name.startswith(first)}


AT_START = _read_at_start()


def may_be_forked() -> bool:
    """Not where coverage is measured, nor where the interpreter would start up otherwise."""
    untraced = not any(name.startswith("COV") for name in AT_START)
    return hasattr(os, "fork") and untraced and _read_at_start() == AT_START


@cache
def _server() -> socket.socket:
    """The channel to the process that forks, which ends when this one does, however it does."""
    ours, theirs = socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)
    script, number = Path(__file__).with_name("serve_commands.py"), theirs.fileno()
    command = [sys.executable, str(script), str(number)]
    started = subprocess.Popen(
        command,
        pass_fds=[number],
        env=environment(),
        stdin=subprocess.DEVNULL,
        stdout=subprocess.DEVNULL,
    )
    theirs.close()
    atexit.register(started.wait)
    atexit.register(ours.close)  # first: the last registered is the first called
    return ours


def forked(program: str, words: list[str], folder: Path) -> Result:
    """Run ``omegadot`` or ``pytest`` in `folder`, as a fork of a process that has imported it."""
    channel = _server()
    pipes = [os.pipe() for _ in range(2)]
    message: dict[str, Any] = {"program": program, "arguments": words, "folder": str(folder)}
    message["environment"] = environment()
    socket.send_fds(channel, [json.dumps(message).encode()], [end for _, end in pipes])
    for _, end in pipes:
        os.close(end)
    with ThreadPoolExecutor(2) as readers:
        out, err = readers.map(_read, (end for end, _ in pipes))
    return Result(int(channel.recv(16)), out, err)


def _read(pipe: int) -> str:
    """All that is written to it, by a command and whatever it has started."""
    with open(pipe, encoding="utf-8") as text:
        return text.read()


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
