"""Quaternions that are read out of a matrix with a wrong sign in one branch; and silence."""

from __future__ import annotations

import numpy as np
import pytest

from omegadot.diagnosis.models.attitude_misread import attitude_misread
from omegadot.gates.bounds.scales import EPS
from omegadot.reference_impl.rotations import normalize, rotation_matrix
from omegadot.reference_impl.system import Array

Q = normalize(np.random.default_rng(3).normal(size=(60, 4)))
R = rotation_matrix(Q)
DIAGONAL = np.diagonal(R, axis1=-2, axis2=-1)
LARGEST = np.where(DIAGONAL.sum(-1) > 0.0, 0, 1 + np.argmax(DIAGONAL, axis=-1))


def read(branch: int, k: int, value: Array) -> str:
    back = Q.copy()
    back[branch == LARGEST, k] = value[branch == LARGEST]
    return attitude_misread(Q, normalize(back), EPS)


@pytest.mark.parametrize(
    ("branch", "k", "value", "phrases"),
    [
        (
            2,
            1,
            (R[:, 0, 1] - R[:, 1, 0]) / (4.0 * Q[:, 2]),
            ("trace(R) <= 0 and R_yy is the largest", "x is", "not (R_yx + R_xy) / (4 y)"),
        ),
        (0, 3, -Q[:, 3], ("where trace(R) > 0", "z is -(R_yx - R_xy) / (4 w), not")),
        (
            1,
            0,
            (R[:, 2, 1] + R[:, 1, 2]) / (4.0 * Q[:, 1]),
            ("R_xx is the largest", "w is (R_zy + R_yz) / (4 x), not (R_zy - R_yz) / (4 x)"),
        ),
    ],
)
def test_the_branch_and_the_component_are_named(
    branch: int, k: int, value: Array, phrases: tuple[str, ...]
) -> None:
    """Caught: attitudes that are wrong on some scenarios, with no word on which."""
    text = read(branch, k, value)
    for phrase in phrases:
        assert phrase in text


def test_another_number_in_a_branch_is_no_sign() -> None:
    assert read(2, 1, 0.5 * Q[:, 1]) == ""
