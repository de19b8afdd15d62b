"""``omegadot.exact``: the states of a scenario's exact solution at given times."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from omegadot.gates.case import Case
from omegadot.harness.arguments import case_of, scenarios_of
from omegadot.harness.usage import UsageError
from omegadot.reference_impl.motion import forward_dynamics
from omegadot.reference_impl.solutions.exact_solution import exact_solution
from omegadot.reference_impl.solutions.representable import UnrepresentableError
from omegadot.reference_impl.system import Array, State
from omegadot.scenarios import ScenarioLike
from omegadot.written import written

if TYPE_CHECKING:
    import polars as pl

MOST_FURTHER = 10_000  # times beyond the scenario's own


@dataclass(frozen=True, eq=False)
class ExactStates:
    """The exact solution at n times. source: "closed-form", or "series" where there is none.

    time: (n,) s.  orientation: (n, 4), w x y z, world-from-body.  angular_velocity, rad/s, and
    angular_acceleration, rad/s^2, that is omega-dot: (n, 3), body axes.  position, m, and
    linear_velocity, m/s: (n, 3), of the centre of mass, world axes.
    attitude_floor, rad, and angular_velocity_floor, rad/s: (n,), how far a perfect answer in double
    precision may be off, because the scenario's own numbers are rounded.
    """

    source: str
    time: Array
    orientation: Array
    angular_velocity: Array
    angular_acceleration: Array
    position: Array
    linear_velocity: Array
    attitude_floor: Array
    angular_velocity_floor: Array

    def to_polars(self) -> pl.DataFrame:
        """A row a time: the columns of ``trajectories.parquet``, and the two floors."""
        import polars as pl

        named = {
            "q": (self.orientation, "wxyz"),
            "w": (self.angular_velocity, "xyz"),
            "a": (self.angular_acceleration, "xyz"),
            "p": (self.position, "xyz"),
            "v": (self.linear_velocity, "xyz"),
        }
        columns = {
            f"{letter}{axis}": values[:, place]
            for letter, (values, axes) in named.items()
            for place, axis in enumerate(axes)
        }
        names = ("attitude_floor", "angular_velocity_floor")
        floors = {name: getattr(self, name) for name in names}
        return pl.DataFrame({"time": self.time, **columns, **floors})


def exact(scenario: ScenarioLike, times: ArrayLike | None = None) -> ExactStates:
    """The exact solution of a scenario: states, omega-dot and floor at given times.

    scenario: a built-in's name, a path, a scenario or its tables.  times: s, one or several,
    from 0 on and rising; without them, the sample times of the scenario's own sweep.
    Closed forms where there are (double precision, to the floor), else a Taylor series.
    Raises ScenarioError, and UsageError for times that do not rise from 0 on.
    """
    case = case_of(scenarios_of([scenario])[0], ())
    requested = case.sample_times if times is None else _checked(times, case)
    followed = _followed(case, requested)
    rows = np.searchsorted(followed, requested)
    try:
        solution = exact_solution(case.system, case.initial, followed)
    except UnrepresentableError as error:
        raise UsageError(
            f"exact solution of {case.name}: at {written(followed[-1])} s, {error}; "
            "give earlier times."
        ) from None
    state = State(*(values[rows] for values in vars(solution.state).values()))
    return ExactStates(
        source=solution.source,
        time=requested,
        orientation=state.orientation,
        angular_velocity=state.angular_velocity,
        angular_acceleration=forward_dynamics(case.system, state).angular,
        position=state.position,
        linear_velocity=state.linear_velocity,
        attitude_floor=solution.floor.attitude[rows],
        angular_velocity_floor=solution.floor.angular_velocity[rows],
    )


def _followed(case: Case, requested: Array) -> Array:
    """The times requested, and those of the scenario's samples, from 0 to the last of all.

    Rounding accumulates along the motion, so the floor needs the whole of it.
    """
    own = case.sample_times
    interval = own[-1] / (len(own) - 1)
    count = math.ceil(min((requested[-1] - own[-1]) / interval, MOST_FURTHER))
    further = own[-1] + interval * np.arange(count)
    return np.union1d(np.concatenate((own, further)), requested)


def _checked(times: ArrayLike, case: Case) -> Array:
    try:
        found = np.atleast_1d(np.array(times, dtype=float))
    except (TypeError, ValueError, OverflowError):
        found = np.empty(0)
    rising = found.ndim == 1 and found.size and np.isfinite(found).all() and found[0] >= 0.0
    if not rising or np.any(np.diff(found) <= 0.0):
        raise UsageError(
            f"exact solution of {case.name}: the times are no rising numbers of seconds from 0 on; "
            "give one or several such."
        )
    return found
