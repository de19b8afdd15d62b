"""The textbook forms in mpmath's own elliptic functions: the second, independent way.

Free rotation by Landau and Lifshitz, section 37, for ω, and Euler's precession angle by one
incomplete integral of the third kind; the Lagrange top by section 35, problem 1, its three angles
by mpmath's Legendre integrals as well. No code and no formula of the package is used.
"""

from __future__ import annotations

from collections.abc import Sequence

import mpmath as mp

Vector = list[mp.mpf]


def _cross(a: Vector, b: Vector) -> Vector:
    return [a[i - 2] * b[i - 1] - a[i - 1] * b[i - 2] for i in range(3)]


def _rotation(q: Sequence[mp.mpf]) -> mp.matrix:
    w, x, y, z = (mp.mpf(c) / mp.norm(mp.matrix(q)) for c in q)
    return mp.matrix(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
        ]
    )


def _about_z(angle: mp.mpf) -> mp.matrix:
    c, s = mp.cos(angle), mp.sin(angle)
    return mp.matrix([[c, -s, 0], [s, c, 0], [0, 0, 1]])


def _amplitude(u: mp.mpf, m: mp.mpf) -> mp.mpf:
    """am(u, m), continuous in u."""
    turns = mp.nint(u / (4 * mp.ellipk(m)))
    return mp.atan2(mp.ellipfun("sn", u, m=m), mp.ellipfun("cn", u, m=m)) + 2 * mp.pi * turns


def free_rotation(
    inertia: Sequence[Sequence[float]],
    q0: Sequence[float],
    w0: Sequence[float],
    times: Sequence[float],
) -> list[tuple[mp.matrix, Vector]]:
    """(world_R_body, ω) at the times, for a triaxial body off the separatrix and off the axes."""
    moments, columns = mp.eigsy(mp.matrix([[mp.mpf(x) for x in row] for row in inertia]))
    axes = [[columns[i, k] for i in range(3)] for k in range(3)]
    w = [mp.fdot(axis, map(mp.mpf, w0)) for axis in axes]
    twice_t = mp.fsum(i * x * x for i, x in zip(moments, w, strict=True))
    square = mp.fsum((i * x) ** 2 for i, x in zip(moments, w, strict=True))
    a, b, c = (0, 1, 2) if square > twice_t * moments[1] else (2, 1, 0)
    ia, ib, ic = moments[a], moments[b], moments[c]
    size_a = (mp.sign(w[a]) or 1) * mp.sqrt((twice_t * ic - square) / (ia * (ic - ia)))
    size_b = mp.sqrt((twice_t * ic - square) / (ib * (ic - ib)))
    size_c = mp.sign(w[c]) * mp.sqrt((square - twice_t * ia) / (ic * (ic - ia)))
    rate = mp.sqrt((ic - ib) * (square - twice_t * ia) / (ia * ib * ic))
    m = (ib - ia) * (twice_t * ic - square) / ((ic - ib) * (square - twice_t * ia))
    # the handedness of (a, b, c) and the sign of the middle component from Euler's equation for it
    hand = mp.det(mp.matrix([axes[a], axes[b], axes[c]]))
    middle = hand * (ic - ia) * size_c * size_a
    size_b *= mp.sign(middle)
    start = mp.ellipf(mp.atan2(w[b] / size_b, w[a] / size_a), m)
    momentum = mp.sqrt(square)
    floor = square - (ic * size_c) ** 2
    n = -((ic * size_c) ** 2) * m / floor
    found = []
    for t in map(mp.mpf, [0, *times]):
        u = rate * t + start
        wt = [mp.mpf(0)] * 3
        for axis, size, name in ((a, size_a, "cn"), (b, size_b, "sn"), (c, size_c, "dn")):
            value = size * mp.ellipfun(name, u, m=m)
            wt = [x + value * y for x, y in zip(wt, axes[axis], strict=True)]
        h = [mp.mpf(0)] * 3
        for k in range(3):
            part = moments[k] * mp.fdot(axes[k], wt) / momentum
            h = [x + part * y for x, y in zip(h, axes[k], strict=True)]
        third = mp.ellippi(n, _amplitude(u, m), m) / (rate * floor)
        precession = momentum * t / ic + momentum * (twice_t - square / ic) * third
        node = _cross(h, axes[c])
        length = mp.sqrt(mp.fdot(node, node))
        node = [x / length for x in node]
        attitude = _about_z(precession) * mp.matrix([node, _cross(h, node), h])
        found.append((attitude, wt))
    world = _rotation(q0) * found[0][0].T
    return [(world * attitude, wt) for attitude, wt in found[1:]]


def _cubic(c2: mp.mpf, c1: mp.mpf, c0: mp.mpf) -> Vector:
    """The three real roots of ``x³ + c2 x² + c1 x + c0``, by Viète's cosines."""
    p, q = c1 - c2**2 / 3, 2 * c2**3 / 27 - c1 * c2 / 3 + c0
    angle = mp.acos(3 * q / (2 * p) * mp.sqrt(-3 / p)) / 3
    roots = [2 * mp.sqrt(-p / 3) * mp.cos(angle - 2 * mp.pi * k / 3) - c2 / 3 for k in range(3)]
    return sorted(roots)


def nutation(
    transverse: mp.mpf,
    axial: mp.mpf,
    moment: mp.mpf,
    cosine: mp.mpf,
    across: tuple[mp.mpf, mp.mpf],
    spin: mp.mpf,
    times: Sequence[float],
) -> list[tuple[mp.mpf, mp.mpf, mp.mpf]]:
    """(cos θ, φ - φ(0), ψ - ψ(0)) of a top that starts with the node along the body's first axis.

    across: ω_1, ω_2 at time zero, ``moment = m g l``, gravity downwards, no passage of a vertical.
    """
    sine = mp.sqrt(1 - cosine**2)
    vertical, along = (
        transverse * across[1] * sine + axial * spin * cosine,
        axial * spin,
    )
    energy = transverse * (across[0] ** 2 + across[1] ** 2) / 2 + moment * cosine
    a, b, strength = along / transverse, vertical / transverse, 2 * moment / transverse
    height = energy / moment
    u1, u2, u3 = _cubic(
        -height - a * a / strength, 2 * a * b / strength - 1, height - b * b / strength
    )
    m, rate = (u2 - u1) / (u3 - u1), mp.sqrt(strength * (u3 - u1)) / 2
    start = mp.ellipf(mp.asin(mp.sqrt(min((cosine - u1) / (u2 - u1), mp.mpf(1)))), m)
    start *= mp.sign(-across[0]) or 1  # dθ/dt = ω_1 at the node

    def angles(t: mp.mpf) -> tuple[mp.mpf, mp.mpf, mp.mpf]:
        u = rate * t + start
        am = _amplitude(u, m)
        up = mp.ellippi(-(u2 - u1) / (1 + u1), am, m) / (1 + u1)
        down = mp.ellippi((u2 - u1) / (1 - u1), am, m) / (1 - u1)
        phi = ((a + b) * up + (b - a) * down) / (2 * rate)
        psi = (spin - a) * t + ((a + b) * up - (b - a) * down) / (2 * rate)
        return u1 + (u2 - u1) * mp.ellipfun("sn", u, m=m) ** 2, phi, psi

    _, phi0, psi0 = angles(mp.mpf(0))
    return [
        (cosine_t, phi - phi0, psi - psi0)
        for cosine_t, phi, psi in (angles(mp.mpf(t)) for t in times)
    ]
