"""Which class an engine of one's own is: a file, a module, or the class itself."""

from __future__ import annotations

import ast
import importlib.util
import sys
from collections.abc import Container
from pathlib import Path

from omegadot.adapters.registry import OURS
from omegadot.harness.usage import UsageError

EngineLike = str | type[object]
"""``NAME``, ``NAME:INTEGRATOR``, ``FILE.py``, ``FILE.py:Class``, ``module:Class``, or a class."""


def is_target(engine: EngineLike, known: Container[str]) -> bool:
    """Whether an engine is given by its class, not by one of the names known."""
    if not isinstance(engine, str):
        return True
    left, separator, right = engine.rpartition(":")
    if not separator or left in known:
        return right.endswith(".py")
    package = left.partition(".")[0]
    named = package.isidentifier() and package != "__main__"
    return left.endswith(".py") or (named and importlib.util.find_spec(package) is not None)


def target_of(engine: EngineLike) -> str:
    """``FILE.py:Class`` or ``module:Class``, which an engine's own process can import.

    A file alone is given its adapter's class. Raises UsageError.
    """
    if not isinstance(engine, str):
        return _target_of_class(engine)
    if "\0" in engine:
        raise UsageError(f"{engine}: no file has a null character in its name; check the path.")
    if engine.endswith(".py"):
        return f"{engine}:{_class_in(Path(engine))}"
    file, _, name = engine.rpartition(":")
    if file.endswith(".py") and not Path(file).is_file():
        raise UsageError(f"{file}: no such adapter file; check the path.")
    if not name or ".py:" in file:
        raise UsageError(f"{engine}: not one class of one file; give FILE.py:Class.")
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


def _class_in(path: Path) -> str:
    """The adapter in a file: the only class named ...Adapter, or the only class."""
    try:
        body = ast.parse(path.read_text(encoding="utf-8")).body
    except OSError:
        raise UsageError(f"{path}: no such adapter file; check the path.") from None
    except SyntaxError as error:
        raise UsageError(f"{path}, line {error.lineno}: {error.msg}; correct it.") from None
    except ValueError:  # a null byte, or no UTF-8
        raise UsageError(f"{path}: not a Python file; give FILE.py:Class.") from None
    names = [node.name for node in body if isinstance(node, ast.ClassDef)]
    named = [name for name in names if name.endswith("Adapter")] or names
    if len(named) != 1:
        found = ", ".join(named) or "no class"
        raise UsageError(f"{path}: which class is the adapter? It has {found}; give FILE.py:Class.")
    return named[0]
