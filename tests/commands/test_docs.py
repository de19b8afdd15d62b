"""Every command and code block in the documents runs."""

import re
import shlex
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest
from command_line import omegadot
from pytest_line import run_pytest

from omegadot.adapters.registry import OPTIONAL, is_absent
from omegadot.scenarios import scenario_of

ROOT = Path(__file__).parents[2]
DOCUMENTS = [ROOT / "README.md", ROOT / "CONTRIBUTING.md", *sorted((ROOT / "docs").glob("*.md"))]
BLOCK = re.compile(r"^```(\w+)\n(.*?)^```", re.MULTILINE | re.DOTALL)
# These make the environment that the tests run in; continuous integration runs them first.
INSTALLING = (
    "python3 -m venv .venv && .venv/bin/pip install -e . && .venv/bin/omegadot run",
    ".venv/bin/pip install -e '.[test]' && .venv/bin/pytest",
    ".venv/bin/pip install -e '.[drake]'",
    ".venv/bin/pip install -e '.[exudyn]'",
    ".venv/bin/pip install -e '.[basilisk]'",
    ".venv/bin/pip install -e '.[opensim]'",
    ".venv/bin/pip install -e '.[pybullet]'",
    ".venv/bin/pip install -e '.[sapien]'",
    ".venv/bin/pip install -e '.[mjx]'",
    ".venv/bin/pip install -e '.[jaxsim]'",
    ".venv/bin/pip install -e '.[idyntree]'",
    ".venv/bin/pip install -e '.[rapier3d]'",
    ".venv/bin/pip install -e '.[biorbd]'",
    ".venv/bin/omegadot engines --install node",
)


def blocks(language: str) -> list[tuple[str, str]]:
    """(document, block) for every fenced block of a language."""
    return [
        (file.name, text)
        for file in DOCUMENTS
        for kind, text in BLOCK.findall(file.read_text(encoding="utf-8"))
        if kind == language
    ]


def commands() -> list[str]:
    """The commands of every block, joined by &&: a later one may need what an earlier one left."""
    found = []
    for _, block in blocks("bash"):
        # Format, lint and types are continuous integration's own lines.
        lines = [
            line
            for line in block.strip().splitlines()
            if line not in INSTALLING and "ruff" not in line
        ]
        if lines:
            found.append(" && ".join(lines))
    return found


def run_line(command: str, folder: Path) -> None:
    """The parts of a line joined by &&, by this interpreter's programs; each has to end well."""
    for part in command.split("&&"):
        program, *arguments = shlex.split(part)
        run = {"omegadot": omegadot, "pytest": run_pytest}[program.removeprefix(".venv/bin/")]
        done = run(*arguments, folder=folder)
        assert done.code == 0, f"{command}\n{done.out}\n{done.err}"


def test_the_two_commands_stand_at_the_top_and_in_ci() -> None:
    readme = [block.strip() for name, block in blocks("bash") if name == "README.md"]
    assert tuple(readme[:2]) == INSTALLING[:2]
    script = (ROOT / ".ci" / "run").read_text()
    assert "-e ." in script
    assert ".venv/bin/omegadot run" in script
    assert "-e '.[test]'" in script
    assert ".venv/bin/pytest" in script


def test_the_versions_of_python_are_the_same_everywhere() -> None:
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    label = "Programming Language :: Python :: 3."
    minors = [int(c.removeprefix(label)) for c in project["classifiers"] if c.startswith(label)]
    assert minors == list(range(minors[0], minors[-1] + 1))
    assert project["requires-python"] == f">=3.{minors[0]},<3.{minors[-1] + 1}"
    readme = " ".join((ROOT / "README.md").read_text().split())
    *others, last = (f"3.{minor}" for minor in minors)
    assert f"with Python {', '.join(others)} or {last}" in readme
    assert f"with CPython {', '.join(others)} and {last}" in readme


@pytest.fixture(scope="module")
def workplace(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder that looks like the checkout to the commands, and takes what they write."""
    folder = tmp_path_factory.mktemp("docs")
    for name in ("docs", "omegadot", "tests", "benchmarks", "pyproject.toml"):
        if (ROOT / name).exists():
            (folder / name).symlink_to(ROOT / name)
    return folder


@pytest.mark.parametrize("command", commands())
def test_commands_run(command: str, workplace: Path) -> None:
    for name in filter(is_absent, OPTIONAL):
        if re.search(rf"(?<![a-z0-9]){name}(?![a-z0-9])", command):  # test_NAME.py as well
            pytest.skip(f"{name} is not installed")
    run_line(command, workplace)


@pytest.mark.parametrize(("name", "text"), blocks("toml"))
def test_toml_blocks_are_valid(name: str, text: str) -> None:
    data = tomllib.loads(text)
    if "schema" in data:
        scenario_of(data, name)


def script(name: str, *languages: str) -> str:
    """The Python of a document as one script: a later block may use an earlier one's names."""
    found = [text for kind in languages for file, text in blocks(kind) if file == name]
    return "\n".join(found)


WITH_PYTHON = sorted({name for name, _ in blocks("python")})
# The page on adapters shows a class as people write their first one, without annotations.
TYPED = [name for name in WITH_PYTHON if name != "add-an-engine.md"]


@pytest.mark.parametrize("name", WITH_PYTHON)
def test_python_blocks_run(name: str, workplace: Path) -> None:
    text = script(name, "python")
    if "omegadot-run/" in text:  # what the first command of the README leaves
        run_line("omegadot run sphere --engine mujoco", workplace)
    done = subprocess.run(
        [sys.executable, "-c", text], cwd=workplace, capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr


def test_python_blocks_are_typed(tmp_path: Path) -> None:
    """As strictly as the package; blocks in ``py`` are not run, for they fetch or take long."""
    files = []
    for name in TYPED:
        files.append(tmp_path / f"{name.removesuffix('.md').replace('-', '_').lower()}.py")
        files[-1].write_text(script(name, "python", "py"), encoding="utf-8")
    settings = ("--config-file", "pyproject.toml", "--cache-dir", ".mypy_cache")
    done = subprocess.run(
        [sys.executable, "-m", "mypy", *settings, *map(str, files)],
        cwd=ROOT,
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stdout


def test_the_page_shows_the_example_engines_as_they_are() -> None:
    folder = ROOT / "docs" / "examples"
    example = (folder / "toy_engine.py").read_text()
    shown = [text for name, text in blocks("python") if name == "add-an-engine.md"]
    assert shown == [example, (folder / "adaptive_engine.py").read_text()]
    assert len(example[example.index("class ToyAdapter") :].splitlines()) <= 60


def test_local_links_lead_somewhere() -> None:
    for file in DOCUMENTS:
        for target in re.findall(r"\]\(([^)#]+)[^)]*\)", file.read_text(encoding="utf-8")):
            if not target.startswith("http"):
                assert (file.parent / target).exists(), f"{file.name}: {target}"
