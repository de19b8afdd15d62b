"""A scheme stepped from a start to an end, with the steps kept that were asked for."""

from __future__ import annotations

import numpy as np

from omegadot.reference_impl.kinematics import place_on_pivot
from omegadot.reference_impl.schemes.scheme import AccelerationOf, Scheme
from omegadot.reference_impl.system import Array, State, System


def kept_steps(steps: int, every: int) -> list[int]:
    """The numbers of the steps that are logged: 0, each `every`-th, and the last."""
    if steps < 0 or every < 1:
        raise ValueError(f"steps is {steps} and every is {every}; give steps >= 0 and every >= 1")
    kept = list(range(0, steps + 1, every))
    return kept if kept[-1] == steps else [*kept, steps]


def step_through(
    scheme: Scheme,
    system: System,
    acceleration: AccelerationOf,
    initial: State,
    dt: float | Array,
    steps: int,
    every: int,
) -> tuple[Array, State]:
    """Times and states at step 0, each `every`-th and the last.

    dt: s, a float, or an array; the lanes are those of dt and of `initial`, broadcast against each
    other, and all take as many steps. Times are ``n * dt``, (samples,) or (samples, *dt.shape);
    states have the samples in front, (samples, ..., 3). A pivoted body's position and velocity
    follow from its attitude and ω. A run that diverges goes on with infinities and NaN, without
    warnings.
    Raises ValueError for negative steps or `every` below one.
    """
    kept = kept_steps(steps, every)
    step = scheme.step
    h = float(dt) if np.ndim(dt) == 0 and not isinstance(dt, np.longdouble) else np.asarray(dt)
    state, done = _on_lanes(initial, np.shape(h)), 0
    logged = [state]
    with np.errstate(over="ignore", invalid="ignore", divide="ignore"):
        for target in kept[1:]:
            for _ in range(target - done):
                state = step(acceleration, state, h)
            logged.append(state)
            done = target
        states = place_on_pivot(system, stack(logged))
    return np.multiply.outer(kept, h), states


def _on_lanes(state: State, lanes: tuple[int, ...]) -> State:
    fields = (state.orientation, state.angular_velocity, state.position, state.linear_velocity)
    shape = np.broadcast_shapes(lanes, *(field.shape[:-1] for field in fields))
    return State(*(np.broadcast_to(field, (*shape, field.shape[-1])) for field in fields))


def stack(states: list[State]) -> State:
    """Many states as one, with a new axis in front."""
    return State(
        np.stack([state.orientation for state in states]),
        np.stack([state.angular_velocity for state in states]),
        np.stack([state.position for state in states]),
        np.stack([state.linear_velocity for state in states]),
    )
