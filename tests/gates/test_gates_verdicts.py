"""The edges of the verdicts: which side of each bound an error falls on, and the note."""

from dataclasses import replace

import numpy as np
import pytest

from omegadot.gates.errors.observed_order import ORDER_TOLERANCE, VANISHED, ObservedOrder
from omegadot.gates.errors.orders import NEAR_ROUNDING, SATURATE
from omegadot.gates.errors.verdicts import Evidence, Finding, judge

BOUND = np.array([1e-15, 1e-12, 1e-11])
SLOW = ObservedOrder(0.1, True)


def evidence(error: object, left: object = None, floor: object = None, *orders: object) -> Evidence:
    compared = None if left is None else np.array(left, float)
    below = None if floor is None else np.array(floor, float)
    return Evidence(np.array(error, float), BOUND, compared, orders or (SLOW,), below)  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("order", "settled", "kind"),
    [
        (3.14, False, "unsettled"),  # two slopes may agree by chance
        (3.14, True, "unexplained"),
        (0.1, False, "unexplained"),
        (3.9, False, "consistent"),
    ],
)
def test_a_low_order_is_looked_at_again_at_finer_steps(
    order: float, settled: bool, kind: str
) -> None:
    found = evidence([0.0, 1e-3, 1e-3], None, None, ObservedOrder(order, True))
    assert judge(replace(found, settled=settled), "rk4", 4).kind == kind


def test_an_order_of_nothing_has_no_sign() -> None:
    """Caught: "observed order -0.00, declared 1"."""
    found = evidence([0.0, 1e-3, 1e-3], None, None, ObservedOrder(-0.001, True))
    assert judge(found, None, 1).note == "observed order 0.00, declared 1"


def test_a_body_too_thin_for_the_steps_leaves_a_low_order_open() -> None:
    """Caught: a stiff scheme that is accused where its finest step does not resolve the motion."""
    for order in (SLOW, ObservedOrder(0.1, False)):
        found = evidence([0.0, 1e-3, 1e-3], None, None, order)
        assert judge(replace(found, stiffness=1.01), None, 4).kind == "unresolved"
        assert judge(replace(found, stiffness=0.99), None, 4).kind in ("unexplained", "unsettled")
    higher = evidence([0.0, 1e-3, 1e-3], None, None, ObservedOrder(4.0, True))
    assert judge(replace(higher, stiffness=1.01), None, 4).kind == "consistent"


def test_runs_that_are_one_trajectory_need_finer_steps_before_they_fail() -> None:
    flat = ObservedOrder(0.0, True, same=True)
    found = evidence([0.0, 1e-3, 1e-3], None, None, flat)
    assert judge(replace(found, settled=False), None, 4).kind == "unsettled"
    assert judge(replace(found, settled=True), None, 4).kind == "unexplained"


def test_an_order_that_rounding_does_not_leave_open_fails() -> None:
    near = ObservedOrder(1.7, False, hidden=NEAR_ROUNDING)
    found = evidence([0.0, 1e-3, 1e-3], None, None, near)
    assert judge(found, None, 4).kind == "unresolved"
    assert judge(replace(found, highest=3.6), None, 4).kind == "unresolved"
    failed = judge(replace(found, highest=1.78), None, 4)
    assert failed.kind == "unexplained"
    assert failed.note == "the order is 1.78 at most, whatever rounding does, declared 4"
    assert (
        judge(replace(evidence(BOUND, None, None, near), highest=0.0), None, 4).kind == "round-off"
    )


@pytest.mark.parametrize(
    ("kind", "verdict"),
    [
        ("round-off", "pass"),
        ("explained", "pass"),
        ("consistent", "pass"),
        ("beyond", "info"),
        ("unresolved", "info"),
        ("unsettled", "fail"),
        ("unexplained", "fail"),
    ],
)
def test_what_a_kind_comes_to(kind: str, verdict: str) -> None:
    assert Finding(kind, "").verdict == verdict
    assert Finding(kind, "").open is (kind in ("unresolved", "unsettled"))


def test_round_off_holds_at_every_sample() -> None:
    found = judge(evidence(BOUND), "euler", 1)
    assert found == Finding("round-off", "within round-off")
    for place in range(3):
        error = BOUND.copy()
        error[place] *= 1.01
        assert judge(evidence(error), "euler", 1).kind == "unexplained"


