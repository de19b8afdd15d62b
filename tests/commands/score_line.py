"""Traces made without the project's own code, and ``omegadot score`` run in this process."""

import json
import sys
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.spatial.transform import Rotation

from omegadot.commands.cli import main

BRICK = "nesc-checkcase-2"
INERTIA = np.array([0.00256821747408830527, 0.00842101103762734618, 0.00975465593923173486])
START = np.array([*np.deg2rad([10.0, 20.0, 30.0]), 1.0, 0.0, 0.0, 0.0])


def slope(_: float, y: np.ndarray) -> np.ndarray:
    """Euler's equations and the quaternion's, written out: omega, then w x y z."""
    w, q = y[:3], y[3:]
    matrix = np.array([[0, -w[0], -w[1], -w[2]], [w[0], 0, w[2], -w[1]],
                       [w[1], -w[2], 0, w[0]], [w[2], w[1], -w[0], 0]])  # fmt: skip
    return np.concatenate((-np.cross(w, INERTIA * w) / INERTIA, 0.5 * matrix @ q))


_SOLVED = solve_ivp(
    slope, (0.0, 31.0), START, method="DOP853", rtol=2.3e-14, atol=1e-16, dense_output=True
)


def tumble(times: np.ndarray) -> np.ndarray:
    """(n, 7): the brick's omega and quaternion, by an integrator of high order, to 1e-12."""
    return np.asarray(_SOLVED.sol(times)).T


def runge_kutta(step: float, count: int, start: np.ndarray = START) -> np.ndarray:
    """(count + 1, 7): the classical method on omega and quaternion, normalised each step."""
    y, found = start, [start]
    for _ in range(count):
        a = slope(0, y)
        b = slope(0, y + 0.5 * step * a)
        c = slope(0, y + 0.5 * step * b)
        y = y + step / 6.0 * (a + 2 * b + 2 * c + slope(0, y + step * c))
        y[3:] /= np.linalg.norm(y[3:])
        found.append(y)
    return np.array(found)


def turns(states: np.ndarray) -> Rotation:
    """World-from-body rotations of (n, 7) states."""
    return Rotation.from_quat(np.roll(states[:, 3:], -1, axis=1))


def write_brick(path: Path, times: np.ndarray, states: np.ndarray, form: str = "%.17g") -> Path:
    """As the check-case's traces come: deg/s and yaw, pitch, roll in deg."""
    angles = turns(states).as_euler("ZYX", degrees=True)
    table = np.column_stack([times, np.rad2deg(states[:, :3]), angles])
    head = "time,p,q,r,yaw,pitch,roll"
    np.savetxt(path, table, fmt=form, delimiter=",", header=head, comments="")
    return path


MAPPED = ("--scenario", BRICK, "--column", "w=p,q,r", "--rate-unit", "deg/s", "--angle-unit", "deg")


@dataclass(frozen=True)
class Result:
    code: int
    out: str
    err: str

    @property
    def json(self) -> Any:
        return json.loads(self.out)


def run_score(capsys: pytest.CaptureFixture[str], *arguments: object) -> Result:
    """``omegadot score`` with these arguments, in this process."""
    return run_command(capsys, "score", *arguments)


def run_command(capsys: pytest.CaptureFixture[str], *arguments: object) -> Result:
    """``omegadot`` with these arguments, in this process."""
    before = sys.argv
    sys.argv = ["omegadot", *map(str, arguments)]
    try:
        with pytest.raises(SystemExit) as ended:
            main()
    finally:
        sys.argv = before
    text = capsys.readouterr()
    return Result(int(ended.value.code or 0), text.out, text.err)
