"""Where errors show an order, and whether each step's error follows it."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from omegadot.gates.errors.excess import excess_of
from omegadot.gates.errors.highest_order import highest_order
from omegadot.gates.errors.observed_order import (
    ORDER_TOLERANCE,
    VANISHED,
    ObservedOrder,
    is_whole,
    observed_order,
)
from omegadot.gates.errors.orders import LATE, NEAR_ROUNDING, SATURATE, order_of
from omegadot.gates.errors.sweep_errors import LARGEST_RISE, Errors
from omegadot.reference_impl.system import Array

BOUND = 1e-12
SAMPLES = np.arange(65) / 64.0
STEPS = (0.04, 0.02, 0.01)


def over_time(sizes: dict[float, Array], bound: Array | None = None) -> list[Errors]:
    """Errors along time at each step, of omega."""
    limit = np.full(65, BOUND) if bound is None else bound
    return [Errors(h, SAMPLES, size, limit, size, True) for h, size in sizes.items()]


def powers(order: float, steps: tuple[float, ...] = STEPS) -> dict[float, Array]:
    return {h: h**order * SAMPLES for h in steps}


@pytest.mark.parametrize("order", [1, 2, 4])
def test_rounding_leaves_an_order_open_that_the_errors_have(order: int) -> None:
    """However near its bound rounding comes, with either sign."""
    bound = 3e-3 * 0.01**order * SAMPLES + 1e-30
    for part in (-0.9, 0.0, 0.9):
        sizes = {h: error + part * bound for h, error in powers(order).items()}
        assert highest_order(over_time(sizes, bound)) >= order
    hidden = {h: np.minimum(size, 0.9 * bound) for h, size in powers(order).items()}
    assert highest_order(over_time(hidden, bound)) == np.inf


def test_rounding_leaves_no_order_to_an_error_that_no_step_changes() -> None:
    """Close to rounding, so that its order cannot be seen; late rounding hides it as well."""
    bound = 0.1 * SAMPLES * (1.0 + 100.0 * SAMPLES**2)
    sweep = over_time(dict.fromkeys(STEPS, 1e-3 * SAMPLES), bound * 1e-3)
    seen = order_of(sweep)
    assert seen is None or not seen.resolved
    assert 0.0 < highest_order(sweep) < 1.0
    rising = {0.04: 3e-3 * SAMPLES, 0.02: 2e-3 * SAMPLES, 0.01: 1e-3 * SAMPLES}
    assert highest_order(over_time(rising, bound * 1e-3)) == np.inf  # it may settle further on
    saturated = {h: np.full(65, 0.9) for h in STEPS}
    assert highest_order(over_time(saturated)) == np.inf


@pytest.mark.parametrize("order", [1, 2, 4])
def test_the_order_of_a_sweep(order: int) -> None:
    seen = order_of(over_time(powers(order)))
    assert seen is not None
    assert (seen.value, seen.resolved, seen.hidden) == (pytest.approx(order), True, "")


def test_late_errors_that_saturate_hide_no_order() -> None:
    sizes = {h: np.where(SAMPLES > 0.4, 0.9, h**2 * 10 ** (5 * SAMPLES)) for h in STEPS}
    bound = BOUND * 10 ** (6 * SAMPLES)
    bound[26:] *= 1e4  # an instability, in which rounding grows as well
    seen = order_of(over_time(sizes, bound))
    assert seen is not None
    assert (seen.value, seen.resolved) == (pytest.approx(2.0), True)


def test_late_bounds_of_rounding_hide_no_order() -> None:
    sizes = {h: h**2 * SAMPLES * (1.0 + 200.0 * h * SAMPLES**2) for h in STEPS}
    bound = np.where(SAMPLES > 0.2, 4e-4, BOUND)  # above the finest two
    seen = order_of(over_time(sizes, bound))
    assert seen is not None
    assert (round(seen.value, 1), seen.resolved) == (2.0, True)


def test_what_goes_wrong_late_is_not_passed_over_for_a_good_start() -> None:
    # Clear of rounding and small, so nothing hides the order: late errors follow no power of h.
    late = {h: h**2 * SAMPLES + np.where(SAMPLES > 0.8, 4e-4, 0.0) for h in STEPS}
    seen = order_of(over_time(late))
    assert seen is not None
    assert (seen.resolved, seen.hidden) == (False, "")


@pytest.mark.parametrize(("before", "jumps"), [(0.3, True), (3.0, False)])
def test_errors_that_saturate_by_a_jump_show_that_they_do_not_shrink(
    before: float, jumps: bool
) -> None:
    rise = before * 0.5 / LARGEST_RISE / 0.8
    sizes = {h: rise * (h / 0.01) ** 2 * SAMPLES + np.where(SAMPLES > 0.8, 1.0, 0.0) for h in STEPS}
    seen = order_of(over_time(sizes))
    assert seen is not None
    assert seen.resolved
    assert seen.value == pytest.approx(0.0 if jumps else 2.0, abs=0.05)


def test_an_order_may_rise_again_in_what_is_close_to_rounding() -> None:
    """Terms that cancel at one step leave 1.97 and 1.45, then 1.78 with the finest error near."""
    parts = {0.04: 1.19, 0.02: 1.22, 0.01: 1.78, 0.005: 2.08}
    sizes = {h: part * h**2 * SAMPLES for h, part in parts.items()}
    near = np.full(65, 1.5e-5)
    seen = order_of(over_time(sizes, near))
    assert seen is not None
    assert (round(seen.value, 2), seen.resolved) == (1.46, False)
    assert seen.value + seen.rise > 2.0 - ORDER_TOLERANCE
    for part in (7.12, 4.0):  # the error at 0.01 s stays, or falls no faster than before
        stuck = order_of(over_time(sizes | {0.005: part * 0.005**2 * SAMPLES}, near))
        assert stuck is not None
        assert stuck.value + stuck.rise < 1.5


def test_errors_that_are_hidden_say_by_what() -> None:
    near = order_of(over_time(powers(1), np.full(65, 5e-3)))
    assert near is not None
    assert (near.resolved, near.hidden) == (False, NEAR_ROUNDING)
    far = order_of(over_time({h: np.full(65, 0.6 + h) for h in STEPS}))
    assert far is not None
    assert (far.resolved, far.hidden) == (False, SATURATE)
    two = order_of(over_time(powers(1, STEPS[:2])))  # nothing hides it: a step more would do
    assert two is not None
    assert (two.resolved, two.hidden) == (False, "")


def test_errors_close_to_rounding_decide_no_order() -> None:
    sizes = powers(2) | {0.005: np.full(65, 9 * BOUND)}  # the finest has sunk into rounding
    seen = order_of(over_time(sizes))
    assert seen is not None
    assert (seen.value, seen.resolved) == (pytest.approx(2.0), True)


def test_an_error_that_falls_into_rounding_has_vanished() -> None:
    line = np.ones(65)
    assert order_of(over_time({0.04: 1e-3 * line, 0.02: BOUND * line})) is VANISHED
    # One that stays, or comes back at the finest step, has not; nor has one that was never there.
    for sizes in ((1e-3, 1e-4), (BOUND, 1e-3), (BOUND, BOUND)):
        pair = {0.04: sizes[0] * line, 0.02: sizes[1] * line}
        assert order_of(over_time(pair)) is not VANISHED
    coarse, fine = (
        Errors(h, SAMPLES, size * line, bound * line, size * line, True)
        for h, size, bound in ((0.04, 2e-9, 1e-9), (0.02, 2e-9, 4e-9))
    )
    assert order_of([coarse, fine]) is not VANISHED  # the bound has risen above it
    late = np.where(SAMPLES == 0.5, 2 * BOUND, 0.0)  # one sample keeps an error alive
    assert order_of(over_time({0.04: 1e-3 * line, 0.02: late})) is not VANISHED


def signed(of_step: Callable[[float], Array]) -> list[Errors]:
    """Errors of energy along time, with their signs, at each of six steps."""
    limit = np.full(65, BOUND)
    found = {0.08 / 2**n: of_step(0.08 / 2**n) for n in range(6)}
    return [Errors(h, SAMPLES, abs(e), limit, 0 * e, False, e) for h, e in found.items()]


def test_two_terms_that_cancel_at_some_samples_have_the_order_of_the_first() -> None:
    """Caught: the size alone, of which each sample cancels at another step."""
    small, large = 1e-2 * SAMPLES, 6.0 * SAMPLES**4
    for order in (1, 2):
        seen = order_of(signed(lambda h, k=order: small * h**k - large * h ** (k + 1)))  # type: ignore[misc]
        assert seen is not None
        assert (seen.value, seen.resolved) == (float(order), True)
    unsigned = [replace(e, signed=None) for e in signed(lambda h: small * h - large * h**2)]
    shown = order_of(unsigned)
    assert shown is not None
    assert not shown.resolved


def test_a_higher_power_is_no_first_of_two_terms() -> None:
    """Caught: a cubic takes 120 parts of a fourth power for a first one."""
    finest = 0.08 / 2**5

    def of_step(h: float) -> Array:
        r = h / finest
        return SAMPLES * (-3.45e-7 * r**2 + 4.8e-8 * r**3 + 3.08e-10 * r**4)

    seen = order_of(signed(of_step))
    assert seen is not None
    assert not seen.resolved or seen.value == 2.0


def test_errors_that_begin_to_fall_close_to_rounding_are_on_their_way_to_an_order() -> None:
    """Caught: the slope of errors at steps that an engine divides into steps of its own."""
    sizes = {0.04 / 2**n: s * BOUND for n, s in enumerate((24, 21.6, 19, 14, 14, 3.6, 1.1))}
    seen = order_of(over_time({h: size * SAMPLES for h, size in sizes.items()}))
    assert seen is not None
    assert seen.value < 0.5
    assert seen.value + seen.rise > 2.0 - ORDER_TOLERANCE
    stays = {h: max(size, 14 * BOUND) * SAMPLES for h, size in sizes.items()}
    stuck = order_of(over_time(stays))
    assert stuck is not None
    assert stuck.value + stuck.rise < 0.5


@pytest.mark.parametrize("stays", [2e-4, -2e-4])
def test_an_error_that_stays_is_no_first_of_two_terms(stays: float) -> None:
    """Caught: a fault that is there from one time on, under an error that vanishes."""
    late = np.where(SAMPLES > 0.7, stays, 0.0)
    seen = order_of(signed(lambda h: 1e-2 * SAMPLES * h - 6.0 * SAMPLES**4 * h**2 + late))
    assert seen is None or seen.value < 1.0 - ORDER_TOLERANCE or not seen.resolved


def excess(sizes: dict[float, Array], declared: int, bound: Array | None = None) -> list[float]:
    errors = over_time(sizes, bound)
    return [excess_of(one, errors, declared) for one in errors]


@pytest.mark.parametrize(("true", "declared"), [(1, 1), (2, 1), (4, 4), (5, 4), (5, 2)])
def test_errors_of_an_order_or_of_a_higher_one_have_no_excess(true: int, declared: int) -> None:
    assert max(excess(powers(true, (0.08, *STEPS)), declared)) <= 1.0 + 1e-9


def test_next_terms_are_no_excess() -> None:
    sizes = {h: (h**4 * 1e3 + (8 * h) ** 7) * SAMPLES for h in (0.08, *STEPS, 0.005)}
    assert max(excess(sizes, 4)) < 1.0


def test_the_finest_step_has_no_excess() -> None:
    assert excess({0.01: SAMPLES}, 1) == [0.0]


def test_a_fault_at_coarse_steps_alone_is_an_excess() -> None:
    steps = (0.04, 0.02, 0.01, 0.005)
    sizes = powers(2, steps) | {0.04: 0.1 * SAMPLES}
    found = excess(sizes, 2)
    assert found[0] == pytest.approx(0.1 / (0.02**2 * 2**5))
    assert max(found[1:]) < 1.0
    # Where the finer errors are within rounding, these are only known to be no larger than that.
    bare = {0.04: 1e-3 * SAMPLES, 0.02: np.zeros(65), 0.01: np.zeros(65)}
    assert excess(bare, 1)[0] == pytest.approx(1e-3 / (10 * BOUND * 2**4))
    assert excess(bare | {0.04: 70 * BOUND * SAMPLES}, 1)[0] < 1.0


def test_a_finer_step_that_nothing_explains_explains_no_other() -> None:
    """Caught: an error of the whole motion at one step, passed for one as large at the next."""
    steps = (0.08, 0.04, 0.02, 0.01, 0.005, 0.0025)
    sizes = powers(2, steps) | {0.02: 2.0 * SAMPLES, 0.01: 1.5 * SAMPLES}
    assert min(excess(sizes, 2)[2:4]) > 10.0
    assert max(excess(sizes, 2)[4:]) < 1.0


def test_an_error_is_held_against_coarser_steps_too() -> None:
    """Caught: steps below a length that are all wrong, where longer ones are right."""
    wrong = powers(2, (0.08, 0.04)) | dict.fromkeys((0.02, 0.01, 0.005), 2.0 * SAMPLES)
    assert min(excess(wrong, 2)[2:]) > 1.0
    # an error that is small at one step as terms nearly cancel there, and one that is rounding
    near = powers(2, (0.04, 0.02)) | {0.08: 0.1 * 0.04**2 * SAMPLES}
    assert max(excess(near, 2)) < 1.0
    rounding = {0.08: 0.01 * BOUND * SAMPLES, 0.04: 5.0 * BOUND * SAMPLES}
    assert max(excess(rounding, 2)) < 1.0
    # of a body that stays where it is, without rounding
    assert excess(dict.fromkeys(STEPS, 0.0 * SAMPLES), 2, 0.0 * SAMPLES) == [0.0] * len(STEPS)


def test_terms_that_cancel_at_one_step_are_no_excess_at_the_next() -> None:
    """``C h^4 |1 - h / 0.0208|`` is nearly nothing at 0.02, and close to rounding at 0.01."""
    size = 5 * BOUND / (0.01**4 * (1 - 0.01 / 0.0208))
    sizes = {h: size * h**4 * abs(1 - h / 0.0208) * SAMPLES for h in (0.04, 0.02, 0.01, 0.005)}
    assert max(excess(sizes, 4)) < 1.0
    # A fault of the coarse step alone is one all the same, and where finer errors are rounding.
    assert excess(sizes | {0.04: 2e5 * BOUND * SAMPLES}, 4)[0] > 10.0
    hidden = sizes | dict.fromkeys((0.02, 0.01, 0.005), 0.5 * BOUND * SAMPLES)
    assert excess(hidden, 4)[0] == pytest.approx(sizes[0.04][-1] / (10 * BOUND * 2**7))


def test_an_excess_that_saturates_is_seen_where_it_begins() -> None:
    steps = (0.04, 0.02, 0.01, 0.005)
    sizes = powers(4, steps) | {0.04: np.where(SAMPLES > 0.1, 3.0, 0.04**4 * SAMPLES)}
    assert excess(sizes, 4)[0] > 1e3
    # Errors at all steps that saturate together are no excess of the coarsest.
    late = {h: np.where(SAMPLES > 0.4, 2.0, h**2 * SAMPLES) for h in steps}
    assert max(excess(late, 2)) < 1.0


def test_other_sample_times_are_compared_up_to_the_same_time() -> None:
    coarse = Errors(0.5, SAMPLES[::8], np.full(9, 0.1), np.full(9, BOUND), np.full(9, 0.1), True)
    fine = Errors(0.25, SAMPLES, 0.1 * SAMPLES, np.full(65, BOUND), 0.1 * SAMPLES, True)
    found = excess_of(coarse, [coarse, fine], 1)
    assert found == pytest.approx(0.1 / (0.1 * 2**4))


@pytest.mark.parametrize(
    ("order", "whole"), [(1.0, True), (1.15, True), (1.16, False), (0.5, False), (0.84, False)]
)
def test_only_a_whole_number_is_an_order(order: float, whole: bool) -> None:
    assert is_whole(order) is is_whole(-order) is whole


def test_the_order_is_that_of_the_finest_steps() -> None:
    assert ORDER_TOLERANCE == 0.15
    seen = observed_order([0.01, 0.04, 0.02], [1.0, 32.0, 4.0])  # in any order of the steps
    assert seen == ObservedOrder(pytest.approx(2.0), False, pytest.approx(-1.0))
    assert observed_order([0.02, 0.01], [4.0, 1.0]) == ObservedOrder(pytest.approx(2.0), False, 0.0)
    three = observed_order([0.01, 0.03], [1.0, 9.0])
    assert three is not None
    assert three.value == pytest.approx(2.0)


@pytest.mark.parametrize(("last", "resolved"), [(2.14, True), (2.16, False), (1.86, True)])
def test_neighbouring_slopes_agree_within_the_tolerance(last: float, resolved: bool) -> None:
    seen = observed_order([0.04, 0.02, 0.01], [2.0 ** (2 + last), 2.0**last, 1.0])
    assert seen is not None
    assert (seen.value, seen.resolved) == (pytest.approx(last), resolved)


@pytest.mark.parametrize("bad", [0.0, -1.0, np.inf, np.nan])
def test_what_is_no_size_is_left_out(bad: float) -> None:
    seen = observed_order([0.08, 0.04, 0.02, 0.01], [bad, 16.0, 4.0, 1.0])
    assert seen == ObservedOrder(pytest.approx(2.0), True, pytest.approx(0.0))
    assert observed_order([0.02, 0.01], [bad, 1.0]) is None
    assert observed_order([], []) is None


def test_every_step_needs_its_error() -> None:
    with pytest.raises(ValueError, match="zip"):
        observed_order([0.02, 0.01], [1.0])


def test_steps_longer_than_an_engines_own_change_nothing() -> None:
    """Caught: an engine of order 2 that splits long steps, accused of order 0 at these.

    Where no step changes anything, that is reported, and finer ones are requested.
    """
    own = {h: min(h, 0.125) for h in (1.0, 0.5, 0.25, 0.125, 0.0625, 0.03125)}
    growing = 1e-2 * SAMPLES
    found = order_of(over_time({h: step**2 * growing for h, step in own.items()}))
    assert found is not None
    assert (found.value, found.resolved, found.same) == (pytest.approx(2.0), True, False)
    coarse = order_of(over_time({h: own[h] ** 2 * growing for h in (1.0, 0.5, 0.25)}))
    assert coarse is not None
    assert (coarse.value, coarse.same) == (pytest.approx(0.0), True)


@pytest.mark.parametrize(("first", "hidden"), [(4.0, LATE), (3.0, ""), (6.0, "")])
def test_a_late_sum_of_powers_is_not_judged_where_earlier_errors_show_the_first(
    first: float, hidden: str
) -> None:
    """Caught: a scheme in rotation vectors on a thin body, by its late slopes of 4.2 and 3.1.

    Earlier errors of an order that is lower, or far higher, leave the late ones as they are.
    """
    late = {0.04: 1.66e-6, 0.02: 9.25e-8, 0.01: 1.08e-8}
    early = {h: 1e-9 * (h / 0.01) ** first * SAMPLES for h in late}
    sizes = {h: np.where(SAMPLES > 0.6, late[h], early[h]) for h in late}
    found = order_of(over_time(sizes))
    assert found is not None
    assert not found.resolved
    assert found.hidden == hidden
