"""The parts of a system, or of its equation, that an engine may keep for the next one."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from omegadot.diagnosis.equations.equation_form import Form, changed, form_of
from omegadot.harness.loaded_before import LoadedBefore
from omegadot.reference_impl.system import Array, System

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
    """One part that is kept. what: its name.

    of_form: the parts of the equation that are kept, where what they were made of is not.
    key: what the system that it was kept of has in common with this one; "" where nothing.
    plainer: texts of what says less, and is as good where both make the same answers.  lasting:
    whether it is the same for all systems, so that it has one value.
    """

    what: str
    text: str
    part: Part
    donor: Donor
    of_form: tuple[str, ...] = ()
    key: str = ""
    plainer: tuple[str, ...] = ()
    lasting: bool = False

    def vague(self, key: str) -> str:
        """Where it is open when it is kept, but that what has this in common is."""
        same = f" with the same {key}" * bool(key)
        return f"the {self.what} of a system loaded before{same} is kept"

    def form(self, system: System, before: LoadedBefore) -> Form | None:
        """The equation with what is kept; None where nothing is. Raises ValueError."""
        donor = self.donor(system, before)
        if donor is None:
            return None
        if self.of_form:
            kept = form_of(donor)
            return changed(form_of(system), **{one: getattr(kept, one) for one in self.of_form})
        return form_of(self.part.put(system, donor))

    def value(self, system: System, before: LoadedBefore) -> Array:
        """What is kept, in one row."""
        donor = self.donor(system, before)
        assert donor is not None
        if not self.of_form:
            return self.part.value(donor)
        kept = form_of(donor)
        return np.concatenate([np.ravel(getattr(kept, one)) for one in self.of_form])


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
OF_EQUATION = "inertia (about the pivot, if any)"
# What is made of a body and its support, as one may be kept without the other.
MADE = {
    "inverse of the inertia": ("solve",),
    "inertia in the gyroscopic term": ("spin",),
    OF_EQUATION: ("solve", "spin"),
    "lever of the weight": ("arm",),
}
