"""The constants of a heavy symmetric top, from numbers taken as exact."""

from __future__ import annotations

from dataclasses import dataclass
from decimal import Decimal

from omegadot.reference_impl.closed_forms.digits import (
    ONE,
    PRECISION,
    TWO,
    ZERO,
    Matrix,
    Row,
    apply,
    cross,
    dot,
)
from omegadot.reference_impl.closed_forms.elliptic import Modulus
from omegadot.reference_impl.closed_forms.problem import product, quaternion_of

_SMALL = Decimal(10) ** (4 - PRECISION // 2)  # a double root is known to half of the digits


@dataclass(frozen=True)
class Top:
    """Where the top stands and how it turns at time zero, in frames of its own.

    The body frame has its third axis along the lever, the world frame upwards; alpha and beta are
    the Cayley-Klein parameters of the attitude between them, ``q = (Re α, Re β, Im β, Im α)``,
    ``|α|² = (1+u)/2``, ``|β|² = (1-u)/2`` with ``u = cos θ``; across is ``ω_1 + i ω_2``, spin is
    ω_3. (real, imaginary) pairs.  transverse, axial: moments about the pivot; weight: ``m g l``.
    """

    axes: Matrix
    body: Row
    world: Row
    alpha: tuple[Decimal, Decimal]
    beta: tuple[Decimal, Decimal]
    across: tuple[Decimal, Decimal]
    spin: Decimal
    transverse: Decimal
    axial: Decimal
    weight: Decimal


@dataclass(frozen=True)
class Nutation:
    """``u = u_1 + (u_2 - u_1) sn²(rate t + start)``, the roots of ``u̇²`` and what they give.

    ``u̇² = strength (1 - u²)(height - u) - (b - a u)²`` with ``a = I_3 ω_3 / I_1``,
    ``b = L_z / I_1``, ``strength = 2 m g l / I_1``, and ``strength (height - u) = ω_1² + ω_2²``.
    """

    a: Decimal
    b: Decimal
    strength: Decimal
    height: Decimal
    roots: Row
    modulus: Modulus
    rate: Decimal
    start: Decimal


def unit_quaternion_of(axes: Matrix, orientation: Row, upward: Matrix) -> Row:
    """The attitude between the two frames: upward-from-world, world-from-body, body-from-axes."""
    body, world = quaternion_of(axes), quaternion_of(upward)
    size = dot(orientation, orientation).sqrt()
    q = product(world, [x / size for x in orientation])
    return product(q, [body[0], -body[1], -body[2], -body[3]])


def triad(third: Row) -> Matrix:
    """Rows of a right-handed frame whose third axis is this direction."""
    size = dot(third, third).sqrt()
    z = [x / size for x in third]
    least = min(range(3), key=lambda i: abs(z[i]))
    y = cross(z, [ONE if i == least else ZERO for i in range(3)])
    size = dot(y, y).sqrt()
    y = [x / size for x in y]
    return [cross(y, z), y, z]


def top_of(numbers: Row, transverse: Decimal, axial: Decimal) -> Top:
    """numbers: mass, lever (3), gravity (3), angular velocity (3), orientation (4)."""
    mass, lever, gravity = numbers[0], numbers[1:4], numbers[4:7]
    axes, upward = triad(lever), triad([-g for g in gravity])
    q = unit_quaternion_of(axes, numbers[10:14], upward)
    w = apply(axes, numbers[7:10])
    world = quaternion_of(upward)
    return Top(
        axes=axes,
        body=quaternion_of(axes),
        world=[world[0], -world[1], -world[2], -world[3]],
        alpha=(q[0], q[3]),
        beta=(q[1], q[2]),
        across=(w[0], w[1]),
        spin=w[2],
        transverse=transverse,
        axial=axial,
        weight=mass * dot(lever, lever).sqrt() * dot(gravity, gravity).sqrt(),
    )


def nutation_of(top: Top) -> Nutation | None:
    """The nutation, or None where the axis stands vertical and stays so."""
    up, down = dot(top.alpha, top.alpha), dot(top.beta, top.beta)
    u = up - down
    # the vertical in body axes, v_1 + i v_2 = 2i β α*
    v = (
        -2 * (top.beta[1] * top.alpha[0] - top.beta[0] * top.alpha[1]),
        2 * (top.beta[0] * top.alpha[0] + top.beta[1] * top.alpha[1]),
    )
    square = dot(top.across, top.across)
    if max(abs(v[0]), abs(v[1])) <= _SMALL and square <= (_SMALL * (top.spin or ONE)) ** 2:
        return None
    a = top.axial * top.spin / top.transverse
    b = dot(v, top.across) + a * u
    speed = v[0] * top.across[1] - v[1] * top.across[0]  # du/dt
    strength = 2 * top.weight / top.transverse
    height = u + square / strength
    roots = _roots(a, b, strength, height, u)
    span = roots[2] - roots[0]
    swing, gap = roots[1] - roots[0], roots[2] - roots[1]
    if swing <= _SMALL * span:
        swing, roots = ZERO, [u, u, roots[2]]
    if gap <= _SMALL * span:
        gap, roots = ZERO, [roots[0], roots[2], roots[2]]
    modulus = Modulus.of(swing / span, gap / span)
    start = ZERO
    if swing:
        sine = _share((u - roots[0]) / swing).sqrt().copy_sign(speed)
        start = modulus.argument(
            sine, _share((roots[1] - u) / swing), _share((roots[2] - u) / span)
        )
    rate = (strength * span / 4).sqrt()
    return Nutation(a, b, strength, height, roots, modulus, rate, start)


def _share(x: Decimal) -> Decimal:
    return min(max(x, ZERO), ONE)


def _roots(a: Decimal, b: Decimal, strength: Decimal, height: Decimal, u: Decimal) -> Row:
    """The roots ``u_1 <= u_2 <= 1 <= u_3`` of ``u̇² / strength``, a cubic with leading one.

    The greatest by Newton's iteration from above, where it falls steadily (by half of the distance
    at least, so a double root costs one step a bit); the others from their sum and product.
    """
    c2 = -(height + a * a / strength)
    c1 = 2 * a * b / strength - ONE
    c0 = height - b * b / strength
    x = ONE + max(abs(c2), abs(c1), abs(c0))
    while True:
        value = ((x + c2) * x + c1) * x + c0
        slope = (3 * x + 2 * c2) * x + c1
        if value <= 0 or slope <= 0:
            break
        lower = x - value / slope
        if not lower < x:
            break
        x = lower
    greatest = max(x, ONE)
    half = (-c2 - greatest) / TWO
    # (u - u_1)(u_2 - u) = half-width² - (u - half)² is not negative where the top stands
    width = max(half * half - (c1 - greatest * 2 * half), (u - half) ** 2).sqrt()
    return [max(half - width, -ONE), min(half + width, ONE), greatest]
