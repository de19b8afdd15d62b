"""Checks that engines publish with their own tests, described by set-up and bound, not by code.

Each is put to an engine as it stands there: its body, its rates, its step, its length and its
bounds; only the starting attitude is drawn. Energies and momenta are formed from the model that the
engine itself reads back, as an engine's own test does.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.random import Generator

from omegadot.adapters.protocol import Adapter, Integrator, Trajectory
from omegadot.reference_impl.energy import kinetic_energy
from omegadot.reference_impl.momentum import angular_momentum, linear_momentum
from omegadot.reference_impl.rotations import normalize
from omegadot.reference_impl.system import Array, Body, Load, State, System

NONE = np.zeros(3)


@dataclass(frozen=True)
class Published:
    """One published check.

    caught: whether its bounds are broken by the engine that is loaded with nothing yet, from an
    attitude of the generator's.  schemes: those it is meant for, the first that there is is run.
    has: the features of its scenarios.
    """

    name: str
    bound: str
    source: str
    has: frozenset[str]
    schemes: tuple[str, ...]
    caught: Callable[[Adapter, Integrator, Generator], bool]

    def integrator_of(self, engine: Adapter) -> Integrator | None:
        """The engine's integrator that this check is meant for."""
        declared = engine.description.integrators
        fitting = (i for scheme in self.schemes for i in declared if i.scheme == scheme)
        return next(fitting, None)


def attitude(random: Generator) -> Array:
    """A random attitude, uniformly distributed."""
    return normalize(random.standard_normal(4))


def free_body(mass: float, inertia: Array, center: Array = NONE, **load: Array) -> System:
    """A free body."""
    return System((Body(np.array(mass), center, inertia),), Load(**load))


@dataclass(frozen=True)
class Seen:
    """A run as an engine's own test sees it: with the model that the engine reads back.

    energy: (n,) J, kinetic.  angular: (n, 3) kg m^2/s, world, about the centre of mass.
    linear: (n, 3) kg m/s, world.
    """

    trajectory: Trajectory
    energy: Array
    angular: Array
    linear: Array


def see(
    adapter: Adapter, system: System, initial: State, integrator: Integrator, h: float, steps: int
) -> Seen:
    """Load, read the model back, and run, keeping every step."""
    adapter.load(system)
    believed = System(adapter.model(), system.load)
    found = adapter.run(initial, integrator.name, h, steps, 1)
    how = (believed, found.state)
    return Seen(found, kinetic_energy(*how), angular_momentum(*how), linear_momentum(*how))
