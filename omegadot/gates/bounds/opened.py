"""What a declared scheme leaves open beyond rounding: a change of formula, an unsolved rest."""

from __future__ import annotations

import numpy as np

from omegadot.gates.bounds.measures import Yardstick
from omegadot.gates.bounds.scales import norm
from omegadot.gates.case import Sweep
from omegadot.gates.truth import Companion
from omegadot.reference_impl.schemes import SCHEMES
from omegadot.reference_impl.schemes.scheme import Scheme
from omegadot.reference_impl.system import Array


def opened_by_scheme(
    yardstick: Yardstick, sweep: Sweep, own: Companion, theta: Array
) -> dict[str, Array]:
    """(n,) per channel: how far from its companion a run of the scheme may be, beyond rounding.

    theta: (n,), what rounding may make of omega, relative to the yardstick's rate.  What a step
    leaves open grows as rounding does: of N steps that each leave d it is ``N d growth`` at most.
    Empty for a scheme that leaves nothing open.
    """
    scheme = SCHEMES.get(own.scheme)
    if scheme is None:
        return {}
    left = _by_change(scheme, yardstick, sweep, own, theta)
    left = left + _unsolved(scheme, yardstick, sweep.timestep) * sweep.sample_steps
    if not left.any():
        return {}
    # from where growth is infinite, so is the bound of rounding
    growth = np.where(np.isfinite(own.growth), own.growth, 0.0)
    apart = left * growth
    return yardstick.apart_by(apart, sweep.timestep * sweep.sample_steps)


def _unsolved(scheme: Scheme, yardstick: Yardstick, timestep: float) -> float:
    """What an equation that is not solved to rounding leaves of omega in a step, over the rate.

    A rest of the momentum, ``e |J omega| + h t`` with e relative and t a torque, turns omega by as
    much over lambda, J's least eigenvalue.
    """
    of_torque = scheme.solved_torque * timestep / (yardstick.scale.smallest * yardstick.rate)
    return float(scheme.solved_to * yardstick.by_momentum + of_torque)


def _by_change(
    scheme: Scheme, yardstick: Yardstick, sweep: Sweep, own: Companion, theta: Array
) -> Array:
    """(n,) rad: the sum over steps of what two formulas differ by where rounding decides.

    That is where the turn of a step ``h |omega|`` is the one at which the formula changes, to
    rounding of either run: in a steady spin of that very rate.
    """
    if scheme.change is None:
        return np.zeros(len(theta))
    turns = sweep.timestep * norm(own.state.angular_velocity)
    window = 2.0 * theta * sweep.timestep * yardstick.rate
    near = (np.abs(turns - scheme.change.turn) <= window) & np.isfinite(window)
    # of the steps between two samples, those that end at the later one
    steps = np.where(near, np.diff(sweep.sample_steps, prepend=0), 0)
    return scheme.change.jump * np.cumsum(steps)
