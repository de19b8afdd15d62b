"""The order of a signed error whose first two powers of the step cancel at some samples."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from omegadot.gates.errors.observed_order import ORDER_TOLERANCE, ObservedOrder
from omegadot.gates.errors.sweep_errors import FEWEST_STEPS, Errors


def of_two_terms(sweep: Sequence[Errors], horizon: float) -> ObservedOrder | None:
    """The order of signed errors that are a sum of two powers, where these cancel at some samples.

    A cubic in the step goes through the errors of the four finest at every sample. Its constant is
    the error at no step, which a scheme of an order above zero has not. The order is the power of
    its first coefficient that makes a tenth of the finest error or more: with less, the slope of a
    halving would be lower by the tolerance at most. None where that is the constant or the last
    coefficient, after which others may follow, and where it may be rounding of the errors, or what
    the cubic makes of higher powers: a quartic through the five finest has less of these.
    """
    finest = sorted(sweep, key=lambda one: one.timestep)[: FEWEST_STEPS + 2]
    if len(finest) < FEWEST_STEPS + 2 or any(one.signed is None for one in finest):
        return None
    samples = min(int(np.ceil(horizon * len(one.size))) for one in finest)
    times = [one.times[:samples] / finest[0].times[-1] for one in finest]
    if not np.allclose(times, times[0], rtol=0.0, atol=1e-9):  # the samples are not the same
        return None
    errors = np.array([one.signed[:samples] for one in finest if one.signed is not None])
    ratios = np.array([one.timestep / finest[0].timestep for one in finest])
    powers = np.linalg.inv(np.vander(ratios[:-1], increasing=True))
    cubic = powers @ errors[:-1]
    quartic = np.linalg.solve(np.vander(ratios, increasing=True), errors)
    sizes = np.max(np.abs(cubic), axis=1)
    higher = np.max(np.abs(cubic - quartic[:-1]), axis=1)
    rounding = np.abs(powers) @ np.array([np.max(one.bound[:samples]) for one in finest[:-1]])
    first = int(np.argmax(sizes >= (1.0 - 0.5**ORDER_TOLERANCE) * np.max(np.abs(errors[0]))))
    known = 0 < first < 3 and sizes[first] > max(rounding[first], 2.0 * higher[first])
    return ObservedOrder(float(first), True) if known else None
