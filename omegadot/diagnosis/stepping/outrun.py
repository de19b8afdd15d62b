"""Whether a wrong equation slows a body down within a step that is short for the right one."""

from __future__ import annotations

import numpy as np

from omegadot.diagnosis.equations.candidate import Candidate
from omegadot.diagnosis.stepping.vanishing_steps import VanishingSteps
from omegadot.gates.steps.probe import probe_at


def outruns(one: Candidate, steps: VanishingSteps) -> bool:
    """Whether what it gives takes off omega, |omega-dot| h > |omega|, in some of the longest steps.

    Steps do not vanish against such a rate, and show no limit of it.
    """
    made = one.predicted(steps.evidence)
    if made is None or not np.all(np.isfinite(made.angular)):
        return False
    w = steps.states.angular_velocity
    longest = probe_at(steps.system, steps.states, steps.eps).timesteps[:, 0]
    change = np.sum(made.angular * w, axis=-1) * longest
    return bool(np.all(change <= 0.0) and np.any(-change > np.sum(w * w, axis=-1)))
