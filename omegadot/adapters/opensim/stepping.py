"""OpenSim's manager, stepping from sample to sample in native code."""

from __future__ import annotations

from time import perf_counter
from typing import Any

import numpy as np

from omegadot.adapters.opensim.charts import Chart
from omegadot.adapters.opensim.integrators import Plan
from omegadot.adapters.opensim.joint import coordinates, states
from omegadot.adapters.opensim.model import OpenSimModel
from omegadot.reference_impl.system import Array, State

LOOKED_AT = 64  # samples between two looks at whether a run is still finite
ROOT_OF_LARGEST = 2.0**512  # the least number whose square is not finite


class OpenSimStepper:
    """A run of an integrator: a manager for each chart, of which one goes on where another ends.

    accuracy: of the integrator, None for OpenSim's own.
    """

    def __init__(
        self,
        opensim: Any,
        models: dict[Chart, OpenSimModel],
        plan: Plan,
        timestep: float,
        accuracy: float | None,
    ) -> None:
        self._opensim, self._models, self._plan = opensim, models, plan
        self._timestep, self._accuracy = timestep, accuracy
        self._managers: dict[Chart, Any] = {}

    def _manager(self, chart: Chart) -> Any:
        if chart not in self._managers:
            own: Any = self._opensim.Manager(self._models[chart].model)
            own.setIntegratorMethod(
                getattr(self._opensim.Manager, f"IntegratorMethod_{self._plan.method}")
            )
            for log in (own.setWriteToStorage, own.setPerformAnalyses):
                log(False)
            own.setRecordStatesTrajectory(False)
            if self._plan.fixed:
                own.setIntegratorFixedStepSize(self._timestep)
            if self._accuracy:
                own.setIntegratorAccuracy(self._accuracy)
            self._managers[chart] = own
        return self._managers[chart]

    def run(self, chart: Chart, start: Array, times: Array) -> tuple[Array, list[Chart], float]:
        """Coordinates (n, k) at the start and at these times in s, their charts, and the s.

        A run that is no longer finite is not gone on with: its later rows are NaN.
        """
        rows, charts = [start], [chart]
        began = perf_counter()
        try:
            for first in range(0, len(times), LOOKED_AT):
                self._advance(times[first : first + LOOKED_AT].tolist(), first, rows, charts)
                if not is_finite(rows[-1]):
                    break
        except RuntimeError:
            if is_finite(rows[-1]):
                raise
        seconds = perf_counter() - began
        found = np.full((len(times) + 1, len(start)), np.nan)
        found[: len(rows)] = rows
        charts += [charts[-1]] * (len(found) - len(charts))
        return found, charts, seconds

    def _advance(
        self, times: list[float], first: int, rows: list[Array], charts: list[Chart]
    ) -> None:
        """Go on to these times, in the chart of the last row."""
        chart, several = charts[-1], len(self._models) > 1
        manager = self._manager(chart)
        if not first:
            manager.initialize(self._models[chart].put(rows[-1]))
        for time in times:
            y = manager.integrate(time).getY().to_numpy().copy()
            rows.append(y)
            charts.append(chart)
            if several and not chart.is_apt(y[0], y[1]):
                chart = self._other(chart)
                manager = self._manager(chart)
                again = self.changed(charts[-1], chart, y)
                manager.initialize(self._models[chart].put(again, time))
                rows[-1], charts[-1] = again, chart

    def _other(self, chart: Chart) -> Chart:
        return next(other for other in self._models if other != chart)

    def changed(self, old: Chart, new: Chart, y: Array) -> Array:
        """The same state's coordinates in another chart."""
        system = self._models[new].system
        state: State = states(system, old, y[None])[0]
        return coordinates(system, new, state)


def is_finite(row: Array) -> bool:
    """Whether coordinates are finite, and their squares."""
    return bool(np.all(np.abs(row) < ROOT_OF_LARGEST))
