"""The exact trajectory at a trace's own times, whatever these are."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from omegadot.gates.measures import Yardstick
from omegadot.gates.truth import Truth
from omegadot.reference_impl.closed_forms import closed_form_of
from omegadot.reference_impl.exact_solution import exact_solution
from omegadot.reference_impl.growth import growth_along
from omegadot.reference_impl.motion import forward_dynamics
from omegadot.reference_impl.series import solve_series
from omegadot.reference_impl.system import Array, State, System

# Growth and floor change over turns of the body, not over samples.
MOST_FOLLOWED = 1000
ExactTrajectory = Callable[[Array], State]


def part_of(state: State, rows: object) -> State:
    """The states at some samples."""
    return State(*(values[rows] for values in vars(state).values()))


def exact_trajectory(system: System, initial: State) -> ExactTrajectory:
    """The exact motion as a function of rising times (n,) s, none of them negative."""
    form = closed_form_of(system, initial)
    if form is not None:
        return form

    def by_series(times: Array) -> State:
        if times[0] == 0.0:
            return solve_series(system, initial, times)
        found = solve_series(system, initial, np.concatenate(([0.0], times)))
        return part_of(found, slice(1, None))

    return by_series


def _spread(times: Array, known: Array, values: Array) -> Array:
    """Values at some of the times, reported at all: the greater of both neighbours."""
    right = np.clip(np.searchsorted(known, times), 1, len(known) - 1)
    return np.asarray(np.maximum(values[right - 1], values[right]))


def truth_at(system: System, initial: State, times: Array) -> Truth:
    """The exact states at `times`, (n,) s, the growth of rounding up to there, and the floor."""
    rows = np.unique(np.linspace(0, len(times) - 1, MOST_FOLLOWED).round().astype(int))
    some = times[rows]
    if some[0] > 0.0:  # what grows, grows from the start
        some = np.concatenate(([0.0], some))
    exact = exact_solution(system, initial, some)
    state = exact_trajectory(system, initial)(times)
    yardstick = Yardstick(system, times, state)
    growth = growth_along(system, some, exact.state, yardstick.rate)
    floor = {
        "omega": exact.floor.angular_velocity / yardstick.rate,
        "attitude": exact.floor.attitude,
    }
    return Truth(
        source=exact.source,
        times=times,
        state=state,
        omega_dot=forward_dynamics(system, state).angular,
        growth=_spread(times, some, growth),
        floor={channel: _spread(times, some, values) for channel, values in floor.items()},
        yardstick=yardstick,
    )
