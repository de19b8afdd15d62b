"""The nested fits of a trace: every model of shape, bias and damping that is requested."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from omegadot.commands.fit.compared import Compared, Digits, Terms, chosen_of
from omegadot.commands.fit.data import Data
from omegadot.commands.fit.follow import follow
from omegadot.commands.fit.noise import FINEST, noise_of, one_lane
from omegadot.commands.fit.parameters import Free
from omegadot.commands.fit.solve import CLOSE, MOST_TRIALS, TRIALS, Fitted, finish, solve
from omegadot.commands.fit.spread import spread_of
from omegadot.commands.fit.start import sized, starts
from omegadot.harness.usage import UsageError

WIDEST = 1e4  # of weights, which derivatives by differences resolve
ROUNDS = 3  # of the weights of omega and attitude: they settle in two
FINE = 1e-5  # rms of residuals below which the motion is followed to the last digits
VAGUE = 0.1  # a standard error of a bias, of the size of omega, beyond which it is tried smaller
BIASES = (1.0, 0.3, 0.1)  # of the size of omega: what such a fit holds a bias within
HOPELESS = 100.0  # a sum of squares so many times that of the richest is worth few trials
ALONG = 0.1  # rad: a torque nearer to the axis than this does not turn it


def compare_models(data: Data, digits: Digits, terms: Terms) -> Compared:
    """Fit every model that the terms allow, and choose. digits: in the units of the fit."""
    data = sized(data)
    first, found = nearest_fits(data, terms)
    rich = found.free
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
    found_out = chosen_of(data, fits, rich, terms, digits)
    return replace(found_out, vague=_vague(found_out))


def nearest_fits(data: Data, terms: Terms) -> tuple[Fitted, Fitted]:
    """The fits with the fewest and with the most terms, close to their minima. data: `sized`."""
    scale, turning = bool(np.any(data.torque)), data.orientation is not None
    rich = Free(True, scale, terms.bias is not False, terms.damping is not False, turning)
    plain = replace(rich, bias=bool(terms.bias), damping=bool(terms.damping))
    found = follow(data, starts(data, rich), rich)
    first = follow(data, [*starts(data, plain), found.one], plain) if plain != rich else found
    return first, min(found, solve(data, first.one, rich), key=lambda fit: fit.cost)


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


def _keeps_direction(data: Data) -> bool:
    """Whether a body without a shape would keep its axis: no torque turns it."""
    size = float(np.linalg.norm(data.torque))
    if size == 0.0:
        return True
    axis = np.linalg.svd(data.omega, full_matrices=False)[2][0]
    return bool(np.linalg.norm(np.cross(data.torque, axis)) < ALONG * size)
