"""Random bodies, loads and states, and how far rounding may take two equal answers apart."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from omegadot.adapters.protocol import Adapter
from omegadot.gates.bounds.measures import Yardstick
from omegadot.gates.bounds.scales import (
    EPS,
    ROUNDINGS_PER_EVALUATION,
    body_scale,
    linear_size,
    norm,
    torque_size,
)
from omegadot.gates.errors.measured_run import CHANNELS
from omegadot.gates.truth import SchemeKey, scheme_key
from omegadot.reference_impl.inertia import inertia_of_moments
from omegadot.reference_impl.kinematics import place_on_pivot
from omegadot.reference_impl.motion import forward_dynamics
from omegadot.reference_impl.rotations import normalize, rotation_matrix
from omegadot.reference_impl.solutions.companion import Steps, companion
from omegadot.reference_impl.system import Acceleration, Body, Load, State, System

ROTATION = ("omega", "attitude", "angular_momentum")
STATES = 6
STEPS = 20
# Two evaluations, and the change of frame of what goes in and of what comes out.
ROUNDINGS = 2 * ROUNDINGS_PER_EVALUATION + 16


@dataclass(frozen=True)
class Motion:
    """A system and n states of it."""

    system: System
    states: State

    @property
    def first(self) -> State:
        return State(*(values[0] for values in vars(self.states).values()))


@dataclass(frozen=True)
class Wanted:
    """What a property can be requested of. damped: with damping, which time reversal lacks."""

    pivoted: bool = True
    damped: bool = True


ANY = Wanted()


def random_motion(seed: int, wanted: Wanted = ANY) -> Motion:
    """A body of any attitude and shape, moments over two decades; loads are there or not."""
    random = np.random.default_rng(seed)
    mass = 10.0 ** random.uniform(-2.0, 2.0)
    size = 10.0 ** random.uniform(-1.0, 1.0)
    squares = (size * 10.0 ** random.uniform(-1.0, 0.0, 3)) ** 2
    axes = rotation_matrix(normalize(random.standard_normal(4)))
    inertia = axes @ inertia_of_moments(mass, squares) @ axes.T
    inertia = (inertia + inertia.T) / 2.0
    there = random.integers(0, 2, 5)
    center = size * random.standard_normal(3) * there[0]
    rate = 10.0 ** random.uniform(-1.0, 1.0)
    slowest = float(np.linalg.eigvalsh(inertia)[0])
    twist = rate**2 * slowest
    # Loads act within a radian of turning, not faster, so that no step is too long for a scheme.
    load = Load(
        gravity=size * rate**2 * random.standard_normal(3) * there[1],
        pivot=size * random.standard_normal(3) if there[2] and wanted.pivoted else None,
        damping=np.asarray(slowest * rate * there[3] * wanted.damped * random.uniform()),
        torque_body=twist * random.standard_normal(3) * there[4],
        torque_world=twist * random.standard_normal(3) * there[4],
    )
    system = System((Body(np.asarray(mass), center, inertia),), load)
    states = State(
        normalize(random.standard_normal((STATES, 4))),
        rate * random.standard_normal((STATES, 3)),
        size * random.standard_normal((STATES, 3)),
        size * rate * random.standard_normal((STATES, 3)),
    )
    return Motion(system, place_on_pivot(system, states))


def accelerations(adapter: Adapter, motion: Motion) -> Acceleration:
    """The engine's answer."""
    adapter.load(motion.system)
    return adapter.forward_dynamics(motion.states)


def equation_gap(
    motions: tuple[Motion, Motion], expected: Acceleration, found: Acceleration
) -> float:
    """The distance of two accelerations over what rounding allows, at its largest.

    Rounding allows ``eps cond S / J`` an operation on either side: S the terms of equation (8) by
    size, J the largest inertia, cond that over the smallest; the same sizes as the equation gate.
    """
    angular = linear = 0.0
    for side in motions:
        scale = body_scale(side.system)
        allowed = torque_size(side.system, side.states, expected) / scale.smallest
        angular = np.maximum(angular, ROUNDINGS * EPS * allowed)
        allowed = linear_size(side.system, side.states, expected)
        linear = np.maximum(linear, ROUNDINGS * EPS * allowed)
    return float(
        np.max(
            [
                norm(found.angular - expected.angular) / angular,
                norm(found.linear - expected.linear) / linear,
            ]
        )
    )


def timestep_of(motion: Motion) -> float:
    """A step in which the body turns by about a twentieth of a radian, or is so accelerated."""
    spin = norm(motion.states.angular_velocity)
    pull = norm(forward_dynamics(motion.system, motion.states).angular)
    return 0.05 / float(np.max([spin, np.sqrt(pull)]))


def trajectory(adapter: Adapter, motion: Motion, integrator: str, timestep: float) -> State:
    """The engine's states over some steps, from the first state."""
    adapter.load(motion.system)
    return adapter.run(motion.first, integrator, timestep, STEPS, 1).state


def trajectory_gap(
    adapter: Adapter,
    motion: Motion,
    integrator: str,
    timestep: float,
    expected: State,
    found: State,
    relation: str = "",
) -> float:
    """The distance of two trajectories of a motion over what rounding may grow to in both.

    The growth is that of the declared scheme along its own trajectory, or of RK4 without one.
    A scheme that steps a velocity in body axes turns a steady one by an error of its own order, so
    that of a Galilean shift only the rotation knows nothing.
    """
    system = motion.system
    times = timestep * np.arange(STEPS + 1)
    yardstick = Yardstick(system, times, expected)
    named = next(i for i in adapter.description.integrators if i.name == integrator)
    key = scheme_key(named, system) or SchemeKey("rk4-quaternion")
    in_body = key.coordinates == "body-spatial" or key.scheme == "body-axes-midpoint"
    turned = relation == "galilean" and in_body
    plan = [Steps(timestep, STEPS, 1)]
    own = companion(system, motion.first, key.scheme, yardstick.rate, plan, key.coordinates)[0]
    bounds = yardstick.round_off(timestep, np.arange(STEPS + 1.0), own.growth)
    gaps = [
        np.max(yardstick.distance(channel, expected, found) / (2.0 * bounds[channel]))
        for channel in (ROTATION if turned else CHANNELS)
    ]
    return float(np.max(gaps))
