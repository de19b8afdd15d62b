"""A scenario as the TOML file that reads back to it."""

from __future__ import annotations

import json
from typing import Any

from omegadot.scenarios.model import Scenario


def _value(value: Any) -> str:
    if isinstance(value, dict):
        return "{ " + ", ".join(f"{key} = {_value(item)}" for key, item in value.items()) + " }"
    if isinstance(value, list):
        return "[" + ", ".join(map(_value, value)) + "]"
    return json.dumps(value, ensure_ascii=False) if isinstance(value, str | bool) else repr(value)


def _changed(table: dict[str, Any], defaults: dict[str, Any]) -> dict[str, Any]:
    return {key: value for key, value in table.items() if value != defaults.get(key)}


def to_toml(scenario: Scenario) -> str:
    """The text of a scenario file, without what is left at its default."""
    data = scenario.to_dict()
    zero = [0.0, 0.0, 0.0]
    data["initial"] = _changed(
        data["initial"],
        {"orientation": [1.0, 0.0, 0.0, 0.0], "position": zero, "linear_velocity": zero},
    )
    nothing = {"gravity": zero, "damping": 0.0, "torque": {"frame": "body", "value": zero}}
    data["load"] = _changed(data["load"], nothing)
    data["body"] = _changed(data["body"], {"center_of_mass": zero})
    rows = data["body"].get("inertia", [])
    if all(not value for i, row in enumerate(rows) for j, value in enumerate(row) if i != j):
        data["body"] |= {"inertia": [row[i] for i, row in enumerate(rows)]} if rows else {}
    tables = {key: data.pop(key) for key in ("body", "initial", "load", "run")}
    parts = tables["body"].pop("part", [])
    lines = [f"{key} = {_value(value)}" for key, value in data.items()]
    for name, table in tables.items():
        if table or name != "load":
            lines += ["", f"[{name}]", *(f"{key} = {_value(item)}" for key, item in table.items())]
        for part in parts if name == "body" else ():
            lines += ["", "[[body.part]]", *(f"{k} = {_value(item)}" for k, item in part.items())]
    return "\n".join(lines) + "\n"
