"""Nutation period, precession and spin rates of a Lagrange top."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from omegadot.reference_impl.closed_forms.digits import many_digits
from omegadot.reference_impl.closed_forms.lagrange_constants import nutation_of, top_of
from omegadot.reference_impl.closed_forms.lagrange_factors import factors_of
from omegadot.reference_impl.closed_forms.lagrange_top import lagrange_top_of
from omegadot.reference_impl.system import State, System


@dataclass(frozen=True)
class LagrangeTopRates:
    """What a Lagrange top repeats.

    nutation_period: ``2K/λ`` s, infinite on the separatrix.  cosines: least and greatest cosine of
    the angle from the upward vertical to the lever.  precession_rate: mean rate, rad/s, of the
    lever round the vertical.  spin_rate: mean rate, rad/s, of the body round the lever, counted
    from the line of nodes (Euler's angles φ and ψ).
    """

    nutation_period: float
    cosines: tuple[float, float]
    precession_rate: float
    spin_rate: float


def lagrange_top_rates(system: System, initial: State) -> LagrangeTopRates:
    """The rates of a Lagrange top.

    ``arg α = (φ + ψ)/2`` and ``arg β = (φ - ψ)/2`` give φ and ψ as sum and difference. Where the
    lever passes through the vertical, φ and ψ jump by π and their rates are those with jumps left
    out in the one or the other sense. Raises ValueError where the system is no Lagrange top, or
    stands vertical for good.
    """
    problem = lagrange_top_of(system, initial)
    if problem is None:
        raise ValueError("the system is no Lagrange top: its nutation has no closed form")
    with many_digits():
        top = top_of(problem.numbers[2:], problem.numbers[0], problem.numbers[1])
        nutation = nutation_of(top)
        if nutation is None:
            raise ValueError("the top stands vertical for good, so it does not nutate")
        alpha, beta, _ = factors_of(top, nutation)
        sum_rate, difference_rate = alpha.mean_rate(nutation), beta.mean_rate(nutation)
        infinite = nutation.modulus.m1 == 0
        return LagrangeTopRates(
            np.inf if infinite else float(2 * nutation.modulus.quarter / nutation.rate),
            (float(nutation.roots[0]), float(nutation.roots[1])),
            float(sum_rate + difference_rate),
            float(sum_rate - difference_rate),
        )
