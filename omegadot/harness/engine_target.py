"""Which engine of one's own is meant: a class by its file or module, itself, or a program."""

from __future__ import annotations

import ast
import importlib.util
import os
import shutil
import sys
from collections.abc import Container
from pathlib import Path

from omegadot.adapters.command_line import (
    file_in_command,
    has_folder,
    name_in_command,
    own_name_of,
    program_of,
)
from omegadot.adapters.registry import OURS, PROGRAM, AdapterError
from omegadot.harness.python_path import has_module
from omegadot.harness.usage import UsageError, nearest

EngineLike = str | type[object]
"""``NAME``, ``NAME:INTEGRATOR``, ``FILE.py``, ``FILE.py:Class``, ``module:Class``, a class, or the
command line of a program, ``./worker``, ``node worker.js`` or ``NAME=node worker.js``."""
GIVE = "give FILE.py:Class, module:Class or a program, as ./worker or 'node worker.js'"


def is_target(engine: EngineLike, known: Container[str]) -> bool:
    """Whether an engine is given by its class, not by one of the names known."""
    if not isinstance(engine, str):
        return True
    if engine in known:  # a file of this name may stand in the current folder
        return False
    if is_command(engine):
        return True
    left, separator, right = engine.rpartition(":")
    if not separator or left in known:
        return right.endswith(".py")
    package = left.partition(".")[0]
    named = package.isidentifier() and package != "__main__"
    return left.endswith(".py") or (named and _is_module(package))


def _is_module(package: str) -> bool:
    """Whether there is one, here or in the current folder, which an engine's process looks in."""
    return importlib.util.find_spec(package) is not None or has_module(Path(), package)


def is_command(engine: str) -> bool:
    """Whether it is a program: words, a file that is no Python, or ``NAME=PROGRAM``."""
    if engine.startswith(PROGRAM):
        return True
    file = engine if engine.endswith(".py") else engine.rpartition(":")[0]
    if "\0" in engine or (file.endswith(".py") and Path(file).is_file()):
        return False
    words = engine.split()
    return len(words) > 1 or (len(words) == 1 and _is_program(engine))


def _is_program(word: str) -> bool:
    """Whether one word is a program; a program that is not there is one, and then refused."""
    name, sign, program = word.partition("=")
    named = bool(sign) and not has_folder(name) and ":" not in name
    if word.endswith(".py") or ".py:" in word:
        return named and shutil.which(program) is not None
    return named or os.path.isfile(word) or (has_folder(word) and ":" not in word)


def name_of(target: str) -> str:
    """The engine's name: the class's, in small letters without Adapter; of a program the name
    before ``=``, or else that of the last file in its command line, without its suffix.
    """
    if not target.startswith(PROGRAM):
        return target.rpartition(":")[2].removesuffix("Adapter").lower()
    command = target.removeprefix(PROGRAM)
    return name_in_command(command) or own_name_of(command)


def file_of(target: str) -> Path | None:
    """The file in which an engine of one's own stands; None where a module is named."""
    if target.startswith(PROGRAM):
        return file_in_command(target.removeprefix(PROGRAM))
    module = target.rpartition(":")[0]
    return Path(module) if module.endswith(".py") else None


def target_of(engine: EngineLike) -> str:
    """``FILE.py:Class``, ``module:Class`` or ``command:PROGRAM ...``, as an engine's own process
    takes it.

    A file alone is given its adapter's class. Raises UsageError.
    """
    if not isinstance(engine, str):
        return _target_of_class(engine)
    if "\0" in engine:
        raise UsageError(f"{engine}: no file has a null character in its name; check the path.")
    if is_command(engine):
        command = engine.removeprefix(PROGRAM)
        if engine == command and os.path.isfile(engine) and not has_folder(engine):
            command = os.path.join(os.curdir, engine)  # not one of this name on the path
        try:
            program_of(command)
        except AdapterError as error:
            raise UsageError(str(error)) from None
        return PROGRAM + command
    if engine.endswith(".py"):
        return f"{engine}:{_class_in(Path(engine))}"
    file, separator, name = engine.rpartition(":")
    if not separator:
        raise UsageError(f"{engine}: no class is named; {GIVE}.")
    if file.endswith(".py") and not Path(file).is_file():
        raise UsageError(f"{file}: no such adapter file; check the path.")
    if not name or ".py:" in file:
        raise UsageError(f"{engine}: not one class of one file; give FILE.py:Class.")
    if file.endswith(".py"):
        _check_name_in(Path(file), name)
    return engine


def _target_of_class(engine: object) -> str:
    if not isinstance(engine, type):
        raise UsageError(
            f"{engine!r}: not an engine; give a name, FILE.py:Class, module:Class or a class."
        )
    module, name = engine.__module__, engine.__qualname__
    if f"{module}:{name}" in OURS.values():
        return f"{module}:{name}"
    file = getattr(sys.modules.get(module), "__file__", None)
    if module == "__main__" or "." in name or file is None:
        raise UsageError(
            f"{name}: this class is defined in {_where(module, name)}, and an engine runs in a "
            "process of its own, which cannot import it from there; put the class into a file and "
            f"give FILE.py:{engine.__name__}, or import it from that file."
        )
    # A module that stands alone is named by its file: the other process has its own search path.
    return f"{module}:{name}" if "." in module else f"{Path(file).resolve()}:{name}"


def _where(module: str, name: str) -> str:
    if "<locals>" in name:
        return "a function"
    return "a notebook or the script itself" if module == "__main__" else "another class"


def _check_name_in(path: Path, name: str) -> None:
    """Raise UsageError where a file plainly has no such class; one with errors is not judged."""
    try:
        body = ast.parse(path.read_text(encoding="utf-8-sig")).body
    except (OSError, SyntaxError, ValueError):
        return
    bound = {alias.asname or alias.name for node in body for alias in getattr(node, "names", ())}
    names = [node.name for node in body if isinstance(node, ast.ClassDef)]
    plain = all(isinstance(n, ast.ClassDef | ast.Import | ast.ImportFrom | ast.Expr) for n in body)
    if plain and names and name not in names and not bound & {name, "*"}:
        raise UsageError(f"{path}: there is no class {name}; {nearest(name, names)}.")


def _class_in(path: Path) -> str:
    """The adapter in a file: the only class named ...Adapter, or the only class."""
    names = [node.name for node in _parsed(path) if isinstance(node, ast.ClassDef)]
    named = [name for name in names if name.endswith("Adapter")] or names
    if len(named) != 1:
        found = ", ".join(named) or "no class"
        raise UsageError(f"{path}: which class is the adapter? It has {found}; give FILE.py:Class.")
    return named[0]


def _parsed(path: Path) -> list[ast.stmt]:
    """The statements of a file of Python. Raises UsageError where it is none."""
    try:
        return ast.parse(path.read_text(encoding="utf-8-sig")).body
    except OSError:
        raise UsageError(f"{path}: no such adapter file; check the path.") from None
    except SyntaxError as error:
        raise UsageError(f"{path}, line {error.lineno}: {error.msg}; correct it.") from None
    except ValueError:  # a null byte, or no UTF-8
        raise UsageError(f"{path}: not a Python file; give FILE.py:Class.") from None