def test_a_scheme_explains_at_every_sample() -> None:
    error = [0.0, 1e-3, 1e-3]
    found = judge(evidence(error, BOUND), "euler", 1)
    assert found == Finding("explained", "explained by euler, to 1e-11")
    for place in range(3):
        left = 2.0 * BOUND  # the engine's rounding and the reference's
        assert judge(evidence(error, left, None, SLOW, SLOW), "euler", 1).kind == "explained"
        left[place] *= 1.01
        assert judge(evidence(error, left, None, SLOW, SLOW), "euler", 1).kind == "unexplained"


def test_a_floor_is_added_to_rounding() -> None:
    floor = np.array([1e-14, 1e-9, 1e-8])
    found = judge(evidence(BOUND + floor, None, floor), "euler", 1)
    assert found == Finding("beyond", "not judged: below the resolvable floor of this motion")
    assert judge(evidence(1.01 * (BOUND + floor), None, floor), "euler", 1).kind == "unexplained"
    assert judge(evidence(BOUND, None, floor), "euler", 1).kind == "round-off"
    assert judge(evidence(BOUND + floor, BOUND, floor), "euler", 1).kind == "explained"


def test_where_a_scheme_blows_up_there_is_nothing_to_judge_by() -> None:
    error, bounds = np.array([0.0, 1.0, 2.0]), np.array([1e-15, np.inf, np.inf])
    found = judge(Evidence(error, bounds, None, (SLOW,)), "euler", 1)
    assert found.note == "not judged: the scheme itself blows up at so large a step"
    # A bound at the end alone is enough to judge by; the start, where nothing happened, is not.
    partly = Evidence(error, np.array([np.inf, np.inf, 1e-12]), None, (SLOW,))
    assert judge(partly, "euler", 1).kind == "unexplained"
    within = Evidence(np.zeros(3), np.array([1e-15, 1e-12, np.inf]), None, (SLOW,))
    assert judge(within, "euler", 1).kind == "unexplained"
    explained = Evidence(error, np.array([1e-15, 1e-12, np.inf]), np.array([0, 1e-13, 9]), (SLOW,))
    assert judge(explained, "euler", 1).note == (
        "explained by euler, to 1e-13, until the scheme blows up"
    )


@pytest.mark.parametrize("place", range(3))
def test_one_sample_that_is_no_number_fails(place: int) -> None:
    error = np.zeros(3)
    error[place] = np.inf
    found = judge(evidence(error, np.ones(3), None, SLOW, SLOW), "euler", 1)
    assert found == Finding("unexplained", "not finite")
    assert judge(evidence(error), "euler", None) == Finding("unexplained", "not finite")
    # Finer steps may show that this one is too large; as long as they do not, it fails.
    fine = judge(evidence(error, None, None, ObservedOrder(1.0, True)), "euler", 1)
    assert fine == Finding("beyond", "not judged: it blows up at so large a step")
    # But not where a scheme is declared that does not overflow there: it is another one then.
    left = judge(evidence(error, error, None, SLOW, ObservedOrder(2.0, True)), "euler", 1)
    assert left == Finding("unexplained", "not finite")
    hidden = judge(evidence(error, None, None, ObservedOrder(1.0, False, 0.0, SATURATE)), "e", 1)
    assert hidden == Finding("unsettled", "not finite")


def test_an_overflow_is_no_other_scheme_where_rounding_is_as_large_as_the_motion() -> None:
    """Caught: an engine accused that overflows a sample before the run of its scheme does."""
    bounds = np.array([0.0, 1e-15, 1e-3, 1e2])
    error, left = np.array([0.0, 0.0, 0.0, np.inf]), np.array([0.0, 0.0, 1e-4, np.inf])
    seen = Evidence(error, bounds, left, (SLOW,))
    assert judge(seen, "euler", 1).kind == "beyond"
    # not where it has left the scheme before, nor where rounding is still small
    apart = replace(seen, left=np.array([0.0, 0.0, 1e-2, np.inf]))
    assert judge(apart, "euler", 1).kind == "unexplained"
    small = replace(seen, round_off=np.array([0.0, 1e-15, 1e-3, 1e-2]))
    assert judge(small, "euler", 1).kind == "unexplained"


def test_an_error_that_finer_steps_do_not_explain_fails() -> None:
    seen = replace(evidence([0.0, 1.0, 1.0], None, None, ObservedOrder(1.0, True)), excess=1.1)
    assert judge(seen, "euler", 1) == Finding(
        "outlying",
        "at this step the error is 1.1 times what the errors at other steps let it be",
    )
    assert judge(seen, "euler", 1).verdict == "fail"
    assert judge(replace(seen, excess=1.0), "euler", 1).kind == "consistent"
    assert judge(replace(seen, settled=False), "euler", 1).kind == "unsettled"


