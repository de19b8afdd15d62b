"""Which earlier system it is that something is kept of."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from omegadot.diagnosis.equations.kept_parts import Donor, Part
from omegadot.harness.loaded_before import LoadedBefore
from omegadot.reference_impl.inertia import lever
from omegadot.reference_impl.system import Array, System
from omegadot.written import written

DIGITS = 9  # of what systems are found again by
MOST_FOUND = 10_000  # systems, of which the numbers are kept

FOUND_BY: dict[str, Callable[[System], Array]] = {
    "mass": lambda s: np.asarray(s.body.mass, dtype=float),
    "principal moments": lambda s: np.linalg.eigvalsh(np.asarray(s.body.inertia, dtype=float)),
    "inertia": lambda s: np.asarray(s.body.inertia, dtype=float),
    "centre of mass": lambda s: np.asarray(s.body.center_of_mass, dtype=float),
    "pivot": lambda s: (
        np.zeros(0) if s.load.pivot is None else np.asarray(s.load.pivot, dtype=float)
    ),
    "lever": lambda s: np.zeros(0) if s.load.pivot is None else np.asarray(lever(s), dtype=float),
}


def last_of_any(part: Part) -> Donor:
    """Where a system has none, the last that had any."""

    def donor(system: System, before: LoadedBefore) -> System | None:
        if not part.missing(system):
            return None
        return next((one for one in before.latest_first() if not part.missing(one)), None)

    return donor


def last_where_missing(part: Part) -> Donor:
    """Where a system has none, the one loaded before it, if that had any."""

    def donor(system: System, before: LoadedBefore) -> System | None:
        last = before.last
        given = last is not None and part.missing(system) and not part.missing(last)
        return last if given else None

    return donor


def last(_: System, before: LoadedBefore) -> System | None:
    """The one loaded before it."""
    return before.last


def first(_: System, before: LoadedBefore) -> System | None:
    """The very first that was loaded."""
    return before.systems[0] if before.count else None


def first_with_same(key: str, support: bool) -> Donor:
    """By one of `FOUND_BY`. support: and by being pivoted or free."""

    def donor(system: System, before: LoadedBefore) -> System | None:
        own, found = _found_by(key, system), None
        for one in before.latest_first() if own else ():
            alike = not support or (one.load.pivot is None) is (system.load.pivot is None)
            found = one if alike and _found_by(key, one) == own else found
        return found

    return donor


_FOUND: dict[int, tuple[System, dict[str, tuple[str, ...]]]] = {}


def _found_by(key: str, system: System) -> tuple[str, ...]:
    """The numbers that a system is found again by, as text; they are worked out once."""
    if len(_FOUND) >= MOST_FOUND:
        _FOUND.clear()
    _, known = _FOUND.setdefault(id(system), (system, {}))  # held, so that its id stays its own
    if key not in known:
        known[key] = tuple(written(value, DIGITS) for value in np.ravel(FOUND_BY[key](system)))
    return known[key]
