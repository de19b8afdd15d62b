"""Which part of PYTHONPATH an engine of one's own needs: a command that is printed states it."""

from __future__ import annotations

import ast
import os
from collections.abc import Mapping
from pathlib import Path

from omegadot.adapters.registry import OURS, PROGRAM

VARIABLE = "PYTHONPATH"


def setting_for(target: str, environment: Mapping[str, str] = os.environ) -> list[str]:
    """``["PYTHONPATH=lib"]`` to stand before a command, of the folders in which the engine's module
    is, or those that its file imports; none where nothing of it is found there.

    Windows' shells set no variable in this way.
    """
    folders = list(filter(None, environment.get(VARIABLE, "").split(os.pathsep)))
    if not folders or target in OURS.values() or target.startswith(PROGRAM) or os.name == "nt":
        return []
    names = _modules(target.rpartition(":")[0])
    needed = [folder for folder in folders if any(has_module(Path(folder), n) for n in names)]
    return [f"{VARIABLE}={os.pathsep.join(needed)}"] if needed else []


def has_module(folder: Path, name: str) -> bool:
    """Whether a module or a package of this name stands in a folder."""
    return (folder / f"{name}.py").is_file() or (folder / name).is_dir()


def _modules(module: str) -> set[str]:
    """The module's top package; of a file the top packages that it imports."""
    if not module.endswith(".py"):
        return {module.partition(".")[0]}
    try:
        tree = ast.parse(Path(module).read_text(encoding="utf-8-sig"))
    except (OSError, SyntaxError, ValueError):
        return set()
    named = [a.name for n in ast.walk(tree) if isinstance(n, ast.Import) for a in n.names]
    named += [n.module for n in ast.walk(tree) if isinstance(n, ast.ImportFrom) and n.module]
    return {name.partition(".")[0] for name in named}
