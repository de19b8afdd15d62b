"""Gate 3: who declares a scheme must step it, and an order is judged only where it can be seen."""

from dataclasses import replace

import numpy as np
import pytest
from command_line import WRONG
from in_process import builtin, declared, judged, truth_of

from omegadot.adapters.registry import build_adapter
from omegadot.gates.bounds.likeness import likeness, share_of
from omegadot.gates.case import Sweep
from omegadot.gates.errors.findings import Declared, MeasuredSweep
from omegadot.gates.errors.measured_run import MeasuredRun
from omegadot.gates.rows import worst
from omegadot.gates.steps.scheme import comparison_keys, order_rows, orders_seen
from omegadot.gates.truth import SchemeKey
from omegadot.reference_impl.schemes import COMMON

STEPS = (0.02, 0.01, 0.005)


@pytest.fixture(scope="module")
def case():
    return builtin("full-tensor", *STEPS)


@pytest.fixture(scope="module")
def truth(case):
    return truth_of(case)


def rows_of(runs, metric):
    return [row for run in runs for row in run.rows if row.metric == metric]


def gates(runs):
    return {
        gate: worst(row.verdict for row in run.rows if row.gate == gate)
        for run in runs
        for gate in ("scheme", "trajectory")
    }


@pytest.mark.parametrize("scheme", ["semi-implicit-euler", "lie-rk4-naive", "implicit-midpoint"])
def test_a_scheme_that_is_stepped_as_declared_passes(case, truth, scheme):
    runs = judged(case, truth, declared(scheme, scheme))
    found = rows_of(runs, "match")
    assert [row.verdict for row in found] == ["pass"] * 3
    assert all(row.value <= 1.0 and row.bound == 1.0 for row in found)
    assert all(row.note.startswith(f"equals {scheme}, to ") for row in found)
    orders = {row.channel: row for row in rows_of(runs[:1], "observed_order")}
    assert orders["attitude"].verdict == "pass"
    assert orders["attitude"].bound == {"semi-implicit-euler": 1}.get(scheme, 2)


def test_another_scheme_than_the_declared_one_fails_and_is_named(case, truth):
    # Both are of order 1, so nothing but the scheme distinguishes them.
    integrator = declared("own", "semi-implicit-euler")
    runs = judged(case, truth, integrator, steps="linearly-implicit-euler")
    assert gates(runs) == {"scheme": "fail", "trajectory": "pass"}
    assert all("equals linearly-implicit-euler" in run.why for run in runs)
    assert all(row.value > 1e6 for row in rows_of(runs, "match"))


def test_an_energy_that_is_made_to_look_right_is_not_the_declared_scheme(case, truth):
    corrected = build_adapter(f"{WRONG}:EnergyCorrected")
    runs = judged(case, truth, corrected.description.integrators[0], corrected)
    assert gates(runs)["scheme"] == "fail"
    (first, *_) = rows_of(runs, "match")
    assert first.channel in ("omega", "angular_momentum", "energy")
    assert "steps otherwise" in first.note


def test_without_a_declared_scheme_the_orders_alone_are_judged(case, truth):
    runs = judged(case, truth, declared("own", None, 2), steps="implicit-midpoint")
    assert gates(runs) == {"scheme": "pass", "trajectory": "pass"}
    found = rows_of(runs, "match")
    assert {row.verdict for row in found} == {"info"}
    assert all(row.note.endswith("equals implicit-midpoint") for row in found)
    assert all(row.value <= 1.0 for row in found)


def test_an_order_that_is_declared_too_high_fails(case, truth):
    runs = judged(case, truth, declared("own", None, 4), steps="implicit-midpoint")
    failed = {row.channel for row in rows_of(runs, "observed_order") if row.verdict == "fail"}
    assert {"omega", "attitude"} <= failed
    assert gates(runs)["scheme"] == "fail"


def test_a_scheme_that_was_not_stepped_is_no_verdict(case):
    alone = truth_of(case, ())
    for integrator in (declared("lie-rk4", "lie-rk4"), declared("lie-rk4", None, 4)):
        found = rows_of(judged(case, alone, integrator), "match")
        assert {row.verdict for row in found} == {"info"}
        assert all(np.isnan(row.value) for row in found)


def measured(timestep, size, bound=1e-12, saturated=0.0, **more):
    sweep = Sweep(timestep, 10, 1)
    channels = ("omega", "attitude", "position", "energy", "angular_momentum", "linear_momentum")
    error = {channel: np.linspace(0.0, size, 11) for channel in channels}
    error["omega"] = error["omega"] + saturated
    return MeasuredRun(sweep, error, dict.fromkeys(channels, np.full(11, bound)), **more)


