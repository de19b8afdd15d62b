"""The exact solution as an engine: it is not stepped, so its samples do not depend on the step."""

from __future__ import annotations

import numpy as np

from omegadot import __version__
from omegadot.adapters.protocol import Description, Integrator, Trajectory, UnsupportedError
from omegadot.adapters.reference.adapter import FEATURES, ReferenceAdapter
from omegadot.reference_impl.exact_solution import exact_states
from omegadot.reference_impl.series import solve_series
from omegadot.reference_impl.stepping import kept_steps
from omegadot.reference_impl.system import State

CLOSED_FORM, SERIES = "closed-form", "series"
NOTE = "solved, not stepped: no order"


class ExactAdapter(ReferenceAdapter):
    """The reference's equations, solved instead of stepped."""

    @property
    def description(self) -> Description:
        """The exact solution: closed forms where there are, else the Taylor series."""
        return Description(
            name="exact",
            version=__version__,
            integrators=tuple(
                Integrator(name, None, {}, note=NOTE) for name in (CLOSED_FORM, SERIES)
            ),
            conventions=("the project's own: equation (8), body axes, about the centre of mass",),
            features=FEATURES,
            licence="Apache-2.0",
        )

    def run(
        self, initial: State, integrator: str, timestep: float, steps: int, every: int
    ) -> Trajectory:
        """The exact states at the times of the kept steps; NaN from a state that is not finite.

        Where no closed form is known the series stands in for it. Raises UnsupportedError for
        another integrator.
        """
        if integrator not in (CLOSED_FORM, SERIES):
            raise UnsupportedError(f"the exact solution has no integrator {integrator!r}.")
        times = np.multiply(kept_steps(steps, every), timestep)
        if not _is_finite(initial):
            return Trajectory(times, _nowhere(len(times)))
        if integrator == SERIES:
            return Trajectory(times, solve_series(self.system, initial, times))
        return Trajectory(times, exact_states(self.system, initial, times)[1])


def _is_finite(state: State) -> bool:
    parts = (state.orientation, state.angular_velocity, state.position, state.linear_velocity)
    return all(bool(np.all(np.isfinite(part))) for part in parts)


def _nowhere(n: int) -> State:
    vector = np.full((n, 3), np.nan)
    return State(np.full((n, 4), np.nan), vector, vector, vector)
