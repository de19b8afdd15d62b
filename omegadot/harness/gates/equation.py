"""Gate 2, equation: omega-dot, acceleration and torque of the engine at identical states."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from omegadot.harness.plan import Case
from omegadot.harness.rows import Row, judged
from omegadot.harness.scales import (
    EPS,
    ROUNDINGS_PER_EVALUATION,
    angular_size,
    linear_size,
    norm,
    torque_size,
)
from omegadot.reference_impl.kinematics import place_on_pivot
from omegadot.reference_impl.motion import (
    center_of_mass_acceleration,
    forward_dynamics,
    inverse_dynamics,
)
from omegadot.reference_impl.precision import cast, extended, extended_state
from omegadot.reference_impl.system import Acceleration, Array, State, System

GATE = "equation"
BOUND = ROUNDINGS_PER_EVALUATION * EPS


def random_states(case: Case, count: int, seed: Sequence[int]) -> State:
    """`count` states: any attitude, rates over two decades about the scenario's own."""
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
    return place_on_pivot(case.system, state)


def random_acceleration(system: System, states: State, seed: Sequence[int]) -> Acceleration:
    """An acceleration to ask inverse dynamics for: not the one that the loads would give."""
    random = np.random.default_rng(seed)
    free = forward_dynamics(system, states)
    rate = norm(states.angular_velocity)[..., None]
    angular = free.angular + rate**2 * random.standard_normal(free.angular.shape)
    if system.load.pivot is not None:  # the pivot, not the caller, sets the linear part
        return Acceleration(angular, center_of_mass_acceleration(system, states, angular))
    linear = free.linear + rate**2 * random.standard_normal(free.linear.shape)
    return Acceleration(angular, linear)


def _row(channel: str, metric: str, residual: Array, scale: Array, rounding: Array) -> Row:
    """The state that comes nearest to its bound, or passes it by most.

    residual / scale is the value, ``BOUND * rounding / scale`` its bound. Where the scale is zero
    there is nothing to be wrong about, so any residual counts as infinite.
    """
    with np.errstate(divide="ignore", invalid="ignore"):
        value = np.where(residual == 0.0, 0.0, residual / scale)
        bound = BOUND * np.where(scale > 0.0, rounding / scale, 1.0)
        value = np.where(np.isnan(value), np.inf, value)
    nearest = int(np.argmax(value / bound))
    row = Row(GATE, channel, metric, float(value[nearest]), "1", float(bound[nearest]))
    return judged(row, bool(np.all(value <= bound)))


def forward_rows(system: System, states: State, found: Acceleration, metric: str) -> list[Row]:
    """Forward dynamics against equation (8).

    omega_dot: ``|omega_dot - reference| / (|omega_dot| + |omega|^2)``.
    linear_momentum: ``|a - reference| / (the terms of a by size)``, of the centre of mass.
    """
    true = forward_dynamics(extended(system), extended_state(states))
    rate = norm(states.angular_velocity)
    angular = norm(found.angular - true.angular)
    linear = norm(found.linear - true.linear)
    size = linear_size(system, states, true)
    return [
        _row(
            "omega_dot",
            metric,
            angular,
            norm(true.angular) + rate**2,
            angular_size(system, states, true),
        ),
        _row("linear_momentum", metric, linear, size, size),
    ]


def inverse_rows(system: System, states: State, asked: Acceleration, torque: Array) -> list[Row]:
    """Inverse dynamics: ``|tau - reference|`` over the terms of equation (8) by size."""
    exactly = cast(asked, np.longdouble)
    true = inverse_dynamics(extended(system), extended_state(states), exactly)
    size = torque_size(system, states, asked)
    return [_row("torque", "residual", norm(torque - true), size, size)]
