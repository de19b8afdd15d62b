"""Terms of the linear acceleration, and what reports make of both."""

from __future__ import annotations

import numpy as np

from omegadot.diagnosis.equations.terms.parts import (
    body_constant,
    by_rows,
    free,
    gravity_at,
    rows,
    scaled_report,
)
from omegadot.diagnosis.equations.terms.terms import AXES, Terms
from omegadot.diagnosis.wording.digits import factor, number, vector
from omegadot.gates.bounds.scales import norm
from omegadot.reference_impl.cross_product import cross
from omegadot.reference_impl.rotations import rotate
from omegadot.reference_impl.system import Array

REPORTED: tuple[Terms, ...] = (
    Terms(
        "omega-dot scaled",
        lambda s, x, a: a.angular[None],
        scaled_report("the omega-dot that is reported"),
        reported=True,
    ),
    Terms(
        "omega-dot rows",
        lambda s, x, a: rows(a.angular),
        by_rows("the omega-dot that is reported"),
        by_rows=True,
        reported=True,
    ),
    Terms(
        "gravity in report",
        lambda s, x, a: gravity_at(s, x)[None],
        lambda s, p: (
            "the linear acceleration leaves gravity out, as an accelerometer does"
            if abs(p[0] + 1.0) < 1e-6
            else f"the linear acceleration has {factor(1.0 + float(p[0]))} times gravity in it"
        ),
        linear=True,
        reported=True,
    ),
    Terms(
        "linear acceleration scaled",
        lambda s, x, a: a.linear[None] * (not free(s)),  # a free body's is constant
        scaled_report("the linear acceleration"),
        linear=True,
        reported=True,
    ),
    Terms(
        "linear acceleration rows",
        lambda s, x, a: rows(a.linear) * (not free(s)),
        by_rows("the linear acceleration"),
        by_rows=True,
        linear=True,
        reported=True,
    ),
)


def _by_axes(numbers: Array, each: str) -> str:
    """``0.1 v_x and 0.3 v_z``: each of the numbers that are not zero, with its axis."""
    pairs = zip(numbers, AXES, strict=True)
    return " and ".join(each.format(number(float(k)), axis) for k, axis in pairs if k)


LINEAR: tuple[Terms, ...] = (
    Terms(
        "drag square",
        lambda s, x, a: (norm(x.linear_velocity)[:, None] * x.linear_velocity)[None] * free(s),
        lambda s, p: (
            f"the linear velocity is damped by its square: the acceleration has "
            f"{number(float(p[0]))} |v| v in it"
        ),
        linear=True,
    ),
    Terms(
        "drag rows",
        lambda s, x, a: rows(x.linear_velocity) * free(s),
        lambda s, p: (
            "the linear velocity is damped: the acceleration has "
            + _by_axes(p, "{} v_{}")
            + " in it"
        ),
        linear=True,
    ),
    Terms(
        "constant acceleration",
        lambda s, x, a: body_constant(x) * free(s),
        lambda s, p: f"the linear acceleration has a constant {vector(p)} m/s^2 too much",
        linear=True,
    ),
    Terms(
        "constant acceleration in body",
        lambda s, x, a: (
            np.stack([rotate(x.orientation, one) for one in body_constant(x)]) * free(s)
        ),
        lambda s, p: (
            f"the linear acceleration has {vector(p)} m/s^2 too much, constant in body axes"
        ),
        linear=True,
    ),
    Terms(
        "gravity by place",
        lambda s, x, a: (
            np.stack([x.position[:, [k]] * gravity_at(s, x) for k in range(3)]) * free(s)
        ),
        lambda s, p: (
            "gravity changes with the place: " + _by_axes(p, "by {} of it a metre along {}")
        ),
        linear=True,
    ),
    Terms(
        "spring",
        lambda s, x, a: rows(x.position) * free(s),
        lambda s, p: (
            "the linear acceleration has " + _by_axes(p, "{} {}") + " of the position in it"
        ),
        linear=True,
    ),
    Terms(
        "world turns",
        lambda s, x, a: (
            np.stack([cross(one, x.linear_velocity) for one in body_constant(x)]) * free(s)
        ),
        lambda s, p: (
            f"the linear acceleration has c x v in it with c = {vector(p)} rad/s, as where the "
            "world's axes turn"
        ),
        linear=True,
    ),
)
