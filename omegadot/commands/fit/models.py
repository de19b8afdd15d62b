"""Which of shape, bias and damping the data support: nested fits, and F-tests between them.

An F-test compares the gain of a term with what noise alone gains. Its numerator is divided by the
inflation of correlated residuals, so that a model that lacks something is not made to fit by a
bias.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from scipy.stats import f as fisher

from omegadot.commands.fit.noise import FINEST, Noise, noise_of
from omegadot.commands.fit.parameters import Free
from omegadot.commands.fit.solve import MOST_TRIALS, TRIALS, Data, Fitted, finish, follow, solve
from omegadot.commands.fit.start import sized, starts

# The probability that noise alone gains so much. A term that is wrongly left out distorts the rest,
# one that is wrongly taken widens the errors: bias and damping enter easily, shape does not.
SIGNIFICANT = {"shape": 1e-3, "bias": 0.01, "damping": 0.01}
WIDEST = 1e4  # of weights, which derivatives by differences resolve
ROUNDS = 3  # of the weights of omega and attitude: they settle in two
FINE = 1e-5  # rms of residuals below which the motion is followed to the last digits
HOPELESS = 100.0  # a sum of squares so many times that of the richest is worth few trials
ALONG = 0.1  # rad: a torque nearer to the axis than this does not turn it
Digits = tuple[float, float]
NONE = (0.0, 0.0)


@dataclass(frozen=True)
class Compared:
    """The fits of a trace.

    data: with the weight of the attitude that was used.  fits: by what is free.  noise: of the
    chosen one.  chances: the probability that noise alone gains as much as each term did.
    """

    data: Data
    fits: dict[Free, Fitted]
    chosen: Free
    noise: Noise
    chances: dict[str, float]

    @property
    def best(self) -> Fitted:
        """The fit of the chosen model."""
        return self.fits[self.chosen]

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


def compare_models(data: Data, digits: Digits, terms: Terms) -> Compared:
    """Fit every model that the terms allow, and choose. digits: in the units of the fit."""
    data = sized(data)
    scale, turning = bool(np.any(data.torque)), data.orientation is not None
    rich = Free(True, scale, terms.bias is not False, terms.damping is not False, turning)
    plain = replace(rich, bias=bool(terms.bias), damping=bool(terms.damping))
    found = follow(data, starts(data, rich), rich)
    first = follow(data, [*starts(data, plain), found.one], plain) if plain != rich else found
    found = min(found, solve(data, first.one, rich), key=lambda fit: fit.cost)
    data, found = _weighted(data, found, digits)
    fits = {rich: finish(data, found)}
    for free in _smaller(rich, terms, _keeps_direction(data)):
        near = [solve(data, one, free) for one in (fits[rich].one, first.one)]
        best = min(near, key=lambda fit: fit.cost)
        hopeless = best.cost > HOPELESS * fits[rich].cost
        fits[free] = finish(data, best, TRIALS if hopeless else MOST_TRIALS)
    return _chosen(data, fits, rich, terms, digits)


def _weighted(data: Data, fit: Fitted, digits: Digits) -> tuple[Data, Fitted]:
    """The data with the attitude weighted by the noise, followed as finely as that requires."""
    for _ in range(ROUNDS if data.orientation is not None else 1):
        fit = finish(data, fit)
        noise = noise_of(data, fit, digits)
        fine = min(noise.omega, noise.turn if data.orientation is not None else 1.0) < FINE
        weight = float(np.clip(noise.omega / noise.turn, 1.0 / WIDEST, WIDEST))
        data = replace(data, turn_weight=weight, tolerance=FINEST if fine else data.tolerance)
    return data, fit


def _smaller(rich: Free, terms: Terms, shapeless: bool) -> list[Free]:
    """The models within the richest: with fewer terms, and of a body that shows no shape."""
    found = [rich]
    for name in terms.open:
        found += [replace(free, **{name: False}) for free in found]
    return found[1:] + [replace(free, shape=False) for free in found if shapeless]


def _chosen(
    data: Data, fits: dict[Free, Fitted], rich: Free, terms: Terms, digits: Digits
) -> Compared:
    """Drop the shape, then term after term, as long as noise alone gains as much."""
    chances: dict[str, float] = {}
    chosen, noise = rich, noise_of(data, fits[rich], digits)
    if _keeps_direction(data):
        chances["shape"] = _chance(data, fits[replace(rich, shape=False)], fits[rich], noise)
        if chances["shape"] > SIGNIFICANT["shape"] / len(
            data.times
        ):  # its frequency was sought as well
            chosen = replace(rich, shape=False)
    left = list(terms.open)
    while left:
        tried = {
            name: _chance(data, fits[replace(chosen, **{name: False})], fits[chosen], noise)
            for name in left
        }
        if "damping" in tried and not fits[chosen].one.damping > 0.0:
            tried["damping"] = 1.0  # no friction drives a body
        name = max(tried, key=lambda key: tried[key])
        chances |= tried
        if tried[name] <= SIGNIFICANT[name]:
            break
        chosen = replace(chosen, **{name: False})
        noise = noise_of(data, fits[chosen], digits)
        left.remove(name)
    return Compared(data, fits, chosen, noise, chances)


def _chance(data: Data, small: Fitted, large: Fitted, noise: Noise) -> float:
    """The probability of the larger model's gain, or more, by noise alone."""
    numbers = data.omega.size * (1 if data.orientation is None else 2)
    more, spare = large.free.count - small.free.count, max(numbers - large.free.count, 1)
    left = max(large.cost, noise.omega**2 * spare)
    gain = max(small.cost - large.cost, 0.0) / (more * noise.inflation)
    return float(fisher.sf(gain * spare / left, more, spare))


def _keeps_direction(data: Data) -> bool:
    """Whether a body without a shape would keep its axis: no torque turns it."""
    size = float(np.linalg.norm(data.torque))
    if size == 0.0:
        return True
    axis = np.linalg.svd(data.omega, full_matrices=False)[2][0]
    return bool(np.linalg.norm(np.cross(data.torque, axis)) < ALONG * size)
