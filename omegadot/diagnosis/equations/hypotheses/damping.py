"""What engines make of the damping."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from omegadot.diagnosis.equations.hypotheses.hypothesis import (
    AXES,
    Hypothesis,
    given,
    of_form,
    over_diagonal,
)


def damping_hypotheses() -> Iterator[Hypothesis]:
    """Each of them."""
    for text, factor in (("is missing", 0), ("has the wrong sign", -1), ("counts twice", 2)):
        yield of_form(
            f"the damping {text}",
            "damping",
            given(factor, lambda k, f, s: {"damping": k * f.damping}),
        )
    yield of_form(
        "the damping acts as a rate, not as a torque: omega-dot has -d omega, whatever the inertia",
        "damping",
        lambda f, s: {"damping": np.linalg.inv(f.solve) * float(s.load.damping)},
    )
    yield of_form(
        "the damping is divided by the mass instead of the inertia",
        "damping",
        lambda f, s: {
            "damping": np.linalg.inv(f.solve) * (float(s.load.damping) / float(s.body.mass))
        },
    )
    yield of_form(
        "the damping torque is divided by the mass",
        "damping",
        lambda f, s: {"damping": f.damping / float(s.body.mass)},
    )
    yield of_form(
        "the damping torque is multiplied by the mass",
        "damping",
        lambda f, s: {"damping": f.damping * float(s.body.mass)},
    )
    yield of_form(
        "the damping torque is divided by the inertia's diagonal alone",
        "damping",
        lambda f, s: {"damping": np.linalg.inv(f.solve) @ over_diagonal(f) @ f.damping},
    )
    yield of_form(
        "the damping goes with |omega| omega instead of omega",
        "damping",
        lambda f, s: {"damping": 0 * f.damping, "drag_square": np.asarray(s.load.damping)},
    )
    for axis in range(3):
        alone = np.arange(3) == axis
        yield of_form(
            f"the damping about {AXES[axis]} is missing",
            "damping",
            given(
                alone, lambda k, f, s: {"damping": np.diag(np.where(k, 0.0, np.diag(f.damping)))}
            ),
        )
        yield of_form(
            f"the damping acts about {AXES[axis]} alone",
            "damping",
            given(
                alone, lambda k, f, s: {"damping": np.diag(np.where(k, np.diag(f.damping), 0.0))}
            ),
        )
    yield of_form(
        "the linear velocity is damped as well: the acceleration has -d v",
        "drag",
        lambda f, s: {"drag": np.asarray(s.load.damping)},
    )
    yield of_form(
        "the linear velocity is damped as well: the acceleration has -d v / m",
        "drag",
        lambda f, s: {"drag": np.asarray(s.load.damping) / float(s.body.mass)},
    )
