"""Steps at which a scheme changes its formula: where rounding decides which of the two is taken."""

from __future__ import annotations

import numpy as np

from omegadot.gates.bounds.measures import Yardstick
from omegadot.gates.bounds.scales import norm
from omegadot.gates.case import Sweep
from omegadot.gates.truth import Companion
from omegadot.reference_impl.schemes import SCHEMES
from omegadot.reference_impl.system import Array


def opened_by_change(
    yardstick: Yardstick, sweep: Sweep, own: Companion, theta: Array
) -> dict[str, Array]:
    """(n,) per channel: how far apart one scheme's runs may be as its formula changes at a turn.

    theta: (n,), what rounding may make of omega, relative to the yardstick's rate.  Where the turn
    of a step ``h |omega|`` is that at which the formula changes, to rounding of either run, each
    may take another formula, and they are apart by what the two differ by there. Of N such steps
    the attitude is off by ``N jump growth`` at most. Empty where no step is near, which is so for
    all but a steady spin of that very rate.
    """
    change = SCHEMES[own.scheme].change if own.scheme in SCHEMES else None
    if change is None:
        return {}
    step, numbers = sweep.timestep, sweep.sample_steps
    turns = step * norm(own.state.angular_velocity)
    near = np.abs(turns - change.turn) <= 2.0 * theta * step * yardstick.rate
    near[0] = False  # of the steps between two samples, those that end at the later one
    if not near.any():
        return {}
    steps = np.cumsum(np.where(near, np.diff(numbers, prepend=0), 0))
    # growth may be infinite before the first such step
    apart = change.jump * np.where(steps > 0, steps * own.growth, 0.0)
    return yardstick.apart_by(apart, step * numbers)
