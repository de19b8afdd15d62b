"""A record whose body turns over at 1 s and 3 s, on engines that do, do so late, or never."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import polars as pl
from synthetic_record import build

from omegadot.reports.record.record import Record

ENGINES: dict[str, dict[str, int]] = {
    "reference": {"lie-rk4": 4},
    "mujoco": {"Euler": 1, "RK4": 4},
    "dart": {"semi-implicit": 1},
    "drake": {"discrete": 1},
    "havok": {"step": 1},
}
LATE = 0.7  # DART turns over at 1 / 0.7 s, and has no time for a second flip


def turning_record() -> Record:
    """`turning`: omega along the middle axis is 2 cos(pi t / 2), 2 rad/s in havok; and `sphere`."""
    record = build(("sphere", "turning"), engines=ENGINES, steps=(0.02, 0.01))
    _, entry = record.run["scenarios"]
    entry["system"]["inertia"] = [[0.3, 0.0, 0.0], [0.0, 0.5, 0.0], [0.0, 0.0, 0.4]]
    rate = pl.when(pl.col("engine") == "dart").then(LATE).otherwise(1.0)
    turned = 2.0 * (rate * pl.col("time") * np.pi / 2).cos()
    turning = (pl.col("scenario") == "turning") & (pl.col("engine") != "havok")
    rows = record.trajectories.with_columns(
        wz=pl.when(turning).then(turned).otherwise(pl.col("wz"))
    )
    return replace(record, trajectories=rows)
