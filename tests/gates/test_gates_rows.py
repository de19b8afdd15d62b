"""What the gates of invariants and trajectory write of a trajectory."""

from dataclasses import is_dataclass
from importlib import import_module
from pkgutil import iter_modules

import numpy as np
import pytest

from omegadot import gates
from omegadot.commands.check.judge import sentence
from omegadot.gates.bounds.scales import EPS
from omegadot.gates.case import Sweep
from omegadot.gates.errors.measured_run import CHANNELS, MeasuredRun
from omegadot.gates.errors.verdicts import Finding
from omegadot.gates.runs import invariants, trajectory

TIMES = np.array([0.0, 1.0, 2.0, 3.0, 4.0])
ERROR = np.array([0.0, 1.0, 5.0, 3.0, 4.0])
FINE = Finding("consistent", "consistent: observed order 1.00, declared 1")
BAD = Finding("unexplained", "declared conserved, and it drifts")


def test_what_gates_hand_on_cannot_be_changed() -> None:
    for module in iter_modules(gates.__path__, f"{gates.__name__}."):
        for found in vars(import_module(module.name)).values():
            if is_dataclass(found) and found.__module__ == module.name:
                assert found.__dataclass_params__.frozen, found.__name__


def measured(bound: object, left: bool = False, error: object = ERROR) -> MeasuredRun:
    errors = {channel: np.array(error, float) for channel in CHANNELS}
    bounds = {channel: np.broadcast_to(np.array(bound, float), (5,)) for channel in CHANNELS}
    against = dict.fromkeys(CHANNELS, 0.5 * ERROR) if left else {}
    return MeasuredRun(Sweep(1.0, 4, 1), errors, bounds, against)


def test_drifts_over_three_horizons() -> None:
    bound = [0.1, 0.2, 0.3, 0.4, 0.5]
    rows = invariants.rows(measured(bound), dict.fromkeys(CHANNELS, FINE), TIMES)
    assert len(rows) == 9
    assert {row.gate for row in rows} == {"invariants"}
    assert {row.channel for row in rows} == {"energy", "angular_momentum", "linear_momentum"}
    found = {row.metric: (row.value, row.bound) for row in rows if row.channel == "energy"}
    assert found == {
        "drift_quarter": (1.0, 0.2),
        "drift_half": (5.0, 0.3),
        "drift_full": (5.0, 0.5),
    }
    assert {(row.unit, row.verdict, row.note) for row in rows} == {("1", "pass", FINE.note)}


def test_a_drift_without_a_reason_fails_from_where_it_shows() -> None:
    rows = invariants.rows(measured(1.0), dict.fromkeys(CHANNELS, BAD), TIMES, ["energy"])
    assert [(row.verdict, row.note) for row in rows] == [
        ("pass", "within round-off"),
        ("fail", BAD.note),
        ("fail", BAD.note),
    ]


def test_nothing_is_within_a_bound_that_is_none() -> None:
    rows = invariants.rows(measured(np.inf), dict.fromkeys(CHANNELS, BAD), TIMES, ["energy"])
    assert {row.verdict for row in rows} == {"fail"}


def test_errors_of_a_trajectory() -> None:
    findings = {c: BAD if c == "attitude" else FINE for c in CHANNELS}
    rows = trajectory.rows(measured([0.1, 0.2, 0.9, 0.4, 0.5], left=True), findings)
    assert {row.gate for row in rows} == {"trajectory"}
    units = {(row.channel, row.unit) for row in rows}
    assert units == {("omega", "1"), ("attitude", "rad"), ("position", "m")}
    for channel in ("omega", "attitude", "position"):
        found = {row.metric: row for row in rows if row.channel == channel}
        assert list(found) == ["error_max", "error_end", "unexplained_max"]
        assert (found["error_max"].value, found["error_max"].bound) == (5.0, 0.9)
        assert (found["error_max"].verdict, found["error_max"].note) == (
            findings[channel].verdict,
            findings[channel].note,
        )
        assert (found["error_end"].value, found["error_end"].verdict) == (4.0, "info")
        assert (found["unexplained_max"].value, found["unexplained_max"].bound) == (2.5, 1.8)
        assert found["unexplained_max"].verdict == "info"


