"""How what is wrong in an equation depends on single sizes: from one of them doubled at a time."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from omegadot.diagnosis.equations.evidence import Evidence
from omegadot.diagnosis.wording.digits import listed, number
from omegadot.gates.bounds.scales import norm
from omegadot.harness.requests.scaled import ATTITUDE, STATES, TWICE
from omegadot.reference_impl.system import Array

CLEAN = 1e-4  # of an exponent
CLEAR_OF_ROUNDING = 1.0 / CLEAN  # in bounds, which are of many more roundings than there are
LEAST = 4  # states


LEAST_SCENARIOS = 3  # that show a power law: one size doubled is no more than two points

# By what is doubled: the exponent, and on how many scenarios it is seen.
Powers = dict[str, tuple[float, int]]


def dependence(evidence: Evidence, scaled: Mapping[str, Evidence]) -> str:
    """Of one scenario, as text; "" where nothing is known."""
    kind = "angular" if np.any(_clear(_first(evidence), "angular")) else "linear"
    return dependence_text(powers_over([powers_of(evidence, scaled, kind)]))


def powers_over(every: Sequence[Mapping[str, float | None]]) -> Powers:
    """Exponents that no scenario contradicts; what one cannot show is left to the others."""
    found = dict[str, list[float | None]]()
    for one in every:
        for name, power in one.items():
            found.setdefault(name, []).append(power)
    return {
        name: (values[0], len(values))
        for name, values in found.items()
        if values[0] is not None and len(set(values)) == 1
    }


def dependence_text(powers: Powers, it: str = "it") -> str:
    """``it goes as |omega|^2 and as the mass; it does not depend on the damping``.

    Of fewer scenarios than three, what is seen: ``twice |omega| makes it 4 times as large``.
    """
    grows = [
        f"as {what}" if power == 1.0 else f"as {what}^{_number(power)}"
        for what, (power, count) in powers.items()
        if power and count >= LEAST_SCENARIOS
    ]
    seen = [
        f"twice {what} makes {it} {_number(TWICE**power)} times as large"
        for what, (power, count) in powers.items()
        if power and count < LEAST_SCENARIOS
    ]
    same = [w for w, (p, count) in powers.items() if not p and count >= LEAST_SCENARIOS]
    still = [w for w, (p, count) in powers.items() if not p and count < LEAST_SCENARIOS]
    unturned, still = ATTITUDE in still, [what for what in still if what != ATTITUDE]
    parts = [f"{it} goes {listed(grows)}"] if grows else []
    parts += [f"{it} does not depend on {listed(same)}"] if same else []
    parts += seen
    parts += [f"{it} is the same with twice {listed(still)}"] if still else []
    parts += [f"{it} is the same at another attitude"] if unturned else []
    return ", and ".join(parts)


def _number(value: float) -> str:
    return number(float(f"{value:.3g}"))


def powers_of(
    evidence: Evidence, scaled: Mapping[str, Evidence], kind: str
) -> dict[str, float | None]:
    """The exponents by what is doubled; None where there is none, and not what cannot be seen.

    scaled: by what is doubled, the evidence at the first states of this one.  kind: "angular" or
    "linear".  Of the attitude, which is turned, it is zero where nothing changes in body axes.
    """
    base, found = _first(evidence), dict[str, float | None]()
    for what, other in scaled.items():
        seen, power = (_unturned if what == ATTITUDE else _exponent)(base, other, kind)
        if seen:
            found[what] = power
    return found


def changes_with_attitude(evidence: Evidence, scaled: Mapping[str, Evidence], kind: str) -> bool:
    """Whether the same states at another attitude are off by another vector, in body axes."""
    other = scaled.get(ATTITUDE)
    if other is None or kind != "angular":  # the linear one is in the world
        return False
    return _unturned(_first(evidence), other, kind) == (True, None)


def _unturned(base: Evidence, other: Evidence, kind: str) -> tuple[bool, float | None]:
    """Whether enough states show it, and zero where they are off by the same vector."""
    used = _clear(base, kind)
    if kind != "angular" or np.count_nonzero(used) < LEAST:
        return False, None
    before, after = (one.found.angular - one.true.angular for one in (base, other))
    apart, size = norm(after - before)[used], norm(before)[used]
    if not np.all(np.isfinite(apart)):
        return False, None
    return True, 0.0 if np.all(apart <= CLEAN * size) else None


def _first(evidence: Evidence) -> Evidence:
    return evidence.at(np.arange(min(STATES, len(evidence.sound))))


def _clear(evidence: Evidence, kind: str) -> NDArray[np.bool_]:
    bound = evidence.angular_bound if kind == "angular" else evidence.linear_bound
    size = _off(evidence, kind)
    return np.asarray(np.isfinite(size) & (size > CLEAR_OF_ROUNDING * bound))


def _off(evidence: Evidence, kind: str) -> Array:
    return norm(getattr(evidence.found, kind) - getattr(evidence.true, kind))


def _exponent(base: Evidence, other: Evidence, kind: str) -> tuple[bool, float | None]:
    """Whether enough states show it; and the exponent that holds at all, None where none does."""
    used = _clear(base, kind) & _clear(other, kind)
    if np.count_nonzero(used) < LEAST or not np.array_equal(used, _clear(base, kind)):
        return False, None
    powers = np.log(_off(other, kind)[used] / _off(base, kind)[used]) / np.log(TWICE)
    middle = float(np.median(powers))
    # of other exponents one factor shows no power law
    near = round(2.0 * middle) / 2.0
    return True, near + 0.0 if np.max(np.abs(powers - near)) < CLEAN else None
