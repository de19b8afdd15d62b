"""Where no cause fits: what is known of the difference, component, direction and dependence."""

from __future__ import annotations

from collections.abc import Sequence
from math import comb

import numpy as np
from numpy.typing import NDArray

from omegadot.diagnosis.equations.equation_form import form_of
from omegadot.diagnosis.equations.evidence import Evidence
from omegadot.diagnosis.wording.digits import number
from omegadot.diagnosis.wording.features import Features, in_common, ways_of
from omegadot.gates.bounds.scales import norm
from omegadot.reference_impl.cross_product import cross
from omegadot.reference_impl.rotations import rotate_inverse
from omegadot.reference_impl.symmetric import apply
from omegadot.reference_impl.system import Array

PARALLEL = 1e-6  # the sine of the angle up to which two directions are the same
CLEAN = 1e-4  # of an exponent, where a power law is exact but for rounding
CLEAR_OF_ROUNDING = 1.0 / CLEAN  # in bounds, which are of many more roundings than there are


def description(evidence: Evidence) -> str:
    """The difference of an engine's accelerations from the right ones, as text; "" without any."""
    parts = [
        _of(evidence, "omega-dot", evidence.found.angular - evidence.true.angular, "angular"),
        _of(evidence, "the linear acceleration", evidence.found.linear - evidence.true.linear, ""),
    ]
    return "; ".join(part for part in parts if part)


def _of(evidence: Evidence, what: str, rest: Array, kind: str) -> str:
    bound = evidence.angular_bound if kind else evidence.linear_bound
    size = norm(rest)
    clear = np.isfinite(size) & (size > CLEAR_OF_ROUNDING * bound)
    if np.count_nonzero(clear) < 6:
        return ""
    wrong = np.abs(rest) > CLEAR_OF_ROUNDING * bound[:, None]
    axes = [axis for k, axis in enumerate("xyz") if np.any(wrong[clear, k])]
    texts = [f"{what} is off"]
    if len(axes) < 3:
        texts[0] += f" in {' and '.join(axes)} alone"
    share = np.count_nonzero(~evidence.sound) / len(size)
    if share < 1.0:
        texts.append(f"at {100 * share:.0f} % of the states")
    along, vectors = _direction(evidence, rest, clear) if kind else ("", rest)
    if along:
        texts.append(along)
    power = _power(norm(evidence.states.angular_velocity)[clear], norm(vectors)[clear])
    if power is not None:
        grows = (
            "by the same amount at every omega"
            if abs(power) < CLEAN
            else (f"by an amount that goes as |omega|^{number(round(power, 3))}")
        )
        texts.append(grows)
    return ", ".join(texts)


def _direction(evidence: Evidence, rest: Array, clear: NDArray[np.bool_]) -> tuple[str, Array]:
    """The direction of the torque, or of the rate, that is too much, and these vectors."""
    system, w = evidence.system, evidence.states.angular_velocity
    form = form_of(system)
    momentum = apply(form.spin, w)
    down = rotate_inverse(evidence.states.orientation, system.load.gravity)
    driven = rotate_inverse(evidence.states.orientation, system.load.torque_world)
    named = {
        "omega": w,
        "the angular momentum": momentum,
        "omega x I omega": cross(w, momentum),
        "the torque of gravity": cross(form.arm + 0 * w, down),
        "gravity": down,
        "the torque in body axes": system.load.torque_body + 0 * w,
        "the torque in world axes": driven,
    }
    moment = apply(form.spin, rest)
    for what, vectors in (("a torque", moment), ("a rate", rest)):
        for name, direction in named.items():
            sizes = norm(direction)[clear] * norm(vectors)[clear]
            sine = norm(cross(vectors, direction))[clear]
            if np.all(sizes > 0.0) and np.all(sine <= PARALLEL * sizes):
                return f"by {what} along {name}", vectors
    return "", rest


def _power(x: Array, y: Array) -> float | None:
    """The exponent of an exact power law, from the slope of the logarithms."""
    used = (x > 0.0) & (y > 0.0)
    if np.count_nonzero(used) < 6 or np.ptp(np.log(x[used])) < 1.0:
        return None
    slope, start = np.polyfit(np.log(x[used]), np.log(y[used]), 1)
    left = np.log(y[used]) - slope * np.log(x[used]) - start
    return float(slope) if float(np.max(np.abs(left))) < 10 * CLEAN else None


def scenarios_in_common(failing: Sequence[Features], passing: Sequence[Features]) -> str:
    """What the scenarios that fail have in common and the others lack."""
    if comb(len(failing) + len(passing), len(failing)) < ways_of(failing):
        return ""  # so few are sorted by chance
    common = in_common(failing, passing)
    if not common or len(common) > 2:
        return ""
    return f"it fails in scenarios alone where {' or where '.join(common)}"
