"""What follows from a system alone, formed once for it and kept.

Judging, and looking for a cause, ask some thousand times for the same constants of a few systems.
"""

from __future__ import annotations

from collections.abc import Callable, Hashable
from functools import wraps
from typing import Any, Concatenate, ParamSpec, TypeVar, cast

from omegadot.reference_impl.system import System

MOST = 32  # systems and further arguments, of each function

More = ParamSpec("More")
Result = TypeVar("Result")


def formed_once(
    form: Callable[Concatenate[System, More], Result],
) -> Callable[Concatenate[System, More], Result]:
    """A function of a system, and of hashable arguments, that keeps its latest results.

    A system is known again as the same object, which is held as long as its result: its arrays
    cannot be hashed, and comparing them would take as long as many a result. Neither a system nor
    a result may be changed in place.
    """
    kept: dict[tuple[Hashable, ...], tuple[System, Result]] = {}

    @wraps(form)
    def found(system: System, *more: Any, **named: Any) -> Result:
        key = (id(system), *more, *named.items())
        known = kept.get(key)
        if known is not None:
            return known[1]
        result = cast(Callable[..., Result], form)(system, *more, **named)
        if len(kept) >= MOST:
            kept.clear()
        kept[key] = system, result
        return result

    return cast(Callable[Concatenate[System, More], Result], found)
