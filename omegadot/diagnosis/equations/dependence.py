"""How what is wrong in an equation depends on single sizes: from one of them doubled at a time."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from omegadot.diagnosis.equations.evidence import Evidence
from omegadot.diagnosis.wording.digits import listed, number
from omegadot.gates.bounds.scales import norm
from omegadot.harness.requests.scaled import STATES, TWICE
from omegadot.reference_impl.system import Array

CLEAN = 1e-4  # of an exponent
CLEAR_OF_ROUNDING = 1.0 / CLEAN  # in bounds, which are of many more roundings than there are
LEAST = 4  # states


def dependence(evidence: Evidence, scaled: Mapping[str, Evidence]) -> str:
    """``it goes as |omega|^2 and as the mass; it does not depend on the damping``; "" without any.

    scaled: by what is doubled, the evidence at the first states of this one.
    """
    base = evidence.at(np.arange(min(STATES, len(evidence.sound))))
    kind = "angular" if np.any(_clear(base, "angular")) else "linear"
    grows, same = list[str](), list[str]()
    for what, other in scaled.items():
        power = _exponent(base, other, kind)
        if power is None:
            continue
        if abs(power) < CLEAN:
            same.append(what)
        else:
            shown = number(float(f"{power:.3g}"))
            grows.append(f"as {what}" if shown == "1" else f"as {what}^{shown}")
    parts = [f"it goes {listed(grows)}"] if grows else []
    return ", and ".join([*parts, *([f"it does not depend on {listed(same)}"] if same else [])])


def _clear(evidence: Evidence, kind: str) -> NDArray[np.bool_]:
    bound = evidence.angular_bound if kind == "angular" else evidence.linear_bound
    size = _off(evidence, kind)
    return np.asarray(np.isfinite(size) & (size > CLEAR_OF_ROUNDING * bound))


def _off(evidence: Evidence, kind: str) -> Array:
    return norm(getattr(evidence.found, kind) - getattr(evidence.true, kind))


def _exponent(base: Evidence, other: Evidence, kind: str) -> float | None:
    """The exponent of a power law that holds at every state; None where none does."""
    used = _clear(base, kind) & _clear(other, kind)
    if np.count_nonzero(used) < LEAST or not np.array_equal(used, _clear(base, kind)):
        return None
    powers = np.log(_off(other, kind)[used] / _off(base, kind)[used]) / np.log(TWICE)
    middle = float(np.median(powers))
    # of other exponents one factor shows no power law
    near = round(2.0 * middle) / 2.0
    return near if np.max(np.abs(powers - near)) < CLEAN else None
