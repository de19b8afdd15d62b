"""The requests that a worker answers: each operation takes the adapter and the request's fields."""

from __future__ import annotations

import time
from collections.abc import Callable
from functools import partial
from typing import Any

import numpy as np

from omegadot.adapters.protocol import Adapter, Trajectory, UnsupportedError
from omegadot.reference_impl.motion import forward_dynamics
from omegadot.reference_impl.stepping import stack
from omegadot.reference_impl.system import Acceleration, State
from omegadot.workers.engine_end.checked import (
    AnswerError,
    checked,
    checked_bodies,
    checked_native,
    checked_seconds,
    checked_trajectory,
    numbers,
)
from omegadot.workers.engine_end.described import description_of
from omegadot.workers.engine_end.memory import peak_memory
from omegadot.workers.wire import system_from

Request = dict[str, Any]


def _lead(states: State) -> tuple[int, ...]:
    """The leading axes of some states: () for one, (n,) for n."""
    return states.angular_velocity.shape[:-1]


def _own(state: State) -> State:
    """A copy of one state: an adapter may step in the arrays that it is given."""
    return State(*map(np.array, vars(state).values()))


def _declared(adapter: Adapter, feature: str) -> Callable[..., Any]:
    """The method of a feature. Raises AnswerError where the adapter declares it and has none."""
    method: Callable[..., Any] | None = getattr(adapter, feature, None)
    if method is None:
        raise AnswerError(
            f"description.features names {feature!r}, and the adapter has no method {feature}(); "
            "write the method, or leave the feature out"
        )
    return method


def _load(adapter: Adapter, request: Request) -> Any:
    """Load a system; the description that comes back may refers to this very system."""
    adapter.load(system_from(request["system"]))
    return description_of(adapter)


def _model(adapter: Adapter, request: Request) -> Any:
    """Bodies as the engine holds them, and a state after a round trip, after another one."""
    state = State(**request["state"])
    if "before" in request:
        adapter.set_state(State(**request["before"]))
    adapter.set_state(state)
    bodies = checked_bodies(adapter.model(), 1)
    return {
        "bodies": bodies,
        "state": checked("get_state()", adapter.get_state(), State, _lead(state)),
    }


def _forward(adapter: Adapter, request: Request) -> Any:
    return _accelerations(adapter, State(**request["states"]))


def _accelerations(adapter: Adapter, states: State) -> Acceleration:
    found = _declared(adapter, "forward_dynamics")(states)
    return checked("forward_dynamics()", found, Acceleration, _lead(states))


def _inverse(adapter: Adapter, request: Request) -> Any:
    states = State(**request["states"])
    inverse_dynamics = _declared(adapter, "inverse_dynamics")
    torque = inverse_dynamics(states, Acceleration(**request["acceleration"]))
    return {"torque": numbers("inverse_dynamics()", torque, (*_lead(states), 3))}


def _runs_of(adapter: Adapter, request: Request) -> Callable[..., Trajectory]:
    """The adapter's `run`, with the accuracy where one is requested."""
    run: Callable[..., Trajectory] = adapter.run  # the protocol's has no accuracy
    accuracy = request.get("accuracy")
    return run if accuracy is None else partial(run, accuracy=accuracy)


def _timed_run(adapter: Adapter, request: Request) -> tuple[Trajectory, float]:
    initial, run = State(**request["initial"]), _runs_of(adapter, request)
    step = (request["integrator"], request["timestep"])
    run(_own(initial), *step, 1, 1)  # a warm-up, so that first-call costs are not counted
    started = time.perf_counter()
    trajectory = run(_own(initial), *step, request["steps"], request["every"])
    whole = time.perf_counter() - started
    checked = checked_trajectory(trajectory)
    return checked, checked_seconds(checked.seconds, whole) / request["steps"]


def _run(adapter: Adapter, request: Request) -> Any:
    """A run with the engine's own omega-dot at its samples; the time per step is its own."""
    trajectory, seconds_per_step = _timed_run(adapter, request)
    fields = vars(trajectory.state).values()
    finite = np.all(np.concatenate([np.isfinite(f) for f in fields], axis=-1), axis=-1)
    angular = np.full(trajectory.state.angular_velocity.shape, np.nan)
    if "forward_dynamics" in adapter.description.features and finite.any():
        kept = State(*(f[finite] for f in fields))
        angular[finite] = _accelerations(adapter, kept).angular
    return {
        "time": trajectory.time,
        "state": trajectory.state,
        "omega_dot": angular,
        "seconds_per_step": seconds_per_step,
    }


def _replay(adapter: Adapter, request: Request) -> Any:
    """The states of a run, and nothing before it: not even a first step to warm up."""
    how = (request["integrator"], request["timestep"], request["steps"], request["every"])
    trajectory = checked_trajectory(_runs_of(adapter, request)(State(**request["initial"]), *how))
    return {"time": trajectory.time, "state": trajectory.state}


def _first_steps(adapter: Adapter, request: Request) -> Any:
    """The states (m, k, ...) that single steps of (m, k) sizes lead to from m states."""
    states, integrator = State(**request["states"]), request["integrator"]
    run = _runs_of(adapter, request)

    def end(start: State, timestep: float) -> State:
        found = checked_trajectory(run(_own(start), integrator, timestep, 1, 1))
        if len(found.time) < 2 and abs(found.time[-1]) < abs(found.time[-1] - timestep):
            raise AnswerError("run() of one step has the start alone; answer with its end as well")
        return found.state[-1]

    return stack(
        [
            stack([end(states[index], timestep) for timestep in timesteps])
            for index, timesteps in enumerate(request["timesteps"].tolist())
        ]
    )


def _solve(_: Adapter, request: Request) -> Any:
    """The exact states, their floor, and exact omega-dot; no engine takes part."""
    # No engine's worker solves, and it starts sooner without what this needs.
    from omegadot.reference_impl.solutions.exact_solution import exact_solution

    system, initial = system_from(request["system"]), State(**request["initial"])
    found = exact_solution(system, initial, request["times"])
    omega_dot = forward_dynamics(system, found.state).angular
    return {**vars(found), "omega_dot": omega_dot}


def _companion(_: Adapter, request: Request) -> Any:
    """The reference stepping one scheme over a sweep, with the growth of rounding."""
    from omegadot.reference_impl.solutions.companion import Steps, companion

    system, initial = system_from(request["system"]), State(**request["initial"])
    plan = [Steps(**step) for step in request["plan"]]
    how = (request["scheme"], request["rate"], plan, request["coordinates"])
    runs = companion(system, initial, *how)
    return [{**vars(run), "omega_dot": forward_dynamics(system, run.state).angular} for run in runs]


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
    "replay": _replay,
    "first_steps": _first_steps,
}
