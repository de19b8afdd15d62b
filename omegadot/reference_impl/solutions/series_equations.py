"""The equations of motion as one quadratic system with constant coefficients, in the extended type.

In principal axes equation (8) reads ``ω̇₁ = (I₂ - I₃)/I₁ ω₂ω₃ + τ₁/I₁`` and so on. Its coefficients
are formed in eighty digits from the doubles that the system holds and rounded once, so that the
differences of moments and the small moment of a thin body keep all their digits; in body axes the
tensor's condition number would multiply every rounding.

The unknown is ``x = (q, ω, g, t)``: the attitude (world from body), ω in principal axes, and, where
they act, gravity and the world's torque as the body sees them, in principal axes. Of these the
last two move as ``u̇ = u × ω``, constant vectors of the world seen from the body, and ``q̇ = ½ q ω``.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from decimal import Decimal

import numpy as np

from omegadot.reference_impl.arithmetic.precision import from_decimals, to_double, to_extended
from omegadot.reference_impl.closed_forms.digits import apply, cross, many_digits
from omegadot.reference_impl.closed_forms.given import Given, principal_axes
from omegadot.reference_impl.rotations import normalize, quaternion_product, rotate_inverse
from omegadot.reference_impl.system import Array, State, System

Q, W, G, T = slice(0, 4), slice(4, 7), slice(7, 10), slice(10, 13)


@dataclass(frozen=True)
class Equations:
    """``ẋ_a = Σ_bc quadratic[b, c, a] x_b ω_c + Σ_b linear[b, a] x_b + constant[a]``.

    axes: (3, 3), the principal axes, row by row, in body axes.  gravity and torque_world: (3,),
    world axes, what x's last six components follow.  unit: s, what time is counted in here.  All
    but the unit in the extended type.
    """

    quadratic: Array
    linear: Array
    constant: Array
    axes: Array
    gravity: Array
    torque_world: Array
    unit: float = 1.0

    def rates(self, x: Array) -> Array:
        """The ẋ of x, (..., 13)."""
        products = (x[..., :, None] * x[..., None, W]).reshape(*x.shape[:-1], 39)
        rates: Array = np.concatenate((products, x), -1) @ self.table + self.constant
        return rates

    @property
    def table(self) -> Array:
        """(52, 13): from the 39 products of x with ω, then x, to their part of ẋ."""
        return np.concatenate((self.quadratic.reshape(39, 13), self.linear))

    def in_own_time(self, x: Array) -> Equations:
        """The same with time in a unit of the motion's own, a power of two near ``1/rate``.

        Coefficients of high order are powers of the rate: in seconds those of a molecule would
        leave the range of numbers. The rate is ``max(|ω|, |ω̇|^½)``, the largest over the lanes.
        """
        w, w_dot = (np.abs(to_double(y)[..., W]) for y in (x, self.rates(x)))
        rate = max(np.max(w), np.sqrt(np.max(w_dot)))
        unit = float(np.ldexp(1.0, 1 - int(np.frexp(rate)[1]))) if rate > 0 else 1.0
        linear, constant = self.linear.copy(), self.constant * unit**2
        linear[W, W] *= unit
        linear[G, W] *= unit**2
        linear[T, W] *= unit**2
        return replace(self, linear=linear, constant=constant, unit=unit)

    def unknown(self, state: State) -> Array:
        """The x of states, (..., 13); the quaternion is made unit in the extended type."""
        q, w = to_extended(state.orientation), to_extended(state.angular_velocity)
        shape = np.broadcast_shapes(q.shape[:-1], w.shape[:-1])
        x = to_extended(np.zeros((*shape, 13)))
        x[..., Q] = q
        x[..., W] = w @ self.axes.T * self.unit
        return self.refreshed(x)

    def refreshed(self, x: Array) -> Array:
        """The x with a unit quaternion, and the world's vectors turned into the body by it."""
        q, x = normalize(x[..., Q]), x.copy()
        x[..., Q] = q
        x[..., G] = rotate_inverse(q, self.gravity) @ self.axes.T
        x[..., T] = rotate_inverse(q, self.torque_world) @ self.axes.T
        return x

    def angular_velocity(self, x: Array) -> Array:
        """ω in body axes, (..., 3) rad/s."""
        w: Array = x[..., W] @ self.axes / self.unit
        return w


def equations_of(system: System) -> Equations:
    """The coefficients of one system. Raises ValueError for a system with leading axes."""
    body, load = system.body, system.load
    if np.ndim(body.inertia) != 2 or np.ndim(load.gravity) != 1:
        raise ValueError("a series is of one system; lanes are for its initial states")
    with many_digits():
        given = Given.of(system)
        moments, axes = principal_axes(given.inertia)
        inverse = [1 / moment for moment in moments]
        weight_arm = [given.mass * r for r in apply(axes, given.lever)]
        # τ = m r × g: columns are the torques of g along each principal axis
        unit = [[Decimal(int(i == j)) for j in range(3)] for i in range(3)]
        columns = [cross(weight_arm, e) for e in unit]
        push = apply(axes, given.torque_body)
        gyroscopic = [(moments[i - 2] - moments[i - 1]) * inverse[i] for i in range(3)]
        by_gravity = [[inverse[i] * columns[j][i] for j in range(3)] for i in range(3)]
        linear, constant = to_extended(np.zeros((13, 13))), to_extended(np.zeros(13))
        one = np.arange(W.start, W.stop)
        linear[one, one] = from_decimals([-given.damping * k for k in inverse])
        linear[one, one + T.start - W.start] = from_decimals(inverse)
        for row, pull in zip(one, by_gravity, strict=True):
            linear[row, G] = from_decimals(pull)
        constant[W] = from_decimals([k * tau for k, tau in zip(inverse, push, strict=True)])
        rows = from_decimals([part for axis in axes for part in axis]).reshape(3, 3)
        turning = from_decimals(gyroscopic)
    pivoted = load.pivot is not None
    return Equations(
        quadratic=_quadratic(turning, rows),
        linear=linear.T,
        constant=constant,
        axes=rows,
        gravity=to_extended(load.gravity if pivoted else np.zeros(3)),
        torque_world=to_extended(load.torque_world),
    )


def _quadratic(gyroscopic: Array, rows: Array) -> Array:
    """The table of products, (13, 3, 13): factor in x, factor in ω, component of ẋ."""
    table = to_extended(np.zeros((13, 3, 13)))
    unit = to_extended(np.eye(4))
    for c in range(3):
        pure = np.concatenate((to_extended(np.zeros(1)), rows[c]))  # body axes
        for b in range(4):
            table[b, c, Q] = quaternion_product(unit[b], pure) / 2
    for i in range(3):
        j, k = (i + 1) % 3, (i + 2) % 3
        table[4 + j, k, 4 + i] = gyroscopic[i]
        for start in (G.start, T.start):  # (u × ω)_i = u_j ω_k - u_k ω_j
            table[start + j, k, start + i] = 1
            table[start + k, j, start + i] = -1
    return table
