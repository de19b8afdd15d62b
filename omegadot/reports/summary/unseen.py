"""What a failing measure was taken at, where no run comes near it and so none shows the fault."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import polars as pl

from omegadot.reports.record.record import Record
from omegadot.reports.summary.reasons import failing_gates
from omegadot.reports.text.numbers import listed, short

Row = Mapping[str, Any]
OF_STEPS = "rate_at_no_step"  # single steps from states of their own
AT_STATES, ALONG = "residual", "residual_on_path"
SHOWING = ("invariants", "trajectory")


def unseen(record: Record, worst: Row, own: Sequence[Row], failing: Sequence[Row]) -> str:
    """Where the failure shows in no run: that it does not, as a clause; "" where it does.

    worst: the row that is quoted.  own: every row of its engine.  failing: the tasks of which its
    gate fails.  States are drawn at rates of up to ten times a scenario's own and beyond, so that
    its runs may hold though the engine is wrong.
    """
    scenario = worst["scenario"]
    below = _fastest(record.trajectories, scenario)
    if worst["metric"] == OF_STEPS:
        here = [task for task in failing if task["scenario"] == scenario]
        hold = [g for g in SHOWING if any(t["gates"].get(g) == "pass" for t in here)]
        if not hold or any(gate in failing_gates(t) for t in here for gate in SHOWING):
            return ""
        whose = f"{listed(hold)} {'gate holds' if len(hold) == 1 else 'gates hold'}"
        return f"the runs on {scenario} do not show it: {below}their {whose}"
    if worst["gate"] == "equation" and worst["metric"] == AT_STATES:
        along = [
            row["verdict"]
            for row in own
            if (row["scenario"], row["channel"]) == (scenario, worst["channel"])
            and row["metric"] == ALONG
        ]
        if along and "fail" not in along:
            return f"along the motion of {scenario} it does not show: {below}it holds there"
    return ""


def _fastest(trajectories: pl.DataFrame, scenario: str) -> str:
    """The greatest rate of the exact motion, as the beginning of a clause; "" without any."""
    exact = trajectories.filter(engine="exact", scenario=scenario)
    if exact.is_empty():
        return ""
    rates = np.linalg.norm(exact.select("wx", "wy", "wz").to_numpy(), axis=1)
    return f"|omega| is at most {short(float(rates.max()), 3)} rad/s, and "