def by_order(*orders: ObservedOrder | None, declared: int | None = 2) -> Finding:
    return judge(evidence([0.0, 1.0, 1.0], None, None, *orders), "euler", declared)


def test_the_tolerance_of_an_order() -> None:
    assert ORDER_TOLERANCE == 0.15
    assert by_order(ObservedOrder(2 - ORDER_TOLERANCE, True)).kind == "consistent"
    assert by_order(ObservedOrder(1.849, True)).kind == "unresolved"
    assert by_order(ObservedOrder(1.845, True, 0.01)).kind == "unresolved"
    assert by_order(ObservedOrder(1.15, True, 0.69)).kind == "unexplained"
    assert by_order(ObservedOrder(1.15, True, -0.71)).kind == "unexplained"
    assert by_order(VANISHED).kind == "consistent"


@pytest.mark.parametrize(
    ("order", "whole"), [(1.0, True), (1.15, True), (1.16, False), (0.5, False), (0.84, False)]
)
def test_only_a_whole_number_is_an_order(order: float, whole: bool) -> None:
    """An energy that drifts with 3.41 is neither of order 3 nor of order 4: finer steps decide."""
    for value in (order, -order):
        kind = by_order(ObservedOrder(value, True)).kind
        assert kind == ("unexplained" if whole else "unsettled")
    assert by_order(ObservedOrder(order + 1, True)).kind == (
        "consistent" if order >= 0.85 else "unsettled" if order < 0.5 else "unresolved"
    )
    rising = ObservedOrder(order, True, 0.16)  # with finer steps it rises: there is no telling yet
    assert by_order(rising).kind == ("unexplained" if whole else "unresolved")


def test_clear_errors_that_do_not_begin_to_shrink_are_no_open_question() -> None:
    for order, kind in (
        (ObservedOrder(1.4, False), "unsettled"),
        (ObservedOrder(1.6, False), "unresolved"),
        (ObservedOrder(1.4, False, 0.2), "unresolved"),
        (ObservedOrder(1.4, False, 0.0, SATURATE), "unresolved"),
    ):
        assert by_order(order).kind == kind


def test_the_lowest_order_counts() -> None:
    high, low = ObservedOrder(3.0, True), ObservedOrder(1.0, True)
    for orders in ((high, low), (low, high)):
        assert by_order(*orders) == Finding("unexplained", "observed order 1.00, declared 2")
    assert by_order(high, high) == Finding(
        "consistent", "consistent: observed order 3.00, declared 2"
    )


def test_what_is_not_known_is_unresolved() -> None:
    high = ObservedOrder(3.0, True)
    assert by_order(None).note == "one step size cannot show an order"
    assert by_order(high, None).kind == by_order(None, high).kind == "unresolved"
    note = "the sweep does not resolve the order: observed order 1.00, declared 2"
    low = ObservedOrder(1.0, False, 0.0, SATURATE)
    for orders in ((high, low), (low, high)):
        assert by_order(*orders) == Finding("unresolved", note)
    rising = ObservedOrder(1.8, True, 0.1)
    assert by_order(rising).note.startswith("the sweep does not resolve the order: observed")


def test_what_is_conserved_may_not_drift_at_any_order() -> None:
    found = by_order(VANISHED, declared=None)
    assert found.kind == "unexplained"
    assert found.note.endswith("and it drifts")


def test_an_unknown_scheme_may_round_the_momentum() -> None:
    """An error that grows as the step shrinks is no scheme's, if it is larger than all rounding."""
    grows = ObservedOrder(-1.6, False)
    found = evidence([0.0, 1e-9, 1e-9], None, None, grows)
    assert judge(found, None, 3).kind == "unsettled"
    assert judge(replace(found, of_momentum=np.full(3, 2e-9)), None, 3).kind == "unresolved"
    assert judge(replace(found, of_momentum=np.full(3, 5e-10)), None, 3).kind == "unsettled"
    # a resolved order that is near a whole number by chance says no more
    found = evidence([0.0, 1e-9, 1e-9], None, None, ObservedOrder(-1.1, True))
    assert judge(found, None, 1).kind == "unexplained"
    assert judge(replace(found, of_momentum=np.full(3, 2e-9)), None, 1).kind == "unresolved"
