"""How far a small change of the state has grown: what rounding errors may have become.

The tangent map M(t) takes a small change of the initial state to the change at time t, the
attitude's as a rotation vector in body axes, ω's in units of `rate`. A rounding error made at time
s reaches t as ``M(t) M(s)⁻¹``, so n steps that each err by a few eps leave, to first order,

    ``|error(t_n)| <= c eps n growth(t_n)``, ``growth(t) = sup_{s<=t} |M(t) M(s)⁻¹|``

with c the roundings of one step. Norms are spectral.

M(t) itself would not do: near a separatrix it squeezes one direction as much as it stretches
another, and its inverse, taken from any difference of runs, is lost in rounding.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from omegadot.reference_impl.one_body.body_motion import attitude_motion
from omegadot.reference_impl.rotations import rotation_between, turn_in_body
from omegadot.reference_impl.schemes import SCHEMES
from omegadot.reference_impl.schemes.jacobian import acceleration_and_jacobian
from omegadot.reference_impl.system import Array, State, System

MOST_STARTS = 64  # instants s that the supremum is taken over, spread over the samples
# a tenth of a radian a step: Runge-Kutta is then good to 1e-5, plenty for a bound
STEPS_A_RADIAN = 10
MOST_STEPS = 4096  # between two samples
EPS = float(np.finfo(float).eps)


def changes(before: State, after: State, rate: float) -> Array:
    """From one state to another as a vector (..., 6): turn in body axes, then Δω / rate."""
    turn = rotation_between(before.orientation, after.orientation)
    spin = (after.angular_velocity - before.angular_velocity) / rate
    return np.concatenate((turn, spin), axis=-1)


def growth_along(system: System, times: Array, states: State, rate: float) -> Array:
    """Growth at each sample, (n,), of the exact motion's tangent along given states.

    times: (n,) s.  states: (n,), a trajectory at these times, such as an engine's or the truth.
    From each sample twelve neighbours move to the next by Runge-Kutta steps; the maps between
    samples, each well conditioned, are then multiplied up, so that the growth may be as large as
    it will. Infinite from the first state on that is not finite, or turns so far to the next sample
    that its neighbours cannot be followed there in MOST_STEPS: a trajectory that has blown up, or a
    damping that stops the body in far less than the time between samples. Infinite as well from
    where its square leaves the range of doubles: long before, nothing of the start is left.
    """
    w = states.angular_velocity
    finite = np.all(np.isfinite(w), axis=-1) & np.all(np.isfinite(states.orientation), axis=-1)
    with np.errstate(over="ignore", invalid="ignore"):
        spans = np.abs(np.diff(times, append=times[-1]))
        turns = spans * np.max(np.abs(w), axis=-1)
        followed = finite & (STEPS_A_RADIAN * turns <= MOST_STEPS)
    count = len(times) if np.all(followed) else int(np.argmin(followed))
    with np.errstate(over="ignore", invalid="ignore"):
        maps = _maps_between(system, np.asarray(times)[:count], states, rate)
    known = np.all(np.isfinite(maps), axis=(-1, -2))
    count = count if np.all(known) else int(np.argmin(known)) + 1
    starts = _starts(count)
    found = np.full(len(times), np.inf)
    products = np.empty((len(starts), 6, 6))
    start = 0
    for n in range(count):
        if n:
            with np.errstate(over="ignore", invalid="ignore"):
                products[:start] = maps[n - 1] @ products[:start]
        if start < len(starts) and starts[start] == n:
            products[start] = np.eye(6)
            start += 1
        found[n] = max(1.0, _largest(products[:start]))
        if not np.isfinite(found[n]):
            break
    return found


def _maps_between(system: System, times: Array, states: State, rate: float) -> Array:
    """The tangent maps from each sample to the next, (n - 1, 6, 6), by central differences."""
    spans = np.diff(times)
    delta = EPS ** (1 / 3)  # central differences: curvature delta^2 against rounding eps / delta
    axes = delta * np.concatenate((np.eye(6), -np.eye(6)))
    q, w = states.orientation[: len(spans)], states.angular_velocity[: len(spans)]
    motion = attitude_motion(system)
    w_dot, jacobian = acceleration_and_jacobian(motion, q, w)
    rates = (  # 1/s: turning, the loads' pull, damping and the gyroscopic term
        np.max(np.abs(w), axis=-1),
        np.sqrt(np.max(np.abs(w_dot), axis=-1)),
        np.max(np.abs(jacobian), axis=(-1, -2)),
    )
    fastest = STEPS_A_RADIAN * np.max(np.abs(spans) * np.maximum.reduce(rates), initial=0.1)
    steps = int(np.ceil(min(fastest, MOST_STEPS)))
    q, w = turn_in_body(q[:, None], axes[:, :3], 1.0), w[:, None] + rate * axes[:, 3:]
    h = np.broadcast_to(spans[:, None, None], (len(spans), 12, 1)) / steps
    for _ in range(steps):
        q, w = SCHEMES["lie-rk4"].step(motion, q, w, h)
    turn, spin = rotation_between(q[:, 6:], q[:, :6]), (w[:, :6] - w[:, 6:]) / rate
    maps: Array = np.swapaxes(np.concatenate((turn, spin), axis=-1), -1, -2) / (2 * delta)
    return maps


def _starts(count: int) -> NDArray[np.intp]:
    return np.unique(np.linspace(0, count - 1, min(count, MOST_STARTS)).round().astype(int))


def _largest(matrices: Array) -> float:
    """The largest spectral norm of (m, 6, 6), of the one whose sum of squares is largest.

    The sum of squares bounds the norm within a factor of the root of six and is far cheaper.
    Infinite where one is not finite.
    """
    with np.errstate(over="ignore", invalid="ignore"):
        squares = np.einsum("mij,mij->m", matrices, matrices)
    if not np.all(np.isfinite(squares)):
        return float("inf")
    return float(np.linalg.norm(matrices[int(np.argmax(squares))], 2))
