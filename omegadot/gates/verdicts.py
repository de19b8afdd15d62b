"""Why an error may stand: it is rounding, it is the scheme's own, or it shrinks as declared.

A drift of the declared scheme is not a fault. An error passes where it is
*round-off* (within what rounding may grow to), *explained* (the engine's trajectory equals, to
round-off growth, that of the reference stepping the declared scheme), or *consistent* (it shrinks
with the step at the declared order). Otherwise it fails.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from omegadot.reference_impl.system import Array

# How far an observed order may lie below the declared one where the sweep resolves it.
ORDER_TOLERANCE = 0.15
ONE_STEP = "one step size cannot show an order"
UNSETTLED = "the sweep does not resolve the order"
UNDECIDED = (ONE_STEP, UNSETTLED)
"""How the notes begin of failures that a finer step could lift."""


@dataclass(frozen=True)
class Finding:
    """One channel of one run, judged.

    kind: "round-off", "explained", "consistent", "beyond" (there is nothing to judge by),
    "unresolved" or "unexplained".
    note: the reason as text.
    """

    kind: str
    note: str

    @property
    def verdict(self) -> str:
        """The verdict on the error: pass, fail, or info where it cannot be judged."""
        if self.kind == "beyond":
            return "info"
        return "pass" if self.kind in ("round-off", "explained", "consistent") else "fail"


@dataclass(frozen=True)
class ObservedOrder:
    """The slope of log error over log step. resolved: neighbouring slopes agree.

    rise: by how much the slope rose with the last halving. Where the next term of the error is one
    order higher, what a slope lacks halves with the step, so that it is heading for
    ``value + rise``.
    """

    value: float
    resolved: bool
    rise: float = 0.0


def is_whole(order: float) -> bool:
    """Whether an order can be one: those of smooth motion are whole numbers, and 0 is no order.

    Between two of them, terms of different orders are still of a size, or the largest error has
    moved to another sample.
    """
    return abs(order - round(order)) <= ORDER_TOLERANCE


VANISHED = ObservedOrder(float("inf"), True)
"""Of an error that falls into rounding at the finest step: it shrinks, if too fast to measure."""


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
    rise = float(slopes[0] - slopes[1]) if len(slopes) > 1 else 0.0
    return ObservedOrder(float(slopes[0]), bool(resolved), rise)


@dataclass(frozen=True)
class Evidence:
    """What is known of one channel of one run.

    error: (n,), the distance from the exact trajectory.  round_off: (n,), what rounding may grow
    to.
    left: (n,), the distance from the reference stepping the declared scheme, where there is one.
    orders: the observed orders of `error` and, where there is one, of `left`.
    floor: (n,), how far a perfect answer may be off, where that is known.
    """

    error: Array
    round_off: Array
    left: Array | None
    orders: tuple[ObservedOrder | None, ...]
    floor: Array | None = None


def judge(evidence: Evidence, scheme: str | None, declared: int | None) -> Finding:
    """The reason why an error is accepted, or that there is none.

    An error that is not explained must shrink at the declared order, and so must what is left of
    it after the declared scheme: two schemes of an order differ by a term of that order, a fault
    does not. A declared order of None means conserved: only rounding or the scheme can account
    for an error then.
    """
    if not np.all(np.isfinite(evidence.error)):
        return Finding("unexplained", "not finite")
    # From where the scheme itself blows up there is no bound, and nothing to be held against.
    bounded = np.isfinite(evidence.round_off)
    if not bounded[1:].any():
        return Finding("beyond", "not judged: the scheme itself blows up at so large a step")
    if np.all(evidence.error <= evidence.round_off) and bounded.all():
        return Finding("round-off", "within round-off")
    if evidence.left is not None and np.all(evidence.left <= evidence.round_off):
        largest = float(np.max(evidence.left[bounded]))
        until = "" if bounded.all() else ", until the scheme blows up"
        return Finding("explained", f"explained by {scheme}, to {largest:.1e}{until}")
    if evidence.floor is not None and np.all(evidence.error <= evidence.round_off + evidence.floor):
        return Finding("beyond", "not judged: below the resolvable floor of this motion")
    if declared is None:
        return Finding("unexplained", "declared conserved, and it drifts")
    return _by_order(evidence.orders, declared)


def _by_order(orders: tuple[ObservedOrder | None, ...], declared: int) -> Finding:
    seen = [order for order in orders if order is not None]
    if len(seen) < len(orders):
        return Finding("unresolved", ONE_STEP)
    lowest = min(seen, key=lambda order: order.value)
    text = f"observed order {lowest.value:.2f}, declared {declared}"
    if not all(order.resolved for order in seen):
        return Finding("unresolved", f"{UNSETTLED}: {text}")
    if lowest.value >= declared - ORDER_TOLERANCE:
        return Finding("consistent", f"consistent: {text}")
    if lowest.value + lowest.rise >= declared - ORDER_TOLERANCE or not is_whole(lowest.value):
        return Finding("unresolved", f"{UNSETTLED}: {text}")
    return Finding("unexplained", text)
