"""What a script passes to a public function, held to the function's own annotations."""

from __future__ import annotations

import functools
import inspect
import types
from collections.abc import Callable, Collection, Iterable, Mapping, Sequence
from numbers import Integral, Real
from os import PathLike
from typing import Any, Literal, ParamSpec, TypeVar, Union, get_args, get_origin, get_type_hints

from omegadot.harness.usage import UsageError

P = ParamSpec("P")
R = TypeVar("R")
_LONGEST = 80  # characters of a value in an error
_NAMES: dict[Any, str] = {
    **{float: "a number", int: "a whole number", str: "a text", bool: "True or False"},
    **{Literal: "a text", PathLike: "a path", Mapping: "a table", type: "a class"},
}


def typed(function: Callable[P, R]) -> Callable[P, R]:
    """The function, which then raises UsageError for an argument of none of its annotated types.

    A number that no float holds is none, whatever its type.
    """
    signature = inspect.signature(function)
    hints = functools.cache(lambda: get_type_hints(function))

    @functools.wraps(function)
    def held(*args: P.args, **kwargs: P.kwargs) -> R:
        for name, value in signature.bind(*args, **kwargs).arguments.items():
            if not _fits(value, hints()[name]):
                wanted = " or ".join(dict.fromkeys(_kinds(hints()[name])))
                raise UsageError(f"{name} is {_shown(value)}; give {wanted}.")
        return function(*args, **kwargs)

    return held


def _fits(value: Any, hint: Any) -> bool:
    origin, arguments = get_origin(hint) or hint, get_args(hint)
    if origin in (Union, types.UnionType):
        return any(_fits(value, one) for one in arguments)
    if origin is float:
        return isinstance(value, Real) and not isinstance(value, bool) and _is_float(value)
    if origin is int:
        return isinstance(value, Integral) and not isinstance(value, bool) and _is_float(value)
    if origin is bool:
        return isinstance(value, bool) or type(value).__name__ in ("bool_", "bool")
    if origin is Literal:
        return isinstance(value, str)
    if origin is Sequence:
        return _fits_all(value, arguments[0])
    if origin is Mapping:
        key, kind = arguments
        whole = isinstance(value, Mapping)
        return whole and all(_fits(k, key) and _fits(v, kind) for k, v in value.items())
    try:
        return isinstance(value, origin)
    except TypeError:  # Any, or one of the protocols that an array may follow
        return True


def _fits_all(value: Any, kind: Any) -> bool:
    """Whether it is a list, an array or any other iterable of such things."""
    plain = value.tolist() if hasattr(value, "tolist") else value
    if isinstance(plain, str):
        return kind is str  # one text stands for a list of it
    if isinstance(plain, bytes | bytearray | Mapping | type) or not isinstance(plain, Iterable):
        return False
    return not isinstance(plain, Collection) or all(_fits(one, kind) for one in plain)


def _is_float(value: Any) -> bool:
    try:
        float(value)
    except OverflowError:
        return False
    return True


def _kinds(hint: Any) -> list[str]:
    origin, arguments = get_origin(hint) or hint, get_args(hint)
    if origin in (Union, types.UnionType):
        return [name for one in arguments for name in _kinds(one)]
    if origin is Sequence:
        return [*_kinds(arguments[0]), "a list of such"]
    if origin is type(None):
        return []
    return [_NAMES.get(origin, f"a {getattr(origin, '__name__', 'value')}")]


def _shown(value: object) -> str:
    try:
        text = " ".join(repr(value).split())
    except Exception:  # a number of thousands of digits, or a list that holds itself
        text = f"a {type(value).__name__}"
    return text if len(text) <= _LONGEST else f"{text[: _LONGEST - 20]}..."
