"""What every closed form is made of: exact numbers in, a motion out."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np

from omegadot.reference_impl.closed_forms.digits import ONE, ZERO, Matrix, Row, dot, exact
from omegadot.reference_impl.closed_forms.times import COLUMNS, Times, chunks
from omegadot.reference_impl.system import Array

# Times (n,) s to the attitude (n, 4) and the angular velocity (n, 3) rad/s, body frame.
Motion: TypeAlias = Callable[[Array], tuple[Array, Array]]

# The same in a frame of its own, ready to be placed: a vector and a quaternion, written to the
# given arrays (3, n) and (4, n). The second one's transpose is contiguous.
MeasuredRun: TypeAlias = Callable[[Times, Array, Array], None]

_LARGE_PAGE = 2**21  # bytes, on Linux
# Times worked at once: intermediate arrays stay in the cache and below 128 KB.
_CHUNK = 15 * COLUMNS


@dataclass(frozen=True)
class Problem:
    """A motion that has a closed form.

    kind: its name.  numbers: all it depends on, taken as exact.  solve: makes the motion of any
    such numbers, which is how its sensitivity to their rounding is found.
    """

    kind: str
    numbers: Row
    solve: Callable[[Row], Motion]


@dataclass(frozen=True)
class Placed:
    """A motion seen from the world and the body.

    turning: (3, 3), the linear map of the motion's vector to ω in body axes.  placing: (4, 4), that
    of its quaternion to the attitude.
    """

    trajectory: MeasuredRun
    turning: Array
    placing: Array

    def __call__(self, times: Array) -> tuple[Array, Array]:
        """Attitude (n, 4) and angular velocity (n, 3)."""
        both = _block(7 * times.size)
        orientation = both[: 4 * times.size].reshape(-1, 4)
        angular_velocity = both[4 * times.size :].reshape(-1, 3)
        vectors, quaternions = np.empty((3, _CHUNK)), np.empty((_CHUNK, 4))
        for part, moments in chunks(times, _CHUNK):
            w, q = vectors[:, : moments.value.size], quaternions[: moments.value.size]
            self.trajectory(moments, w, q.T)
            np.matmul(w.T, self.turning, out=angular_velocity[part])
            np.matmul(q, self.placing, out=orientation[part])
        return orientation, angular_velocity


def _block(size: int) -> Array:
    """An array of its own; a large one from the bounds of large pages on, which NumPy requests.

    In small pages its page faults would take longer than the samples do.
    """
    large = _LARGE_PAGE // 8
    if size < 2 * large:
        return np.empty(size)
    room = np.empty(-(-size // large) * large + large)
    first = -room.ctypes.data % _LARGE_PAGE // 8
    return room[first : first + size]


IDENTITY: Matrix = [[ONE if i == j else ZERO for j in range(3)] for i in range(3)]
_UPRIGHT: Row = [ONE, ZERO, ZERO, ZERO]


def place(
    trajectory: MeasuredRun,
    orientation: Row,
    turning: Matrix = IDENTITY,
    frame: Row = _UPRIGHT,
) -> Placed:
    """The motion with the given attitude at time zero.

    frame: the quaternion of frame-from-body, whose axes are the body's if not given.  Attitudes are
    ``W q(t) frame``, with the constant W such that the first one is ``orientation``.
    """
    q = np.empty((1, 4)).T
    trajectory(Times(np.zeros(1)), np.empty((3, 1)), q)
    body = product(exact(q), frame)
    start = [x / dot(orientation, orientation).sqrt() for x in orientation]
    world = product(start, [body[0], -body[1], -body[2], -body[3]])
    return Placed(trajectory, np.array(turning, float), placing_of(world, frame))


def placing_of(world: Row, frame: Row) -> Array:
    """The matrix of ``q -> world q frame``, (4, 4), by rows: the images of 1, i, j and k."""
    a, b, c, d = world
    units = [a, b, c, d], [-b, a, d, -c], [-c, -d, a, b], [-d, c, -b, a]
    return np.array([product(unit, frame) for unit in units], float)


def product(a: Row, b: Row) -> Row:
    """Hamilton's product of two quaternions of many digits."""
    return [
        a[0] * b[0] - a[1] * b[1] - a[2] * b[2] - a[3] * b[3],
        a[0] * b[1] + a[1] * b[0] + a[2] * b[3] - a[3] * b[2],
        a[0] * b[2] + a[2] * b[0] + a[3] * b[1] - a[1] * b[3],
        a[0] * b[3] + a[3] * b[0] + a[1] * b[2] - a[2] * b[1],
    ]


def quaternion_of(axes: Matrix) -> Row:
    """The quaternion of the rotation whose matrix has these rows: frame-from-body.

    The row of ``q qᵀ`` with the greatest diagonal element is taken, so that nothing cancels
    (S. W. Shepperd, Quaternion from rotation matrix, J. Guidance and Control 1 (1978) 223-224).
    """
    m = axes
    squares = [ONE + sum(s * m[i][i] for i, s in enumerate(signs)) for signs in _SIGNS]
    products = [
        [squares[0], m[2][1] - m[1][2], m[0][2] - m[2][0], m[1][0] - m[0][1]],
        [m[2][1] - m[1][2], squares[1], m[0][1] + m[1][0], m[0][2] + m[2][0]],
        [m[0][2] - m[2][0], m[0][1] + m[1][0], squares[2], m[1][2] + m[2][1]],
        [m[1][0] - m[0][1], m[0][2] + m[2][0], m[1][2] + m[2][1], squares[3]],
    ]
    row = products[max(range(4), key=lambda i: squares[i])]
    size = dot(row, row).sqrt()
    return [x / size for x in row]


_SIGNS = ((1, 1, 1), (1, -1, -1), (-1, 1, -1), (-1, -1, 1))
