"""Gate 6, cost: what a step and a simulated second take. Measured, not judged."""

from omegadot.gates.rows import Row

GATE = "cost"


def rows(timestep: float, seconds_per_step: float) -> list[Row]:
    """Wall time per step, after a warm-up, and simulated seconds per second of it."""
    if not seconds_per_step > 0.0:
        return []
    return [
        Row(GATE, "time", "time_per_step", seconds_per_step, "s"),
        Row(GATE, "time", "real_time_factor", timestep / seconds_per_step, "1"),
    ]
