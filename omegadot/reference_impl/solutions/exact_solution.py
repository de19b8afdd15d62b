"""The exact motion of a system: in closed form where one is known, else by its Taylor series."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from omegadot.reference_impl.closed_forms import Floor, closed_form_of, floor
from omegadot.reference_impl.motion import forward_dynamics
from omegadot.reference_impl.solutions.growth import growth_along
from omegadot.reference_impl.solutions.representable import check_representable, check_solved
from omegadot.reference_impl.solutions.series import solve_series
from omegadot.reference_impl.system import Array, State, System

EPS = float(np.finfo(float).eps)


@dataclass(frozen=True)
class ExactSolution:
    """source: "closed-form" or "series".  state: (n,).  floor: what doubles can resolve."""

    source: str
    state: State
    floor: Floor


def exact_states(system: System, initial: State, times: Array) -> tuple[str, State]:
    """How it was found ("closed-form" or "series"), and the states at `times`, (n,) s."""
    form = closed_form_of(system, initial) if len(system.bodies) == 1 else None
    if form is None:
        return "series", solve_series(system, initial, times)
    return "closed-form", form(times)


def exact_solution(system: System, initial: State, times: Array) -> ExactSolution:
    """The exact states at rising `times`, (n,) s, with the resolvable floor of each.

    Raises UnrepresentableError where double precision cannot hold the motion.
    """
    check_representable(system, initial, float(np.max(np.abs(times), initial=0.0)))
    with np.errstate(over="ignore", invalid="ignore", divide="ignore"):  # refused where it matters
        source, state = exact_states(system, initial, times)
        check_solved(state, forward_dynamics(system, state).angular, times)
    if source == "closed-form":
        return ExactSolution(source, state, floor(system, initial, times))
    return ExactSolution(source, state, _floor_by_growth(system, times, state))


def _floor_by_growth(system: System, times: Array, state: State) -> Floor:
    """The floor where there is no form to solve again with each input moved.

    The start is off by an eps, and the inertia's eps moves omega-dot by an eps of its size A, so
    that ``eps (1 + A t / rate) growth`` is off at time t; half an eps is the answer's rounding.
    """
    speed = np.linalg.norm(state.angular_velocity, axis=-1)
    turning = np.linalg.norm(forward_dynamics(system, state).angular, axis=-1)
    rate = float(np.max(speed)) or float(np.max(turning)) * float(times[-1]) or 1.0
    grown = growth_along(system, times, state, rate)
    off = EPS * (1.0 + float(np.max(turning)) / rate * times) * grown
    return Floor(angular_velocity=rate * off + 0.5 * EPS * speed, attitude=off + EPS)
