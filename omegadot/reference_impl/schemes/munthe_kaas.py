"""Runge-Kutta methods after Munthe-Kaas, with the inverse of dexp in closed form."""

from __future__ import annotations

from omegadot.reference_impl.schemes.motion import Motion
from omegadot.reference_impl.schemes.runge_kutta import kutta, step_in_exponential
from omegadot.reference_impl.schemes.scheme import IN_WORLD, Scheme, Step, explicit
from omegadot.reference_impl.schemes.tableaus import BUTCHER6, EULER, HEUN3, MIDPOINT, Method
from omegadot.reference_impl.system import Array


def by_method(method: Method) -> Step:
    """The method on u of ``q = q₀ exp(u)``, whose rate is the motion's, and v."""

    def step(motion: Motion, q: Array, v: Array, h: float | Array) -> tuple[Array, Array]:
        return step_in_exponential(motion, motion.rate, q, v, h, method)

    return step


SOURCE = "Munthe-Kaas, BIT 38 (1998) 92-111; Iserles et al., Acta Numerica 9 (2000), section 4"
SCHEME = Scheme(
    name="munthe-kaas-rk4",
    title="Runge-Kutta-Munthe-Kaas 4, dexp inverse in closed form",
    step=by_method(kutta),
    **explicit(4),
    source=SOURCE,
    coordinates=IN_WORLD,
)
OTHERS = tuple(
    Scheme(
        name=f"munthe-kaas-{name}",
        title=f"{tableau.title} after Munthe-Kaas, dexp inverse in closed form",
        step=by_method(tableau.step),
        **explicit(tableau.order),
        source=f"{SOURCE}; {tableau.source}",
        coordinates=IN_WORLD,
    )
    for name, tableau in (
        ("explicit-euler", EULER),
        ("midpoint", MIDPOINT),
        ("heun3", HEUN3),
        ("butcher6", BUTCHER6),
    )
)
