"""Angular velocity of a free symmetric body that viscous friction slows down.

The attitude of such a body is left to the series. With ``s = e^(-d t/I_c)`` and ``ρ = I_c/I_a`` its
Cayley-Klein parameters, turned back by half the spin, obey

    s² A'' + s (1 - ρ - iρσ s) A' + (w s^ρ)² A = 0,  σ = I_c ω_c(0)/d,  w = I_c |ω_⊥(0)|/2d,

by elimination from ``2 q̇ = q ω``. The sphere, ρ = 1, makes that elementary, ρ = 1/2 Kummer's
equation, and the flat disc, ρ = 2, a biconfluent Heun equation (DLMF 31.12.3), whose solutions are
themselves known by their series only. In general the powers s and s^ρ at the irregular point at
infinity do not go together and no standard function solves it. Spin about a principal axis and
spheres are in ``fixed_axis.py``.
"""

from __future__ import annotations

import numpy as np

from omegadot.reference_impl.system import Array


def damped_symmetric_angular_velocity(
    moments: Array, damping: float, omega: Array, times: Array
) -> Array:
    """ω at times (n,) s, (n, 3) rad/s, body frame, of ``I dω/dt = -d ω - ω × I ω``.

    moments: (3,) principal moments of which two agree, kg m^2, in body axes.  damping: d, N m
    s/rad.  omega: (3,) rad/s at time zero. With c the axis of symmetry and a, b the next two,

        ω_c = ω_c(0) e^(-d t/I_c),
        ω_a + i ω_b = (ω_a + i ω_b)(0) e^(-d t/I_a + i κ S),  κ = (I_c - I_a)/I_a,
        S = ∫ ω_c dt = ω_c(0) t (1 - e^-x)/x,  x = d t/I_c,

    by direct integration of Euler's equations. Raises ValueError where no two moments agree.
    """
    moments, omega = np.asarray(moments, float), np.asarray(omega, float)
    axis = next((i for i in range(3) if moments[i - 2] == moments[i - 1]), None)
    if axis is None:
        raise ValueError(f"no two of the moments {moments.tolist()} agree: the body is triaxial")
    a, b, c = (axis + 1) % 3, (axis + 2) % 3, axis
    x = damping * times / moments[c]
    safe = np.where(x == 0, 1.0, x)
    angle = omega[c] * times * np.where(x == 0, 1.0, -np.expm1(-safe) / safe)
    angle *= (moments[c] - moments[a]) / moments[a]
    across = (omega[a] + 1j * omega[b]) * np.exp(1j * angle - damping * times / moments[a])
    w = np.empty((*np.shape(times), 3))
    w[..., a], w[..., b], w[..., c] = across.real, across.imag, omega[c] * np.exp(-x)
    return w
