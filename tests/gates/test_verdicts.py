"""Why an error may stand, and when it may not."""

import numpy as np
import pytest

from omegadot.gates.errors.observed_order import ObservedOrder, observed_order
from omegadot.gates.errors.verdicts import Evidence, judge

BOUND = np.full(3, 1e-12)
LARGE = np.array([0.0, 1e-3, 1e-2])
RESOLVED = ObservedOrder(1.01, True)


@pytest.mark.parametrize("order", [1, 2, 4])
def test_a_power_of_the_step_shows_its_order(order: int) -> None:
    steps = [0.04, 0.02, 0.01]
    seen = observed_order(steps, [3.0 * h**order for h in steps])
    assert seen is not None
    assert seen.resolved
    assert seen.value == pytest.approx(order, abs=1e-12)


def test_a_constant_error_has_order_zero() -> None:
    seen = observed_order([0.04, 0.02, 0.01], [1e-3, 1e-3, 1e-3])
    assert seen == ObservedOrder(0.0, True, 0.0)


def test_two_slopes_that_differ_are_not_resolved() -> None:
    seen = observed_order([0.04, 0.02, 0.01], [1e-1, 9e-2, 3e-2])
    assert seen is not None
    assert not seen.resolved
    assert observed_order([0.02, 0.01], [4e-2, 2e-2]) == ObservedOrder(pytest.approx(1.0), False)


@pytest.mark.parametrize("errors", [[1e-3], [0.0, 0.0], [np.inf, 1.0], [np.nan, 1.0]])
def test_less_than_two_errors_show_no_order(errors: list[float]) -> None:
    assert observed_order([0.02, 0.01][: len(errors)], errors) is None


def kind(
    error: np.ndarray,
    left: np.ndarray | None,
    orders: tuple[ObservedOrder | None, ...],
    declared: int | None,
) -> str:
    return judge(Evidence(error, BOUND, left, orders), "scheme", declared).kind


def test_rounding_needs_no_other_reason() -> None:
    assert kind(BOUND, None, (None,), 1) == "round-off"


def test_the_declared_scheme_explains_its_own_error() -> None:
    assert kind(LARGE, BOUND / 2, (None, None), 1) == "explained"
    assert kind(LARGE, 3 * BOUND, (ObservedOrder(0.0, True),) * 2, 1) == "unexplained"


def test_an_error_of_the_declared_order_is_consistent() -> None:
    assert kind(LARGE, None, (RESOLVED,), 1) == "consistent"
    assert kind(LARGE, None, (ObservedOrder(3.0, True),), 2) == "consistent"
    assert kind(LARGE, None, (ObservedOrder(1.8, True),), 2) == "unresolved"
    assert kind(LARGE, None, (ObservedOrder(1.1, True),), 2) == "unexplained"


def test_what_is_left_of_a_fault_does_not_shrink() -> None:
    # A step that is 0.1 % long hides behind a first-order error, but not behind its scheme.
    left = np.array([0.0, 1e-4, 1e-3])
    assert kind(LARGE, left, (RESOLVED, ObservedOrder(0.01, True)), 1) == "unexplained"
    assert kind(LARGE, left, (RESOLVED, ObservedOrder(2.0, True)), 1) == "consistent"


def test_what_is_declared_conserved_may_not_drift() -> None:
    assert kind(LARGE, None, (RESOLVED,), None) == "unexplained"


def test_too_few_steps_leave_it_open() -> None:
    assert kind(LARGE, None, (None,), 1) == "unresolved"
    assert kind(LARGE, None, (ObservedOrder(1.0, False),), 1) == "unresolved"
    assert kind(LARGE, LARGE, (RESOLVED, None), 1) == "unresolved"


def test_what_lies_below_the_floor_is_not_judged() -> None:
    floor = np.array([0.0, 1e-3, 1e-2])
    seen = judge(Evidence(LARGE, BOUND, None, (None,), floor), "scheme", 1)
    assert (seen.kind, seen.verdict) == ("beyond", "info")
    seen = judge(Evidence(LARGE / 2, BOUND, None, (None,), floor), "scheme", 1)
    assert seen.kind == "beyond"
    seen = judge(Evidence(2 * LARGE, BOUND, None, (RESOLVED,), floor), "scheme", 1)
    assert seen.kind == "consistent"


def test_nan_is_never_explained() -> None:
    error, slow = np.array([0.0, np.nan, 0.0]), ObservedOrder(0.0, True)
    assert kind(error, BOUND / 2, (slow, slow), 1) == "unexplained"


def test_beyond_the_schemes_own_end_nothing_is_judged() -> None:
    bound = np.array([1e-15, np.inf, np.inf])
    finding = judge(Evidence(LARGE, bound, LARGE, (None, None)), "scheme", 1)
    assert (finding.kind, finding.verdict) == ("beyond", "info")
    bound = np.array([1e-15, 1e-12, np.inf])
    left = np.array([0.0, 1e-13, 1e9])
    finding = judge(Evidence(LARGE, bound, left, (None, None)), "scheme", 1)
    assert finding.kind == "explained"
    assert "until the scheme blows up" in finding.note
    left[1] = 1e-11
    assert judge(Evidence(LARGE, bound, left, (None, None)), "scheme", 1).kind == "unresolved"


def test_a_slope_that_is_still_rising_fails_no_run() -> None:
    steps = [0.04, 0.02, 0.01]
    seen = observed_order(steps, [h - 9 * h**2 for h in steps])
    assert seen is not None
    assert seen.resolved is False
    rising = ObservedOrder(0.83, True, 0.08)
    assert kind(LARGE, None, (rising,), 1) == "unresolved"
    assert kind(LARGE, None, (ObservedOrder(0.83, True, -0.01),), 1) == "unresolved"
    assert kind(LARGE, None, (ObservedOrder(0.1, True, -0.01),), 1) == "unexplained"
