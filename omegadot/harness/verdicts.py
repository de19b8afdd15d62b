"""Why an error may stand: it is rounding, it is the scheme's own, or it shrinks as declared.

A drift of the declared scheme is not a fault. An error passes where it is
*round-off* (within what rounding may grow to), *explained* (the engine's course equals, to
round-off growth, that of the reference stepping the declared scheme), or *consistent* (it shrinks
with the step at the declared order). Otherwise it fails.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from omegadot.reference_impl.system import Array

# How far an observed order may lie below the declared one where the sweep resolves it.
ORDER_TOLERANCE = 0.15


@dataclass(frozen=True)
class Finding:
    """One channel of one run, judged.

    kind: "round-off", "explained", "consistent", "unresolved" or "unexplained".
    note: the reason in words.
    """

    kind: str
    note: str

    @property
    def holds(self) -> bool:
        """Whether the error may stand."""
        return self.kind in ("round-off", "explained", "consistent")


@dataclass(frozen=True)
class ObservedOrder:
    """The slope of log error over log step. resolved: neighbouring slopes agree."""

    value: float
    resolved: bool


def observed_order(timesteps: Sequence[float], errors: Sequence[float]) -> ObservedOrder | None:
    """The order seen between the finest steps: ``log(e1 / e2) / log(h1 / h2)``.

    Resolved where the two finest slopes agree within the tolerance. None with fewer than two
    positive errors.
    """
    points = sorted((h, e) for h, e in zip(timesteps, errors, strict=True) if 0.0 < e < np.inf)
    if len(points) < 2:
        return None
    steps, sizes = np.log(np.array(points)).T
    slopes = np.diff(sizes) / np.diff(steps)
    resolved = len(slopes) > 1 and abs(slopes[0] - slopes[1]) <= ORDER_TOLERANCE
    return ObservedOrder(float(slopes[0]), bool(resolved))


def judge(
    error: Array,
    round_off: Array,
    scheme: str | None,
    against_scheme: Array | None,
    declared: int | None,
    order: ObservedOrder | None,
) -> Finding:
    """Give the reason why `error` may stand, or say that there is none.

    error, round_off and against_scheme: (n,), the distance from the exact course, its rounding
    bound, the distance from the reference stepping `scheme`. A declared order of None means
    conserved: then only rounding or the scheme can account for an error.
    """
    if not np.all(np.isfinite(error)):
        return Finding("unexplained", "not finite")
    if np.all(error <= round_off):
        return Finding("round-off", "within round-off")
    if scheme is not None and against_scheme is not None and np.all(against_scheme <= round_off):
        largest = float(np.max(against_scheme))
        return Finding("explained", f"explained by {scheme}, to {largest:.1e}")
    if order is not None and declared is not None:
        seen = f"observed order {order.value:.2f}, declared {declared}"
        if order.resolved and order.value >= declared - ORDER_TOLERANCE:
            return Finding("consistent", f"consistent: {seen}")
        if not order.resolved:
            return Finding("unresolved", f"the sweep does not resolve the order: {seen}")
        return Finding("unexplained", seen)
    if declared is not None:
        return Finding("unresolved", "one step size cannot show an order")
    return Finding("unexplained", "declared conserved, and it drifts")
