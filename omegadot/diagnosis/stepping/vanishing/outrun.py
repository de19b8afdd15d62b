"""Whether a wrong equation slows a body down within a step that is short for the right one."""

from __future__ import annotations

import numpy as np

from omegadot.diagnosis.equations.candidate import Candidate
from omegadot.diagnosis.stepping.vanishing.vanishing_steps import VanishingSteps
from omegadot.gates.steps.probe import probe_at
from omegadot.reference_impl.system import Array


def outruns(one: Candidate, steps: VanishingSteps) -> bool:
    """Whether what it gives takes off omega, |omega-dot| h > |omega|, in some of the longest steps.

    Or a free body's velocity. Steps do not vanish against such a rate, and show no limit of it.
    """
    made = one.predicted(steps.evidence)
    if made is None or not np.all(np.isfinite(made.angular)):
        return False
    longest = probe_at(steps.system, steps.states, steps.eps).timesteps[:, 0]
    takes = _takes_off(made.angular, steps.states.angular_velocity, longest)
    if steps.system.load.pivot is not None or not np.all(np.isfinite(made.linear)):
        return takes
    own = made.linear - steps.system.load.gravity  # which is no part of what slows it down
    return takes or _takes_off(own, steps.states.linear_velocity, longest)


def _takes_off(rate: Array, velocity: Array, longest: Array) -> bool:
    change = np.sum(rate * velocity, axis=-1) * longest
    return bool(np.all(change <= 0.0) and np.any(-change > np.sum(velocity * velocity, axis=-1)))
