"""Turns below a limit that a step does not make: a guard against a division by a small angle.

It shows without any scheme: the attitude stays as it was, though omega is not zero. No step between
two such samples turns the body by as much as the limit.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from omegadot.diagnosis.stepping.kept_run import KeptRun
from omegadot.diagnosis.wording.digits import limits
from omegadot.gates.bounds.scales import EPS, norm
from omegadot.reference_impl.rotations import rotation_between
from omegadot.reference_impl.system import Array

SCENARIOS = 2  # at least, in which such a turn is left out, and is made
LOST = 64.0 * EPS  # rad: a turn that a sound step may lose in the rounding of a quaternion
# A step turns by the omega of its start, or of its end.
OMEGAS: tuple[Callable[[Array], Array], ...] = (lambda w: w[:-1], lambda w: w[1:])


def short_turns(runs: Sequence[KeptRun]) -> list[str]:
    """The limit below which no step turns the body, of all runs; none without one."""
    for omegas in OMEGAS:
        still, moving = 0.0, np.inf
        shown = set[str](), set[str]()
        for run in runs:
            lengths, q = _turns(run, omegas), run.state.orientation
            made = norm(rotation_between(q[:-1], q[1:])) > LOST
            left_out = ~made & (lengths > LOST)
            for which, names in zip((left_out, made), shown, strict=True):
                names.update({run.name} if np.any(which) else ())
            still = max(still, float(np.max(lengths[left_out], initial=0.0)))
            moving = min(moving, float(np.min(lengths[made], initial=np.inf)))
        if still < moving and min(map(len, shown)) >= SCENARIOS:
            between = limits(still, moving, "rad")
            return [f"a step does not turn the body by less than a limit between {between}"]
    return []


def _turns(run: KeptRun, omegas: Callable[[Array], Array]) -> Array:
    """(n - 1,) rad, of a step in each interval; of several the larger of its two ends."""
    sizes = run.timestep * norm(run.state.angular_velocity)
    if run.sweep.every == 1:
        return omegas(sizes)
    return np.asarray(np.maximum(sizes[:-1], sizes[1:]))
