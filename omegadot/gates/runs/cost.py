"""Gate 6, cost: what a step and a simulated second take. Measured, not judged."""

from __future__ import annotations

from omegadot.gates.case import Sweep
from omegadot.gates.rows import Row

GATE = "cost"


def rows(sweep: Sweep, seconds_per_step: float) -> list[Row]:
    """Wall time per step, after a warm-up, and simulated seconds per second of it.

    How many steps an error-controlled integrator takes is not known.
    """
    if not seconds_per_step > 0.0:
        return []
    found = [Row(GATE, "time", "real_time_factor", sweep.timestep / seconds_per_step, "1")]
    if sweep.accuracy is None:
        found.insert(0, Row(GATE, "time", "time_per_step", seconds_per_step, "s"))
    return found
