"""The judgement of errors over accuracies, on errors that are known as functions of the accuracy.

What these tests catch: a floor that passes because coarse errors hide it; a power law that is taken
for a floor; steps that end at samples taken for a fault; a coarse error waved through because finer
ones are good.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from in_process import builtin, truth_of

from omegadot.adapters.protocol import Integrator
from omegadot.gates.bounds.roundings import Roundings
from omegadot.gates.case import Sweep
from omegadot.gates.errors.measured_run import CHANNELS
from omegadot.gates.errors.verdicts import Finding
from omegadot.gates.steps.accuracy import (
    AccuracyRun,
    finest_of,
    fixed,
    measure_accuracy,
    order_of,
    per_sample,
    steps_per_radian,
    tolerated_by,
    usual_for,
)
from omegadot.gates.steps.accuracy_followed import findings_of, rows
from omegadot.reference_impl.schemes.scheme import every_channel

TIMES = np.linspace(0.0, 1.0, 21)
ROUNDING = 1e-14
ACCURACIES = (1e-3, 1e-5, 1e-7, 1e-9, 1e-11, 1e-13)


def run(accuracy: float, error: float, spacing: int = 1) -> AccuracyRun:
    """A run whose error grows in proportion to time, up to `error`."""
    sweep = Sweep(0.05 / spacing, 20 * spacing, spacing, accuracy)
    errors = dict.fromkeys(CHANNELS, error * TIMES)
    bounds = dict.fromkeys(CHANNELS, ROUNDING * (1.0 + TIMES))
    kept = dict.fromkeys(CHANNELS, accuracy * (1.0 + TIMES))
    return AccuracyRun(sweep, errors, bounds, {}, {}, kept)


def swept(error: Callable[[float], float]) -> list[AccuracyRun]:
    return [run(accuracy, error(accuracy)) for accuracy in ACCURACIES]


def verdicts(runs: list[AccuracyRun]) -> list[str]:
    return [findings_of(one, runs)["omega"].verdict for one in runs if one.sweep.every == 1]


@pytest.mark.parametrize("power", [0.55, 2 / 3, 1.0, 1.5, 1.95])
@pytest.mark.parametrize("size", [1e-3, 1.0, 100.0])
def test_a_power_of_the_accuracy_passes(power: float, size: float) -> None:
    assert set(verdicts(swept(lambda t: size * t**power))) == {"pass"}


@pytest.mark.parametrize("floor", [1e-3, 1e-6, 1e-9, 1e-11])
def test_a_floor_above_rounding_fails_at_every_accuracy(floor: float) -> None:
    runs = swept(lambda t: t + floor)
    assert set(verdicts(runs)) == {"fail"}
    assert "does not follow its accuracy" in findings_of(runs[0], runs)["omega"].note


def test_a_floor_within_rounding_is_none() -> None:
    assert set(verdicts(swept(lambda t: t + 5 * ROUNDING))) == {"pass"}


@pytest.mark.parametrize("power", [0.3, 0.4])
def test_a_weak_power_is_none(power: float) -> None:
    assert set(verdicts(swept(lambda t: 1e-3 * t**power))) == {"fail"}


def test_an_error_of_order_one_need_not_have_settled() -> None:
    """Half of an order of 1, seen to within what orders are: 0.109 rad at 1e-3, 0.012 at 1e-5."""
    assert set(verdicts(swept(lambda t: 3.0 * t**0.479))) == {"pass"}


@pytest.mark.parametrize("coarse", [1, 2])
def test_an_error_that_finer_ones_do_not_account_for_fails_alone(coarse: int) -> None:
    far = ACCURACIES[:coarse]
    found = verdicts(swept(lambda t: 0.3 if t in far else 1e-3 * t))
    assert found == ["fail"] * coarse + ["pass"] * (len(ACCURACIES) - coarse)


def test_steps_that_end_at_samples_shrink_with_their_spacing() -> None:
    flat = [run(t, 1e-10) for t in ACCURACIES]
    assert set(verdicts(flat)) == {"fail"}
    closer = [*flat, run(ACCURACIES[-1], 1e-10 / 4**5, 4)]
    assert set(verdicts(closer)) == {"pass"}
    assert set(verdicts([*flat, run(ACCURACIES[-1], 1e-10, 4)])) == {"fail"}


def test_an_accuracy_that_is_kept_need_not_shrink_further() -> None:
    runs = [run(t, 0.8e-7) for t in (1e-5, 1e-6, 1e-7)]
    assert set(verdicts(runs)) == {"pass"}


def test_errors_as_large_as_the_motion_show_nothing_and_hide_nothing() -> None:
    assert set(verdicts(swept(lambda t: min(2.0, 1e4 * t)))) == {"pass"}
    assert set(verdicts(swept(lambda t: 2.0))) == {"fail"}


def test_what_is_not_finite_fails() -> None:
    runs = swept(lambda t: t)
    runs[0].error["omega"][3:] = np.inf
    assert verdicts(runs) == ["fail", *["pass"] * 5]


def test_the_slope_is_recorded_and_so_are_the_parts_of_the_accuracy() -> None:
    runs = swept(lambda t: 1e3 * t)
    named = {(row.channel, row.metric): row.value for row in rows(runs[0], runs)}
    assert named["omega", "accuracy_slope"] == pytest.approx(1.0)
    assert named["omega", "parts_of_accuracy"] == pytest.approx(500.0)


def test_a_fixed_accuracy_excuses_no_failure_but_that_of_the_size() -> None:
    wrong = Finding("unexplained", "observed order 0.00, declared 5")
    kept = {"a": Finding("round-off", ""), "b": Finding("unexplained", "not finite")}
    found = fixed({**kept, "c": wrong})
    assert found["c"].verdict == "info"
    assert {name: found[name] for name in kept} == kept


def test_what_an_integrator_declares_of_its_accuracy() -> None:
    free = Integrator("a", None, every_channel(5), "accuracy")
    assert (order_of(free), finest_of(free), usual_for(free)) == (5, 1e-13, 1e-9)
    coarse = Integrator("a", None, {}, "accuracy", finest_accuracy=1e-6)
    assert (order_of(coarse), finest_of(coarse), usual_for(coarse)) == (1, 1e-6, 1e-6)
    assert steps_per_radian(coarse, 1e-6) == pytest.approx(1e3)
    assert usual_for(Integrator("a", None, {})) is None
    assert tolerated_by(Integrator("a", None, {})).in_a_run == 0.0
    assert tolerated_by(coarse).in_a_radian == pytest.approx(1e-3)
    assert tolerated_by(coarse).in_a_run == pytest.approx(2e-6 * np.sqrt(13))  # of one step


@pytest.mark.parametrize(("order", "steps"), [(1, 10), (2, 4), (4, 2), (8, 2)])
def test_steps_that_samples_end_become_no_shorter_than_a_weak_power_makes_them(
    order: int, steps: int
) -> None:
    """r^(1/(2p)), rounded up; where motion is slow against the samples, they count."""
    assert per_sample(Integrator("a", None, every_channel(order), "accuracy")) == steps
    assert steps - 1 < 100.0 ** (0.5 / order) <= steps


def test_velocities_that_are_turns_over_a_step_have_a_bound() -> None:
    """Caught: a division by zero, in the rounding of a step of no length."""
    whole = builtin("t-handle")
    case = replace(whole, sweeps=(Sweep(0.1, 20, 1, 1e-6),))
    truth = truth_of(case, ()).of_roundings(Roundings(of_turns=True))
    integrator = Integrator("own", None, every_channel(1), knob="accuracy")
    sweep = case.sweeps[0]
    found = measure_accuracy(truth, integrator, sweep, truth.at(sweep))
    for bounds in (found.round_off, found.kept):
        assert all(np.all(np.isfinite(values)) for values in bounds.values())
