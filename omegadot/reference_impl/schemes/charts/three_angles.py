"""Three angles of the body in a frame of the world, and ω in the world's axes.

``R = F Rx(a) Ry(b) Rz(c) B``, singular where ``cos b = 0``. F, the frame's axes, is held through a
step; B exchanges the body's axes. Both are turns whose quaternions are of halves, which are exact.
Other sequences are these angles in other axes, and to add a constant to an angle changes no step:
of ``F = Ry(-90°) Rx(90°)`` and ``B = Rz(90°) Ry(90°)`` it is yaw, pitch and minus roll,
``R = Rz(a + 90°) Ry(b) Rx(-c - 90°)``.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from omegadot.reference_impl.arithmetic.components import (
    Number,
    Numbers,
    arctan2,
    cosine_and_sine,
    product4,
    rotated,
)
from omegadot.reference_impl.schemes.charts.chart import Chart

NO_TURN = (1.0, 0.0, 0.0, 0.0)
# Of the body's z-axis along the world's x-axis, up to which the world's axes are the frame. The
# singularity is then 45 degrees away at least, and in the other frame 44.
MOST = 0.7


def _angles(q: Numbers) -> tuple[Number, Number, Number]:
    """a, b, c of ``Rx(a) Ry(b) Rz(c)``: exact to rounding together, near the singularity too."""
    w, x, y, z = q
    c1, s1 = 1 - 2 * (x * x + y * y), 2 * (w * x - y * z)
    a = arctan2(s1, c1)
    level = (1 - 2 * (y * y + z * z), 2 * (w * z - x * y))  # cos b cos c, cos b sin c
    b = arctan2(2 * (x * z + w * y), (level[0] * level[0] + level[1] * level[1]) ** 0.5)
    c1, s1 = cosine_and_sine(a)
    sine = c1 * (2 * (x * y + w * z)) + s1 * (2 * (x * z - w * y))
    cosine = c1 * (1 - 2 * (x * x + z * z)) + s1 * (2 * (y * z + w * x))
    return a, b, arctan2(sine, cosine)


def _rates(a: Number, b: Number, w: Numbers) -> list[Number]:
    """ȧ, ḃ, ċ of ``ω = ȧ x + ḃ Rx y + ċ Rx Ry z`` in the frame's axes."""
    (c1, s1), (c2, s2) = cosine_and_sine(a), cosine_and_sine(b)
    last = (c1 * w[2] - s1 * w[1]) / c2
    return [w[0] - s2 * last, c1 * w[1] + s1 * w[2], last]


def three_angles(frame: Callable[[Numbers], Numbers], body: Numbers = NO_TURN) -> Chart:
    """The chart. frame: F of an attitude, a quaternion.  body: B, a quaternion."""

    def of_quaternion(q: Numbers) -> list[Number]:
        f = frame(q)
        own = product4(product4(_back(f), q), _back(body))
        return [*_angles(own), *f]

    def quaternion(y: Numbers) -> Numbers:
        turn = y[3:]
        for axis in range(3):
            c, s = cosine_and_sine(0.5 * y[axis])
            about = [c, 0.0, 0.0, 0.0]
            about[1 + axis] = s
            turn = product4(turn, about)
        return product4(turn, body)

    def rate(y: Numbers, spin: Numbers) -> list[Number]:
        return [*_rates(y[0], y[1], rotated(_back(y[3:]), spin)), 0.0, 0.0, 0.0, 0.0]

    return Chart(7, of_quaternion, quaternion, rate)


def _back(q: Numbers) -> Numbers:
    w, x, y, z = q
    return -w, x, y, z


def _one_of_two(q: Numbers) -> Numbers:
    """The world's axes, or ``Rz(90°) Rx(90°)`` where these are near singular."""
    w, x, y, z = q
    turned = abs(2 * (x * z + w * y)) > MOST
    if type(w) is float:
        return (0.5, 0.5, 0.5, 0.5) if turned else NO_TURN
    half = np.where(turned, 0.5, 0.0)
    return 1.0 - half, half, half, half


ROLL_PITCH_YAW = three_angles(lambda _: (0.5, 0.5, -0.5, 0.5), (0.5, -0.5, 0.5, 0.5))
TWO_FRAMES = three_angles(_one_of_two)
