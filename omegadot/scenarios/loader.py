"""From whatever names or describes a scenario to a Scenario, or to one sentence."""

from __future__ import annotations

import os
import re
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from pydantic import ValidationError

from omegadot.scenarios.errors import Phrase, ScenarioError, describe, printable
from omegadot.scenarios.files import read_toml
from omegadot.scenarios.model import Scenario
from omegadot.scenarios.random_systems import LARGEST_SEED, MOST_SYSTEMS, random_of_name
from omegadot.scenarios.refusals import nearest, scenario_error

BUILTIN = Path(__file__).with_name("builtin")
ScenarioLike = str | os.PathLike[str] | Scenario | Mapping[str, Any]
"""A built-in's name, a path, a scenario, or its tables as the file has them."""

IN_CODE = "the scenario given"
ROBOT_FILE = re.compile(r"\.(urdf|sdf|mjcf|xml)(#.*)?$", re.IGNORECASE)


def load_scenario(path: str | os.PathLike[str]) -> Scenario:
    """The scenario in a TOML file.

    Raises ScenarioError when the file cannot be read, is not TOML or is no valid scenario.
    """
    file = printable(os.fspath(path))
    if ROBOT_FILE.search(os.fspath(path)):
        found = "a robot file, not a scenario"
        raise ScenarioError(
            file, None, found, "omegadot choose --body FILE#LINK takes a link of it"
        )
    return scenario_of(read_toml(Path(path), file), file)


def builtin_names() -> tuple[str, ...]:
    """The names of the built-in scenarios, in alphabetical order."""
    return tuple(sorted(file.stem for file in BUILTIN.glob("*.toml")))


def load_builtin(name: str) -> Scenario:
    """A built-in scenario by its name.

    Raises ScenarioError, with the nearest name, when there is none of this name.
    """
    names = builtin_names()
    if name not in names:
        raise ScenarioError(describe(name), None, "not a built-in scenario", _other_name(name))
    return load_scenario(BUILTIN / f"{name}.toml")


def scenario_of(data: Mapping[str, Any], file: str) -> Scenario:
    """The scenario in a dict as `Scenario.to_dict` or a TOML parser gives it.

    `file` is the name to use in errors. Raises ScenarioError.
    """
    try:
        return Scenario.model_validate(data)
    except ValidationError as error:
        raise scenario_error(file, error) from None


def _other_name(name: str) -> str:
    if name.startswith("random-"):
        return (
            f"write random-SEED-INDEX, with a seed of at most {LARGEST_SEED} and an index below "
            f"{MOST_SYSTEMS}"
        )
    near = nearest(name, list(builtin_names()))
    if near:
        return f"write {near} if that is what you mean"
    return "give one of the built-in names or the path of a TOML file"


def scenario(given: ScenarioLike | None = None, /, **changes: Any) -> Scenario:
    """A built-in scenario, a file's, or one built in code.

    given: a built-in's name, a path, a scenario or a mapping of its tables; nothing for a new one.
    changes: keys and tables as in the file, such as ``name="spin"`` or ``run={"duration": 5.0}``.
    They are put over the scenario given, key by key within ``initial``, ``load`` and ``run``; a
    ``body`` replaces the whole body. NumPy arrays are taken for lists, and ``schema`` is 1 where
    it is left out. Raises ScenarioError.
    """
    if isinstance(given, Scenario) and not changes:
        return given
    if given is None or isinstance(given, Mapping):
        return _built(given or {}, changes)
    found = given if isinstance(given, Scenario) else _named(given)
    return _built(found.to_dict(), changes) if changes else found


def _named(given: object) -> Scenario:
    """The built-in of a name; failing that, the scenario in the file of a path.

    A name without a slash, a dot or a file of its name is taken for a mistyped built-in.
    """
    if isinstance(given, str):
        if given in builtin_names():
            return load_builtin(given)
        if (drawn := random_of_name(given)) is not None:
            return drawn
        if not re.search(r"[/\\.]", given) and not os.path.lexists(given):
            found = "neither a built-in scenario nor a file"
            raise ScenarioError(describe(given), None, found, _other_name(given))
    if isinstance(given, str | os.PathLike):
        return load_scenario(given)
    found = Phrase(f"of type {type(given).__name__}")
    advice = "give a built-in's name, a path, a Scenario or a mapping of its tables"
    raise ScenarioError(IN_CODE, None, found, advice)


def _built(tables: Mapping[str, Any], changes: Mapping[str, Any]) -> Scenario:
    data: dict[str, Any] = {"schema": 1, **_plain(tables)}
    for key, value in _plain(changes).items():
        merged = key != "body" and isinstance(value, dict) and isinstance(data.get(key), dict)
        data[key] = {**data[key], **value} if merged else value
    name = data.get("name")
    return scenario_of(data, name if isinstance(name, str) and name else IN_CODE)


def _plain(value: Any) -> Any:
    """Tables and lists of plain numbers: arrays have a ``tolist``."""
    if isinstance(value, Mapping):
        return {key: _plain(item) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [_plain(item) for item in value]
    if isinstance(value, str):  # the arguments of a process may hold what UTF-8 cannot
        return value.encode(errors="replace").decode()
    return value.tolist() if hasattr(value, "tolist") else value
