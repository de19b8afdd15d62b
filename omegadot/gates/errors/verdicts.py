"""Why an error may stand: it is rounding, it is the scheme's own, or it shrinks as declared.

A drift of the declared scheme is not a fault. An error passes where it is
*round-off* (within what rounding may grow to), *explained* (the engine's trajectory equals, to
round-off growth, that of the reference stepping the declared scheme), or *consistent* (it shrinks
with the step at the declared order). Otherwise it fails.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from omegadot.gates.bounds.scales import EPS
from omegadot.gates.errors.observed_order import ORDER_TOLERANCE, ObservedOrder, is_whole
from omegadot.reference_impl.system import Array
from omegadot.written import written

ONE_STEP = "one step size cannot show an order"
UNSETTLED = "the sweep does not resolve the order"
STIFF = "the steps are too long for so thin a body to show the order"
NOT_FINITE = "not finite"
OF_EITHER = 2.0  # a run and the reference's of its scheme: each may be off by its rounding
UNDECIDED = (ONE_STEP, UNSETTLED, STIFF)
"""How the notes begin of failures that a finer step could lift."""


@dataclass(frozen=True)
class Finding:
    """One channel of one run, judged.

    kind: "round-off", "explained", "consistent", "beyond" (there is nothing to judge by),
    "unresolved" (the order is hidden), "unsettled" (it is not, and there is none), "outlying" (it
    shrinks as declared, but at this step it is larger than that explains) or "unexplained".
    note: the reason as text.
    """

    kind: str
    note: str

    @property
    def verdict(self) -> str:
        """The verdict on the error: pass, fail, or info where it cannot be judged."""
        if self.kind in ("beyond", "unresolved"):
            return "info"
        return "pass" if self.kind in ("round-off", "explained", "consistent") else "fail"

    @property
    def open(self) -> bool:
        """Whether a finer step could still decide."""
        return self.kind in ("unresolved", "unsettled")


BLOWN_UP_UNSEEN = Finding("unsettled", NOT_FINITE)
"""Of an error that overflows, and whose order is not to be seen until then."""


@dataclass(frozen=True)
class Evidence:
    """What is known of one channel of one run.

    error: (n,), the distance from the exact trajectory.  round_off: (n,), what rounding may grow
    to.
    left: (n,), the distance from the reference stepping the declared scheme, where there is one.
    orders: the observed orders of `error` and, where there is one, of `left`.
    floor: (n,), how far a perfect answer may be off, where that is known.
    excess: how many times larger the error is than those at finer steps let it be.
    settled: there are so many finer steps that more would not change that.
    highest: the order that rounding leaves open at most, where that is known.
    of_momentum: (n,), what rounding may grow to where the angular momentum may be what is stepped.
    stiffness: ``h |omega| sqrt(J / lambda)`` of the finest step. Above one the body's thin axis may
    turn by more than a radian in a step, on which a sound scheme may err without any order.
    opened: (n,), what the scheme itself leaves open between its runs.
    """

    error: Array
    round_off: Array
    left: Array | None
    orders: tuple[ObservedOrder | None, ...]
    floor: Array | None = None
    excess: float = 0.0
    settled: bool = True
    highest: float = np.inf
    of_momentum: Array | None = None
    stiffness: float = 0.0
    opened: Array | None = None

    @property
    def equals_scheme(self) -> bool:
        """Whether rounding alone, of either, tells the run from the reference's of its scheme."""
        opened = 0.0 if self.opened is None else self.opened
        bound = OF_EITHER * self.round_off + opened
        return self.left is not None and bool(np.all(self.left <= bound))

    @property
    def lost_by_rounding(self) -> bool:
        """Whether the run equals the scheme's up to where one rounding is as large as the motion.

        From there the one may overflow and the other not yet.
        """
        lost = ~np.isfinite(self.error)
        first = int(np.argmax(lost))
        if self.left is None or first < 2 or not lost[first]:
            return False
        magnified = bool(EPS * self.round_off[first] > self.round_off[1])
        return magnified and self._until(first).equals_scheme

    def _until(self, count: int) -> Evidence:
        opened = None if self.opened is None else self.opened[:count]
        left = None if self.left is None else self.left[:count]
        return replace(self, left=left, round_off=self.round_off[:count], opened=opened)

    @property
    def may_be_rounding(self) -> bool:
        """Whether an unknown scheme may have made the error by rounding the angular momentum."""
        return self.of_momentum is not None and bool(np.all(self.error <= self.of_momentum))


