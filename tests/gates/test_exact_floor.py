"""The resolvable floor of each channel against derivatives taken by hand."""

from __future__ import annotations

import numpy as np
import pytest

from omegadot.gates.bounds.measures import Yardstick
from omegadot.gates.bounds.scales import EPS
from omegadot.gates.runs.exact import UNITS, floor_rows, floors, slopes
from omegadot.gates.truth import Truth
from omegadot.reference_impl.rotations import rotate_inverse
from omegadot.reference_impl.system import Body, Load, State, System

INERTIA = np.diag([1.0, 2.0, 3.0])
SPIN = np.array([0.3, 2.0, -0.7])
TURN = np.array([1.0, 2.0, 2.0, 4.0]) / 5.0


def system(torque_world: tuple[float, float, float] = (0.0, 0.0, 0.0)) -> System:
    zero = np.zeros(3)
    load = Load(zero, None, np.asarray(0.0), zero, np.array(torque_world))
    return System((Body(np.asarray(2.0), zero, INERTIA),), load)


def at(count: int = 1) -> State:
    def repeated(value: np.ndarray) -> np.ndarray:
        return np.tile(value, (count, 1))

    return State(repeated(TURN), repeated(SPIN), np.zeros((count, 3)), np.zeros((count, 3)))


def test_omega_dot_changes_with_omega_as_eulers_equations_do() -> None:
    x, y, z = SPIN
    # (8) without torque: (y z (I2 - I3) / I1, ...), differentiated by hand.
    jacobian = np.array([[0.0, -z, -y], [z, 0.0, x], [-y / 3.0, -x / 3.0, 0.0]])
    by_omega, by_attitude = slopes(system(), at(), 2.0)
    assert by_omega == pytest.approx([np.linalg.norm(jacobian, 2)], rel=64 * EPS)
    assert by_attitude == pytest.approx([0.0], abs=64 * EPS / 1e-3)


def test_a_torque_in_the_world_turns_with_the_body() -> None:
    tau = rotate_inverse(TURN, np.array([0.5, -1.0, 2.0]))
    x, y, z = tau
    # R(theta)^T tau is tau - theta x tau to first order; the difference is good to a turn squared.
    turned = np.linalg.solve(INERTIA, np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]]))
    _, by_attitude = slopes(system((0.5, -1.0, 2.0)), at(), 2.0)
    assert by_attitude == pytest.approx([np.linalg.norm(turned, 2)], rel=1e-6)


def truth(omega: float, attitude: float) -> Truth:
    times = np.array([0.0, 1.0])
    own = {"omega": np.array([0.0, omega]), "attitude": np.array([0.0, attitude])}
    state, still = at(2), np.zeros((2, 3))
    yardstick = Yardstick(system(), times, state)
    return Truth("closed-form", times, state, still, np.ones(2), own, yardstick)


def test_the_floor_grows_with_the_uncertainty_and_never_ends_below_a_rounding() -> None:
    small, large = floors(truth(0.0, 0.0)), floors(truth(1e-9, 2e-9))
    assert set(small) == set(UNITS)
    assert small["energy"][-1] >= EPS
    assert small["omega_dot"][-1] > 0.0
    rate = float(np.linalg.norm(SPIN))
    by_omega, _ = slopes(system(), at(), rate)
    assert large["omega_dot"][-1] == pytest.approx(by_omega[0] * rate * 1e-9, rel=1e-6)
    for channel in ("omega_dot", "energy", "angular_momentum"):
        assert large[channel][-1] > 1e6 * small[channel][-1]


def test_a_row_holds_the_largest() -> None:
    rows = {row.channel: row for row in floor_rows(truth(1e-9, 2e-9))}
    assert rows["attitude"].value == 2e-9
    assert {row.unit for row in rows.values()} == {"1", "rad", "rad/s^2"}
    assert {(row.metric, row.verdict, row.bound) for row in rows.values()} == {
        ("resolvable_floor", "info", None)
    }
