"""One sentence out of the list of faults that pydantic finds in a scenario."""

from __future__ import annotations

import difflib
from typing import Any

from pydantic import BaseModel, ValidationError

from omegadot.scenarios.errors import ScenarioError, describe, printable
from omegadot.scenarios.model import Body, Initial, Load, Run, Scenario, Torque
from omegadot.scenarios.parts import SHAPES

Location = tuple[int | str, ...]
ONE_SHAPE = "one of " + ", ".join(SHAPES)
TABLES: dict[str, type[BaseModel]] = {
    "": Scenario,
    "body": Body,
    "initial": Initial,
    "load": Load,
    "load.torque": Torque,
    "run": Run,
    **{f"body.part.{shape}": model for shape, model in SHAPES.items()},
}


def scenario_error(file: str, error: ValidationError) -> ScenarioError:
    """The fault to fix first: a wrong schema number, then unknown keys, then the rest in order.

    A mistyped key is also a missing one; naming the typing error helps more.
    """

    def urgency(fault: Any) -> int:
        if fault["loc"] == ("schema",) and fault["type"] == "refused":
            return 0
        return 1 if fault["type"] == "extra_forbidden" else 2

    fault = min(error.errors(include_url=False), key=urgency)
    location: Location = fault["loc"]
    key = key_path(location)
    context: dict[str, Any] = fault.get("ctx", {})
    found = describe(fault["input"])
    match fault["type"]:
        case "refused":
            key, advice = _join(key, context["key"]), context["advice"]
            found = describe(context.get("found", fault["input"]))
        case "extra_forbidden":
            found, advice = f"an unknown key ({found})", _nearest_key(location)
        case "missing":
            found, advice = "missing", f"add it ({_description(location)})"
        case "union_tag_not_found":
            key, found, advice = _join(key, "shape"), "missing", f"add it, {ONE_SHAPE}"
        case "union_tag_invalid":
            tag = fault["input"]["shape"] if isinstance(fault["input"], dict) else fault["input"]
            key, found, advice = _join(key, "shape"), describe(tag), f"give {ONE_SHAPE}"
        case "tuple_type":
            advice = f"write each one as a table [[{key}]]"
        case "literal_error":
            advice = f"give {context['expected']}"
        case _:  # what is left is a value where a table belongs
            advice = f"write it as a table{f' [{key}]' if key.isalpha() else ''} of keys and values"
    return ScenarioError(file, key or None, found, advice)


def key_path(location: Location) -> str:
    """The dotted path of a place, such as ``body.part[1].radius``; lists count from 0."""
    path = ""
    for index, item in enumerate(location):
        if isinstance(item, int):
            path += f"[{item}]"
        elif not (item in SHAPES and location[index - 2 : index - 1] == ("part",)):
            path = _join(path, _as_written(printable(item)))
    return path


def _as_written(key: str) -> str:
    """A key as TOML takes it: in quotes, where a blank in it would not be seen."""
    return f'"{key}"' if set(key) & {" ", "."} else key


def _join(path: str, key: str) -> str:
    return f"{path}{key}" if not path or not key or key[0] == "[" else f"{path}.{key}"


def _table(location: Location) -> str:
    return ".".join(item for item in location if isinstance(item, str))


def _known(table: str) -> list[str]:
    return [field.alias or name for name, field in TABLES[table].model_fields.items()]


def _description(location: Location) -> str:
    """What belongs at the place of a missing key."""
    fields = TABLES[_table(location[:-1])].model_fields
    given = {field.alias or name: field.description for name, field in fields.items()}
    return given[str(location[-1])] or str(location[-1])


def _nearest_key(location: Location) -> str:
    """Advice for an unknown key: the nearest known one, its right table, or all that may stand."""
    table, key = _table(location[:-1]), str(location[-1])[:64]
    known = _known(table)
    if near := nearest(key, known):
        return f"write {near} if that is what you mean"
    homes = [home for home in TABLES if home and "part" not in home and key in _known(home)]
    if homes:
        return f"move it to [{homes[0]}]"
    return f"take it out, the keys known there are {', '.join(known)}"


def nearest(term: str, known: list[str]) -> str | None:
    """The known name that is spelt most like this one, if any is; capitals do not count."""
    lower = {name.lower(): name for name in reversed(known)}
    near = difflib.get_close_matches(term[:64].lower(), lower, n=1)
    return lower[near[0]] if near else None
