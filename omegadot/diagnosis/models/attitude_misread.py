"""Attitudes that do not read back, made of those that were set by one rule with no number in it."""

from __future__ import annotations

import numpy as np

from omegadot.diagnosis.models.attitude_charts import chart_misread
from omegadot.diagnosis.models.euler_angles import angles_misread
from omegadot.diagnosis.models.matrix_branches import branch_misread
from omegadot.diagnosis.models.mistyped_matrix import matrix_mistyped
from omegadot.reference_impl.rotations import attitude_angle, normalize
from omegadot.reference_impl.system import Array

LEAST = 2  # attitudes that are wrong: one may be so by chance
UNIT = 1e-6  # of a quaternion's length


def attitude_misread(requested: Array, back: Array, eps: float) -> str:
    """The rule by which all attitudes (n, 4) come back; "" without one."""
    lengths = np.linalg.norm(back, axis=-1)
    if not np.all(np.abs(lengths - 1.0) <= UNIT):
        return ""
    requested, back = normalize(requested), normalize(back)
    if np.count_nonzero(attitude_angle(requested, back) > UNIT) < LEAST:
        return ""
    angles = angles_misread(requested, back, eps)
    if angles:
        return f"attitudes go through Euler angles of two conventions: {angles}"
    chart = chart_misread(requested, back, eps)
    if chart:
        return f"attitudes {chart}"
    branch = branch_misread(requested, back, eps)
    if branch:
        return f"attitudes {branch}"
    entry = matrix_mistyped(requested, back, eps)
    return f"attitudes go through a matrix that has one entry wrong: {entry}" * bool(entry)
