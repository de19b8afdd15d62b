"""The requests that a worker answers: each operation takes the adapter and the request's fields."""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import Any

import numpy as np

from omegadot.adapters.protocol import Adapter, Trajectory, UnsupportedError
from omegadot.reference_impl.companion import Steps, companion
from omegadot.reference_impl.exact_solution import exact_solution
from omegadot.reference_impl.motion import forward_dynamics
from omegadot.reference_impl.system import State
from omegadot.workers.engine_end.checked import (
    checked_acceleration,
    checked_bodies,
    checked_description,
    checked_native,
    checked_seconds,
    checked_state,
    checked_torque,
    checked_trajectory,
)
from omegadot.workers.engine_end.memory import peak_memory
from omegadot.workers.wire import acceleration_from, state_from, system_from

Request = dict[str, Any]


def _lead(states: State) -> tuple[int, ...]:
    """The leading axes of some states: () for one, (n,) for n."""
    return states.angular_velocity.shape[:-1]


def _load(adapter: Adapter, request: Request) -> Any:
    """Load a system; the description that comes back may refers to this very system."""
    adapter.load(system_from(request["system"]))
    return checked_description(adapter.description)


def _model(adapter: Adapter, request: Request) -> Any:
    """Bodies as the engine holds them, and a state after a round trip through it."""
    state = state_from(request["state"])
    adapter.set_state(state)
    bodies = checked_bodies(adapter.model(), 1)
    return {
        "bodies": bodies,
        "state": checked_state("get_state()", adapter.get_state(), _lead(state)),
    }


def _forward(adapter: Adapter, request: Request) -> Any:
    states = state_from(request["states"])
    return checked_acceleration(adapter.forward_dynamics(states), _lead(states))


def _inverse(adapter: Adapter, request: Request) -> Any:
    states = state_from(request["states"])
    torque = adapter.inverse_dynamics(states, acceleration_from(request["acceleration"]))
    return {"torque": checked_torque(torque, _lead(states))}


def _is_finite(state: State) -> Any:
    values = (state.orientation, state.angular_velocity, state.position, state.linear_velocity)
    return np.all(np.concatenate([np.isfinite(v) for v in values], axis=-1), axis=-1)


def _timed_run(adapter: Adapter, request: Request) -> tuple[Trajectory, float]:
    initial = state_from(request["initial"])
    step = (request["integrator"], request["timestep"])
    adapter.run(initial, *step, 1, 1)  # a warm-up, so that first-call costs are not counted
    started = time.perf_counter()
    trajectory = adapter.run(initial, *step, request["steps"], request["every"])
    whole = time.perf_counter() - started
    checked = checked_trajectory(trajectory)
    return checked, checked_seconds(checked.seconds, whole) / request["steps"]


def _run(adapter: Adapter, request: Request) -> Any:
    """A run with the engine's own omega-dot at its samples; the time per step is its own."""
    trajectory, seconds_per_step = _timed_run(adapter, request)
    finite = _is_finite(trajectory.state)
    angular = np.full(trajectory.state.angular_velocity.shape, np.nan)
    if "forward_dynamics" in adapter.description.features and finite.any():
        state = trajectory.state
        kept = State(
            state.orientation[finite],
            state.angular_velocity[finite],
            state.position[finite],
            state.linear_velocity[finite],
        )
        found = adapter.forward_dynamics(kept)
        angular[finite] = checked_acceleration(found, _lead(kept)).angular
    return {
        "time": trajectory.time,
        "state": trajectory.state,
        "omega_dot": angular,
        "seconds_per_step": seconds_per_step,
    }


def _first_steps(adapter: Adapter, request: Request) -> Any:
    """The states (m, k, ...) that single steps of (m, k) sizes lead to from m states."""
    states, ends = state_from(request["states"]), []
    for index, timesteps in enumerate(request["timesteps"]):
        start = State(*(values[index] for values in vars(states).values()))
        for timestep in timesteps:
            run = adapter.run(start, request["integrator"], float(timestep), 1, 1)
            state = checked_trajectory(run).state
            ends.append([values[-1] for values in vars(state).values()])
    shape = request["timesteps"].shape
    stacked = (np.array(values) for values in zip(*ends, strict=True))
    return State(*(values.reshape(*shape, -1) for values in stacked))


def _solve(_: Adapter, request: Request) -> Any:
    """The exact states, their floor, and exact omega-dot; no engine takes part."""
    system, initial = system_from(request["system"]), state_from(request["initial"])
    found = exact_solution(system, initial, request["times"])
    omega_dot = forward_dynamics(system, found.state).angular
    return {**vars(found), "omega_dot": omega_dot}


def _companion(_: Adapter, request: Request) -> Any:
    """The reference stepping one scheme over a sweep, with the growth of rounding."""
    system, initial = system_from(request["system"]), state_from(request["initial"])
    plan = [Steps(**step) for step in request["plan"]]
    how = (request["scheme"], request["rate"], plan, request["coordinates"])
    runs = companion(system, initial, *how)
    return [
        {
            "time": run.time,
            "state": run.state,
            "growth": run.growth,
            "omega_dot": forward_dynamics(system, run.state).angular,
        }
        for run in runs
    ]


def _native(adapter: Adapter, _: Request) -> Any:
    """The engine's own conventions and defaults; no part of the protocol, so it may be lacking."""
    request = getattr(adapter, "native", None)
    if request is None:
        raise UnsupportedError("the adapter cannot decide the engine's own conventions.")
    return checked_native(request())


def _memory(_: Adapter, __: Request) -> Any:
    return peak_memory()


OPERATIONS: dict[str, Callable[[Adapter, Request], Any]] = {
    "native": _native,
    "memory": _memory,
    "solve": _solve,
    "companion": _companion,
    "load": _load,
    "model": _model,
    "forward": _forward,
    "inverse": _inverse,
    "run": _run,
    "first_steps": _first_steps,
}