def held(measured_runs, order, left=None, stiffness=0.0):
    scheme = Declared("scheme" if left else None, dict.fromkeys(measured_runs[0].error, order))
    seen = orders_seen(MeasuredSweep(tuple(measured_runs)))
    of = measured_runs[-1] if left is None else replace(measured_runs[-1], against_scheme=left)
    (row,) = [r for r in order_rows(seen, scheme, of, stiffness) if r.channel == "attitude"]
    return row


def sweep_of(power, factor=1.0, **more):
    return [measured(h, factor * h**power, **more) for h in STEPS]


def test_orders_are_judged_within_the_tolerance_and_may_be_higher():
    assert held(sweep_of(2.0), 2).verdict == "pass"
    assert held(sweep_of(1.9), 2).verdict == "pass"
    assert held(sweep_of(3.0), 2).verdict == "pass"
    assert held(sweep_of(1.8), 2).verdict == "info"
    assert held(sweep_of(1.1), 2).verdict == "fail"
    assert held(sweep_of(0.0, 1e-2), 1).verdict == "fail"
    assert held(sweep_of(0.0, 1e-2), 1, stiffness=1.01).verdict == "info"


def test_an_order_of_what_may_be_rounding_of_the_momentum_is_none():
    """Caught: a momentum-keeping engine on a thin body, of which rounding grows as steps shrink."""
    for size, verdict in ((1e-7, "info"), (1e-11, "fail")):
        runs = sweep_of(-1.0, 1e-11, of_momentum={"attitude": np.full(11, size)})
        assert held(runs, 1).verdict == verdict
    assert held(sweep_of(1.0), None).verdict == "info"


def test_slopes_that_are_still_rising_are_not_judged():
    # Slopes of 0.70 and 0.83, heading for 0.96: sound schemes of order 1 show such ones.
    sizes = dict(zip(STEPS, (0.1, 0.1 / 2**0.70, 0.1 / 2**1.53), strict=True))
    row = held([measured(h, size) for h, size in sizes.items()], 1)
    assert row.value == pytest.approx(0.83)
    assert (row.verdict, row.note) == ("info", "not settled: the slopes are heading for 0.96")
    falling = dict(zip(STEPS, (0.1, 0.1 / 2**0.83, 0.1 / 2**1.53), strict=True))
    row = held([measured(h, size) for h, size in falling.items()], 1)
    assert (row.verdict, row.note) == ("info", "not settled: observed order 0.70, declared 1")
    falling = dict(zip(STEPS, (0.1, 0.1 / 2**0.15, 0.1 / 2**0.25), strict=True))
    assert held([measured(h, size) for h, size in falling.items()], 1).verdict == "fail"


def test_an_error_near_rounding_or_saturated_shows_no_order():
    near = sweep_of(1.0, bound=1e-3)
    assert (held(near, 2).verdict, held(near, 2).note[-17:]) == ("info", "close to rounding")
    far = sweep_of(1.0, saturated=0.6)
    assert (held(far, 2).verdict, held(far, 2).note[-8:]) == ("info", "saturate")
    floor = sweep_of(1.0, floor={"attitude": np.full(11, 1e-3)})
    assert held(floor, 2).verdict == "info"


def test_the_declared_scheme_itself_is_not_held_against_an_engine():
    low = sweep_of(1.0)
    equal = {channel: np.zeros(11) for channel in low[0].error}
    assert held(low, 2, left=equal).verdict == "info"
    assert held(low, 2, left={c: np.ones(11) for c in equal}).verdict == "fail"


def test_shares_of_a_bound():
    bound = np.array([0.0, 1.0, 2.0, np.inf])
    assert share_of(np.array([0.0, 0.5, 3.0, 1e9]), bound) == 1.5
    assert share_of(np.array([1e-16, 0.0, 0.0, 0.0]), bound) == np.inf
    assert share_of(np.array([0.0, np.nan, 0.0, 0.0]), bound) == np.inf
    assert np.isnan(share_of(np.zeros(3), np.array([1.0, np.inf, np.inf])))


def test_a_likeness_names_where_it_is_least():
    bounds = dict.fromkeys(("omega", "attitude", "energy"), np.full(3, 0.1))
    distances = {"omega": np.full(3, 0.02), "attitude": np.full(3, 0.05), "energy": np.ones(3)}
    found = likeness(distances, bounds)
    assert (found.channel, found.distance, found.agree) == ("energy", 0.05, False)
    assert found.share == pytest.approx(10.0)


def test_without_a_declared_scheme_all_that_are_common_are_compared(case):
    assert comparison_keys(declared("own", "lie-rk4"), case.system) == [SchemeKey("lie-rk4")]
    silent = comparison_keys(declared("own"), case.system)
    assert {key.scheme for key in silent} == set(COMMON)
    offset = builtin("offset-com").system
    at_origin = replace(declared("own"), coordinates="origin-world")
    assert {key.coordinates for key in comparison_keys(at_origin, offset)} == {"origin-world"}
    assert {key.coordinates for key in comparison_keys(at_origin, case.system)} == {"com-world"}
