"""The parts of a system that an engine may keep for the next one, and when it does."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from omegadot.diagnosis.equations.equation_form import Form, form_of
from omegadot.harness.loaded_before import LoadedBefore
from omegadot.reference_impl.inertia import lever
from omegadot.reference_impl.system import Array, System
from omegadot.written import written

DIGITS = 9  # of what systems are found again by

# From a system and what had been loaded before it: the one whose part it has; None without any.
Donor = Callable[[System, LoadedBefore], System | None]


@dataclass(frozen=True)
class Part:
    """name: as it is worded.  attributes: of the load, or of the body, that hold it.  none: how it
    is worded that a system has none; "" of what every system has.
    """

    name: str
    attributes: tuple[str, ...]
    none: str = ""

    def value(self, system: System) -> Array:
        """Its numbers in one row; zeros where there are none, and of no pivot nothing."""
        found = [getattr(_owner(system, one), one) for one in self.attributes]
        return np.concatenate([np.ravel(v) for v in found if v is not None] or [np.zeros(3)])

    def missing(self, system: System) -> bool:
        """Whether a system has none."""
        found = [getattr(_owner(system, one), one) for one in self.attributes]
        if self.attributes == ("pivot",):
            return found[0] is None
        return not any(np.any(one) for one in found)

    def put(self, system: System, donor: System) -> System:
        """The system with the part of another."""
        made: dict[str, Any] = {one: getattr(_owner(donor, one), one) for one in self.attributes}
        if hasattr(system.load, self.attributes[0]):
            return replace(system, load=replace(system.load, **made))
        return replace(system, bodies=(replace(system.body, **made),))


def _owner(system: System, attribute: str) -> Any:
    return system.load if hasattr(system.load, attribute) else system.body


@dataclass(frozen=True)
class Kept:
    """One part that is kept. what: its name.  vague: as text, without when."""

    what: str
    text: str
    part: Part
    donor: Donor
    solve: bool = False  # the inverse of the inertia that moves alone, whatever it was made of

    @property
    def vague(self) -> str:
        """Where it is open when it is kept."""
        return f"the {self.what} of a system loaded before is kept"

    def form(self, system: System, before: LoadedBefore) -> Form | None:
        """The equation with what is kept; None where nothing is. Raises ValueError."""
        donor = self.donor(system, before)
        if donor is None:
            return None
        if self.solve:
            return replace(form_of(system), solve=form_of(donor).solve)
        return form_of(self.part.put(system, donor))

    def value(self, system: System, before: LoadedBefore) -> Array:
        """What is kept, in one row."""
        donor = self.donor(system, before)
        assert donor is not None
        return np.ravel(form_of(donor).solve) if self.solve else self.part.value(donor)


LOADS = (
    Part("gravity", ("gravity",), "where no gravity is requested"),
    Part("damping", ("damping",), "where no damping is requested"),
    Part("torque in body axes", ("torque_body",), "where no torque in body axes is requested"),
    Part("torque in world axes", ("torque_world",), "where no torque in world axes is requested"),
    Part("applied torque", ("torque_body", "torque_world"), "where no torque is requested"),
    Part("pivot", ("pivot",), "where no pivot is requested"),
)
INERTIA = Part("inertia", ("inertia",))
BODY = (
    Part("mass", ("mass",)),
    Part("centre of mass", ("center_of_mass",), "where the centre of mass is at the origin"),
    INERTIA,
    Part("body", ("mass", "center_of_mass", "inertia")),
)
FOUND_BY: dict[str, Callable[[System], Array]] = {
    "mass": lambda s: np.asarray(s.body.mass, dtype=float),
    "principal moments": lambda s: np.linalg.eigvalsh(np.asarray(s.body.inertia, dtype=float)),
    "inertia": lambda s: np.asarray(s.body.inertia, dtype=float),
    "centre of mass": lambda s: np.asarray(s.body.center_of_mass, dtype=float),
    "lever": lambda s: np.zeros(0) if s.load.pivot is None else np.asarray(lever(s), dtype=float),
}


def _last_of_any(part: Part) -> Donor:
    def donor(system: System, before: LoadedBefore) -> System | None:
        if not part.missing(system):
            return None
        return next((one for one in before.latest_first() if not part.missing(one)), None)

    return donor


def _last_where_missing(part: Part) -> Donor:
    def donor(system: System, before: LoadedBefore) -> System | None:
        last = before.last
        given = last is not None and part.missing(system) and not part.missing(last)
        return last if given else None

    return donor


def _first_with_same(key: Callable[[System], Array]) -> Donor:
    def found_by(system: System) -> tuple[str, ...]:
        return tuple(written(value, DIGITS) for value in np.ravel(key(system)))

    def donor(system: System, before: LoadedBefore) -> System | None:
        own, found = found_by(system), None
        for one in before.latest_first() if own else ():
            found = one if found_by(one) == own else found
        return found

    return donor


def _every() -> Iterator[Kept]:
    for part in (*LOADS, *BODY):
        of_last = f"the {part.name} of the system loaded before is kept"
        if part.none:
            one = f"{part.none}, that of the system loaded before is kept"
            yield Kept(part.name, one, part, _last_where_missing(part))
            one = f"{part.none}, that of a system loaded before is kept: of the last that had any"
            yield Kept(part.name, one, part, _last_of_any(part))
        yield Kept(part.name, of_last, part, lambda _, before: before.last)
    inverse = "inverse of the inertia"
    yield Kept(
        inverse,
        f"the {inverse} of the system loaded before is kept",
        INERTIA,
        lambda _, before: before.last,
        solve=True,
    )
    for part in BODY[:-1]:
        for name, key in FOUND_BY.items():
            if name != part.name:
                text = f"the {part.name} is found again by the {name}: a system has that of the "
                text += f"first with this {name} that was loaded before"
                yield Kept(part.name, text, part, _first_with_same(key))


KEPT = tuple(_every())
