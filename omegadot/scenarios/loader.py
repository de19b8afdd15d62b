"""From a file, a built-in's name or a plain dict to a Scenario, or to one sentence."""

from __future__ import annotations

import os
import re
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from pydantic import ValidationError

from omegadot.scenarios.errors import ScenarioError, describe, printable
from omegadot.scenarios.model import Scenario
from omegadot.scenarios.refusals import nearest, scenario_error
from omegadot.scenarios.toml_file import read_toml

BUILTIN = Path(__file__).with_name("builtin")


def load_scenario(path: str | os.PathLike[str]) -> Scenario:
    """The scenario in a TOML file.

    Raises ScenarioError when the file cannot be read, is not TOML or is no valid scenario.
    """
    file = printable(os.fspath(path))
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


def find_scenario(name_or_path: str) -> Scenario:
    """The built-in of this name; failing that, the scenario in the file of this path.

    A name without a slash, a dot or a file of its name is taken for a mistyped built-in.
    Raises ScenarioError.
    """
    if name_or_path in builtin_names():
        return load_builtin(name_or_path)
    if re.search(r"[/\\.]", name_or_path) or os.path.lexists(name_or_path):
        return load_scenario(name_or_path)
    found = "neither a built-in scenario nor a file"
    raise ScenarioError(describe(name_or_path), None, found, _other_name(name_or_path))


def scenario_of(data: Mapping[str, Any], file: str) -> Scenario:
    """The scenario in a dict as `Scenario.to_dict` or a TOML parser gives it.

    `file` is the name to use in errors. Raises ScenarioError.
    """
    try:
        return Scenario.model_validate(data)
    except ValidationError as error:
        raise scenario_error(file, error) from None


def _other_name(name: str) -> str:
    near = nearest(name, list(builtin_names()))
    if near:
        return f"write {near} if that is what you mean"
    return "give one of the built-in names or the path of a TOML file"
