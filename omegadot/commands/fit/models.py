"""Which of shape, bias and damping the data support: nested fits, and F-tests between them.

An F-test compares the gain of a term with what noise alone gains. Its numerator is divided by the
inflation of correlated residuals, so that a model that lacks something is not made to fit by a
bias. That a term is left out is a choice of words, not knowledge that it is zero: every model that
the data allow counts in the standard errors.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np
from scipy.stats import f as fisher

from omegadot.commands.fit.noise import FINEST, Noise, noise_of, one_lane
from omegadot.commands.fit.parameters import Free
from omegadot.commands.fit.solve import (
    CLOSE,
    MOST_TRIALS,
    TRIALS,
    Data,
    Fitted,
    finish,
    follow,
    solve,
)
from omegadot.commands.fit.spread import spread_of
from omegadot.commands.fit.start import sized, starts
from omegadot.harness.usage import UsageError

# The probability that noise alone gains so much. A term that is wrongly left out distorts the rest,
# one that is wrongly taken widens the errors: bias and damping enter easily, shape does not.
SIGNIFICANT = {"shape": 1e-3, "bias": 0.01, "damping": 0.01}
ALLOWED = 1e-3  # the same, below which a model is refuted
WIDEST = 1e4  # of weights, which derivatives by differences resolve
ROUNDS = 3  # of the weights of omega and attitude: they settle in two
FINE = 1e-5  # rms of residuals below which the motion is followed to the last digits
VAGUE = 0.1  # a standard error of a bias, of the size of omega, beyond which it is tried smaller
BIASES = (1.0, 0.3, 0.1)  # of the size of omega: what such a fit holds a bias within
LARGEST = 4.0  # of the size of omega: a larger bias is none, but what nothing holds
HOPELESS = 100.0  # a sum of squares so many times that of the richest is worth few trials
ALONG = 0.1  # rad: a torque nearer to the axis than this does not turn it
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
    fits = {free: fit for free, fit in fits.items() if _followed(data, fit)}
    if not fits:
        raise UsageError("No motion of a body was found that can be followed; fit another part.")
    near = [fit for fit in fits.values() if not fit.free.shape]
    if near and rich in fits:  # of a body that is nearly a sphere the balance shows no shape
        sphere = min(near, key=lambda fit: fit.cost)
        again = finish(data, replace(sphere, free=rich))
        if again.cost < fits[rich].cost and _followed(data, again):
            fits[rich] = again
    lowest = min(fits.values(), key=lambda fit: fit.cost)
    if lowest.free != rich:  # the richest holds every other, and can do no worse
        again = finish(data, replace(lowest, free=rich))
        fits[rich] = again if _followed(data, again) else replace(lowest, free=rich)
    found_out = _chosen(data, fits, rich, terms, digits)
    return replace(found_out, vague=_vague(found_out))


def _followed(data: Data, fit: Fitted) -> bool:
    """Whether its motion can be followed by itself, as it was among those beside it."""
    try:
        return bool(np.all(np.isfinite(data.residuals(one_lane(fit.one)))))
    except ArithmeticError:
        return False


def _vague(compared: Compared) -> list[Fitted]:
    """The fits with a small bias where the data leave a bias open.

    A bias that is hardly held comes out large, and beside a large one the other numbers look sure.
    """
    data, rich, noise = compared.data, compared.fits[compared.rich], compared.noise
    if not compared.rich.bias:
        return []
    spread = spread_of(data, rich, noise)
    block = spread.places("bias")
    if np.max(np.diag(spread.covariance)[block]) < VAGUE**2:
        return []
    found = []
    for most in BIASES:
        ridge = noise.omega * np.sqrt(noise.inflation) / most
        fit = solve(replace(data, ridge=ridge), rich.one, compared.rich, CLOSE, MOST_TRIALS)
        if _followed(data, fit):
            found.append(fit)
    return found


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
    return float(fisher.sf(gain * spare / left, more, spare))


def _keeps_direction(data: Data) -> bool:
    """Whether a body without a shape would keep its axis: no torque turns it."""
    size = float(np.linalg.norm(data.torque))
    if size == 0.0:
        return True
    axis = np.linalg.svd(data.omega, full_matrices=False)[2][0]
    return bool(np.linalg.norm(np.cross(data.torque, axis)) < ALONG * size)
