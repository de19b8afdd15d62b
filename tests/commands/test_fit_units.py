"""Units that a trace is not in: the motion shows them, and the fit names the likely one."""

import re
from pathlib import Path

import numpy as np
import pytest
from fit_traces import MOMENTS, Truth, run_fit, states, write_trace
from scipy.integrate import solve_ivp

from omegadot import fit, scenario
from omegadot.commands.fit.print_fit import print_text
from omegadot.commands.score.named_units import WORDS

TIMES = np.linspace(0.0, 4.0, 101)
QUICK = ("--no-bias", "--no-damping")
DEGREES = ("stamp_ms", "A", "B", "C")
MAPPED = ("--column", "t=stamp_ms", "--column")


def in_degrees(path: Path, names: tuple[str, ...] = DEGREES, noise: float = 0.0) -> Path:
    """A trace with times in ms and omega in deg/s. noise: rad/s."""
    times = np.linspace(0.0, 4.0, 201) if noise else TIMES  # noise takes more samples
    omega = states(Truth(), times)[:, :3]
    omega = omega + noise * np.random.default_rng(1).normal(size=omega.shape)
    rows = [f"{1e3 * t:.0f},{a:.6g},{b:.6g},{c:.6g}" for t, (a, b, c) in zip(
        times, np.rad2deg(omega), strict=True)]  # fmt: skip
    path.write_text("\n".join([",".join(names), *rows]) + "\n")
    return path


@pytest.mark.parametrize(("noise", "terms"), [(0.0, QUICK), (1e-3, ())])
def test_rates_in_deg_s_that_are_read_in_rad_s_are_refused(tmp_path, capsys, noise, terms):
    """Caught: moments of almost a sphere with errors of a thousandth, of a trace in deg/s."""
    path, out = in_degrees(tmp_path / "imu.csv", noise=noise), tmp_path / "fitted.toml"
    arguments = (*MAPPED, "w=A,B,C", "--time-unit", "ms", *terms, "--out", out)
    result = run_fit(capsys, path, *arguments)
    assert (result.code, result.out, result.err.count("\n")) == (2, "", 1)
    assert "read in rad/s (the default) and ms (by --time-unit)" in result.err
    assert "omega looks like deg/s; give --rate-unit deg/s." in result.err
    assert not out.exists()


def test_an_attitude_is_fitted_in_the_other_units_too(tmp_path, capsys):
    """It cannot tell rate and time apart: a body that turns so much slower turns as far."""
    path = write_trace(tmp_path / "imu.csv", Truth(), TIMES, attitude=True)
    rows = np.loadtxt(path, delimiter=",", skiprows=1)
    rows[:, 1:4] *= 1e3
    head = "time,wx,wy,wz,qw,qx,qy,qz"
    np.savetxt(path, rows[:41], "%.10g", ",", header=head, comments="")
    result = run_fit(capsys, path, *QUICK)
    assert result.code == 2
    advice = "give --rate-unit mrad/s or give --time-unit ms."
    assert f"omega looks like mrad/s or the time looks like ms; {advice}" in result.err
    result = run_fit(capsys, path, *QUICK, "--time-unit", "s")
    assert result.err.endswith("omega looks like mrad/s; give --rate-unit mrad/s.\n")


def test_a_wrong_unit_in_a_name_is_to_be_corrected_there(tmp_path, capsys):
    names = ("stamp_ms", *(f"w{axis} [rad/s]" for axis in "xyz"))
    path = in_degrees(tmp_path / "imu.csv", names)
    result = run_fit(capsys, path, "--column", "t=stamp_ms", "--time-unit", "ms", *QUICK)
    assert result.code == 2
    advice = "omega looks like deg/s; correct the unit in the name of column 'wx [rad/s]'."
    assert advice in result.err


def test_of_a_unit_in_a_name_and_a_default_the_default_is_questioned(tmp_path, capsys):
    """Caught: advice to correct [dps], which is right, where the stamps are in ms."""
    names = ("stamp_ms", *(f"Rate{axis}[dps]" for axis in ("Roll", "Nick", "Gier")))
    path = in_degrees(tmp_path / "imu.csv", names)
    result = run_fit(capsys, path, *MAPPED, "w=" + ",".join(names[1:]))
    assert result.code == 2
    assert "read in deg/s (by the name of column 'RateRoll[dps]') and s (the default)" in result.err
    assert result.err.endswith("the time looks like ms; give --time-unit ms.\n")


def test_where_no_single_unit_fits_both_are_questioned(tmp_path, capsys):
    path = in_degrees(tmp_path / "imu.csv")
    result = run_fit(capsys, path, *MAPPED, "w=A,B,C")
    assert result.code == 2
    advice = "give the units of the file with --rate-unit and --time-unit."
    assert result.err.endswith(advice + "\n")


def test_a_steady_spin_fits_in_every_unit_and_shows_none(tmp_path, capsys):
    path = tmp_path / "spin.csv"
    path.write_text("time,wx,wy,wz\n" + "".join(f"{20 * k},0,0,2.0\n" for k in range(40)))
    result = run_fit(capsys, path)
    assert result.code == 2
    assert "looks like" not in result.err


def test_where_the_residuals_are_no_noise_no_error_is_given(tmp_path, capsys):
    """Drag that grows with the square of omega is in no model, and is seen at every sample."""
    inertia, times = np.diag(MOMENTS), np.linspace(0.0, 4.0, 401)

    def slope(_, w):
        load = -np.cross(w, inertia @ w) - 0.15 * np.linalg.norm(w) * w
        return np.linalg.solve(inertia, load)

    omega = solve_ivp(slope, (0.0, 4.0), Truth().start, "DOP853", times, rtol=1e-10).y.T
    path, table = tmp_path / "drag.csv", np.column_stack([times, omega])
    np.savetxt(path, table, "%.6f", ",", header="time,wx,wy,wz", comments="")
    result = fit(path, bias=False)
    print_text(result, None)
    lines = capsys.readouterr().out.splitlines()
    assert lines[1].startswith("No standard error is given: the residuals are ")
    assert not [line for line in lines if re.search(r"\d \+- \d|standard error is \d", line)]
    found = result.as_dict()
    assert all(found[key] is None for key in found if key.endswith(("_error", "_errors")))
    assert found["moments"] is not None


def test_the_samples_interval_is_written_as_the_stamps_have_it(tmp_path, capsys):
    """Caught: 0.009999999999999787, a difference of two times."""
    times = np.arange(201) * 0.01 + 8.0
    path, out = tmp_path / "trace.csv", tmp_path / "fitted.toml"
    rows = np.column_stack([times, states(Truth(), times - 8.0)[:, :3]])
    np.savetxt(path, rows, ("%.2f", "%.9f", "%.9f", "%.9f"), ",", header="t,wx,wy,wz", comments="")
    assert float(np.median(np.diff(times))) != 0.01
    assert run_fit(capsys, path, *QUICK, "--out", out).code == 0
    assert "\nsample = 0.01\n" in out.read_text()
    rows[:, 0] = 8.0 + np.arange(201) / 99.0  # no number of few digits, and none is made of it
    np.savetxt(path, rows, "%.17g", ",", header="t,wx,wy,wz", comments="")
    assert run_fit(capsys, path, *QUICK, "--out", out).code == 0
    assert scenario(str(out)).run.sample == pytest.approx(1.0 / 99.0, rel=1e-12)


def test_every_spelling_of_a_unit_in_a_name_is_documented():
    text = (Path(__file__).parents[2] / "docs" / "score.md").read_text()
    assert [word for word in WORDS if f"`{word}`" not in text] == []
