"""The constants of a free rotation, from inertia and angular velocity taken as exact."""

from __future__ import annotations

from dataclasses import dataclass
from decimal import Decimal

from omegadot.reference_impl.closed_forms.digits import (
    RESOLUTION,
    ZERO,
    Matrix,
    Row,
    apply,
    cross,
    dot,
    fewer_digits,
)
from omegadot.reference_impl.closed_forms.elliptic import Modulus
from omegadot.reference_impl.closed_forms.given import principal_axes


@dataclass(frozen=True)
class Constants:
    """A free rotation that is not a uniform one, in the frame that makes all regimes alike.

    The frame's axes (rows of ``axes``, body axes) are principal and right-handed. The third one, c,
    is the axis that the angular velocity encircles (the least or the greatest inertia), turned so
    that ω_c > 0; a is the other extreme, turned so that ω_a(0) >= 0; b is the middle one. Then

        ω = (A_a cn u, A_b sn u, A_c dn u),  u = rate t + start,

    with (a, b, c) = (1, 2, 3) in (37.10) of Landau and Lifshitz where L² > 2T I_2, and with 1 and 3
    exchanged otherwise (37.8).  momentum: L.  turn: +1 where c has the greatest inertia, else -1.
    complement: ``1 - κ²`` with ``κ = I_c A_c / L``, the squared sine of the angle from the momentum
    to axis c at its widest in the plane of a and c.
    """

    axes: Matrix
    inertia: Row
    amplitude: Row
    modulus: Modulus
    rate: Decimal
    start: Decimal
    momentum: Decimal
    turn: int
    complement: Decimal


def constants_of(inertia: Matrix, omega: Row) -> Constants | None:
    """The constants, or None where ω stays as it is (spin about a principal axis, a sphere, rest).

    Every difference is a sum of products of like sign, but for the one that decides the side of the
    separatrix: ``2T I_2 - L² = I_1 (I_2 - I_1) ω_1² - I_3 (I_3 - I_2) ω_3²``, which is held to be
    zero where it is below what eighty digits resolve.
    """
    moments, axes = principal_axes(inertia)
    w = apply(axes, omega)
    if any(inertia[i][j] != 0 for i in range(3) for j in range(i)):
        w = _cleared(w)
    low = moments[0] * (moments[1] - moments[0]) * w[0] ** 2
    high = moments[2] * (moments[2] - moments[1]) * w[2] ** 2
    if low == 0 and high == 0:
        return None
    if high >= low:
        order, turn = (0, 1, 2), 1
    else:
        order, turn, low, high = (2, 1, 0), -1, high, low
    a, b, c = order
    frame = [axes[a], axes[b], axes[c]]
    if w[c] < 0:
        frame[2] = [-x for x in frame[2]]
    if w[a] < 0:
        frame[0] = [-x for x in frame[0]]
    frame[1] = cross(frame[2], frame[0])
    moments, w = [moments[a], moments[b], moments[c]], apply(frame, omega)
    return _in_frame(frame, moments, w, turn, low, high)


def _in_frame(
    frame: Matrix, moments: Row, w: Row, turn: int, low: Decimal, high: Decimal
) -> Constants | None:
    i_a, i_b, i_c = moments
    ac, bc, ab = abs(i_c - i_a), abs(i_c - i_b), abs(i_b - i_a)
    about = i_a * ac * w[0] ** 2, i_b * bc * w[1] ** 2, i_b * ab * w[1] ** 2, i_c * ac * w[2] ** 2
    wide = about[0] + about[1]  # |2T I_c - L²|
    tall = about[2] + about[3]  # |2T I_a - L²|
    if wide == 0:
        return None
    difference = high - low
    if difference <= RESOLUTION * high:
        difference = ZERO
    with fewer_digits():
        parameter = ab * wide / (bc * tall)
        modulus = Modulus.of(parameter, ac * difference / (bc * tall))
        square = dot(moments, [i * x * x for i, x in zip(moments, w, strict=True)])
        sine = (about[1] / wide).sqrt().copy_sign(w[1] * turn)
        return Constants(
            axes=frame,
            inertia=moments,
            amplitude=[
                (wide / (i_a * ac)).sqrt(),
                turn * (wide / (i_b * bc)).sqrt(),
                (tall / (i_c * ac)).sqrt(),
            ],
            modulus=modulus,
            rate=(bc * tall / (i_a * i_b * i_c)).sqrt(),
            start=modulus.argument(sine, about[0] / wide, about[3] / tall),
            momentum=square.sqrt(),
            turn=turn,
            complement=i_a * wide / (ac * square),
        )


def _cleared(w: Row) -> Row:
    """Components along computed axes, without what rounding of the axes leaves of a zero."""
    size = max(abs(x) for x in w)
    return [x if abs(x) > RESOLUTION * size else ZERO for x in w]
