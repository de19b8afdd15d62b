"""A program's answers as docs/worker-protocol.md has them, of JSON's types and under its names."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import MISSING, fields
from typing import Any, TypeVar

import numpy as np

from omegadot.adapters.protocol import Description, Integrator, Trajectory
from omegadot.reference_impl.system import Acceleration, Array, Body, State
from omegadot.workers.engine_end.checked import SHAPES, AnswerError, Shape
from omegadot.workers.wire import one_line

Arrays = TypeVar("Arrays", bound=State | Acceleration | Body)
DESCRIPTION = {
    **dict.fromkeys(("name", "version", "precision", "licence"), "a text"),
    **dict.fromkeys(("conventions", "switched_off", "settings", "links"), "a list of texts"),
    **dict.fromkeys(("features", "importers"), "a list of texts"),
    "integrators": "a list of objects",
}
INTEGRATOR = {
    **dict.fromkeys(("name", "knob", "note", "coordinates"), "a text"),
    "scheme": "a text or null",
    "orders": "an object of whole numbers",
    "one_step": "true or false",
    "finest_accuracy": "a number",
}
_HINTS = {"scheme": " (null if you do not know it)"}
_FITS: dict[str, Callable[[Any], bool]] = {
    "a text": lambda v: isinstance(v, str),
    "a text or null": lambda v: v is None or isinstance(v, str),
    "an object": lambda v: isinstance(v, dict),
    "true or false": lambda v: isinstance(v, bool),
    "a number": lambda v: isinstance(v, int | float) and not isinstance(v, bool),
    "a whole number or null": lambda v: v is None or type(v) is int,
}
_ITEMS: dict[str, tuple[type[list[Any]] | type[dict[Any, Any]], str]] = {
    "a list of texts": (list, "a text"),
    "a list of objects": (list, "an object"),
    "an object of texts": (dict, "a text"),
    "an object of whole numbers": (dict, "a whole number or null"),
}


def description_in(operation: str, found: Any) -> Description:
    """The description of an answer. Raises AnswerError where JSON's types are others."""
    what = f"the answer to {operation}"
    given = _keys_of(what, found, Description)
    _check_types(what, given, DESCRIPTION)
    kept: dict[str, Any] = {
        key: tuple(value) if isinstance(value, list) else value for key, value in given.items()
    }
    kept["features"] = frozenset(given.get("features", ()))
    kept["integrators"] = tuple(_integrator(what, one) for one in given["integrators"])
    return Description(**kept)


def _integrator(what: str, found: Any) -> Integrator:
    what = f"an integrator of {what}"
    given = _keys_of(what, found, Integrator)
    _check_types(what, given, INTEGRATOR)
    return Integrator(**given)


def arrays_in(what: str, found: Any, kind: type[Arrays], lead: Shape = ()) -> Arrays:
    """A state, an acceleration or a body whose arrays have the leading axes `lead`."""
    given, shapes = _keys_of(what, found, kind), SHAPES[kind]
    return kind(
        **{key: array(f"{what}: {key}", given[key], (*lead, *shapes[key])) for key in shapes}
    )


def torque_in(found: Any, lead: Shape) -> Array:
    """The torque of inverse dynamics, of the shape (*lead, 3)."""
    what = "the answer to inverse"
    if not isinstance(found, dict):
        raise AnswerError(f"{what} is {_shown(found)}; give an object with the key 'torque'")
    _check_keys(what, found, ["torque"], ["torque"])
    return array(f"{what}: torque", found["torque"], (*lead, 3))


def trajectory_in(found: Any) -> Trajectory:
    """A trajectory with as many states as times."""
    what = "the answer to run"
    given = _keys_of(what, found, Trajectory)
    count = np.size(_numbers(f"{what}: time", given["time"]))
    time = array(f"{what}: time", given["time"], (max(1, count),))
    state = arrays_in(f"{what}: state", given["state"], State, (count,))
    seconds = given.get("seconds")
    if seconds is not None:
        seconds = float(array(f"{what}: seconds", seconds, ()))
    return Trajectory(time, state, seconds)


def native_in(found: Any) -> dict[str, dict[str, str]]:
    """An engine's own conventions and defaults, both names with texts."""
    what, parts = "the answer to native", ["conventions", "defaults"]
    if not isinstance(found, dict):
        raise AnswerError(f"{what} is {_shown(found)}; give an object with {' and '.join(parts)}")
    _check_keys(what, found, parts, parts)
    _check_types(what, found, dict.fromkeys(parts, "an object of texts"))
    return found


def array(what: str, value: Any, shape: Shape) -> Array:
    """An array of this shape, from one or from lists; null in a list is what is not finite."""
    found = _numbers(what, value)
    if found.shape != shape:
        raise AnswerError(f"{what} has the shape {list(found.shape)}; give {list(shape)}")
    return found


def _numbers(what: str, value: Any) -> Array:
    if not isinstance(value, list | np.ndarray) and not _FITS["a number"](value):
        raise AnswerError(f"{what} is {_shown(value)}; give an array of numbers")
    try:
        return np.array(value, dtype=float)
    except (TypeError, ValueError, OverflowError):
        raise AnswerError(f"{what} is no array of numbers; give rows of one length") from None


def _keys_of(what: str, found: Any, kind: type) -> dict[str, Any]:
    """An object with the keys of a dataclass. Raises AnswerError."""
    known = [field.name for field in fields(kind)]
    if not isinstance(found, dict):
        raise AnswerError(f"{what} is {_shown(found)}; give an object with {', '.join(known)}")
    due = [f.name for f in fields(kind) if f.default is f.default_factory is MISSING]
    _check_keys(what, found, known, due)
    return found


def _check_keys(what: str, found: Mapping[str, Any], known: list[str], due: list[str]) -> None:
    """Raise AnswerError where a key is unknown, or one that is due is missing."""
    missing = [key for key in due if key not in found]
    named = " and ".join(f"{key!r}{_HINTS.get(key, '')}" for key in missing)
    verb, keys = "is" if len(missing) == 1 else "are", ", ".join(known)
    also = f", and {named} {verb} missing" if missing else ""
    for key in found:
        if key not in known:
            shown = one_line(key, 60)
            raise AnswerError(f"{shown!r} is not a key of {what}; its keys are {keys}{also}")
    if missing:
        raise AnswerError(f"{what} lacks {named}")


def _check_types(what: str, found: Mapping[str, Any], types: Mapping[str, str]) -> None:
    for key, value in found.items():
        due, is_what = types[key], "is"
        if due in _ITEMS and isinstance(value, _ITEMS[due][0]):
            items = value.values() if isinstance(value, dict) else value
            wrong = [one for one in items if not _FITS[_ITEMS[due][1]](one)]
            if not wrong:
                continue
            is_what, value = "has", wrong[0]
        elif due in _FITS and _FITS[due](value):
            continue
        raise AnswerError(f"{what}: {key} {is_what} {_shown(value)}; give {due}")


def _shown(value: Any) -> str:
    """A value of an answer by its type in JSON; a short one as it is."""
    if value is None or isinstance(value, bool):
        return {None: "null", True: "true", False: "false"}[value]
    if isinstance(value, int | float):
        return f"the number {one_line(str(value), 40)}"
    if isinstance(value, str):
        return f"the text {one_line(value, 60)!r}"
    names = {list: "a list", dict: "an object", np.ndarray: "an array"}
    return names[type(value)]
