"""What wrong steppers make of the end of a step: ``end(before, after, h) -> state``."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from omegadot.gates.bounds.scales import norm
from omegadot.reference_impl.inertia import moving_inertia
from omegadot.reference_impl.rotations import (
    conjugate,
    normalize,
    quaternion_product,
    rotation_between,
    turn_in_body,
)
from omegadot.reference_impl.schemes import Motion, Scheme
from omegadot.reference_impl.symmetric import apply, inverse
from omegadot.reference_impl.system import Array, State, System

End = Callable[[State, State, float | Array], State]


def with_end(scheme: Scheme, end: End) -> Scheme:
    """A scheme whose every step ends in ``end(before, after, h)`` instead of ``after``.

    The states are those of the coordinates that are stepped: position and linear velocity are what
    stands there, and on a pivot they are empty.
    """

    def step(motion: Motion, q: Array, v: Array, h: float | Array) -> tuple[Array, Array]:
        ended = end(_kept(q, v), _kept(*scheme.step(motion, q, v, h)), h)
        return (
            np.concatenate((ended.position, ended.orientation), axis=-1),
            np.concatenate((ended.linear_velocity, ended.angular_velocity), axis=-1),
        )

    return replace(scheme, step=step)


def _kept(q: Array, v: Array) -> State:
    return State(q[..., -4:], v[..., -3:], q[..., :-4], v[..., :-3])


def left_multiplied(before: State, after: State, dt: float | Array) -> State:
    """The attitude's change in body axes from the left: ``dq q`` for ``q dq``."""
    q = normalize(before.orientation)
    change = quaternion_product(conjugate(q), after.orientation)
    return replace(after, orientation=quaternion_product(change, q))


def straight_quaternion(before: State, after: State, dt: float | Array) -> State:
    """``q + h/2 q omega``, never normalised."""
    w, h = after.angular_velocity, dt
    pure = np.concatenate([np.zeros_like(w[..., :1]), 0.5 * w], axis=-1)
    q = before.orientation
    return replace(after, orientation=q + h * quaternion_product(q, pure))


def turned_by_last_omega(before: State, after: State, dt: float | Array) -> State:
    """``q exp(h omega)`` with the omega at the end of the step."""
    turned = turn_in_body(before.orientation, after.angular_velocity, dt)
    return replace(after, orientation=turned)


def turn_within(angle: float) -> End:
    """The turn of the step is cut at an angle in rad."""

    def end(before: State, after: State, dt: float | Array) -> State:
        turn = rotation_between(before.orientation, after.orientation)
        turned = turn_in_body(before.orientation, _shortened(turn, angle), 1.0)
        short = norm(turn)[..., None] <= angle
        return replace(after, orientation=np.where(short, after.orientation, turned))

    return end


def second_order_turn(before: State, after: State, dt: float | Array) -> State:
    """The turn of the step by the exponential's series to second order, made unit."""
    turn = rotation_between(before.orientation, after.orientation)
    first = 1.0 - 0.125 * np.sum(turn * turn, axis=-1, keepdims=True)
    short = normalize(np.concatenate([first, 0.5 * turn], axis=-1))
    return replace(after, orientation=quaternion_product(before.orientation, short))


def single_trigonometry(of_angle: bool) -> End:
    """Sine and cosine of the turn of the step in single precision, the quaternion made unit.

    of_angle: of half the angle rounded so; else the two are rounded alone.
    """

    def end(before: State, after: State, dt: float | Array) -> State:
        turn = rotation_between(before.orientation, after.orientation)
        size = norm(turn)[..., None]
        half = (0.5 * size).astype(np.float32) if of_angle else 0.5 * size
        cosine, sine = (f(half).astype(np.float32).astype(float) for f in (np.cos, np.sin))
        axis = turn / np.where(size > 0.0, size, 1.0)
        turned = normalize(np.concatenate((cosine, sine * axis), axis=-1))
        return replace(after, orientation=quaternion_product(before.orientation, turned))

    return end


def single_precision(before: State, after: State, dt: float | Array) -> State:
    """Every number rounded to single precision."""
    return State(*(f.astype(np.float32).astype(float) for f in vars(after).values()))


def _of_omega(change: Callable[[Array], Array]) -> End:
    """Omega is changed at the end of a step, and nothing else."""

    def end(before: State, after: State, dt: float | Array) -> State:
        return replace(after, angular_velocity=change(after.angular_velocity))

    return end


def asleep_below(rate: float) -> End:
    """Omega is zero below a rate in rad/s."""
    return _of_omega(lambda w: np.where(norm(w)[..., None] < rate, 0.0, w))


def clipped_at(rate: float) -> End:
    """Each component of omega is held within a rate in rad/s."""
    return _of_omega(lambda w: np.clip(w, -rate, rate))


def _shortened(vectors: Array, length: float) -> Array:
    with np.errstate(divide="ignore"):
        return np.asarray(vectors * np.minimum(1.0, length / norm(vectors)[..., None]))


def held_below(rate: float) -> End:
    """Omega is scaled down to a rate in rad/s."""
    return _of_omega(lambda w: _shortened(w, rate))


def kept_ends(system: System) -> dict[str, End]:
    """Omega is rescaled after each step, so that something of it keeps its value."""
    inertia = moving_inertia(system)
    sizes: dict[str, Callable[[Array], Array]] = {
        "its size": norm,
        "the kinetic energy of rotation": lambda w: np.sqrt(np.sum(w * apply(inertia, w), -1)),
        "the size of the angular momentum": lambda w: norm(apply(inertia, w)),
    }

    def by(size: Callable[[Array], Array]) -> End:
        def end(before: State, after: State, dt: float | Array) -> State:
            w = after.angular_velocity
            # at rest there is nothing to scale
            own = np.where(size(w) > 0.0, size(w), 1.0)
            scaled = w * (size(before.angular_velocity) / own)[..., None]
            return replace(after, angular_velocity=scaled)

        return end

    return {
        f"omega is rescaled after each step, so that {what} stays the same": by(size)
        for what, size in sizes.items()
    }


def speed_below(speed: float) -> End:
    """The linear velocity is scaled down to a speed in m/s."""

    def end(before: State, after: State, dt: float | Array) -> State:
        return replace(after, linear_velocity=_shortened(after.linear_velocity, speed))

    return end


def damping_ends(system: System) -> dict[str, End]:
    """Ends of a step in which the damping, left out of the rest of it, acts by itself."""
    ratio = np.asarray(inverse(moving_inertia(system)), dtype=float) * float(system.load.damping)
    rates, axes = np.linalg.eigh(ratio)

    def by(share: Callable[[Array], Array]) -> End:
        def end(before: State, after: State, h: float | Array) -> State:
            matrix = (axes * share(rates * np.max(h))) @ axes.T
            return replace(after, angular_velocity=apply(matrix, after.angular_velocity))

        return end

    return {
        "after the rest of it, by an explicit step": by(lambda x: 1.0 - x),
        "after the rest of it, by its exponential": by(lambda x: np.exp(-x)),
        "after the rest of it, by an implicit step": by(lambda x: 1.0 / (1.0 + x)),
    }
