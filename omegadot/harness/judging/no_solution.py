"""Steps at which an implicit scheme's equation has no solution, or another: not judged.

A variational scheme solves for the angle f of a step. Of a body that spins about a principal axis
this is ``sin f = h |omega|``, which has a solution up to a radian a step.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from omegadot.adapters.protocol import Integrator
from omegadot.gates.bounds.scales import norm
from omegadot.gates.case import Sweep
from omegadot.gates.rows import Row
from omegadot.gates.truth import Truth
from omegadot.harness.judging.judged_run import is_finite
from omegadot.reference_impl.inertia import moving_inertia
from omegadot.reference_impl.motion import forward_dynamics
from omegadot.reference_impl.rotations import rotate
from omegadot.reference_impl.schemes import SCHEMES
from omegadot.reference_impl.symmetric import apply
from omegadot.reference_impl.system import State, System
from omegadot.workers.harness_end.process import Answer
from omegadot.written import written

SOLVABLE = 1.0  # rad a step
LOST = 1e-3  # of omega
ROUNDINGS = 2**12  # of a run of a few steps
NO_ROOT = "not judged: at so long a step omega solves no equation, or another, and keeps its size"
OVERFLOWS = "not judged: the scheme itself blows up at so large a step, where the engine raises {}"
NO_STEP = "not judged: at steps of {turn} rad the engine raises {reason}, and not at finer ones"


def unjudged_row(note: str) -> Row:
    """The row of a run that is reported and not judged."""
    return Row("trajectory", "omega", "error_max", float("nan"), "1", None, "info", note)


def is_lost(integrator: Integrator, system: System, sweep: Sweep, state: State, eps: float) -> bool:
    """Whether steps of more than a radian turn a steady omega to somewhere else, of the same size.

    A variational scheme turns the momentum back by what it turns the attitude, whatever root of its
    equation is taken, or none: the momentum keeps its size, and in world axes its direction.
    """
    omega = state.angular_velocity
    rate = float(norm(omega[0]))
    slight = ROUNDINGS * eps
    known = integrator.scheme in SCHEMES or rate * sweep.timestep <= SOLVABLE
    if known or np.any(norm(forward_dynamics(system, state[:1]).angular) > slight * rate**2):
        return False
    if not np.all(np.abs(norm(omega) - rate) <= slight * rate):
        return False
    momentum = rotate(state.orientation, apply(moving_inertia(system), omega))
    kept = np.all(norm(momentum - momentum[0]) <= slight * norm(momentum[0]))
    return bool(kept) and bool(np.any(norm(omega - omega[0]) > LOST * rate))


def reason_without_a_solution(
    truth: Truth, integrator: Integrator, sweep: Sweep, answers: Sequence[tuple[Sweep, Answer]]
) -> str:
    """Why a run that raises is not judged: it steps more than a radian, and no finer one raises.

    "" where it is judged. A known scheme has its solutions, and may be raised at if it overflows.
    """
    turn, answer = _turn_of_a_step(truth, sweep), dict(answers)[sweep]
    own = truth.companion(integrator, sweep)
    if answer.outcome == "raised" and own is not None and not is_finite(own.state):
        return OVERFLOWS.format(answer.reason)
    finer = [one.ok for other, one in answers if other.timestep < sweep.timestep]
    raised = answer.outcome == "raised" and bool(finer) and all(finer)
    if not raised or integrator.scheme is not None or turn <= SOLVABLE:
        return ""
    return NO_STEP.format(turn=written(turn, 2), reason=answer.reason)


def _turn_of_a_step(truth: Truth, sweep: Sweep) -> float:
    """rad: the longest turn of a step, with half of what omega gains in it: h (w + h w_dot / 2).

    A variational scheme has turned omega by half a step's torque when it solves for the turn.
    """
    gain = 0.5 * sweep.timestep * float(np.max(norm(truth.omega_dot)))
    return sweep.timestep * (truth.yardstick.rate + gain)
