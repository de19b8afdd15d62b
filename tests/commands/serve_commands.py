"""A process that has imported the package, and forks itself for each command line it is sent.

A command has arguments, a folder, an environment and streams of its own, and ends as a program
does. It is spared the imports, which take most of the processor time of a small command. Started
as a script, with the number of its socket.
"""

from __future__ import annotations

import atexit
import gc
import importlib
import json
import os
import socket
import sys
import threading
from typing import Any

import pytest
from _pytest.config import default_plugins

from omegadot.commands.cli import main

# What the commands import when they are called; engines are left to the workers.
LOADED = (
    *(f"omegadot.commands.{name}.{name}" for name in ("check", "choose", "compare", "engines")),
    *(f"omegadot.commands.{name}.{name}" for name in ("fit", "report", "run", "schemes", "score")),
    *("omegadot.commands.versions.versions", "pyarrow.parquet", "scipy.optimize"),
    *(f"_pytest.{name}" for name in default_plugins),
)
PROGRAMS = {"omegadot": main, "pytest": pytest.console_main}


def serve(channel: socket.socket) -> None:
    """Answer each command line with its exit code, until the other end is closed."""
    for name in LOADED:
        importlib.import_module(name)
    gc.freeze()
    while True:
        message, streams, _, _ = socket.recv_fds(channel, 1 << 20, 2)
        if not message:
            return
        child = os.fork()
        if child == 0:
            channel.close()
            run_command(json.loads(message), streams)
        for stream in streams:
            os.close(stream)
        code = os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])
        channel.send(str(code).encode())


def run_command(received: dict[str, Any], streams: list[int]) -> None:
    """Be this command, and end."""
    for number, stream in enumerate(streams, 1):
        os.dup2(stream, number)
        os.close(stream)
    os.chdir(received["folder"])
    os.environ.clear()
    os.environ.update(received["environment"])
    # As -c and -m have them.
    sys.path[0] = "" if received["program"] == "omegadot" else os.getcwd()
    sys.argv[:] = ["-c", *received["arguments"]]
    code: Any = 0
    try:
        code = PROGRAMS[received["program"]]()
    except SystemExit as end:
        code = end.code
    except BaseException:
        sys.excepthook(*sys.exc_info())
        code = 1
    threading._shutdown()
    atexit._run_exitfuncs()
    for stream in (sys.stdout, sys.stderr):
        stream.flush()
    # The interpreter's own end would take every module apart, in memory that is copied for it.
    os._exit(int(code or 0))


if __name__ == "__main__":
    serve(socket.socket(fileno=int(sys.argv[1])))
