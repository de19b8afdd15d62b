"""When the trace flips about its middle axis, compared with the exact motion."""

from __future__ import annotations

import numpy as np

from omegadot.commands.score.bounds import Rounding
from omegadot.commands.score.exact_trajectory import ExactTrajectory
from omegadot.commands.score.measured import Measured
from omegadot.commands.score.trace import Trace
from omegadot.gates.interpolation import Hermite
from omegadot.gates.phase import flip_rows
from omegadot.gates.rows import Row
from omegadot.gates.scales import norm
from omegadot.gates.truth import Truth


def flips_of(
    truth: Truth, trajectory: ExactTrajectory, trace: Trace, measured: Measured, bound: Rounding
) -> list[Row]:
    """The largest error of a flip's time; none without omega, or where nothing flips.

    Both trajectories are interpolated alike between the trace's samples. What that leaves open is
    the cubic's own error, found half-way between the samples on the exact trajectory.
    """
    if trace.angular_velocity is None or len(trace.times) < 3:
        return []
    exact = Hermite(truth.times, truth.state.angular_velocity, truth.omega_dot)
    middle = 0.5 * (trace.times[1:] + trace.times[:-1])
    gap = float(np.max(norm(exact.at(middle)[0] - trajectory(middle).angular_velocity)))
    rounding = truth.yardstick.rate * float(np.max(bound["omega"]))
    with np.errstate(all="ignore"):
        return flip_rows(truth.yardstick.system, exact, measured.state, rounding + gap, rounding)
