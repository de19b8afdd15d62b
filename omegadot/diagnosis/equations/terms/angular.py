"""Terms of omega-dot, as torques and as rates."""

from __future__ import annotations

import numpy as np

from omegadot.diagnosis.equations.terms.parts import (
    along_omega,
    applied,
    body_constant,
    by_rows,
    constant,
    full_linear,
    gyroscopic,
    linear_text,
    omega_cross,
    rows,
    scaled_report,
    solved,
    turning,
    unit_rates,
    world,
)
from omegadot.diagnosis.equations.terms.terms import Terms
from omegadot.diagnosis.wording.digits import number
from omegadot.reference_impl.loads import gravity_torque

ANGULAR: tuple[Terms, ...] = (
    Terms(
        "gyroscopic rows",
        lambda s, x, a: np.stack([solved(s, -one) for one in rows(gyroscopic(s, x))]),
        by_rows("the gyroscopic term"),
        by_rows=True,
    ),
    Terms(
        "torque rows",
        lambda s, x, a: np.stack([solved(s, one) for one in rows(applied(s, x))]),
        by_rows("the applied torque"),
        by_rows=True,
    ),
    Terms(
        "damping rows",
        lambda s, x, a: np.stack(
            [
                solved(s, one)
                for one in rows(-float(s.load.damping) * np.asarray(x.angular_velocity))
            ]
        ),
        by_rows("the damping"),
        by_rows=True,
    ),
    Terms(
        "gravity torque",
        lambda s, x, a: solved(s, gravity_torque(s, x))[None],
        scaled_report("the torque of gravity"),
    ),
    Terms(
        "gravity torque rows",
        lambda s, x, a: np.stack([solved(s, one) for one in rows(gravity_torque(s, x))]),
        by_rows("the torque of gravity"),
        by_rows=True,
    ),
    Terms("constant in body", unit_rates, constant("body")),
    Terms("constant in world", lambda s, x, a: world(s, x, np.eye(3)), constant("world")),
    Terms("omega x body", lambda s, x, a: omega_cross(x, body_constant(x)), turning("body")),
    Terms(
        "omega x world",
        lambda s, x, a: omega_cross(x, world(s, x, np.eye(3))),
        turning("world"),
    ),
    Terms("linear in omega", lambda s, x, a: full_linear(x), linear_text),
    Terms(
        "friction as a rate",
        lambda s, x, a: along_omega(x, 0)[None],
        lambda s, p: f"omega-dot has {number(float(p[0]))} omega/|omega| in it, whatever its size",
    ),
    Terms(
        "friction as a torque",
        lambda s, x, a: solved(s, along_omega(x, 0))[None],
        lambda s, p: f"a torque of {number(float(p[0]))} N m along omega acts, whatever its size",
    ),
    Terms(
        "square as a rate",
        lambda s, x, a: along_omega(x, 2)[None],
        lambda s, p: f"omega-dot has {number(float(p[0]))} |omega| omega in it",
    ),
    Terms(
        "cube as a rate",
        lambda s, x, a: along_omega(x, 3)[None],
        lambda s, p: f"omega-dot has {number(float(p[0]))} |omega|^2 omega in it",
    ),
    Terms(
        "cube as a torque",
        lambda s, x, a: solved(s, along_omega(x, 3))[None],
        lambda s, p: f"a torque of {number(float(p[0]))} |omega|^2 omega N m acts",
    ),
)