def judge(evidence: Evidence, scheme: str | None, declared: int | None) -> Finding:
    """The reason why an error is accepted, or that there is none.

    An error that is not explained must shrink at the declared order, and so must what is left of
    it after the declared scheme: two schemes of an order differ by a term of that order, a fault
    does not. A declared order of None means conserved: only rounding or the scheme can account
    for an error then.
    """
    # From where the scheme itself blows up there is no bound, and nothing to be held against.
    bounded = np.isfinite(evidence.round_off)
    if not bounded[1:].any():
        return Finding("beyond", "not judged: the scheme itself blows up at so large a step")
    if np.all(evidence.error <= evidence.round_off) and bounded.all():
        return Finding("round-off", "within round-off")
    known = bool(np.all(np.isfinite(evidence.error[bounded])))
    if known and evidence.left is not None and evidence.equals_scheme:
        largest = float(np.max(evidence.left[bounded]))
        until = "" if bounded.all() else ", until the scheme blows up"
        return Finding("explained", f"explained by {scheme}, to {written(largest, 2)}{until}")
    if not known and evidence.lost_by_rounding:
        return Finding("beyond", "not judged: the scheme itself blows up at so large a step")
    if not known and evidence.left is not None:  # the declared scheme does not overflow here
        return Finding("unexplained", NOT_FINITE)
    if evidence.floor is not None and np.all(evidence.error <= evidence.round_off + evidence.floor):
        return Finding("beyond", "not judged: below the resolvable floor of this motion")
    finite = bool(np.all(np.isfinite(evidence.error)))
    if declared is None:
        return Finding("unexplained", _drifts(scheme) if finite else NOT_FINITE)
    found = _by_order(evidence, declared)
    if finite:
        return found
    if found.kind == "consistent":
        return Finding("beyond", "not judged: it blows up at so large a step")
    return BLOWN_UP_UNSEEN if found.open else Finding("unexplained", NOT_FINITE)


def _drifts(scheme: str | None) -> str:
    """Of a channel without truncation error: by what is declared of it."""
    if scheme is None:
        return "declared conserved, as no order is given for it, and it drifts"
    return f"{scheme} has no error in it here but rounding, and it drifts"


def _by_order(evidence: Evidence, declared: int) -> Finding:
    seen = [order for order in evidence.orders if order is not None]
    if len(seen) < len(evidence.orders):
        return Finding("unresolved", ONE_STEP)
    lowest = min(seen, key=lambda order: order.value)
    least = declared - ORDER_TOLERANCE
    text = f"observed order {lowest.value:z.2f}, declared {declared}"
    if evidence.highest < declared - 0.5:
        limit = f"the order is {evidence.highest:.2f} at most, whatever rounding does"
        return Finding("unexplained", f"{limit}, declared {declared}")
    if lowest.value < least and evidence.stiffness > 1.0:
        return Finding("unresolved", f"{STIFF}: {text}")
    if not all(order.resolved for order in seen):
        shown = [order for order in seen if not order.resolved and not order.hidden]
        # Clear errors that do not even begin to shrink as they should.
        falls = any(o.value < declared - 0.5 and o.rise <= ORDER_TOLERANCE for o in shown)
        falls = falls and not evidence.may_be_rounding
        return Finding("unsettled" if falls else "unresolved", f"{UNSETTLED}: {text}")
    if lowest.value < least and evidence.may_be_rounding:
        return Finding("unresolved", f"{UNSETTLED}: {text}")
    if lowest.value < least:
        if lowest.value + lowest.rise >= least or not is_whole(lowest.value):
            rises = lowest.rise > ORDER_TOLERANCE and evidence.excess <= 1.0
            falls = lowest.value < declared - 0.5 and not rises
            return Finding("unsettled" if falls else "unresolved", f"{UNSETTLED}: {text}")
        # Two slopes may agree by chance where terms nearly cancel; at finer steps they do not.
        # A step that is longer than an engine's own changes nothing.
        doubtful = not evidence.settled and (lowest.value > 0.5 or lowest.same)
        return Finding("unsettled" if doubtful else "unexplained", text)
    if evidence.excess > 1.0:
        times = f"{written(evidence.excess, 2)} times what the errors at other steps let it be"
        note = f"at this step the error is {times}"
        if evidence.settled:
            return Finding("outlying", note)
        return Finding("unsettled", f"{UNSETTLED}: {note}")
    return Finding("consistent", f"consistent: {text}")
