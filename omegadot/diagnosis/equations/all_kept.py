"""Everything that an engine may keep of a system that it was loaded with before."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from omegadot.diagnosis.equations.kept_donors import (
    FOUND_BY,
    first,
    first_with_same,
    last,
    last_of_any,
    last_where_missing,
)
from omegadot.diagnosis.equations.kept_parts import (
    BODY,
    INERTIA,
    LOADS,
    MADE,
    OF_EQUATION,
    Kept,
    Part,
)

SUPPORT = " and by whether it is pivoted"
SAME_SUPPORT = " and the same support, pivoted or free,"


def _text(what: str, key: str, support: bool) -> str:
    if not key:
        return f"the {what} of the system loaded before is kept"
    found = f"the {what} is found again by the {key}{SUPPORT * support}: a system has that of the "
    return f"{found}first with this {key}{SAME_SUPPORT * support} that was loaded before"


def _whenever(
    what: str, part: Part, keys: Iterable[str], of_form: tuple[str, ...] = ()
) -> Iterator[Kept]:
    """One thing that is kept: of the system loaded before, or of the first with the same key."""
    plain = INERTIA.name if what == OF_EQUATION else what
    every = [("", False), *((key, support) for key in keys for support in (False, True))]
    for key, support in every:
        donor = first_with_same(key, support) if key else last
        text = _text(what, key, support)
        less = {_text(one, key, s) for one in (what, plain) for s in (False, support)} - {text}
        yield Kept(what, text, part, donor, of_form, key, tuple(less))


def _every() -> Iterator[Kept]:
    for part in (*LOADS, *BODY):
        if part.none:
            one = f"{part.none}, that of the system loaded before is kept"
            yield Kept(part.name, one, part, last_where_missing(part))
            one = f"{part.none}, that of a system loaded before is kept: of the last that had any"
            yield Kept(part.name, one, part, last_of_any(part))
        one = f"the {part.name} of the first system that was loaded is kept for all"
        yield Kept(part.name, one, part, first, lasting=True)
        by_key = part not in LOADS and part != BODY[-1]
        yield from _whenever(part.name, part, [k for k in FOUND_BY if by_key and k != part.name])
    for what, of_form in MADE.items():
        yield from _whenever(what, INERTIA, FOUND_BY, of_form)


KEPT = tuple(_every())
