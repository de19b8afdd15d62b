"""No engine of one's own passes for another: names of classes, programs, entry points."""

import re
from importlib.metadata import EntryPoint
from pathlib import Path

import pytest

from omegadot.adapters.reference import ReferenceAdapter
from omegadot.adapters.registry import ENTRY_POINT_GROUP, OURS
from omegadot.commands.check.check import check
from omegadot.commands.run.run import run
from omegadot.harness.arguments import engine_choices
from omegadot.harness.own_engines import known_engines
from omegadot.harness.usage import UsageError

RENAME = "is that of a built-in engine; rename the class."


@pytest.fixture
def own(tmp_path: Path) -> Path:
    """A file of classes, each with the name of a built-in engine."""
    file = tmp_path / "own.py"
    names = ("Mujoco", "MujocoAdapter", "ReferenceAdapter", "ExactAdapter", "DrakeAdapter")
    file.write_text("\n".join(f"class {name}: ..." for name in names) + "\n", encoding="utf-8")
    return file


@pytest.mark.parametrize("name", ["Mujoco", "MujocoAdapter", "ExactAdapter", "DrakeAdapter"])
def test_a_class_with_the_name_of_a_built_in_engine_is_refused(own: Path, name: str) -> None:
    engine = name.removesuffix("Adapter").lower()
    sentence = re.escape(f"{own}:{name}: its name, {engine}, {RENAME}")
    for wanted, extra in (([], [f"{own}:{name}"]), ([f"{own}:{name}"], [])):
        with pytest.raises(UsageError, match=sentence):
            engine_choices(wanted, extra)


def test_every_command_refuses_it(own: Path) -> None:
    """Caught: a reference that was replaced by the engine to be judged by it."""
    target = f"{own}:ReferenceAdapter"
    sentence = re.escape(f"{target}: its name, reference, {RENAME}")
    with pytest.raises(UsageError, match=sentence):
        check(target, scenarios="sphere")
    with pytest.raises(UsageError, match=sentence):
        run("sphere", adapters=target)


def test_a_program_with_such_a_name_is_told_how_to_take_another() -> None:
    with pytest.raises(UsageError, match="MuJoCo, is that of a built-in engine; write another"):
        engine_choices([], ["MuJoCo=sh mine.sh"])
    with pytest.raises(UsageError, match=r"sh /x/exact\.sh: its name, exact, is that of a built"):
        engine_choices(["sh /x/exact.sh"])


def test_the_built_in_class_itself_is_taken() -> None:
    (found,) = engine_choices([ReferenceAdapter])
    assert (found.name, found.target) == ("reference", OURS["reference"])


@pytest.mark.parametrize(
    ("points", "sentence"),
    [
        ((("mujoco", "mine:Own"),), "entry point mujoco = mine:Own: mujoco is the name of omegad"),
        ((("MuJoCo", "mine:Own"),), "entry point MuJoCo = mine:Own: mujoco is the name of omegad"),
        ((("bolt", "a:Bolt"), ("bolt", "b:Bolt")), "bolt = b:Bolt: bolt is the name of a:Bolt too"),
    ],
)
def test_entry_points_of_one_name_are_refused(
    monkeypatch: pytest.MonkeyPatch, points: tuple[tuple[str, str], ...], sentence: str
) -> None:
    found = [EntryPoint(*point, ENTRY_POINT_GROUP) for point in points]
    monkeypatch.setattr("importlib.metadata.entry_points", lambda group: found)
    with pytest.raises(UsageError, match=re.escape(sentence)):
        known_engines()


def test_a_package_that_is_found_twice_is_one(monkeypatch: pytest.MonkeyPatch) -> None:
    point = EntryPoint("bolt", "a:Bolt", ENTRY_POINT_GROUP)
    monkeypatch.setattr("importlib.metadata.entry_points", lambda group: [point, point])
    assert known_engines()["bolt"] == "a:Bolt"
