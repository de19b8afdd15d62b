"""omega-dot that is a difference quotient of omega."""

from __future__ import annotations

import numpy as np

from omegadot.diagnosis.equations.evidence import BEYOND_ROUNDING, SLACK, Evidence
from omegadot.gates.bounds.scales import norm
from omegadot.reference_impl.one_body.body_motion import attitude_motion
from omegadot.reference_impl.schemes import SCHEMES
from omegadot.written import written


def difference_quotient(evidence: Evidence) -> str:
    """omega-dot as ``(omega(t + h) - omega(t)) / h``, one h at all states.

    It is off by ``h/2`` times the second derivative; the third bounds what is left, by h times the
    fastest rate of the size of the first.
    """
    motion, states = attitude_motion(evidence.system), evidence.states
    rate = float(np.max(norm(evidence.states.angular_velocity)))
    off = norm(evidence.found.linear - evidence.true.linear)
    free = evidence.system.load.pivot is None
    if not rate > 0.0 or (free and not np.all(off <= SLACK * evidence.linear_bound)):
        return ""  # it would be omega-dot alone that is off
    if np.all(
        norm(evidence.found.angular - evidence.true.angular)
        <= BEYOND_ROUNDING * evidence.angular_bound
    ):
        return ""
    delta, step = 1e-4 / rate, SCHEMES["lie-rk4"].step
    ahead, behind = (
        motion.acceleration(*step(motion, states.orientation, states.angular_velocity, h))
        for h in (delta, -delta)
    )
    second = (ahead - behind) / (2 * delta)
    rest = evidence.found.angular - evidence.true.angular
    weight = 1.0 / evidence.angular_bound[:, None]
    line = np.ravel(0.5 * second * weight)
    h = float(np.ravel(rest * weight) @ line / (line @ line))
    left = norm(rest - 0.5 * h * second)
    if not 0.0 < h * rate < 0.1:
        return ""
    allowed = 4.0 * h * rate * (0.5 * h * norm(second)) + SLACK * evidence.angular_bound
    # where the second derivative is small the third is not: the sizes of both count
    allowed = allowed + h**2 * rate**2 * norm(evidence.true.angular)
    if not np.all(left <= allowed):
        return ""
    return f"omega-dot looks like a difference quotient over {written(h, 2)} s"
