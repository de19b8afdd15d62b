"""What the steps of an engine round, beyond parts of what they step.

Position-based dynamics (Mueller et al. 2020, *Detailed rigid body simulation with extended position
based dynamics*) steps the place and the attitude, and sets ``v = (x1 - x0) / h`` and
``omega = 2 vec(q0* q1) / h``. A rounding of the place, ``eps |x|``, is then one of ``eps |x| / h``
in v, and that of the unit quaternion one of ``eps / h`` in omega. So it is where a velocity is any
other difference of places over a time like h, as in Stoermer's form of Verlet's method.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from omegadot.gates.bounds.scales import ROUNDINGS_PER_STEP, norm
from omegadot.reference_impl.system import Array, State

OF_A_DIFFERENCE = 4  # roundings of a difference over the step, in parts of itself


@dataclass(frozen=True)
class Roundings:
    """of_places: of the place over h, in the velocity.  of_turns: of a turn over h, in omega.

    per_step: how many, in parts of what is stepped.
    """

    of_places: bool = False
    of_turns: bool = False
    per_step: float = float(ROUNDINGS_PER_STEP)


PLAIN = Roundings()


def roundings_per_step(order: int) -> float:
    """How often a step of a method of this order rounds what it steps, at most.

    An extrapolation (Gragg 1965) of even order p takes ``n = 2, 4, ..., p`` steps of its own, each
    with half a rounding, and adds the ends up with ``w_n = prod n^2 / (n^2 - m^2)`` over all other
    m: ``sum |w_n| n / 2``. Up to order 6 these are fewer than those of any step.
    """
    numbers = np.arange(2.0, 2.0 * np.ceil(0.5 * order) + 1.0, 2.0)
    squares = numbers**2
    apart = squares[:, None] - squares + np.diag(squares)
    weights = np.prod(squares[:, None] / apart, axis=1)
    return max(float(ROUNDINGS_PER_STEP), float(np.sum(np.abs(weights) * numbers)) / 2.0)


def is_change_of_place(before: State, after: State, timestep: Array, eps: float) -> bool:
    """Whether the velocity after single steps (..., n) of so many s is the change of place over h.

    It is to parts of itself: where a velocity is stepped, it agrees with the change of place to
    parts of the place alone.
    """
    way = after.position - before.position
    moved = timestep[..., None] * after.linear_velocity
    same = norm(way - moved) <= OF_A_DIFFERENCE * eps * norm(moved)
    return bool(np.all(same)) and bool(np.any(way))  # at rest nothing is seen
