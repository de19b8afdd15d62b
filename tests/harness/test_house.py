"""The house: imports run one way, and the project speaks of itself alone."""

import ast
from pathlib import Path

import pytest

import omegadot

ROOT = Path(omegadot.__file__).parent
ALLOWED = {
    "scenarios": set(),
    "reference_impl": {"scenarios"},
    "adapters": {"reference_impl", "scenarios"},
    "reports": {"reference_impl", "scenarios"},
    "harness": {"reports", "adapters", "reference_impl", "scenarios"},
}
# What a worker beside one old engine must make do with.
THIRD_PARTY = {
    "scenarios": {"numpy", "scipy", "pydantic", "pydantic_core"},
    "reference_impl": {"numpy", "scipy"},
    "adapters": {"numpy", "scipy", "mujoco", "pinocchio", "dartpy"},
}
STANDARD = set(__import__("sys").stdlib_module_names)


def imported(file: Path) -> set[str]:
    """Dotted names of every module that a file imports, anywhere in it."""
    names: set[str] = set()
    for node in ast.walk(ast.parse(file.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            names |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom):
            assert node.level == 0, f"{file}: relative import"
            assert node.module is not None
            names.add(node.module)
    return names


def files_of(room: str) -> list[Path]:
    return sorted((ROOT / room).rglob("*.py"))


@pytest.mark.parametrize("room", ALLOWED)
def test_rooms_import_one_way(room: str) -> None:
    for file in files_of(room):
        for name in imported(file):
            parts = name.split(".")
            if parts[0] == "omegadot" and len(parts) > 1:
                assert parts[1] in {room, *ALLOWED[room]}, f"{file.name} imports {name}"


@pytest.mark.parametrize("room", THIRD_PARTY)
def test_lower_rooms_stay_small(room: str) -> None:
    for file in files_of(room):
        outside = {name.split(".")[0] for name in imported(file)} - STANDARD - {"omegadot"}
        assert outside <= THIRD_PARTY[room], f"{file.name} imports {outside}"


@pytest.mark.parametrize("engine", ["mujoco", "pinocchio", "dartpy"])
def test_engines_are_imported_in_functions_only(engine: str) -> None:
    for file in files_of("adapters"):
        for node in ast.parse(file.read_text(encoding="utf-8")).body:
            if isinstance(node, ast.Import | ast.ImportFrom):
                named = [a.name for a in node.names] + [getattr(node, "module", "") or ""]
                assert all(name.split(".")[0] != engine for name in named), file.name


def test_no_module_is_called_after_nothing() -> None:
    for file in ROOT.rglob("*.py"):
        assert file.stem not in {"utils", "helpers", "common", "misc"}
