"""A run that is interrupted while finer steps could still decide."""

from __future__ import annotations

from dataclasses import replace

from omegadot.adapters.protocol import Integrator
from omegadot.gates.case import Sweep
from omegadot.gates.rows import Row
from omegadot.harness.judging.judged_run import JudgedRun
from omegadot.harness.judging.refine import UNDECIDED, left_undecided

LOW = Row("scheme", "omega", "observed_order", 1.2, "1", 2.0, "fail", "observed order 1.20")
BROKEN = Row("trajectory", "attitude", "unit", 0.1, "1", 1e-15, "fail", "no unit quaternion")


def run(name: str, timestep: float, *rows: Row, unresolved: bool = False) -> JudgedRun:
    integrator = Integrator(name, None, {"omega": 2})
    return JudgedRun(integrator, Sweep(timestep, 10, 1), "ok", "", list(rows), "", unresolved)


def test_what_finer_steps_could_decide_has_no_verdict() -> None:
    """Caught: an interrupted run that accuses an engine of an order which finer steps show."""
    runs = [run("rk2", 0.1, LOW), run("rk2", 0.05, LOW, unresolved=True)]
    for one in left_undecided(runs):
        assert (one.outcome, one.reason, one.rows) == ("interrupted", UNDECIDED, [])


def test_what_is_decided_stays() -> None:
    """Caught: verdicts that are dropped with those of another integrator or step."""
    sound, broken = run("rk2", 0.1), run("rk2", 0.2, BROKEN)
    other = run("rk4", 0.1, LOW)
    still_open = run("rk2", 0.05, unresolved=True)
    kept = left_undecided([sound, broken, other, still_open])
    assert kept[:3] == [sound, broken, other]
    assert kept[3] == replace(still_open, outcome="interrupted", reason=UNDECIDED, unresolved=False)
