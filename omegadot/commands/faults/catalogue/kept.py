"""Faults of what is kept from a system before: parts of it are found again by too few things."""

from __future__ import annotations

from collections.abc import Hashable
from dataclasses import replace
from functools import partial

import numpy as np

from omegadot.adapters.protocol import Adapter
from omegadot.commands.faults.fault import Spoiled, fault, fault_by
from omegadot.reference_impl.inertia import lever
from omegadot.reference_impl.system import Array, Body, State, System


class KeptParts(Spoiled):
    """A system is given the inertia of the first one that had the same key."""

    def __init__(self, inner: Adapter) -> None:
        super().__init__(inner)
        self._kept: dict[Hashable, System] = {}

    def key(self, system: System) -> Hashable:
        """By what a system is found again."""
        return None

    def mixed(self, system: System, before: System) -> System:
        """The system with what is kept of the one before."""
        return replace(system, bodies=(replace(system.body, inertia=before.body.inertia),))

    def loaded(self, system: System) -> System:
        """With what is kept."""
        return self.mixed(system, self._kept.setdefault(self.key(system), system))

    def model(self) -> tuple[Body, ...]:
        """What was requested."""
        return self.system.bodies


kept = partial(fault_by, KeptParts, "key", "state", "equation")
LEFT_OVER = ("loaded before", "scenario before", "kept")


@kept(named=LEFT_OVER)
def InertiaKeptByMass(self: KeptParts, system: System) -> Hashable:
    """The inertia is kept by the mass: another body of the same mass has that of the first."""
    return float(system.body.mass)


@kept(named=LEFT_OVER)
def InertiaKeptByMoments(self: KeptParts, system: System) -> Hashable:
    """The inertia is kept by its principal moments: the axes are those of the first body."""
    return tuple(f"{moment:.9g}" for moment in np.linalg.eigvalsh(system.body.inertia))


@fault("state", "equation", "pivot lever", named=LEFT_OVER)
class MassKeptByLever(KeptParts):
    """A pivoted body's mass is kept by its lever: another with this lever has that of the first."""

    def key(self, system: System) -> Hashable:
        """The lever, or none."""
        return None if system.load.pivot is None else tuple(map(float, lever(system)))

    def mixed(self, system: System, before: System) -> System:
        """With the first one's mass."""
        if system.load.pivot is None:
            return system
        return replace(system, bodies=(replace(system.body, mass=before.body.mass),))


@fault("state", "model", named="read back is that of a state set before")
class FirstAttitudeKept(Spoiled):
    """The attitude of the first state that a system is set to stays for all later ones."""

    _first: Array | None = None

    def load(self, system: System) -> None:
        """A first state is to come."""
        self._first = None
        super().load(system)

    def set_state(self, state: State) -> None:
        """With the first one's attitude."""
        self._first = state.orientation if self._first is None else self._first
        super().set_state(replace(state, orientation=self._first))
