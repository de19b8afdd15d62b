"""Series for a turn's quaternion ``(cos(x/2), sin(x/2)/x u)``, ``x = |u|``, with a wrong number."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from omegadot.diagnosis.wording.digits import number
from omegadot.gates.bounds.scales import norm
from omegadot.reference_impl.rotations import normalize
from omegadot.reference_impl.system import Array

WHOLE = 1e-4  # relative, of it
# Of the series: names, right numbers, powers of x; those of C, then those of S.
COSINE = {"x^2/8": (-1 / 8, 2), "x^4/384": (1 / 384, 4)}
SINE = {"1/2": (1 / 2, 0), "x^2/48": (-1 / 48, 2), "x^4/3840": (1 / 3840, 4)}


@dataclass(frozen=True)
class Series:
    """How many terms C and S have, none where it is exact, and which of S's or C's is wrong.

    wrong: its place in the series; of_sine: in which.  completed: C is what makes the quaternion of
    unit length with this S, ``sqrt(1 - (S x)^2)``.
    """

    cosine: int | None
    sine: int | None
    of_sine: bool = True
    wrong: int | None = None
    completed: bool = False

    def unit(self, u: Array, c: float) -> Array:
        """The quaternion, with c in place of the wrong number."""
        x = norm(u)[..., None]
        cosine, sine = np.cos(0.5 * x), np.sinc(0.5 * x / np.pi) / 2.0
        terms = ((self.cosine, COSINE, False), (self.sine, SINE, True))
        for count, series, of_sine in terms:
            if count is None:
                continue
            own = 0.0 * x + (0.0 if of_sine else 1.0)
            for place, (value, power) in enumerate([*series.values()][:count]):
                wrong = place == self.wrong and of_sine is self.of_sine
                own = own + (c if wrong else value) * x**power
            cosine, sine = (cosine, own) if of_sine else (own, sine)
        if self.completed:
            cosine = np.sqrt(np.maximum(1.0 - (sine * x) ** 2, 0.0))
        return normalize(np.concatenate((cosine, sine * u), axis=-1))


def series_to_try() -> list[Series]:
    """Those with one wrong number, and those that end too early with every number right."""
    counts = [(c, s) for c in (0, 1, 2, None) for s in (1, 2, 3, None)]
    found = [Series(c, s) for c, s in counts if c is not None or s is not None]
    found += [Series(None, s, completed=True) for s in (1, 2)]
    for c, s in counts:
        found += [Series(c, s, True, k) for k in range(1, s or 0)]
        found += [Series(c, s, False, k) for k in range(c or 0)]
    return found


def series_named(series: Series, c: float) -> str:
    """What is wrong with it; "" where the number is none that is a slip."""
    if series.wrong is None:
        ends = []
        for count, what, own in (
            (series.cosine, "cos(x/2)", COSINE),
            (series.sine, "sin(x/2)/x", SINE),
        ):
            if count is not None and count < len(own):
                ends.append(f"{[*own][count]} in {what}")
        text = f"that ends before {' and '.join(ends)}" if ends else ""
        return f"{text}, with the scalar part that makes it a unit one" * series.completed or text
    own, what = (SINE, "sin(x/2)/x") if series.of_sine else (COSINE, "cos(x/2)")
    name, (right, power) = [*own.items()][series.wrong]
    if abs(c / right - 1.0) < WHOLE:
        return ""
    sign = "-" if c * right < 0.0 else ""
    if abs(c) < WHOLE * abs(right):
        if series.wrong + 1 == (series.sine if series.of_sine else series.cosine):
            return ""  # it is the series that ends before it
        return f"without {name} in {what}"
    whole = np.round(1.0 / abs(c))
    exact = abs(abs(c) * whole - 1.0) < WHOLE
    made = f"x^{power}/{int(whole)}" if exact else f"{number(float(f'{abs(c):.4g}'))} x^{power}"
    return f"for {what} with {sign}{made} in place of {name}"
