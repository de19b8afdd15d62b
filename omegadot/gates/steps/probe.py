"""Where the limit of vanishing steps is looked for: from which states, and by which steps."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from omegadot.gates.bounds.scales import EPS, norm
from omegadot.gates.states.equation import EvaluationStates
from omegadot.reference_impl.one_body.body_motion import attitude_motion
from omegadot.reference_impl.schemes.jacobian import acceleration_and_jacobian
from omegadot.reference_impl.system import Array, State, System

PROBES = 6  # of the random states, and as many along the exact trajectory


@dataclass(frozen=True)
class Ladder:
    """Halved steps: the radians r of the longest, and the ranges of five that give a limit each.

    Relative to a rate, five steps leave about ``r^5 / 2^10`` of the scheme's own terms, and
    ``80 * 16 eps / r`` of rounding. The two are equal at 0.026 rad in double and at 0.73 rad in
    single precision, and a part of that is taken.
    digits: those of a step's length that rounding leaves certain.
    """

    radians: float
    ranges: tuple[slice, ...]
    digits: int

    @property
    def count(self) -> int:
        """How many steps there are."""
        return int(self.ranges[-1].stop)


# A scheme may take short turns by a shorter formula, which breaks the smoothness at one length of
# step. Such a break lies in one of two ranges of steps only, and a fault shows in both.
DOUBLE = Ladder(2.0**-7, (slice(0, 5), slice(4, 9)), 4)
# Shorter steps are hidden by rounding here, and so is the break of a formula that is sound.
SINGLE = Ladder(2.0**-1, (slice(0, 5),), 2)


def ladder_of(eps: float) -> Ladder:
    """The steps for engines of this precision."""
    return DOUBLE if eps <= EPS else SINGLE


@dataclass(frozen=True)
class Probe:
    """States (m, ...) to take one step from, and the steps (m, k) in s to try there."""

    states: State
    timesteps: Array


def probe_of(system: System, evaluation_states: EvaluationStates, eps: float = EPS) -> Probe:
    """States to step from, (m,), and steps (m, k) s, short against all that goes on there."""
    count = len(evaluation_states.path.angular_velocity)
    along = np.unique(np.linspace(0, count - 1, PROBES).round().astype(int))
    random, path = vars(evaluation_states.random), vars(evaluation_states.path)
    pairs = zip(random.values(), path.values(), strict=True)
    states = State(*(np.concatenate([one[:PROBES], two[along]]) for one, two in pairs))
    return probe_at(system, states, eps)


def probe_at(system: System, states: State, eps: float = EPS) -> Probe:
    """These states (m,), and steps (m, k) s."""
    turning = (states.orientation, states.angular_velocity)
    w_dot, jacobian = acceleration_and_jacobian(attitude_motion(system), *turning)
    slopes = np.max(np.abs(jacobian), axis=(-1, -2))
    rate = np.maximum.reduce((norm(states.angular_velocity), np.sqrt(norm(w_dot)), slopes))
    ladder = ladder_of(eps)
    longest = ladder.radians / np.where(rate > 0.0, rate, 1.0)
    return Probe(states, longest[:, None] / 2.0 ** np.arange(ladder.count))
