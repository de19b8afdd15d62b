"""MJX's integrators: code of its own, which follows MuJoCo's as it was before 3.7.

Compared with the reference's schemes step by step, to rounding: `tests/adapters/test_mjx.py`.
"""

from __future__ import annotations

from dataclasses import replace

from omegadot.adapters.mujoco.integrators import Case, explicit, rk4
from omegadot.adapters.protocol import Integrator

# By the names of `mjx.IntegratorType`. MuJoCo's implicit and discrete are none of MJX's.
KINDS = {"Euler": "EULER", "RK4": "RK4", "implicitfast": "IMPLICITFAST"}
LIKE = (3, 6)  # the last MuJoCo whose integrators are MJX's


def declared_integrators(case: Case) -> tuple[Integrator, ...]:
    """Every integrator, with what it does in this case, whose version is ``LIKE``.

    ``implicitfast`` has the derivative of damping alone, and none of the gyroscopic term.
    """
    made = (
        explicit("Euler", case.damped and case.euler_damps),
        rk4(case),
        explicit("implicitfast", case.damped),
    )
    return tuple(replace(one, coordinates="origin-world") for one in made)
