"""What the data do not determine is stated in words, and no number stands for it."""

import numpy as np
import pytest
from fit_traces import AXES, Truth, fitted, run_fit, write_trace

from omegadot import fit

TIMES = np.linspace(0.0, 6.0, 91)
NOISE = 0.01
AXIS = AXES[:, 2]


def joined(found: dict) -> str:
    return " ".join(found["sentences"])


@pytest.mark.parametrize("noise", [0.0, NOISE])
@pytest.mark.parametrize("damping", [0.0, 0.1])
def test_a_spin_about_one_axis_shows_no_ratio(tmp_path, capsys, noise, damping):
    """A fit that reads a frequency out of noise would give moments here."""
    truth = Truth(start=2.0 * AXIS, damping=damping)
    found = fitted(capsys, write_trace(tmp_path / "trace.csv", truth, TIMES, noise))
    assert found["shape_determined"] is False
    assert found["moments"] is found["axes"] is found["inertia"] is None
    assert "shows no ratio of moments" in joined(found)
    if damping:  # over the moment about the axis, which is the largest, 1
        error = max(4.0 * found["damping_error"], 1e-8)
        assert found["damping"] == pytest.approx(damping, abs=error)
    else:
        assert found["damping"] is None
        assert "bias is not determined in any direction" in joined(found)


def test_a_torque_along_the_axis_shows_that_moment(tmp_path, capsys):
    truth = Truth(start=2.0 * AXIS, torque=0.4 * AXIS)
    trace = write_trace(tmp_path / "trace.csv", truth, TIMES, NOISE)
    found = fitted(capsys, trace, "--torque=" + ",".join(map(repr, (0.4 * AXIS).tolist())))
    assert found["moments"] is None
    words = joined(found).split("The moment about that axis is ")[1].split()
    assert float(words[0]) == pytest.approx(1.0, abs=4.0 * float(words[2]))


def test_a_torque_that_does_not_act_gives_no_scale(tmp_path, capsys):
    trace = write_trace(tmp_path / "trace.csv", Truth(start=2.0 * AXIS), TIMES, NOISE)
    found = fitted(capsys, trace, "--torque", "0,0,1e-9")
    assert "The torque is not seen in omega" in joined(found)


def test_a_symmetric_body_leaves_its_axes_open_and_a_bias_its_moments(tmp_path, capsys):
    """A bias along the axis is another ratio of moments, so that none is determined with one."""
    truth = Truth(inertia=AXES @ np.diag([0.5, 1.0, 1.0]) @ AXES.T)
    trace = write_trace(tmp_path / "trace.csv", truth, TIMES, NOISE, 4)
    found = fitted(capsys, trace)
    assert found["moments"] is None or found["moments"][0] is None
    assert "A bias along" in joined(found)
    assert "would not determine the moments and a bias" in joined(found)
    found = fitted(capsys, trace, "--no-bias")
    assert found["axis_errors"][0] is not None
    assert found["axis_errors"][1:] == [None, None]
    assert "The moments near y and z are alike within their errors" in joined(found)
    assert found["moments"][0] == pytest.approx(0.5, abs=4.0 * found["moment_errors"][0])


@pytest.mark.parametrize("samples", [11, 12])
def test_a_short_window_determines_its_readings_alone(tmp_path, capsys, samples):
    """A bias of several rad/s with a small error came out, and another one of a sample more."""
    times = np.linspace(0.0, 0.01 * (samples - 1), samples)
    truth = Truth(start=np.array([-3.0, 2.2, -3.3]), bias=np.array([0.02, -0.01, 0.03]))
    found = fitted(capsys, write_trace(tmp_path / "trace.csv", truth, times, 0.02, 3))
    assert found["moments"] is found["bias"] is None
    assert found["omega"] == [None] * 3
    off = np.abs(np.array(found["reading"]) - truth.start - truth.bias)
    assert np.all(off < 4.0 * np.array(found["reading_errors"]))
    assert "This window does not separate the moments" in joined(found)
    assert "of this motion" in joined(found)


def test_what_is_reported_is_within_four_standard_errors(tmp_path):
    """Of windows in which a bias is hardly held: errors that take it as zero would be too small."""
    draw, worst = np.random.default_rng(2), 0.0
    for seed, seconds in enumerate((0.2, 1.0)):
        start = 2.0 * draw.normal(size=3)
        truth = Truth(start=start, bias=0.05 * draw.normal(size=3), damping=0.05 * seed)
        times = np.linspace(0.0, seconds, 41)
        own = fit(write_trace(tmp_path / "trace.csv", truth, times, 0.01, seed)).estimates
        off = [(own.reading - start - truth.bias) / own.reading_errors]
        off += [((own.omega - start) / own.omega_errors)[own.omega_known]]
        off += [((own.bias - truth.bias) / own.bias_errors)[own.bias_known]]
        if np.all(own.moments_known):
            off += [((own.inertia - truth.inertia) / own.inertia_errors).ravel()]
        worst = max(worst, float(np.max(np.abs(np.concatenate(off)))))
    assert worst < 4.0


def test_without_a_torque_there_is_no_scale(tmp_path, capsys):
    trace = write_trace(tmp_path / "trace.csv", Truth(), TIMES, NOISE)
    found = fitted(capsys, trace, "--no-bias", "--no-damping")
    assert found["unit"] == ""
    assert "never their scale" in joined(found)
    assert found["bias"] is found["damping"] is None


def test_a_flat_body_sits_at_the_limit(tmp_path, capsys):
    truth = Truth(inertia=AXES @ np.diag([0.4, 0.6, 1.0]) @ AXES.T)
    trace = write_trace(tmp_path / "trace.csv", truth, TIMES)
    found = fitted(capsys, trace, "--no-bias", "--no-damping")
    assert "equals the sum of the other two" in joined(found)
    assert found["moments"] == pytest.approx([0.4, 0.6, 1.0], abs=1e-9)


def test_a_body_that_gains_energy_has_no_damping(tmp_path, capsys):
    trace = write_trace(tmp_path / "trace.csv", Truth(damping=-0.05), TIMES, NOISE)
    found = fitted(capsys, trace, "--no-bias")
    assert found["damping"] is None
    assert "the energy does not fall" in joined(found)


def test_what_is_no_motion_of_a_body_is_a_poor_fit(tmp_path, capsys):
    """Random readings: the command ends well, and states that nothing fits."""
    trace = tmp_path / "trace.csv"
    readings = np.random.default_rng(0).normal(size=(40, 3))
    table = np.column_stack([0.2 * np.arange(40), readings])
    np.savetxt(trace, table, "%.6f", ",", header="time,wx,wy,wz", comments="")
    result = run_fit(capsys, trace, "--no-bias", "--no-damping")
    assert result.code == 0
    assert "% of omega: this is not the motion of one free rigid body" in result.out
