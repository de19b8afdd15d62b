"""The exact solution as an engine: it is not stepped, so its samples do not depend on the step."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from omegadot.adapters.protocol import Description, Integrator, Trajectory, UnsupportedError
from omegadot.adapters.reference.adapter import ReferenceAdapter
from omegadot.reference_impl.solutions.exact_solution import exact_states
from omegadot.reference_impl.solutions.series import solve_series
from omegadot.reference_impl.stepping import kept_steps
from omegadot.reference_impl.system import State

CLOSED_FORM, SERIES = "closed-form", "series"
NOTE = "solved, not stepped: no order"


class ExactAdapter(ReferenceAdapter):
    """The reference's equations, solved instead of stepped."""

    @property
    def description(self) -> Description:
        """The exact solution: closed forms where there are, else the Taylor series."""
        ways = tuple(Integrator(name, None, {}, note=NOTE) for name in (CLOSED_FORM, SERIES))
        return replace(super().description, name="exact", integrators=ways)

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
        start = vars(initial).values()
        if not all(np.all(np.isfinite(values)) for values in start):
            nowhere = (np.full((len(times), len(values)), np.nan) for values in start)
            return Trajectory(times, State(*nowhere))
        if integrator == SERIES:
            return Trajectory(times, solve_series(self.system, initial, times))
        return Trajectory(times, exact_states(self.system, initial, times)[1])
