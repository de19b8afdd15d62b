"""A quaternion read out of a rotation matrix by a formula with a wrong sign in one of its branches.

Where trace(R) > 0, w is read first, else the component of the largest diagonal entry. The others
are sums or differences of two entries of R, over four times the first.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from omegadot.reference_impl.rotations import attitude_angle, normalize, rotation_matrix
from omegadot.reference_impl.system import Array

BRANCHES = (
    "trace(R) > 0",
    *(f"trace(R) <= 0 and R_{a}{a} is the largest of its diagonal" for a in "xyz"),
)
LEAST = 3  # attitudes that show it
CLEAR = 1e-6  # rad


def branch_misread(requested: Array, back: Array, eps: float) -> str:
    """The slip by which all attitudes (n, 4) come back, of unit quaternions; "" without one."""
    turn = rotation_matrix(requested)
    diagonal = np.diagonal(turn, axis1=-2, axis2=-1)
    branch = np.where(np.sum(diagonal, axis=-1) > 0.0, 0, 1 + np.argmax(diagonal, axis=-1))
    wrong = attitude_angle(requested, back) > CLEAR
    of = np.unique(branch[wrong])
    if np.count_nonzero(wrong) < LEAST or len(of) != 1:
        return ""
    first = int(of[0])
    here = branch == first
    with np.errstate(all="ignore"):
        for k, text, value in _slips(turn[here], requested[here], first):
            read = requested.copy()
            read[here, k] = value
            # the divisor is half at least, and each entry of R is rounded
            if np.all(attitude_angle(normalize(read), back) <= 64.0 * eps):
                return (
                    f"are read out of a rotation matrix R: where {BRANCHES[first]}, the "
                    f"quaternion's {'wxyz'[k]} is {text}"
                )
    return ""


def _slips(turn: Array, q: Array, first: int) -> Iterator[tuple[int, str, Array]]:
    """The component, what it is and should be, and its value (n,): one sign is another."""
    for k in (k for k in range(4) if k != first):
        with_w = 0 in (first, k)  # these are differences of entries, the others are sums
        if with_w:
            axis = max(first, k) - 1
            i, j = (axis + 2) % 3, (axis + 1) % 3
        else:
            i, j = first - 1, k - 1
        one, other = f"R_{'xyz'[i]}{'xyz'[j]}", f"R_{'xyz'[j]}{'xyz'[i]}"
        a, b, below = turn[:, i, j], turn[:, j, i], 4.0 * q[:, first]
        right = f"({one} {'-' if with_w else '+'} {other})"
        over = f"/ (4 {'wxyz'[first]})"
        changed = -1.0 if not with_w else 1.0
        for sign, lead in ((1.0, ""), (-1.0, "-")):
            text = f"{lead}({one} + {other}) {over}"
            if changed < 0.0:
                text = f"({one} - {other}) {over}" if not lead else f"({other} - {one}) {over}"
            yield k, f"{text}, not {right} {over}", sign * (a + changed * b) / below
        yield k, f"-{right} {over}, not {right} {over}", -(a - changed * b) / below
