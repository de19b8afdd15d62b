"""What the data determine and what they do not, one sentence each."""

from __future__ import annotations

import numpy as np

from omegadot.commands.fit.compared import Compared, Terms
from omegadot.commands.fit.determined import Determined
from omegadot.commands.fit.estimates import Estimates, open_directions
from omegadot.commands.fit.scale import Scale
from omegadot.reference_impl.system import Array
from omegadot.written import written

FLAT = 1e-5  # of the largest moment: nearer to the sum of the other two it is at the limit
POOR = 0.1  # rms of the residuals, of omega
COARSE = 1.0  # rad from a sample to the next


def sentences(known: Determined, own: Estimates, terms: Terms) -> list[str]:
    """All that hold."""
    compared = known.compared
    return [
        *_no_errors(compared),
        *([] if own.size_known else ["The torque is not seen in omega: no scale is determined."]),
        *(_shape(own) if compared.chosen.shape else _no_shape(known, own)),
        *_open(known, own),
        *_scale(compared, known.scale, own),
        *_bias(known, own),
        *_damping(compared, known.scale, own, terms),
        *_quality(compared),
    ]


def _no_errors(compared: Compared) -> list[str]:
    """First of all, why no number has a standard error."""
    noise = compared.noise
    if not noise.is_model_error:
        return []
    return [
        "No standard error is given: the residuals are "
        f"{written(noise.omega / noise.resolution, 2)} times the resolution of omega, and "
        f"neighbours correlate by {noise.correlation:.2f} at least, so that they are no noise: "
        "the model lacks something, such as drag, or units or axes are not as declared."
    ]


def direction(axis: Array) -> str:
    """``(0.00, 0.71, 0.71)``."""
    return "(" + ", ".join(f"{part + 0.0:.2f}" for part in np.round(axis, 2)) + ")"


def _no_shape(known: Determined, own: Estimates) -> list[str]:
    axis = own.omega / np.linalg.norm(own.omega)
    found = [
        f"omega keeps the direction {direction(axis)} within the noise, which shows no ratio of "
        "moments: every body that has a principal axis along it turns like this, and a sphere "
        "about any axis."
    ]
    if known.compared.rich.scale and own.size_known:
        value, error = known.moment_about(axis)
        sure = "" if known.compared.noise.is_model_error else f" +- {written(error, 2)}"
        found.append(
            f"The moment about that axis is {written(value)}{sure} kg m^2; "
            "the others are not determined."
        )
    return found


def _open(known: Determined, own: Estimates) -> list[str]:
    """What the window does not determine, and how long it would have to be."""
    left = known.open_terms(own)
    if not left:
        return []
    verb = "separate" if len(left) > 1 else "determine"
    found = f"This window does not {verb} {_listed(left)}"
    fewest, best, longest = left, (0.0, 0.0), 0.0
    for seconds, turned, still in known.longer():
        best = (seconds, turned) if len(still) < len(fewest) else best
        fewest = still if len(still) < len(fewest) else fewest
        longest = seconds
        if not fewest:
            break
    shown = f"{written(best[0], 2)} s of this motion ({written(best[1], 2)} rad)"
    if not fewest:
        return [f"{found}; some {shown} would."]
    if len(fewest) < len(left):
        gained = [name for name in left if name not in fewest]
        found += f"; some {shown} would determine {_listed(gained)}"
    if longest:
        found += f"; {written(longest, 2)} s of it would not determine {_listed(fewest)}"
    return [f"{found}."]


def _listed(names: list[str]) -> str:
    return " and ".join([", ".join(names[:-1]), names[-1]] if len(names) > 1 else names)


def _shape(own: Estimates) -> list[str]:
    if not own.shape_known:
        return ["No ratio of moments is determined."] if own.size_known else []
    found = []
    for axis, sure in zip("xyz", own.moments_known, strict=True):
        if not sure:
            found.append(f"The moment near {axis} is not determined.")
    open_axes = [axis for axis, sure in zip("xyz", own.axes_known, strict=True) if not sure]
    if len(open_axes) == 3 and np.all(own.moments_known):
        found.append(
            "The three moments are alike within their errors: no principal axis is determined."
        )
    elif open_axes and not np.all(own.moments_known):
        found.append(f"The principal axes near {' and '.join(open_axes)} are not determined.")
    elif open_axes:
        found.append(
            f"The moments near {' and '.join(open_axes)} are alike within their errors: their axes "
            "are open within their plane, as those of a symmetric body are."
        )
    a, b, c = sorted(own.moments)
    if np.all(own.moments_known) and a + b - c < FLAT * c:
        found.append(
            "The largest moment equals the sum of the other two: the body is flat, or the fit sits "
            "at the limit of what bodies can have, where standard errors hold on one side only."
        )
    return found


def _scale(compared: Compared, scale: Scale, own: Estimates) -> list[str]:
    if scale.unit or not (compared.chosen.shape and own.shape_known):
        return []
    damping = compared.chosen.damping and own.damping_known
    damped = " and the damping over a moment" if damping else ""
    return [
        f"Without a torque only ratios of moments{damped} are determined, never their scale: give "
        "--torque, or a moment that is known with --moment."
    ]


def _bias(known: Determined, own: Estimates) -> list[str]:
    """Whether it is determined, and why it is not fitted."""
    compared = known.compared
    if not compared.rich.bias:
        return []
    given = "; --no-bias takes it as zero, which is right for a gyro that was calibrated."
    axes = [direction(axis) for axis in open_directions(known.spreads)]
    if len(axes) == 3:
        return [f"A bias is not determined in any direction: it looks like omega itself{given}"]
    if axes:
        return [
            f"A bias along {' and '.join(axes)} is not determined: other moments would show the "
            f"same omega{given}"
        ]
    if compared.chosen.bias:
        return []
    errors = ", ".join(written(error, 2) for error in own.bias_errors)
    sure = "" if compared.noise.is_model_error else f"; its standard errors are {errors} rad/s"
    return [
        "A gyro bias is not supported by the data: noise alone gains as much with a probability of "
        f"{written(compared.chances.get('bias', 1.0), 2)}. It is taken as zero{sure}."
    ]


def _damping(compared: Compared, scale: Scale, own: Estimates, terms: Terms) -> list[str]:
    if compared.chosen.damping and own.damping_known:
        if own.damping < 0.0:
            return [
                "The damping comes out negative: the body gains energy, which no friction does. "
                "The scenario is written without it."
            ]
        return []
    if terms.damping is False:
        return []
    if not own.damping_known:
        return ["Damping is not determined."]
    negative = any(fit.one.damping < 0.0 for free, fit in compared.fits.items() if free.damping)
    chance = compared.chances.get("damping", 1.0)
    if chance == 1.0 and negative:
        found = "No damping is seen: the energy does not fall."
    else:
        found = (
            "Damping is not supported by the data: noise alone gains as much with a probability of "
            f"{written(chance, 2)}."
        )
    unit = "N m s/rad" if scale.unit else "1/s"
    sure = f"; its standard error is {written(own.damping_error, 2)} {unit}"
    return [f"{found} It is taken as zero{'' if compared.noise.is_model_error else sure}."]


def _quality(compared: Compared) -> list[str]:
    noise, found = compared.noise, []
    if noise.correlation > 0.0 and not noise.is_model_error:
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
            f"The body turns by {written(step, 2)} rad from sample to sample: another motion "
            "may fit as "
            "well."
        )
    return found
