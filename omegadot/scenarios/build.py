"""A scenario from whatever names or describes it: a built-in's name, a path, or tables in code."""

from __future__ import annotations

import os
from collections.abc import Mapping
from typing import Any

from omegadot.scenarios.errors import Phrase, ScenarioError
from omegadot.scenarios.loader import find_scenario, load_scenario, scenario_of
from omegadot.scenarios.model import Scenario

ScenarioLike = str | os.PathLike[str] | Scenario | Mapping[str, Any]
"""A built-in's name, a path, a scenario, or its tables as the file has them."""

IN_CODE = "the scenario given"


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
    if given is None:
        return _built({}, changes)
    if isinstance(given, Mapping):
        return _built(given, changes)
    found = given if isinstance(given, Scenario) else _named(given)
    return _built(found.to_dict(), changes) if changes else found


def _named(given: object) -> Scenario:
    if isinstance(given, str):
        return find_scenario(given)
    if isinstance(given, os.PathLike):
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
    return value.tolist() if hasattr(value, "tolist") else value
