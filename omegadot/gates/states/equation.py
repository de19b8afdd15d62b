"""Gate 2, equation: omega-dot, acceleration and torque of the engine at identical states."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from omegadot.gates.bounds.scales import (
    EPS,
    ROUNDINGS_PER_EVALUATION,
    body_scale,
    linear_size,
    norm,
    omega_dot_bound,
    torque_size,
)
from omegadot.gates.case import Case
from omegadot.gates.rows import Row, within
from omegadot.gates.truth import Truth
from omegadot.reference_impl.arithmetic.precision import extended, in_doubles, to_double
from omegadot.reference_impl.kinematics import place_on_pivot
from omegadot.reference_impl.motion import (
    center_of_mass_acceleration,
    forward_dynamics,
    inverse_dynamics,
)
from omegadot.reference_impl.rotations import normalize
from omegadot.reference_impl.system import Acceleration, Array, State, System
from omegadot.written import written

GATE = "equation"
BOUND = ROUNDINGS_PER_EVALUATION * EPS  # in double, of a well-conditioned body
RANDOM_STATES = 200
PATH_STATES = 200
SPECIAL = 16
NOTES = {
    "residual_alone": "at one state by itself",
    "residual_reloaded": "after another system was loaded in between",
}


@dataclass(frozen=True)
class EvaluationStates:
    """Where an engine's equations are evaluated: at random, and along the exact trajectory.

    path: spread evenly, both ends among them.  acceleration: at the random states, for inverse
    dynamics.
    """

    random: State
    path: State
    acceleration: Acceleration


def evaluation_states_of(case: Case, truth: Truth, seed: int) -> EvaluationStates:
    """The states of a case, the same for every engine and every run."""
    own = [seed, *case.name.encode()]
    states = random_states(case, RANDOM_STATES, own)
    along = np.unique(np.linspace(0, len(truth.times) - 1, PATH_STATES).round().astype(int))
    path = truth.state[along]
    return EvaluationStates(states, path, random_acceleration(case.system, states, own))


def random_states(case: Case, count: int, seed: Sequence[int]) -> State:
    """`count` states: any attitude, rates over two decades about the scenario's own.

    A tenth are turned little, by 0.003 to 0.3 rad, where formulas for small angles take over. A few
    others spin about one of the body's axes, do not turn, or do not move.
    """
    random = np.random.default_rng(seed)
    orientation = random.standard_normal((count, 4))
    orientation /= np.linalg.norm(orientation, axis=-1, keepdims=True)
    body, initial = case.system.body, case.initial
    gyration = np.sqrt(float(np.trace(body.inertia)) / float(body.mass))
    rate = float(norm(initial.angular_velocity)) or 1.0
    speed = float(norm(initial.linear_velocity)) or rate * gyration
    reach = float(norm(initial.position)) or gyration
    spread = 10.0 ** random.uniform(-1.0, 1.0, (count, 1))
    state = State(
        orientation=orientation,
        angular_velocity=rate * spread * random.standard_normal((count, 3)),
        position=reach * random.standard_normal((count, 3)),
        linear_velocity=speed * random.standard_normal((count, 3)),
    )
    few = count // 10
    half = 0.5 * 10.0 ** random.uniform(-2.5, -0.5, (few, 1))
    axes = orientation[:few, 1:] / norm(orientation[:few, 1:])[..., None]
    turned = np.concatenate([np.cos(half), np.sin(half) * axes], axis=-1)
    orientation[count - few :] = turned * np.where(np.arange(few) % 2, -1.0, 1.0)[:, None]
    still = np.arange(min(few, SPECIAL)) + few
    state.angular_velocity[still] *= np.eye(4, 3)[still % 4]
    state.linear_velocity[still[still % 4 == 0]] = 0.0  # of these that turn
    return place_on_pivot(case.system, state)


def random_acceleration(system: System, states: State, seed: Sequence[int]) -> Acceleration:
    """An acceleration at which inverse dynamics is evaluated: not the one that the loads give."""
    random = np.random.default_rng(seed)
    free = forward_dynamics(system, states)
    rate = norm(states.angular_velocity)[..., None]
    angular = free.angular + rate**2 * random.standard_normal(free.angular.shape)
    if system.load.pivot is not None:  # the pivot, not the caller, sets the linear part
        return Acceleration(angular, center_of_mass_acceleration(system, states, angular))
    gyration = np.sqrt(np.trace(system.body.inertia) / system.body.mass)
    linear = free.linear + rate**2 * gyration * random.standard_normal(free.linear.shape)
    return Acceleration(angular, linear)


def _apart(found: Array, true: Array) -> Array:
    """``|found - true|`` of doubles and the truth, taken before any digit is dropped.

    By hypot, which has no square to lose: where nothing acts, the least that moves is a fault.
    """
    length: Array = np.hypot.reduce(to_double(found - true), -1)
    return length


UNITS = {"omega_dot": "rad/s^2", "linear_momentum": "m/s^2", "torque": "N m"}


def _row(
    channel: str, metric: str, residual: Array, size: Array, bound: float, states: State
) -> Row:
    """The state with the largest residual, relative to `size`, against its bound.

    Where the size is zero there is nothing to be wrong about: any residual there is too large. The
    largest such one stands as it is, in the channel's own unit.
    """
    note = NOTES.get(metric, "")
    if not np.all(np.isfinite(residual)):
        return within(GATE, channel, metric, float("nan"), "1", bound, note)
    undue = np.where((size == 0.0) & (residual > 0.0), residual, 0.0)
    if np.any(undue):
        note = note or _place(states, int(np.argmax(undue)))
        return within(GATE, channel, metric, float(np.max(undue)), UNITS[channel], 0.0, note)
    with np.errstate(divide="ignore", invalid="ignore"):
        value = np.where(residual == 0.0, 0.0, residual / size)
    note = note or _place(states, int(np.argmax(value)))
    return within(GATE, channel, metric, float(np.max(value)), "1", bound, note)


def _place(states: State, place: int) -> str:
    """At which state: a motion need not come near those that are drawn."""
    rate = float(norm(states.angular_velocity[place]))
    return f"at a state of |omega| = {written(rate, 3)} rad/s"


def forward_rows(
    system: System, states: State, found: Acceleration, metric: str, eps: float = EPS
) -> list[Row]:
    """Forward dynamics against equation (8).

    omega_dot: ``J |omega_dot - reference| / S``, S the terms of (8) by size (`torque_size`) and J
    the largest inertia among them, within ``64 eps cond`` (`omega_dot_bound`).
    linear_momentum: the centre of mass's acceleration, relative to its terms by size.
    """
    true = forward_dynamics(extended(system), extended(states))
    linear = _apart(found.linear, true.linear)
    size = linear_size(system, states, in_doubles(true), eps)
    return [
        _omega_dot_row(system, states, found.angular, true, metric, eps),
        _row("linear_momentum", metric, linear, size, ROUNDINGS_PER_EVALUATION * eps, states),
    ]


def _omega_dot_row(
    system: System, states: State, omega_dot: Array, true: Acceleration, metric: str, eps: float
) -> Row:
    size = torque_size(system, states, in_doubles(true)) / body_scale(system).largest
    apart = _apart(omega_dot, true.angular)
    return _row("omega_dot", metric, apart, size, omega_dot_bound(system, eps), states)


def reported_rows(system: System, states: State, omega_dot: Array, eps: float = EPS) -> list[Row]:
    """The omega-dot reported along a run, against equation (8) at the very states that it reports.

    States that are not finite, or whose squares overflow, have no omega-dot to be held against.
    Neither have those that damping has brought so near to rest that squares lose digits to
    underflow, nor those whose quaternion is so short.
    """
    with np.errstate(over="ignore", invalid="ignore"):
        rate = norm(states.angular_velocity) ** 2
    kept = np.isfinite(rate) & np.isfinite(norm(states.orientation)) & np.isfinite(norm(omega_dot))
    least = np.sqrt(np.finfo(float if eps <= EPS else np.float32).tiny / eps)
    largest = np.max(np.abs(states.angular_velocity), axis=-1)
    kept &= (largest == 0.0) | (largest >= least)
    kept &= norm(states.orientation) >= least  # a shorter quaternion has no direction
    if not kept.any():
        return []
    sound = states[kept]
    unit = replace(sound, orientation=normalize(sound.orientation))
    true = forward_dynamics(extended(system), extended(unit))
    return [_omega_dot_row(system, unit, omega_dot[kept], true, "residual_in_run", eps)]


def inverse_rows(
    system: System,
    states: State,
    requested: Acceleration,
    torque: Array,
    metric: str = "residual",
    eps: float = EPS,
) -> list[Row]:
    """Inverse dynamics: ``|tau - reference|`` relative to the terms of equation (8) by size."""
    true = inverse_dynamics(extended(system), extended(states), extended(requested))
    size = torque_size(system, states, requested)
    bound = ROUNDINGS_PER_EVALUATION * eps
    return [_row("torque", metric, _apart(torque, true), size, bound, states)]
