"""A fit finds the body that made the trace, and its standard errors are those of repeats."""

import numpy as np
import pytest
from fit_traces import AXES, MOMENTS, Truth, fitted, write_trace
from scipy.spatial.transform import Rotation

from omegadot import fit

TIMES = np.linspace(0.0, 6.0, 91)
BIAS = np.array([0.05, -0.02, 0.03])
TORQUE = np.array([0.05, 0.1, -0.02])
# A motion of 12 rad is followed to 1e-12 a step, and the data hold these moments to some tens of
# residuals.
CLOSE = 1e-9


@pytest.mark.parametrize(
    ("truth", "arguments"),
    [
        (Truth(), {}),
        (Truth(bias=BIAS), {}),
        (Truth(damping=0.02), {}),
        (Truth(bias=BIAS, damping=0.02), {}),
        (Truth(torque=TORQUE), {"torque": TORQUE}),
        (Truth(torque=1e-5 * TORQUE, inertia=1e-5 * Truth().inertia), {"torque": 1e-5 * TORQUE}),
        (Truth(torque=TORQUE, bias=BIAS, damping=0.02), {"torque": "0.05,0.1,-0.02"}),
        (Truth(), {"moment": "largest=1.0"}),
        (Truth(damping=0.02), {"moment": f"x={float(Truth().inertia[0, 0])!r}"}),
    ],
)
def test_a_trace_without_noise_gives_its_body(tmp_path, truth, arguments):
    """All terms are found without being named, and none that is not there."""
    found = fit(write_trace(tmp_path / "trace.csv", truth, TIMES), **arguments)
    own = found.estimates
    wanted = {name for name, on in (("bias", truth.bias.any()), ("damping", truth.damping)) if on}
    assert set(found.terms) == wanted
    assert np.allclose(own.inertia, truth.inertia, rtol=0.0, atol=CLOSE * np.max(truth.inertia))
    assert np.allclose(own.omega, truth.start, rtol=0.0, atol=CLOSE)
    assert np.allclose(own.bias, truth.bias, rtol=0.0, atol=CLOSE)
    assert own.damping == pytest.approx(truth.damping, abs=CLOSE)
    assert found.unit == ("kg m^2" if arguments else "")


def test_attitude_gives_the_bias_of_a_symmetric_body(tmp_path):
    """Omega alone leaves it open along the axis: any bias there is another ratio of moments."""
    truth = Truth(inertia=AXES @ np.diag([0.5, 1.0, 1.0]) @ AXES.T, bias=BIAS)
    trace = write_trace(tmp_path / "trace.csv", truth, TIMES, attitude=True)
    own = fit(trace).estimates
    assert np.allclose(own.bias, BIAS, rtol=0.0, atol=CLOSE)
    assert np.allclose(own.inertia, truth.inertia, rtol=0.0, atol=CLOSE)
    assert own.axes_known.tolist() == [True, False, False]


def test_principal_axes_and_moments_stand_next_to_the_axes_of_the_trace(tmp_path, capsys):
    found = fitted(capsys, write_trace(tmp_path / "trace.csv", Truth(), TIMES))
    assert found["moments"] == pytest.approx(MOMENTS.tolist(), abs=CLOSE)
    assert np.allclose(np.array(found["axes"]).T, AXES, rtol=0.0, atol=1e-7)
    assert found["moment_errors"][2] < 1e-15  # the unit


def test_turned_axes_turn_the_tensor(tmp_path):
    """Whatever the axes of the gyro, the same body and the same residuals are found."""
    turn = Rotation.from_rotvec([1.0, 2.0, -0.5]).as_matrix()
    truth = Truth()
    turned = Truth(inertia=turn @ truth.inertia @ turn.T, start=turn @ truth.start)
    one = fit(write_trace(tmp_path / "one.csv", truth, TIMES)).estimates
    other = fit(write_trace(tmp_path / "other.csv", turned, TIMES)).estimates
    assert np.allclose(other.inertia, turn @ one.inertia @ turn.T, rtol=0.0, atol=CLOSE)


@pytest.mark.parametrize(
    ("truth", "arguments"),
    [
        (Truth(), {"bias": False, "damping": False}),
        (Truth(bias=BIAS, damping=0.02), {"bias": True, "damping": True}),
        (Truth(torque=TORQUE), {"torque": TORQUE, "bias": False, "damping": False}),
    ],
)
def test_standard_errors_are_those_of_repeats(tmp_path, truth, arguments):
    """The mean square of errors over their standard errors is one, within chance of the repeats.

    Of m such squares that are alike it spreads by ``sqrt(2 / m)``; six entries of a tensor in eight
    repeats count as eight times four, for they depend on each other. Four sigma are allowed.
    """
    squares = []
    for seed in range(8):
        trace = write_trace(tmp_path / f"{seed}.csv", truth, TIMES, 0.02, seed)
        own = fit(trace, **arguments).estimates
        known = own.inertia_errors > 1e-9
        squares += list((((own.inertia - truth.inertia) / own.inertia_errors)[known]) ** 2)
        squares += list(((own.omega - truth.start) / own.omega_errors) ** 2)
        if arguments.get("bias"):
            squares += list(((own.bias - truth.bias) / own.bias_errors) ** 2)
            squares.append(((own.damping - truth.damping) / own.damping_error) ** 2)
    assert abs(np.mean(squares) - 1.0) < 4.0 * np.sqrt(2.0 / 32.0)
    assert np.max(squares) < 16.0


def test_a_long_trace_has_one_minimum_only_from_its_beginning(tmp_path):
    """Over 120 rad the rates of a first guess turn phases round many times."""
    times = np.linspace(0.0, 60.0, 601)
    own = fit(write_trace(tmp_path / "trace.csv", Truth(), times, 0.02, 1)).estimates
    assert np.allclose(own.moments, MOMENTS, rtol=0.0, atol=1e-3)


def test_correlated_residuals_widen_the_errors(tmp_path):
    """A slow wobble that no model has: the errors grow, and the sentence states by how much."""
    trace = write_trace(tmp_path / "trace.csv", Truth(), TIMES)
    lines = trace.read_text().splitlines()
    rows = np.array([line.split(",") for line in lines[1:]], dtype=float)
    rows[:, 1] += 0.05 * np.sin(3.0 * TIMES) ** 3
    np.savetxt(trace, rows, "%.17g", ",", header=lines[0], comments="")
    found = fit(trace, bias=False, damping=False)
    assert found.compared.noise.correlation > 0.5
    assert any("Neighbouring residuals correlate" in sentence for sentence in found.sentences)
