"""Periods, flip times and precession rate of a free rotation."""

from __future__ import annotations

from dataclasses import dataclass
from decimal import Decimal
from typing import Literal

import numpy as np

from omegadot.reference_impl.closed_forms.digits import many_digits
from omegadot.reference_impl.closed_forms.euler_poinsot import Constants, constants_of
from omegadot.reference_impl.closed_forms.free_rotation import (
    free_rotation_of,
    inertia_and_omega,
)
from omegadot.reference_impl.closed_forms.free_rotation_motion import (
    encircling_theta,
    mean_rate,
)
from omegadot.reference_impl.system import Array, State, System


@dataclass(frozen=True)
class FreeRotationRates:
    """What a free rotation repeats.

    encircled: the principal axis that ω goes round, or None where ω is constant.
    flip_period: ``2K/λ`` s between two sign changes of the middle component of ω.
    period: ``4K/λ`` s of ω in the body; both are infinite on the separatrix and where ω is
    constant.
    precession_rate: mean rate, rad/s, at which the encircled axis goes round the angular momentum.
    complement: ``1 - m``, zero on the separatrix, one for a symmetric body.
    """

    encircled: Literal["least", "greatest"] | None
    flip_period: float
    period: float
    precession_rate: float
    complement: float


def free_rotation_rates(system: System, initial: State) -> FreeRotationRates:
    """The rates of a free rotation; where ω is constant the precession rate is ``|ω|``.

    The angle ψ about the momentum L that is left when the shortest rotation takes L to the
    encircled axis advances by ``precession_rate flip_period`` in every flip (Montgomery, How much
    does the rigid body rotate?, Am. J. Phys. 59 (1991) 394-398, has the same by areas).
    Raises ValueError where a torque acts.
    """
    c = _constants(system, initial)
    if c is None:
        speed = float(np.linalg.norm(initial.angular_velocity))
        return FreeRotationRates(None, np.inf, np.inf, speed, 1.0)
    with many_digits():
        flip = float(2 * c.modulus.quarter / c.rate) if c.rate else np.inf
        rate = float(mean_rate(c, encircling_theta(c)))
        complement = float(c.modulus.m1)
    encircled: Literal["least", "greatest"] = "greatest" if c.turn > 0 else "least"
    return FreeRotationRates(encircled, flip, 2 * flip, rate, complement)


def flip_times(system: System, initial: State, start: float, end: float) -> Array:
    """The times from start to end, s, at which the middle component of ω changes its sign.

    ``u = 2 n K``: t = (2 n K - u(0)) / λ. On the separatrix there is one, where ω is constant none.
    Raises ValueError where a torque acts.
    """
    c = _constants(system, initial)
    if c is None:
        return np.empty(0)
    with many_digits():
        first = -c.start / c.rate
        if c.modulus.m1 == 0:
            times = [float(first)]
        else:
            flip = 2 * c.modulus.quarter / c.rate
            lowest = int(np.floor(float((_decimal(start) - first) / flip)))
            highest = int(np.ceil(float((_decimal(end) - first) / flip)))
            times = [float(first + n * flip) for n in range(lowest, highest + 1)]
    return np.array([t for t in times if start <= t <= end])


def _decimal(x: float) -> Decimal:
    return Decimal(float(x))


def _constants(system: System, initial: State) -> Constants | None:
    problem = free_rotation_of(system, initial)
    if problem is None:
        raise ValueError("a torque acts on the body, so it has no periods of free rotation")
    with many_digits():
        return constants_of(*inertia_and_omega(problem.numbers))
