"""Which of shape, bias and damping the data support: F-tests between nested fits.

An F-test compares the gain of a term with what noise alone gains. Its numerator is divided by the
inflation of correlated residuals, so that a model that lacks something is not made to fit by a
bias. That a term is left out is a choice of words, not knowledge that it is zero: every model that
the data allow counts in the standard errors.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np
from scipy.special import fdtrc

from omegadot.commands.fit.data import Data
from omegadot.commands.fit.noise import Noise, noise_of
from omegadot.commands.fit.parameters import Free
from omegadot.commands.fit.solve import Fitted

# The probability that noise alone gains so much. A term that is wrongly left out distorts the rest,
# one that is wrongly taken widens the errors: bias and damping enter easily, shape does not.
SIGNIFICANT = {"shape": 1e-3, "bias": 0.01, "damping": 0.01}
ALLOWED = 1e-3  # the same, below which a model is refuted
LARGEST = 4.0  # of the size of omega: a larger bias is none, but what nothing holds
Digits = tuple[float, float]
NONE = (0.0, 0.0)


@dataclass(frozen=True)
class Compared:
    """The fits of a trace.

    data: with the weight of the attitude that was used.  fits: by what is free.  rich: the model
    with every term.  chosen: the one that is reported.  noise: of that.  chances: the probability
    that noise alone gains as much as each term did.  vague: more fits of the richest, with smaller
    biases, where the bias is open.
    """

    data: Data
    fits: dict[Free, Fitted]
    rich: Free
    chosen: Free
    noise: Noise
    chances: dict[str, float]
    vague: list[Fitted] = field(default_factory=list)

    @property
    def best(self) -> Fitted:
        """The fit of the chosen model."""
        return self.fits[self.chosen]

    @cached_property
    def allowed(self) -> list[Fitted]:
        """The fits that the data do not refute against the richest; the chosen one is the first."""
        rich = self.fits[self.rich]
        others = [
            fit
            for free, fit in self.fits.items()
            if free not in (self.rich, self.chosen)
            and np.linalg.norm(fit.one.bias) < LARGEST
            and _chance(self.data, fit, rich, self.noise) > ALLOWED / _sought(self.data, free)
        ]
        small = replace(self.rich, bias=False)  # as many numbers fewer as a bias has
        others += [
            fit
            for fit in self.vague
            if _chance(self.data, replace(fit, free=small), rich, self.noise) > ALLOWED
        ]
        return [self.best, *([] if self.chosen == self.rich else [rich]), *others]

    def rms(self, free: Free) -> float:
        """What a model leaves of a component of omega, in the units of the fit."""
        return float(np.sqrt(np.mean(noise_of(self.data, self.fits[free], NONE).axes ** 2)))


@dataclass(frozen=True)
class Terms:
    """Whether bias and damping are fitted: always (True), never (False), or as the data support."""

    bias: bool | None = None
    damping: bool | None = None

    @property
    def open(self) -> list[str]:
        """The terms that the data decide on."""
        return [name for name, given in vars(self).items() if given is None]


def chosen_of(
    data: Data, fits: dict[Free, Fitted], rich: Free, terms: Terms, digits: Digits
) -> Compared:
    """Drop term after term, as long as noise alone gains as much.

    The bias is the first, and with one a shape stays: a sphere with a bias shows almost any short
    piece of a motion.
    """
    chances: dict[str, float] = {}
    chosen = rich
    still = replace(rich, damping=False)
    if "damping" in terms.open and still in fits and not fits[rich].one.damping > 0.0:
        chosen, chances["damping"] = still, 1.0  # no friction drives a body
    noise = noise_of(data, fits[chosen], digits)
    for name in ("bias", "shape", "damping"):
        small = replace(chosen, **{name: False})
        if small == chosen or small not in fits or (name == "shape" and chosen.bias):
            continue
        chances[name] = _chance(data, fits[small], fits[chosen], noise)
        if name == "damping" and not fits[chosen].one.damping > 0.0:
            chances[name] = 1.0
        if chances[name] > SIGNIFICANT[name] / _sought(data, small):
            chosen = small
            noise = noise_of(data, fits[chosen], digits)
    return Compared(data, fits, rich, chosen, noise, chances)


def _sought(data: Data, free: Free) -> int:
    """In how many places noise was searched for what the model lacks: a shape has a frequency."""
    return 1 if free.shape else len(data.times)


def _chance(data: Data, small: Fitted, large: Fitted, noise: Noise) -> float:
    """The probability of the larger model's gain, or more, by noise alone."""
    numbers = data.omega.size * (1 if data.orientation is None else 2)
    more, spare = large.free.count - small.free.count, max(numbers - large.free.count, 1)
    left = max(large.cost, noise.omega**2 * spare)
    gain = max(small.cost - large.cost, 0.0) / (more * noise.inflation)
    return float(fdtrc(more, spare, gain * spare / left))
