"""Traces of bodies that are known, made without the project's own code, and ``omegadot fit``."""

import json
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.spatial.transform import Rotation
from score_line import Result, run_command

AXES = Rotation.from_rotvec([0.3, -0.2, 0.5]).as_matrix()  # of the body, in the gyro's axes
MOMENTS = np.array([0.5, 0.8, 1.0])


@dataclass(frozen=True)
class Truth:
    """A body and its motion. inertia: (3, 3), gyro's axes.  start: (3,) rad/s.  bias: (3,)."""

    inertia: np.ndarray = field(default_factory=lambda: AXES @ np.diag(MOMENTS) @ AXES.T)
    start: np.ndarray = field(default_factory=lambda: np.array([1.5, 0.8, -1.1]))
    bias: np.ndarray = field(default_factory=lambda: np.zeros(3))
    damping: float = 0.0
    torque: np.ndarray = field(default_factory=lambda: np.zeros(3))


def states(truth: Truth, times: np.ndarray) -> np.ndarray:
    """(n, 7): omega and quaternion w x y z, by an integrator of high order, to 1e-13."""

    def slope(_: float, y: np.ndarray) -> np.ndarray:
        w, q = y[:3], y[3:]
        load = truth.torque - truth.damping * w - np.cross(w, truth.inertia @ w)
        turn = 0.5 * np.array([-q[1:] @ w, *(q[0] * w + np.cross(q[1:], w))])
        return np.concatenate((np.linalg.solve(truth.inertia, load), turn))

    start = np.concatenate((truth.start, [1.0, 0.0, 0.0, 0.0]))
    solved = solve_ivp(slope, (0.0, times[-1]), start, "DOP853", times, rtol=2.3e-14, atol=1e-16)
    return solved.y.T


def write_trace(
    path: Path,
    truth: Truth,
    times: np.ndarray,
    noise: float = 0.0,
    seed: int = 0,
    attitude: bool = False,
    form: str = "%.17g",
) -> Path:
    """A CSV file of a gyro's readings, with white noise (rad/s, and rad of the attitude)."""
    draw, found = np.random.default_rng(seed), states(truth, times)
    columns = [times, found[:, :3] + truth.bias + noise * draw.normal(size=(len(times), 3))]
    head = "time,wx,wy,wz"
    if attitude:
        turned = Rotation.from_quat(np.roll(found[:, 3:], -1, axis=1))
        turned = turned * Rotation.from_rotvec(noise * draw.normal(size=(len(times), 3)))
        columns.append(np.roll(turned.as_quat(), 1, axis=1))
        head += ",qw,qx,qy,qz"
    np.savetxt(path, np.column_stack(columns), form, ",", header=head, comments="")
    return path


def run_fit(capsys: pytest.CaptureFixture[str], *arguments: object) -> Result:
    """``omegadot fit`` with these arguments, in this process."""
    return run_command(capsys, "fit", *arguments)


def fitted(capsys: pytest.CaptureFixture[str], *arguments: object) -> dict:
    """What ``omegadot fit --format json`` prints."""
    result = run_fit(capsys, *arguments, "--format", "json")
    assert result.code == 0, result.err
    return json.loads(result.out)
