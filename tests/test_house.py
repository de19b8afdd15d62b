"""The house: imports run downwards between the rooms, and in no circle between the files."""

import ast
import re
import sys
from graphlib import CycleError, TopologicalSorter
from pathlib import Path

import pytest

import omegadot

ROOT = Path(omegadot.__file__).parent
# From the ground up. A room imports from the rooms named, which are all above it in this list.
ROOMS = {
    "scenarios": set(),
    "reference_impl": {"scenarios"},
    "adapters": {"reference_impl", "scenarios"},
    "workers": {"adapters", "reference_impl", "scenarios"},
    "reports": {"reference_impl", "scenarios"},
    "gates": {"adapters", "reference_impl", "scenarios"},
    "harness": {"gates", "reports", "workers", "adapters", "reference_impl", "scenarios"},
    "diagnosis": {"harness", "gates", "workers", "adapters", "reference_impl", "scenarios"},
}
ROOMS["commands"] = set(ROOMS)
# What a worker that serves one old engine has with it.
THIRD_PARTY = {
    "scenarios": {"numpy", "scipy", "pydantic", "pydantic_core", "defusedxml"},
    "reference_impl": {"numpy", "scipy"},
    "adapters": {
        "numpy",
        "scipy",
        "mujoco",
        "pinocchio",
        "dartpy",
        "pydrake",
        "exudyn",
        "Basilisk",
        "opensim",
        "pybullet",
        "sapien",
        "jax",
        "jaxsim",
        "idyntree",
        "rapier3d",
        "biorbd",
    },
    "workers/engine_end": {"numpy", "scipy"},
}
STANDARD = set(sys.stdlib_module_names)


def module_of(file: Path) -> str:
    """The dotted name of a file of the package."""
    parts = file.relative_to(ROOT.parent).with_suffix("").parts
    return ".".join(parts[:-1] if parts[-1] == "__init__" else parts)


def imported(nodes: ast.AST) -> set[str]:
    """Dotted names of every module that is imported anywhere below a node."""
    names: set[str] = set()
    for node in ast.walk(nodes):
        if isinstance(node, ast.Import):
            names |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom):
            assert node.level == 0, "relative import"
            assert node.module is not None
            names |= {node.module, *(f"{node.module}.{alias.name}" for alias in node.names)}
    return names


def parsed(file: Path) -> ast.Module:
    return ast.parse(file.read_text(encoding="utf-8"))


def files_of(room: str) -> list[Path]:
    return sorted((ROOT / room).rglob("*.py"))


def test_every_folder_is_a_room() -> None:
    folders = {path.name for path in ROOT.iterdir() if (path / "__init__.py").is_file()}
    assert folders == set(ROOMS)


@pytest.mark.parametrize("room", ROOMS)
def test_rooms_import_downwards(room: str) -> None:
    for file in files_of(room):
        for name in imported(parsed(file)):
            parts = name.split(".")
            if parts[0] == "omegadot" and len(parts) > 1 and parts[1] in ROOMS:
                assert parts[1] in {room, *ROOMS[room]}, f"{file.name} imports {name}"


def test_no_circle_of_files() -> None:
    """Of all imports, those within functions too: a circle that is put off is one."""
    modules = {module_of(file): file for file in ROOT.rglob("*.py")}
    graph = {}
    for module, file in modules.items():
        named = imported(parsed(file)) & set(modules)
        # A package is named with every import from it; its own file depends on what it imports.
        graph[module] = {n for n in named if n != module and not module.startswith(f"{n}.")}
    try:
        tuple(TopologicalSorter(graph).static_order())
    except CycleError as error:
        pytest.fail(f"files import one another: {' -> '.join(error.args[1])}")


def test_the_harness_knows_of_reports_the_record_alone() -> None:
    for file in files_of("harness"):
        named = {name for name in imported(parsed(file)) if name.startswith("omegadot.reports.")}
        assert all(name.startswith("omegadot.reports.record") for name in named), file.name


def test_functions_print_nothing() -> None:
    """Scripts call them: what is typed, printed and exited with stands in files of its own."""
    for file in sorted((ROOT / "commands").glob("*/**/*.py")):
        if file.name.startswith("print_") or file.name == "command.py":
            continue
        tree = parsed(file)
        assert not {name.partition(".")[0] for name in imported(tree)} & {"typer", "rich"}, file
        named = {ast.unparse(node) for node in ast.walk(tree) if isinstance(node, ast.Attribute)}
        assert not named & {"sys.argv", "sys.exit", "sys.stdout.isatty", "sys.stderr.isatty"}, file
        called = {ast.unparse(n.func) for n in ast.walk(tree) if isinstance(n, ast.Call)}
        assert "print" not in called, file


