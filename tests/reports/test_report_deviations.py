"""The errors along a run against errors that are known by hand."""

from dataclasses import replace

import numpy as np
import polars as pl
import pytest
from synthetic_record import RATE, build

from omegadot.reports.charts.deviations import POINTS, chart_deviations
from omegadot.reports.charts.divergence import CHANNELS


def deviation(record, scenario="sphere", engine="mujoco", integrator="Euler", timestep=0.02):
    chart = chart_deviations(record)[scenario]
    (found,) = [
        c
        for c in chart.deviations
        if (c.engine, c.integrator, c.timestep) == (engine, integrator, timestep)
    ]
    return chart, found


def test_errors_are_those_that_were_put_in(record):
    h = 0.02
    chart, found = deviation(record, timestep=h)
    t, faster = found.time, 1e-3 * h
    turned = 0.3 * h * t + RATE[2] * faster * t
    # acos-free angles are good to a few roundings of the attitude itself
    np.testing.assert_allclose(found.values["attitude"], turned, rtol=1e-12, atol=4e-16)
    np.testing.assert_allclose(found.values["omega_dot"], faster, rtol=1e-12)
    np.testing.assert_allclose(found.values["angular_momentum"], faster, rtol=1e-10)
    np.testing.assert_allclose(found.values["energy"], (1 + faster) ** 2 - 1, rtol=1e-10)
    assert chart.units == {
        "omega_dot": "rad/s²",
        "energy": "1",
        "angular_momentum": "1",
        "attitude": "rad",
    }
    assert chart.unmatched == 0


def test_every_run_has_a_series_and_the_truth_has_none(record):
    charts = chart_deviations(record)
    assert list(charts) == ["sphere", "spun-again"]
    found = {(c.engine, c.integrator, c.timestep) for c in charts["sphere"].deviations}
    wanted = {(t["engine"], t["integrator"], t["timestep"]) for t in record.run["tasks"]}
    assert found == wanted


def test_thinning_keeps_the_envelope_the_start_and_the_end():
    record = build(("sphere",), samples=1000, steps=(0.004,))
    spike = (pl.col("engine") == "mujoco") & (pl.col("time").is_between(1.9999, 2.0001))
    bent = record.trajectories.with_columns(
        az=pl.when(spike).then(123.0).otherwise("az"),
    )
    _, found = deviation(replace(record, trajectories=bent), timestep=0.004)
    assert len(found.time) == POINTS
    assert found.time[0] == 0.0
    assert found.time[-1] == 1000 * 0.004
    assert np.max(found.values["omega_dot"]) == 123.0 == found.largest["omega_dot"]
    assert np.sum(found.values["omega_dot"] == 123.0) == 1
    assert found.end["omega_dot"] == pytest.approx(4e-6, rel=1e-9)


def test_a_short_run_is_not_thinned(record):
    _, found = deviation(record)
    assert len(found.time) == 41


def test_samples_without_truth_are_counted_not_invented(record):
    moved = record.trajectories.with_columns(
        time=pl.when((pl.col("engine") == "dart") & (pl.col("timestep") == 0.01))
        .then(pl.col("time") + 1e-9)
        .otherwise("time")
    )
    chart, found = deviation(
        replace(record, trajectories=moved),
        engine="dart",
        integrator="semi-implicit",
        timestep=0.01,
    )
    assert chart.unmatched == 41
    assert all(np.all(np.isnan(found.values[channel])) for channel in CHANNELS)
    assert found.largest["attitude"] is None


def test_a_closed_form_is_preferred_to_a_series(record):
    exact = record.trajectories.filter(pl.col("engine") == "exact")
    worse = exact.with_columns(integrator=pl.lit("series"), az=pl.lit(5.0))
    both = pl.concat([worse, record.trajectories])
    _, found = deviation(replace(record, trajectories=both))
    np.testing.assert_allclose(found.values["omega_dot"], 2e-5, rtol=1e-12)


def test_a_run_that_lost_its_numbers_shows_a_gap_and_no_largest(record):
    lost = (pl.col("engine") == "mujoco") & (pl.col("time") > 2.0)
    broken = record.trajectories.with_columns(
        pl.when(lost).then(float("nan")).otherwise(name).alias(name) for name in ("wx", "qw")
    )
    _, found = deviation(replace(record, trajectories=broken))
    assert np.isnan(found.largest["attitude"])
    assert np.all(np.isfinite(found.values["attitude"][found.time <= 2.0]))
    assert np.all(np.isnan(found.values["attitude"][found.time > 2.0]))


def test_an_overflow_is_not_lost(record):
    late = (pl.col("engine") == "mujoco") & (pl.col("time") > 3.9)
    wild = record.trajectories.with_columns(wx=pl.when(late).then(1e200).otherwise("wx"))
    _, found = deviation(replace(record, trajectories=wild))
    assert found.values["energy"][-1] > 1e300


def _with_system(record, **more):
    entries = [{**e, "system": {**e["system"], **more}} for e in record.run["scenarios"]]
    return replace(record, run={**record.run, "scenarios": entries})


def test_linear_momentum_is_shown_where_something_moves(record):
    moving = record.trajectories.with_columns(vx=pl.lit(3.0))
    chart, _ = deviation(replace(record, trajectories=moving))
    assert chart.units["linear_momentum"] == "1"
    wrong = record.trajectories.with_columns(
        vx=pl.when(pl.col("engine") == "dart").then(1.0).otherwise(0.0)
    )
    chart, _ = deviation(replace(record, trajectories=wrong))
    assert chart.units["linear_momentum"] == "kg m/s"


def test_a_pivot_takes_linear_momentum_out(record):
    pivoted = _with_system(record, pivot=[0.0, 0.0, 0.1])
    chart, _ = deviation(pivoted)
    assert "linear_momentum" not in chart.units


def test_a_body_at_rest_is_measured_absolutely(record):
    still = record.trajectories.with_columns(
        wz=pl.when(pl.col("engine") == "exact").then(0.0).otherwise(0.5)
    )
    chart, found = deviation(replace(record, trajectories=still))
    assert chart.units["energy"] == "J"
    assert chart.units["angular_momentum"] == "kg m²/s"
    np.testing.assert_allclose(found.values["angular_momentum"], 0.4 * 0.5, rtol=1e-12)


def test_scenarios_without_a_system_or_truth_are_distinguished(record):
    gone = record.trajectories.filter(pl.col("engine") != "exact")
    chart, _ = deviation(replace(record, trajectories=gone))
    assert chart.unmatched == len(gone.filter(pl.col("scenario") == "sphere"))
    entries = [{"name": entry["name"]} for entry in record.run["scenarios"]]
    bare = replace(record, run={**record.run, "scenarios": entries})
    assert chart_deviations(bare)["sphere"].units == {}


def test_no_trajectories_no_deviations(record):
    assert chart_deviations(replace(record, trajectories=record.trajectories.clear())) == {}
