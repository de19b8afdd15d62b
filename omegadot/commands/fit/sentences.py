"""What the data determine and what they do not, one sentence each."""

from __future__ import annotations

import numpy as np

from omegadot.commands.fit.estimates import Estimates, open_directions
from omegadot.commands.fit.models import Compared, Terms
from omegadot.commands.fit.samples import Samples
from omegadot.commands.fit.scale import Scale
from omegadot.commands.fit.spread import Spread, spread_of
from omegadot.reference_impl.system import Array

FLAT = 1e-5  # of the largest moment: nearer to the sum of the other two it is at the limit
POOR = 0.1  # rms of the residuals, of omega
COARSE = 1.0  # rad from a sample to the next


def sentences(
    samples: Samples,
    compared: Compared,
    spread: Spread,
    own: Estimates,
    scale: Scale,
    terms: Terms,
) -> list[str]:
    """All that hold."""
    shape = _shape(own) if compared.chosen.shape else _no_shape(compared, spread, own, scale)
    return [
        *([] if own.size_known else ["The torque is not seen in omega: no scale is determined."]),
        *shape,
        *_scale(compared, scale),
        *_bias(compared, spread, terms),
        *_damping(compared, own, terms),
        *_quality(samples, compared),
    ]


def direction(axis: Array) -> str:
    """``(0.00, 0.71, 0.71)``."""
    return "(" + ", ".join(f"{part + 0.0:.2f}" for part in np.round(axis, 2)) + ")"


def _no_shape(compared: Compared, spread: Spread, own: Estimates, scale: Scale) -> list[str]:
    axis = own.omega / np.linalg.norm(own.omega)
    found = [
        f"omega keeps the direction {direction(axis)} within the noise, which shows no ratio of "
        "moments: every body that has a principal axis along it turns like this, and a sphere "
        "about any axis."
    ]
    if spread.free.scale and own.size_known:
        error = scale.factor * float(spread.error(spread.slope_of_entry(axis, axis)))
        found.append(
            f"The moment about that axis is {axis @ own.inertia @ axis:.6g} +- {error:.2g} kg m^2; "
            "the others are not determined."
        )
    return found


def _shape(own: Estimates) -> list[str]:
    found = []
    for axis, sure in zip("xyz", own.moments_known, strict=True):
        if not sure:
            found.append(f"The moment near {axis} is not determined.")
    open_axes = [axis for axis, sure in zip("xyz", own.axes_known, strict=True) if not sure]
    if len(open_axes) == 3:
        found.append(
            "The three moments are alike within their errors: no principal axis is determined."
        )
    elif open_axes:
        found.append(
            f"The moments near {' and '.join(open_axes)} are alike within their errors: their axes "
            "are open within their plane, as those of a symmetric body are."
        )
    a, b, c = sorted(own.moments)
    if a + b - c < FLAT * c:
        found.append(
            "The largest moment equals the sum of the other two: the body is flat, or the fit sits "
            "at the limit of what bodies can have, where standard errors hold on one side only."
        )
    return found


def _scale(compared: Compared, scale: Scale) -> list[str]:
    if scale.unit or not compared.chosen.shape:
        return []
    damped = " and the damping over a moment" if compared.chosen.damping else ""
    return [
        f"Without a torque only ratios of moments{damped} are determined, never their scale: give "
        "--torque, or a moment that is known with --moment."
    ]


def _bias(compared: Compared, spread: Spread, terms: Terms) -> list[str]:
    """Whether it is determined, and why it is not fitted."""
    chosen = compared.chosen
    rich = spread if chosen.bias else _rich(compared)
    if rich is None:
        return []
    axes = [direction(axis) for axis in open_directions(rich)]
    if len(axes) == 3:
        return ["A bias is not determined in any direction: it looks like omega itself."]
    found = []
    if not chosen.bias:
        chance = compared.chances.get("bias", 1.0)
        found.append(
            f"A gyro bias is not supported by the data: noise alone gains as much with a "
            f"probability of {chance:.2g}. It is taken as zero."
        )
    if axes:
        zero = " and is taken as zero there" if chosen.bias else ""
        found.append(
            f"A bias along {' and '.join(axes)} is not determined{zero}: other moments "
            "would show the same omega."
        )
    return found


def _rich(compared: Compared) -> Spread | None:
    """The covariance of the model with a bias, where one was fitted."""
    known = [free for free in compared.fits if free.bias and free.shape == compared.chosen.shape]
    if not known:
        return None
    free = next((f for f in known if f.damping == compared.chosen.damping), known[0])
    return spread_of(compared.data, compared.fits[free], compared.noise)


def _damping(compared: Compared, own: Estimates, terms: Terms) -> list[str]:
    if compared.chosen.damping:
        if own.damping < 0.0:
            return [
                "The damping comes out negative: the body gains energy, which no friction does. "
                "The scenario is written without it."
            ]
        return []
    if terms.damping is False:
        return []
    negative = any(fit.one.damping < 0.0 for free, fit in compared.fits.items() if free.damping)
    chance = compared.chances.get("damping", 1.0)
    if chance == 1.0 and negative:
        return ["No damping is seen: the energy does not fall. It is taken as zero."]
    return [
        "Damping is not supported by the data: noise alone gains as much with a probability of "
        f"{chance:.2g}. It is taken as zero."
    ]


def _quality(samples: Samples, compared: Compared) -> list[str]:
    noise, found = compared.noise, []
    if noise.correlation > 0.0:
        found.append(
            f"Neighbouring residuals correlate by {noise.correlation:.2f}: the model lacks "
            "something, or the noise is not white. Standard errors are enlarged by "
            f"{np.sqrt(noise.inflation):.1f} for that."
        )
    if noise.omega > POOR:
        found.append(
            f"The residuals are {100.0 * noise.omega * np.sqrt(3.0):.0f} % of omega: this is not "
            "the motion of one free rigid body, or units or axes are not as declared."
        )
    step = float(np.median(np.diff(compared.data.turned)))
    if step > COARSE:
        found.append(
            f"The body turns by {step:.2g} rad from sample to sample: another motion may fit as "
            "well."
        )
    return found
