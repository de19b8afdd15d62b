"""What a linearly implicit step of another length in its factor makes of runs and short steps.

The step is ``(1 - g J) dv = h vdot``, in which g is the length.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from omegadot.diagnosis.stepping.kept_run import CHANNELS, SLACK, KeptRun, SchemeOf
from omegadot.diagnosis.stepping.vanishing.vanishing_steps import VanishingSteps
from omegadot.gates.bounds.scales import EPS, norm
from omegadot.reference_impl.coordinates import canonical
from omegadot.reference_impl.inertia import moving_inertia
from omegadot.reference_impl.motion import forward_dynamics
from omegadot.reference_impl.one_body.body_motion import attitude_motion, body_motion
from omegadot.reference_impl.schemes.jacobian import acceleration_and_jacobian, solve_one_minus
from omegadot.reference_impl.system import Array, State, System

# What has the length, and whether its Jacobian is that of a body at rest.
TERMS = {
    "implicit-damping-euler": ("the implicit damping", True),
    "linearly-implicit-euler": ("the linearly implicit term", False),
}


def follow(steps: VanishingSteps, by: SchemeOf, g: float) -> NDArray[np.bool_]:
    """(m,): whether omega changes at the rate ``(1 - g J)^-1 omega-dot``."""
    evidence = steps.evidence
    a, jacobian = linear(evidence.system, evidence.states, by)
    off = norm(evidence.found.angular - solve_one_minus(g * jacobian, a))
    return np.asarray(off <= SLACK * evidence.angular_bound)


def linear(system: System, states: State, by: SchemeOf) -> tuple[Array, Array]:
    """omega-dot (m, 3), and its derivative by omega where the scheme has it, (m, 3, 3)."""
    w = states.angular_velocity
    place = 0.0 * w if TERMS[by.scheme.name][1] else w
    size = np.maximum(norm(w), EPS)[:, None]
    turning = attitude_motion(system)
    _, jacobian = acceleration_and_jacobian(turning, states.orientation, place, size)
    return forward_dynamics(system, states).angular, jacobian


def reached(run: KeptRun, by: SchemeOf, g: float | None) -> NDArray[np.bool_]:
    """(n - 1,): the change of omega is known to what the matrix is, by its condition as well."""
    own = SchemeOf(by.scheme, canonical(run.system, by.coordinates))
    h, w = run.sweep.timestep, run.state.angular_velocity
    exact = body_motion(run.system, own.coordinates)
    part = 1.0 if g is None else g / h

    def jacobian(q: Array, v: Array, size: Array | None) -> tuple[Array, Array]:
        a, slopes = acceleration_and_jacobian(exact, q, v, size)
        return a, part * slopes

    off = run.apart(run.ends(own, replace(exact, jacobian=jacobian)))
    more = EPS * np.linalg.cond(moving_inertia(run.system)) * norm(w[1:] - w[:-1])
    bounds = run.bounds | {
        "omega": run.bounds["omega"] + more,
        "attitude": run.bounds["attitude"] + h * more,
    }
    return np.asarray(np.all([norm(off[c]) <= SLACK * bounds[c] for c in CHANNELS], axis=0))


def rates(run: KeptRun) -> tuple[Array, Array]:
    """(n - 1, 3) rad/s^2, the mean change of omega in each step, and to how much it is known."""
    h, w = run.sweep.timestep, run.state.angular_velocity
    return (w[1:] - w[:-1]) / h, run.bounds["omega"] / h
