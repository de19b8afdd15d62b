"""A few systems on which schemes differ, and the exact motion of each.

Their tensors are full, their axes turned and their loads askew, so that no two schemes coincide by
symmetry. Steps are reported by the angle that the body turns in one, ``|omega_0| h``.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cache

import numpy as np

from omegadot.gates.bounds.measures import Yardstick
from omegadot.gates.bounds.scales import eps_of
from omegadot.reference_impl.kinematics import place_on_pivot
from omegadot.reference_impl.rotations import normalize
from omegadot.reference_impl.solutions.growth import growth_along
from omegadot.reference_impl.solutions.series import solve_series
from omegadot.reference_impl.system import Array, Body, Load, State, System


@dataclass(frozen=True, eq=False)
class Probe:
    """A system with a start. kind: what it stands for, "free", "damped", "pivoted" or both.

    precision: of the engine that is studied on it, by which rounding is bounded.
    """

    kind: str
    shows: str
    system: System
    initial: State
    precision: str = "float64"

    def timestep(self, angle: float) -> float:
        """The step in s in which the body turns by `angle` rad at its initial rate."""
        return angle / float(np.linalg.norm(self.initial.angular_velocity))


def _state(orientation: Sequence[float], angular_velocity: Sequence[float]) -> State:
    return State(
        orientation=normalize(np.array(orientation)),
        angular_velocity=np.array(angular_velocity),
        position=np.array([0.4, -1.0, 2.0]),
        linear_velocity=np.array([0.5, 1.0, 1.5]),
    )


def _flyer(center_of_mass: Array) -> Body:
    inertia = [[1.0, 0.1, 0.2], [0.1, 1.6, -0.1], [0.2, -0.1, 2.1]]
    return Body(np.array(2.0), center_of_mass, np.array(inertia))


# m/s^2. Stepped in body axes, a slower fall hides the energy's error of order 4 behind its part of
# order 5 until both are lost in rounding; a faster one rounds omega-dot by its m |v|^2.
_GRAVITY = np.array([0.0, 0.4, -1.4])
_HEAVY = np.array([0.0, 0.0, -9.81])
_PIVOT = np.array([0.02, 0.01, -0.1])
_FREE = _state((0.5, 0.1, -0.7, 0.4), (0.8, 2.0, -0.5))
_SPUN = _state((0.8, 0.3, -0.2, 0.1), (1.0, 2.0, 6.0))
_DRIVEN = Load(
    gravity=_GRAVITY,
    damping=np.array(0.15),
    torque_body=np.array([0.3, -0.2, 0.1]),
    torque_world=np.array([-0.1, 0.4, 0.2]),
)
_SLOWED = Load(_HEAVY, _PIVOT, np.array(0.1), torque_body=np.array([0.2, 0.1, 0.3]))
_TOP_INERTIA = np.array([[0.4, 0.03, -0.05], [0.03, 0.6, 0.02], [-0.05, 0.02, 0.3]])
_TOP = Body(np.array(1.5), np.array([0.05, -0.04, 0.2]), _TOP_INERTIA)


def _top(kind: str, shows: str, load: Load) -> Probe:
    system = System((_TOP,), load)
    return Probe(kind, shows, system, place_on_pivot(system, _SPUN))


PROBES = (
    Probe(
        "free",
        "a tumbling body falls, its centre of mass off its origin",
        System((_flyer(np.array([0.05, -0.02, 0.1])),), Load(gravity=_GRAVITY)),
        _FREE,
    ),
    Probe(
        "damped",
        "a body falls, its centre of mass at its origin, damped, driven in body and world axes",
        System((_flyer(np.zeros(3)),), _DRIVEN),
        _FREE,
    ),
    _top("pivoted", "a heavy asymmetric top on a pivot", Load(gravity=_HEAVY, pivot=_PIVOT)),
    _top("pivoted-damped", "the top, damped and driven in body axes", _SLOWED),
)


@cache
def in_precision(probe: Probe, precision: str) -> Probe:
    """The same probe for an engine that computes in "float64" or "float32"."""
    return probe if precision == probe.precision else replace(probe, precision=precision)


@dataclass(frozen=True, eq=False)
class Truth:
    """The exact trajectory of a probe at some times, with the growth of rounding along it."""

    state: State
    yardstick: Yardstick
    growth: Array


@cache
def truth_of(probe: Probe, times: tuple[float, ...]) -> Truth:
    """The exact states of a probe at `times`, the first of them zero."""
    moments = np.array(times)
    state = solve_series(probe.system, probe.initial, moments)
    yardstick = Yardstick(probe.system, moments, state).with_eps(eps_of(probe.precision))
    return Truth(state, yardstick, growth_along(probe.system, moments, state, yardstick.rate))
