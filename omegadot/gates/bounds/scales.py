"""The sizes that errors are measured against, and the rounding that a sound engine may show.

Every bound here is floating point and physics: a count of roundings times eps times the size of
the terms that were added to make the answer. Nothing is tuned.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from omegadot.reference_impl.formed_once import formed_once
from omegadot.reference_impl.inertia import moving_inertia
from omegadot.reference_impl.loads import gravity_torque
from omegadot.reference_impl.symmetric import apply
from omegadot.reference_impl.system import Acceleration, Array, State, System

EPS = float(np.finfo(float).eps)
# A forward or inverse dynamics pass is a chain of about 64 dependent roundings (two changes of
# frame, two cross products, a 3x3 or 6x6 solve).
ROUNDINGS_PER_EVALUATION = 64
# A reader of robot files turns the tensor by the inertial frame's angles and diagonalises it: by
# Jacobi's rotations that is five sweeps of three, each of four roundings, on both of its sides.
ROUNDINGS_OF_A_READER = 128
# A step is an evaluation's result, scaled and added, an exponential and a normalised product.
ROUNDINGS_PER_STEP = 16


def eps_of(precision: str) -> float:
    """From 1 to the next number of "float64" (2^-52) or "float32" (2^-23): what rounding counts in.

    A number that is rounded on its way into an engine, or at the end of a step, is off by half of
    it. Every bound here is in proportion to it.
    """
    return float(np.finfo(np.dtype(precision)).eps)


def norm(vectors: Array) -> Array:
    """Euclidean length over the last axis, (..., n) to (...)."""
    length: Array = np.sqrt(np.add.reduce(vectors * vectors, -1))
    return length


@dataclass(frozen=True)
class BodyScale:
    """Sizes of one system.

    lever: m, how far the engine's own reference points may lie from the centre of mass.
    largest: kg m^2, the largest inertia that enters a sum, about those points.
    smallest: kg m^2, the least eigenvalue of the inertia that is inverted.
    """

    mass: float
    lever: float
    largest: float
    smallest: float


@formed_once
def body_scale(system: System) -> BodyScale:
    """The sizes of `system`; the inverted inertia is about the pivot, if there is one."""
    body, pivot = system.body, system.load.pivot
    mass = float(body.mass)
    lever = float(norm(body.center_of_mass))
    if pivot is not None:
        lever += float(norm(pivot))
    moments = np.linalg.eigvalsh(np.asarray(moving_inertia(system), dtype=float))
    own = float(np.linalg.eigvalsh(np.asarray(body.inertia, dtype=float))[-1])
    return BodyScale(mass, lever, max(own + mass * lever**2, float(moments[-1])), float(moments[0]))


def omega_dot_bound(system: System, eps: float) -> float:
    """``64 eps cond``: what omega-dot may be off by, in parts of ``S / J``.

    S is `torque_size`, ``cond = J / lambda``, J the largest inertia and lambda the least moment
    that is inverted: an engine that inverts the inertia cannot do better.
    """
    scale = body_scale(system)
    return ROUNDINGS_PER_EVALUATION * eps * (scale.largest / scale.smallest)


def torque_size(system: System, state: State, acceleration: Acceleration) -> Array:
    """(...) N m: the terms of equation (8) added up by size, with what cancels among them.

    ``J (|omega|^2 + |omega_dot|) + sum |tau_i| + m L (|g| + |a|)``, J the largest inertia, L the
    lever of `body_scale`, and tau_i the weight's torque, damping and each applied torque: at its
    terminal rate they cancel, and leave the roundings of each. For a free body also
    ``m |v| (|v| + L |omega|)``: the spatial bias force of an engine holds ``v x m v``, which
    vanishes on paper and leaves its rounding; and ``m |x| |a - g|``: a lever that is the difference
    of two places in the world is off by a rounding of x, and the force ``m (a - g)`` acts on it.
    """
    scale, load = body_scale(system), system.load
    rate = norm(state.angular_velocity)
    size = scale.largest * (rate**2 + norm(acceleration.angular)) + load.damping * rate
    size = size + norm(load.torque_body) + norm(load.torque_world)
    size = size + norm(gravity_torque(system, state))
    size = size + scale.mass * scale.lever * (norm(load.gravity) + norm(acceleration.linear))
    if load.pivot is None:
        speed = norm(state.linear_velocity)
        size = size + scale.mass * speed * (speed + scale.lever * rate)
        force = scale.mass * norm(acceleration.linear - load.gravity)
        size = size + norm(state.position) * force
    return np.asarray(size)


def products_in_momentum(system: System, omega: Array) -> Array:
    """(...) kg m^2/s: ``|J| |omega|`` of absolute values, the products that J omega is the sum of.

    Along the principal axes they are J omega; in other axes they may cancel, and leave the
    roundings of each. omega: (..., 3), body axes.
    """
    return norm(apply(np.abs(moving_inertia(system)), np.abs(omega)))


def momentum_of_place(system: System, state: State) -> Array:
    """(...) kg m^2/s: ``m |x| |v|``, what the place of a free body adds to its angular momentum.

    An engine that steps the momentum about the world's origin takes omega from the rest of it.
    """
    free = system.load.pivot is None
    size = norm(state.position) * norm(state.linear_velocity)
    return np.asarray(body_scale(system).mass * size * free)


def stays_on_ellipsoids(
    system: System, omega: Array, start: Array, steps: Array, eps: float
) -> Array:
    """(...) whether omega keeps the energy of rotation and the |J omega| of its start to rounding.

    omega: (..., n, 3).  start: (..., 3).  steps: (n,), how many have been taken from there.  None
    counts in single precision, where every sound scheme does so for long.
    """
    inertia, largest = moving_inertia(system), body_scale(system).largest
    with np.errstate(over="ignore", invalid="ignore"):
        (momentum, now), (first, then) = (
            (turning, np.sum(turning * w, axis=-1))
            for w in (omega, start[..., None, :])
            for turning in (apply(inertia, w),)
        )
        size = ROUNDINGS_PER_STEP * eps * (steps + 1.0) * largest * norm(start)[..., None]
        kept = np.abs(now - then) <= size * norm(start)[..., None]
        kept &= np.abs(norm(momentum) - norm(first)) <= size
    return np.asarray(np.all(kept, axis=-1) & (eps <= EPS))


def between_ellipsoids(system: System, omega: Array, eps: float) -> tuple[Array, Array]:
    """(n, 3) and (n,): the direction in which energy and momentum leave omega open, and by how
    many roundings of its size.

    Without a torque a scheme may put omega back on the ellipsoids of its energy and of |J omega|.
    Their normals are J omega and J^2 omega. Where these lie at an angle a, a rounding of either
    moves omega by 1 / sin a roundings, along the one ellipsoid towards the other. No rounding where
    a torque acts, nor where sin^2 a is below eps: the two conditions are one there.
    """
    load = system.load
    torques = (load.torque_body, load.torque_world, np.asarray(load.damping))
    weight = load.pivot is not None and bool(np.any(load.gravity))
    free = not weight and not any(np.any(one) for one in torques)
    inertia = moving_inertia(system)
    normal = apply(inertia, omega)
    other = apply(inertia, normal)
    with np.errstate(all="ignore"):
        normal = normal / norm(normal)[..., None]
        other = other / norm(other)[..., None]
        across = other - normal * np.sum(other * normal, axis=-1)[..., None]
        sine = norm(across)
        apart = (sine**2 > eps) & free
        direction = np.where(apart[..., None], across / sine[..., None], 0.0)
        return direction, np.where(apart, 1.0 / sine, 0.0)


def angular_size(system: System, state: State, acceleration: Acceleration) -> Array:
    """(...) rad/s^2: `torque_size` through the inverse of the inertia at its largest."""
    return np.asarray(torque_size(system, state, acceleration) / body_scale(system).smallest)


def linear_size(
    system: System, state: State, acceleration: Acceleration, eps: float = EPS
) -> Array:
    """(...) m/s^2: the terms of the centre of mass's acceleration, added up by size.

    The lever of a free body may be the difference of two places in the world, which is off by a
    rounding of x. It turns with the body, and its rounding counts at rest as well.
    """
    rate, lever = norm(state.angular_velocity), np.asarray(body_scale(system).lever)
    turns = np.zeros_like(rate)
    if system.load.pivot is None:
        place = norm(state.position)
        lever = lever + eps * place
        turns = place * (rate**2 + norm(acceleration.angular))
    turning = turns + lever * (rate**2 + angular_size(system, state, acceleration))
    moving = rate * norm(state.linear_velocity)
    return np.asarray(norm(acceleration.linear) + norm(system.load.gravity) + turning + moving)
