"""What a fit leaves: its size, and whether neighbouring residuals correlate."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from omegadot.commands.fit.data import Data
from omegadot.commands.fit.parameters import Parameters
from omegadot.commands.fit.solve import Fitted
from omegadot.reference_impl.system import Array

FINEST = 1e-12  # the tolerance with which the motion of a trace without noise is followed
# What that leaves where errors grow, as near the separatrix: below it there is no noise to be seen.
INTEGRATED = 1000.0 * FINEST
MOST = 0.98  # a correlation that is enlarged for: beyond it a hundred samples hold less than one
ABOVE = 10.0  # times the resolution: no rounding leaves so much


@dataclass(frozen=True)
class Noise:
    """The residuals of a fit, in its units.

    axes: (3,), the rms of each component of omega.  omega and turn: of a component of omega and of
    the attitude, with the numbers that were fitted taken off; at least the resolution of the data.
    correlation: of neighbouring residuals, between 0 and MOST.  resolution: the least that omega
    can be, by the data's digits.
    """

    axes: Array
    omega: float
    turn: float
    correlation: float
    resolution: float

    @property
    def seen(self) -> bool:
        """Whether more than rounding is left."""
        return self.omega > ABOVE * self.resolution

    @property
    def is_model_error(self) -> bool:
        """Whether the residuals are no noise, and their size no measure of what noise does."""
        return self.seen and self.correlation >= MOST

    @property
    def inflation(self) -> float:
        """By how much correlated residuals enlarge a variance: ``(1 + r) / (1 - r)``."""
        return (1.0 + self.correlation) / (1.0 - self.correlation)


def noise_of(data: Data, fit: Fitted, digits: tuple[float, float]) -> Noise:
    """What `fit` leaves. digits: the resolution of omega and attitude, in the units of the fit."""
    left = data.residuals(one_lane(fit.one))[0].reshape(-1, len(data.times), 3)
    left[1:] /= data.turn_weight
    spare = left.size / max(left.size - fit.free.count, 1)
    rms = [float(np.sqrt(np.mean(part**2) * spare)) for part in left]
    floors = [max(INTEGRATED, digit) for digit in digits]
    omega, turn = (max(pair) for pair in zip([*rms, 0.0][:2], floors, strict=True))
    correlation = _correlation(left) if rms[0] > floors[0] else 0.0  # of digits it means nothing
    axes = np.sqrt(np.mean(left[0] ** 2, axis=0))
    return Noise(axes, omega, turn, correlation, floors[0])


def one_lane(one: Parameters) -> Parameters:
    """The same with a leading axis."""
    return Parameters(*(np.asarray(value)[None] for value in vars(one).values()))


def _correlation(left: Array) -> float:
    """Of neighbours, over all components; 0 where it is no more than chance."""
    pairs = np.sum(left[:, 1:] * left[:, :-1])
    found = float(pairs / max(float(np.sum(left**2)), 1e-300))
    chance = 3.0 / np.sqrt(left.size)
    return min(found, MOST) if found > chance else 0.0
