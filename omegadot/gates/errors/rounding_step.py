"""The step below which rounding outweighs truncation, where an error grows as the step shrinks.

A scheme of order p leaves an error that falls as h^p, and the rounding of n = t / h steps rises as
1 / h. In single precision the two meet at steps that are used in practice, and a finer step is then
worse. In double the errors are too small there to matter, and nothing is written.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from omegadot.gates.bounds.scales import EPS
from omegadot.gates.errors.findings import Declared
from omegadot.gates.errors.measured_run import ROTATION, MeasuredRun
from omegadot.gates.rows import Row
from omegadot.written import written

GATE = "scheme"
METRIC = "rounding_step"
SATURATED = 0.5  # rad, or of the rate: beyond it an error is no power of the step


def rows(measured_runs: Sequence[MeasuredRun], declared: Declared, eps: float) -> list[Row]:
    """Per channel of the rotation whose error grows as the step shrinks, within its bound."""
    if eps <= EPS:
        return []
    found = [_row(measured_runs, channel, declared.orders[channel]) for channel in ROTATION]
    return [row for row in found if row is not None]


def _row(measured_runs: Sequence[MeasuredRun], channel: str, order: int | None) -> Row | None:
    """Where ``e_c (h / h_c)^p``, from the coarsest run, meets ``e_f h_f / h``, from the finest.

    Its bound takes for e_f the round-off bound of the coarsest run: the step is that long at most.
    """
    unsaturated = [run for run in measured_runs if np.max(run.error[channel]) <= SATURATED]
    finest_first = sorted(unsaturated, key=lambda run: run.sweep.timestep)
    steps = [run.sweep.timestep for run in finest_first]
    errors = [float(np.max(run.error[channel])) for run in finest_first]
    bounds = [float(np.max(run.round_off[channel])) for run in finest_first]
    if order is None or not steps or not min(errors) < errors[0] <= bounds[0] < np.inf:
        return None
    text = "its error grows as the step shrinks: rounding outweighs truncation"
    if min(errors) == errors[-1]:
        note = f"{text} at every step here"
        return Row(GATE, channel, METRIC, steps[-1], "s", None, "info", note)
    (coarse, truncation, most), power = (steps[-1], errors[-1], bounds[-1]), 1.0 / (order + 1.0)
    meet = coarse * (errors[0] * steps[0] / (truncation * coarse)) ** power
    bound = coarse * (most / truncation) ** power
    note = f"{text} below h = {written(meet, 2)} s"
    return Row(GATE, channel, METRIC, meet, "s", bound, "info", note)
