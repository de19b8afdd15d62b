"""An engine in another Python: the worker's command, with this omegadot lent to it."""

from __future__ import annotations

import shutil
from collections.abc import Mapping, Sequence

import omegadot
from omegadot.harness.usage import UsageError, nearest

# The package alone is lent. Were its parent put on the path, the engine that is installed next to
# it could be taken for the other one's.
_SERVE = """\
import importlib.util, sys
spec = importlib.util.spec_from_file_location("omegadot", {init!r})
sys.modules["omegadot"] = module = importlib.util.module_from_spec(spec)
spec.loader.exec_module(module)
from omegadot.workers.engine_end.worker import main
main()
"""


def worker_command(python: str) -> list[str]:
    """The command that serves an adapter under another interpreter, with NumPy, SciPy there."""
    return [python, "-c", _SERVE.format(init=omegadot.__file__)]


def interpreters(pairs: Sequence[str]) -> dict[str, str]:
    """The interpreters of ``NAME=PATH`` arguments, by engine. Raises UsageError."""
    found: dict[str, str] = {}
    for pair in pairs:
        name, separator, path = pair.partition("=")
        if not separator or not path:
            raise UsageError(f"--python {pair}: give NAME=PATH, an engine and its interpreter.")
        found[name] = path
    return found


def checked_interpreters(pythons: Mapping[str, str], engines: Sequence[str]) -> Mapping[str, str]:
    """The interpreters, each of one of the engines and a program. Raises UsageError."""
    for name, path in pythons.items():
        where = f"--python {name}={path}"
        if name not in engines:
            raise UsageError(
                f"{where}: {name!r} is not among the engines; {nearest(name, engines)}."
            )
        if shutil.which(path) is None:
            raise UsageError(f"{where}: {path} is no program; give a Python interpreter.")
    return pythons