@pytest.mark.parametrize("room", THIRD_PARTY)
def test_lower_rooms_stay_small(room: str) -> None:
    for file in files_of(room):
        outside = {name.split(".")[0] for name in imported(parsed(file))} - STANDARD - {"omegadot"}
        assert outside <= THIRD_PARTY[room], f"{file.name} imports {outside}"


@pytest.mark.parametrize("engine", sorted(THIRD_PARTY["adapters"] - {"numpy", "scipy"}))
def test_engines_are_imported_in_functions_only(engine: str) -> None:
    for file in files_of("adapters"):
        for node in parsed(file).body:
            if isinstance(node, ast.Import | ast.ImportFrom):
                named = [a.name for a in node.names] + [getattr(node, "module", "") or ""]
                assert all(name.split(".")[0] != engine for name in named), file.name


def test_no_module_is_called_after_nothing() -> None:
    for file in ROOT.rglob("*.py"):
        assert file.stem not in {"utils", "helpers", "common", "misc"}


def test_every_place_that_contributing_names_is_there() -> None:
    """The right column of its questions: a file of the package, one a line or several."""
    page = (ROOT.parent / "CONTRIBUTING.md").read_text(encoding="utf-8")
    questions = page.split("| question | place |")[1].split("\n\n")[0]
    places = re.findall(r"`((?:\w+/)+[\w.]*)`", questions)
    assert len(places) > 10
    for place in places:
        engines = ["mujoco", "pinocchio", "dart"] if "ENGINE" in place else [""]
        for engine in engines:
            assert (ROOT / place.replace("ENGINE", engine)).exists(), place


# What machines read back: a baseline's figures, and a key of what is kept.
READ_BACK = ("commands/check/baseline.py", "commands/check/baseline_file.py", "catalogue/kept.py")
OTHER_FORM = re.compile(r"[eEgG]$")
TEMPLATE = re.compile(r"\{\w*:\.?\d*[eEgG]\}|%\.?\d*[eEgG]\b")


def of_another_form(tree: ast.Module) -> list[int]:
    """The lines that write a number by ``:g`` or ``:e``; ``float(f"{x:.3g}")`` rounds one."""
    roundings = {
        id(node)
        for call in ast.walk(tree)
        if isinstance(call, ast.Call) and ast.unparse(call.func) == "float"
        for node in ast.walk(call)
    }
    specs = {
        field.lineno: ast.unparse(field.format_spec).strip("f'\"")
        for field in ast.walk(tree)
        if isinstance(field, ast.FormattedValue)
        and field.format_spec
        and id(field) not in roundings
    }
    texts = (n for n in ast.walk(tree) if isinstance(n, ast.Constant) and isinstance(n.value, str))
    found = [line for line, spec in specs.items() if OTHER_FORM.search(spec)]
    return found + [n.lineno for n in texts if TEMPLATE.search(n.value)]


def test_numbers_are_written_in_one_form() -> None:
    """Caught: 3e+06 beside 2.8e6, and 0.31 beside 3.1e-1."""
    one = ROOT / "written.py"
    for file in ROOT.rglob("*.py"):
        if file != one and not file.as_posix().endswith(READ_BACK):
            assert not of_another_form(parsed(file)), file.relative_to(ROOT)
    for file in (ROOT / "reports" / "page" / "templates").iterdir():
        text = file.read_text(encoding="utf-8")
        form = "toExponential" if file.name != "written.js" else "toPrecision"
        assert not re.search(rf"{form}|toPrecision|%\.\d[eg]|%g", text), file.name


def test_the_other_forms_are_seen() -> None:
    for text in ('f"{x:g}"', 'f"{x:.3g}"', 'f"{x:.{n}e}"', '"{x:.2g}".format(x=1)', '"%.3g" % x'):
        assert of_another_form(ast.parse(text)), text
    for text in ('float(f"{x:.3g}")', 'f"{x:.2f}"', 'f"{written(x, 3)}"', 'f"{name:<9}"'):
        assert not of_another_form(ast.parse(text)), text


# Each takes longer to import than a command takes to begin.
SLOW = ("scipy.signal", "scipy.stats", "scipy.interpolate", "scipy.ndimage", "matplotlib", "pandas")


def test_what_is_slow_to_import_is_imported_where_it_is_needed() -> None:
    """Caught: a start of every command that takes twice as long for what one function needs."""
    own = ROOT / "commands" / "fit"
    for file in ROOT.rglob("*.py"):
        top = [node for node in parsed(file).body if isinstance(node, ast.Import | ast.ImportFrom)]
        names = {name for node in top for name in imported(ast.Module([node], []))}
        slow = {name for name in names if name.startswith(SLOW)}
        assert own in file.parents or not slow, f"{file.relative_to(ROOT)}: {slow}"
