"""JaxSim's integrators, and what their errors depend on.

Both step velocities in the inertial representation: ω in world axes, and the velocity of that point
of the body that is at the world's origin. A straight step of the quaternion follows, made unit. So
a free body's momentum of translation errs by the order of the rest. The reference's schemes of this
kind are those of the name world-spatial.
"""

from __future__ import annotations

import numpy as np

from omegadot.adapters.protocol import Integrator
from omegadot.reference_impl.system import Load

TURNING = ("omega", "attitude", "energy", "angular_momentum")
MOVING = ("linear_momentum", "position")
# By the names of `jaxsim.api.model.IntegratorType`. RungeKutta4Fast needs points that touch ground.
NAMES = ("SemiImplicitEuler", "RungeKutta4")
STEPPED = "on p, q, omega in world axes and the velocity of the point at the world's origin"


def declared_integrators(load: Load) -> tuple[Integrator, ...]:
    """Every integrator, with its orders under a load.

    JaxSim takes the forces on a link at the start of a step, and holds them in world axes. Where
    they go with the body or its omega, RungeKutta4 is no scheme of the reference.
    """
    held = bool(np.any(load.torque_body) or np.any(load.damping))
    orders = dict.fromkeys(TURNING, 1 if held else 4) | dict.fromkeys(MOVING, 4)
    return (
        Integrator(
            "SemiImplicitEuler",
            "semi-implicit-euler-world-spatial",
            dict.fromkeys((*TURNING, *MOVING), 1),
            note=f"semi-implicit Euler {STEPPED}; the quaternion by a straight step",
            coordinates="origin-world",
        ),
        Integrator(
            "RungeKutta4",
            None if held else "rk4-world-spatial",
            orders,
            note=f"Kutta's method {STEPPED}; torques of a link are those of the step's start",
            coordinates="origin-world",
        ),
    )
