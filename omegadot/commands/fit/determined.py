"""What is reported, with errors over every fit that the data allow, and how long a log it takes."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from omegadot.commands.fit.compared import Compared
from omegadot.commands.fit.data import MOST_RATES, Data
from omegadot.commands.fit.estimates import Estimates, estimates_of, widened
from omegadot.commands.fit.motion import motion
from omegadot.commands.fit.noise import one_lane
from omegadot.commands.fit.samples import Samples
from omegadot.commands.fit.scale import Known, Scale, scale_of
from omegadot.commands.fit.spread import Spread, spread_of
from omegadot.reference_impl.system import Array

LONGEST = 300.0  # rad, over which a longer window is tried: it is followed in a second
MOST_SAMPLES = 2000  # of it; fewer of less noise stand for more
DOUBLED = 6  # times: 64 times as long


@dataclass(frozen=True, eq=False)
class Determined:
    """What the data determine.

    own: the numbers of the chosen model, with errors that hold over all that are allowed, each with
    every term free.  spreads: of these, the chosen one first.
    """

    samples: Samples
    compared: Compared
    known: Known | None
    load: Array
    spreads: list[Spread]

    @property
    def own(self) -> Estimates:
        """The numbers and their errors."""
        first, *others = (self.numbers(spread) for spread in self.spreads)
        return widened(first, others)

    @property
    def scale(self) -> Scale:
        """From the chosen fit's inertia to the one that is reported."""
        return self.scale_in(self.spreads[0])

    def scale_in(self, spread: Spread) -> Scale:
        """The scale of another fit."""
        unit = self.samples.inertia_unit(self.load, self.compared.data.torque)
        return scale_of(spread, self.known, unit, self.spin)

    @property
    def spin(self) -> Array | None:
        """(3,): the axis about which the body turns, where omega keeps it."""
        omega = self.compared.best.one.omega
        return None if self.compared.chosen.shape else omega / np.linalg.norm(omega)

    def numbers(self, spread: Spread) -> Estimates:
        """Those of one fit."""
        return estimates_of(spread, self.scale_in(spread), self.samples.size, self.spin)

    def moment_about(self, axis: Array) -> tuple[float, float]:
        """The moment about an axis (3,), and its error over all fits."""
        found = []
        for spread in self.spreads:
            factor = self.scale_in(spread).factor
            error = factor * float(spread.error(spread.slope_of_entry(axis, axis)))
            found.append((factor * float(axis @ spread.one.inertia @ axis), error))
        value = found[0][0]
        return value, max(float(np.hypot(error, other - value)) for other, error in found)

    def open_terms(self, own: Estimates) -> list[str]:
        """Which of moments, bias and damping `own` leaves open, of those that are free."""
        rich = self.compared.rich
        sure = {
            "the moments": bool(np.all(own.moments_known)),
            "a bias": not rich.bias or bool(np.all(own.bias_known)),
            "damping": not rich.damping or own.damping_known,
        }
        return [name for name, known in sure.items() if not known]

    def longer(self) -> Iterator[tuple[float, float, list[str]]]:
        """Windows that are longer, in s and rad, and what they would leave open.

        By the covariance of the chosen fit, were its motion to go on.
        """
        compared, turned = self.compared, float(self.compared.data.turned[-1])
        for factor in (2.0**k for k in range(1, DOUBLED + 1)):
            if factor > 2.0 and factor * turned > LONGEST:
                return
            try:
                data, thinned = _extended(compared.data, compared, factor)
            except ArithmeticError:  # a fit that is so vague spins up beyond what can be followed
                return
            noise = replace(compared.noise, omega=compared.noise.omega / np.sqrt(thinned))
            spread = spread_of(data, compared.best, noise, compared.rich)
            seconds = factor * float(self.samples.times[-1] - self.samples.times[0])
            yield seconds, factor * turned, self.open_terms(self.numbers(spread))


def determined(
    samples: Samples, compared: Compared, known: Known | None, load: Array
) -> Determined:
    """The covariance of every fit that is allowed, with every term free."""
    fits, noise = compared.allowed, compared.noise
    spreads = [spread_of(compared.data, fit, noise, compared.rich) for fit in fits]
    return Determined(samples, compared, known, load, spreads)


def _extended(data: Data, compared: Compared, factor: float) -> tuple[Data, float]:
    """The chosen motion over a longer time, and how many samples each of its own stands for."""
    count = factor * len(data.times)
    kept = int(min(count, MOST_SAMPLES))
    times = np.linspace(0.0, factor * data.times[-1], kept)
    most, turning = int(MOST_RATES * (1.0 + times[-1])), data.orientation is not None
    lane = one_lane(compared.best.one)
    omega, turned = motion(lane, data.torque, times, turning, data.tolerance, most)
    orientation = turned[0] if turning else None
    return replace(data, times=times, omega=omega[0], orientation=orientation), count / kept
