"""An inverse of the inertia that is a series, or comes of a few iterations, and is cut short."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np

from omegadot.diagnosis.equations.equation_form import form_of
from omegadot.diagnosis.equations.evidence import INVERSE, INVERTED, Evidence
from omegadot.diagnosis.wording.kinds import MOST_NAMED, either
from omegadot.reference_impl.inertia import moving_inertia
from omegadot.reference_impl.system import Array

SOLVED = "omega-dot is solved for with an inverse of the inertia that is"
ORDERS = ("diagonal's alone", "first", "second", "third", "fourth", "fifth", "sixth", "seventh")
SWEEPS, STEPS = 6, 12
TIMES = ("", "one", "two", "three", "four", "five", "six", *map(str, range(7, STEPS + 1)))


@dataclass(frozen=True)
class _Cut:
    """text: what the inverse is.  inverse: (3, 3), of an inertia."""

    text: str
    inverse: Array


def inverse_series(every: Sequence[Evidence]) -> str:
    """What explains all that is wrong on all scenarios of one source; "" where nothing does."""
    used = [e for e in every if e.finite and e.source not in (INVERSE, INVERTED)]
    wrong = [e for e in used if e.clear]
    if not wrong:
        return ""
    left: list[str] | None = None
    for evidence in (*wrong, *(e for e in used if not e.clear)):
        left = _fitting(evidence, left)
        if not left:
            return ""
    found = either(left or [])
    return found[0] if found and len(left or []) <= MOST_NAMED else ""


def _fitting(evidence: Evidence, wanted: Sequence[str] | None) -> list[str]:
    """Those that are the engine's on one scenario; wanted: the only ones that are tried."""
    right = form_of(evidence.system)
    inertia = np.asarray(moving_inertia(evidence.system), dtype=float)
    cuts = [one for one in _cuts(inertia) if wanted is None or one.text in wanted]
    cuts = [one for one in cuts if np.all(np.isfinite(one.inverse))]
    fits = evidence.fitting([replace(right, solve=one.inverse) for one in cuts])
    return [cuts[k].text for k in fits]


def _cuts(inertia: Array) -> Iterator[_Cut]:
    """All of them, the plainest first."""
    one = np.eye(3)
    diagonal = np.diag(np.diag(inertia))
    over = np.linalg.inv(diagonal)
    for order in range(1, len(ORDERS)):
        steps = int(np.log2(order + 1))
        same = f", as {_times(steps, 'step')} of Newton-Schulz from the diagonal's give it"
        text = f"its series in the products of inertia up to the {ORDERS[order]} order"
        made = _series(inertia, over, order)
        yield _Cut(f"{SOLVED} {text}{same * (2**steps == order + 1 and order > 1)}", made)
    for name, part in (("xx, yy, zz", np.tril(inertia)), ("zz, yy, xx", np.triu(inertia))):
        start = np.linalg.inv(part)
        for sweeps in range(1, SWEEPS + 1):
            give = "gives" if sweeps == 1 else "give"
            text = f"what {_times(sweeps, 'sweep')} of Gauss-Seidel in the order {name} {give}"
            made = _series(inertia, start, sweeps - 1)
            if sweeps > 1:  # one is the inverse of a triangle, which is named so
                yield _Cut(f"{SOLVED} {text}, from zero", made)
            left = np.linalg.matrix_power(one - start @ inertia, sweeps)
            yield _Cut(f"{SOLVED} {text}, from the diagonal's inverse", made + left @ over)
    norms = np.linalg.norm(inertia, 1) * np.linalg.norm(inertia, np.inf)
    starts = {
        "the unit matrix over the trace": one / np.trace(inertia),
        "the unit matrix over the mean of the diagonal": 3.0 * one / np.trace(inertia),
        "the inertia over its two norms": inertia.T / norms,
    }
    for name, start in starts.items():
        for steps in range(1, STEPS + 1):
            made = _newton(inertia, start, steps)
            give = "gives" if steps == 1 else "give"
            text = f"what {_times(steps, 'step')} of Newton-Schulz from {name} {give}"
            yield _Cut(f"{SOLVED} {text}", made)


def _series(inertia: Array, start: Array, order: int) -> Array:
    """``sum_k (1 - X M)^k X`` up to k = order, with the start X."""
    left = np.eye(3) - start @ inertia
    made = start
    for _ in range(order):
        made = start + left @ made
    return made


def _newton(inertia: Array, start: Array, steps: int) -> Array:
    """``X <- X (2 - M X)``."""
    made = start
    for _ in range(steps):
        made = made @ (2.0 * np.eye(3) - inertia @ made)
    return made


def _times(count: int, what: str) -> str:
    return f"{TIMES[count]} {what}{'s' * (count > 1)}"