def test_an_error_that_fails_early_names_the_sample() -> None:
    """Caught: "0.18 times its bound" of a failure, by a bound that grows along the run."""
    early = measured([1.0, 0.1, 2.0, 4.0, 9.0], error=[0.0, 0.5, 0.5, 0.5, 0.5])
    rows = trajectory.rows(early, dict.fromkeys(CHANNELS, BAD))
    (row,) = (one for one in rows if (one.channel, one.metric) == ("position", "error_max"))
    assert row.note == f"{BAD.note}; at t = 1 s it is 5 times its bound there"
    sound = trajectory.rows(early, dict.fromkeys(CHANNELS, FINE))
    assert {one.note for one in sound if one.metric == "error_max"} == {FINE.note}


def test_without_a_scheme_nothing_is_left_of_it() -> None:
    rows = trajectory.rows(measured(0.1), dict.fromkeys(CHANNELS, FINE))
    assert {row.metric for row in rows} == {"error_max", "error_end"}


@pytest.mark.parametrize(("off", "verdict"), [(0.0, "pass"), (2.0, "pass"), (3.0, "fail")])
def test_samples_stand_at_the_engines_own_steps(off: float, verdict: str) -> None:
    sweep = Sweep(0.25, 4, 2)
    times = np.array([0.0, 0.5, 1.0 - off * EPS])
    row = trajectory.time_row(sweep, times)
    assert (row.gate, row.channel, row.metric, row.unit) == (
        "trajectory",
        "time",
        "sample_times",
        "s",
    )
    assert (row.value, row.bound, row.verdict) == (off * EPS, 2 * EPS, verdict)


def test_a_bound_in_time_is_one_of_the_whole_run() -> None:
    assert trajectory.time_row(Sweep(4.0, 2, 1), np.array([0.0, 4.0, 8.0])).bound == 16 * EPS


@pytest.mark.parametrize("step", [0.1, 0.03, 1.0 / 240.0])
def test_a_clock_may_be_a_running_sum_of_the_step(step: float) -> None:
    """Caught: a sound engine whose time grows by ``t += h``; and a clock that is off by more."""
    sweep = Sweep(step, 5000, 1)
    summed = np.concatenate(([0.0], np.cumsum(np.full(5000, step))))
    assert float(np.max(np.abs(summed - sweep.times))) > 16 * EPS * summed[-1]
    assert trajectory.time_row(sweep, summed).verdict == "pass"
    assert trajectory.time_row(sweep, sweep.times * (1.0 + 1300 * EPS)).verdict == "fail"


@pytest.mark.parametrize("count", [2, 4])
def test_a_sample_too_few_or_too_many_fails(count: int) -> None:
    row = trajectory.time_row(Sweep(0.5, 2, 1), np.linspace(0.0, 1.0, count))
    assert (row.value, row.bound, row.verdict) == (np.inf, 0.0, "fail")
    assert row.note == f"{count} samples came back, 3 were requested"
    assert (row.gate, row.channel, row.metric, row.unit) == (
        "trajectory", "time", "sample_times", "s"
    )  # fmt: skip


@pytest.mark.parametrize(("last", "excess"), [(1e300, "above its bound"), (3.0, "e15 times its")])
def test_a_time_that_is_off_is_never_zero_times_its_bound(last: float, excess: str) -> None:
    """Caught: the key that orders sentences, printed as a ratio."""
    row = trajectory.time_row(Sweep(0.5, 2, 1), np.array([0.0, 0.5, last]))
    assert excess in sentence(row)


def test_times_that_are_no_numbers_fail() -> None:
    row = trajectory.time_row(Sweep(0.5, 2, 1), np.array([0.0, np.nan, 1.0]))
    assert row.verdict == "fail"
