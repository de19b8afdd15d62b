"""Known schemes with one slip in them, as they are written by mistake."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from itertools import permutations

import numpy as np

from omegadot.diagnosis.stepping.explicit_schemes import drift_first, scheme_named, straight
from omegadot.diagnosis.stepping.on_quaternion import Rate, Rows, at_unit, on_quaternion
from omegadot.diagnosis.stepping.slips.tableau_slips import tableau_slips, wrong_signs
from omegadot.diagnosis.stepping.slips.unit_slips import unit_slips
from omegadot.reference_impl.rotations import quaternion_product
from omegadot.reference_impl.schemes import Motion, Scheme
from omegadot.reference_impl.schemes.scheme import Step
from omegadot.reference_impl.system import Array

HALF_TURNS = np.eye(4)  # no turn, and half a turn about each axis: they leave no vector in the mean
CLASSIC: Rows = ((), (0.5,), (0.0, 0.5), (0.0, 0.0, 1.0))
AT_START = (0, 0, 0, 0)


def _by_square(motion: Motion, q: Array, v: Array) -> Array:
    """The rotation matrix is of the quaternion's squares: world loads are |q|^2 too long."""
    unit, size = _unit(motion, q)
    loose = sum(motion.acceleration(_turned(unit, turn), v) for turn in HALF_TURNS) / 4.0
    return np.asarray(loose + size * (motion.acceleration(unit, v) - loose))


def _by_rest(motion: Motion, q: Array, v: Array) -> Array:
    """The rotation matrix is one and what the quaternion's vector part adds, |q|^2 too long."""
    unit, size = _unit(motion, q)
    still = np.concatenate((unit[..., :-4], 0.0 * unit[..., -4:] + HALF_TURNS[0]), axis=-1)
    rest = motion.acceleration(still, v)
    return np.asarray(rest + size * (motion.acceleration(unit, v) - rest))


def _unit(motion: Motion, q: Array) -> tuple[Array, Array]:
    """The place with a unit quaternion, and the square of the length that it had."""
    return motion.normalize(q), np.sum(q[..., -4:] ** 2, axis=-1, keepdims=True)


def _turned(q: Array, turn: Array) -> Array:
    turned = quaternion_product(turn + 0.0 * q[..., -4:], q[..., -4:])
    return np.concatenate((q[..., :-4], turned), axis=-1)


def _classical(
    weights: Sequence[float] = (1 / 6, 1 / 3, 1 / 3, 1 / 6),
    loads_of: Sequence[int] = (),
    rates_of: Sequence[int] = (),
    rate: Rate = at_unit,
    **changed: Sequence[float],
) -> Step:
    """The classical method, but for its weights, for its rows ``a2``, ``a3`` or ``a4``, or more.

    See `on_quaternion`.
    """
    rows = tuple(changed.get(f"a{k + 1}", row) for k, row in enumerate(CLASSIC))
    return on_quaternion(rows, weights, loads_of, rates_of, rate)


RUNGE_KUTTA: dict[str, Step] = {
    "its second stage is taken at the whole step": _classical(a2=(1.0,)),
    "its third stage is taken at the whole step": _classical(a3=(0.0, 1.0)),
    "its third stage starts from the first slope": _classical(a3=(0.5, 0.0)),
    "its fourth stage is taken at half the step": _classical(a4=(0.0, 0.0, 0.5)),
    "its fourth stage starts from the second slope": _classical(a4=(0.0, 1.0, 0.0)),
    "its fourth stage starts from the first slope": _classical(a4=(1.0, 0.0, 0.0)),
    "its four slopes have equal weights": _classical(weights=(0.25,) * 4),
    "its weights are 2, 1, 1, 2": _classical(weights=(1 / 3, 1 / 6, 1 / 6, 1 / 3)),
    "its weights are 1, 3, 3, 1": _classical(weights=(1 / 8, 3 / 8, 3 / 8, 1 / 8)),
    "its weights are 1, 4, 0, 1": _classical(weights=(1 / 6, 2 / 3, 0.0, 1 / 6)),
    "its weights are 1, 0, 4, 1": _classical(weights=(1 / 6, 0.0, 2 / 3, 1 / 6)),
    "its second slope alone is used": _classical(weights=(0.0, 1.0, 0.0, 0.0)),
    "its third slope alone is used": _classical(weights=(0.0, 0.0, 1.0, 0.0)),
    "the mean of its first and last slopes is used": _classical(weights=(0.5, 0.0, 0.0, 0.5)),
    "its first slope alone is used: explicit Euler on the quaternion": _classical(
        weights=(1.0, 0.0, 0.0, 0.0)
    ),
    "the loads are held at the attitude of the step's start": _classical(loads_of=AT_START),
    "its fourth stage takes the loads at the attitude of its third": _classical(
        loads_of=(0, 1, 2, 2)
    ),
    "its third stage takes the loads at the attitude of its second": _classical(
        loads_of=(0, 1, 1, 3)
    ),
    "each stage takes the loads at the attitude of the stage before": _classical(
        loads_of=(0, 0, 1, 2)
    ),
    "its stages take the loads at a quaternion that is not made unit": _classical(rate=_by_square),
    "its stages take the loads at a quaternion that is not made unit (as 1 + 2 (...))": (
        _classical(rate=_by_rest)
    ),
    "omega-dot is held in the step at that of its start": _classical(rates_of=AT_START),
    **{
        text: on_quaternion(rows, (1 / 6, 1 / 3, 1 / 3, 1 / 6))
        for text, rows in wrong_signs(CLASSIC)
    },
}


def _explicit(motion: Motion, q: Array, v: Array, h: float | Array) -> tuple[Array, Array]:
    return motion.retract(q, h * v), v + h * motion.acceleration(q, v)


def _mean_velocity(motion: Motion, q: Array, v: Array, h: float | Array) -> tuple[Array, Array]:
    after = v + h * motion.acceleration(q, v)
    return motion.retract(q, 0.5 * h * (v + after)), after


def _mean_omega(motion: Motion, q: Array, v: Array, h: float | Array) -> tuple[Array, Array]:
    after = v + h * motion.acceleration(q, v)
    mean = 0.5 * (v + after)[..., -3:]
    return motion.retract(q, h * np.concatenate((after[..., :-3], mean), axis=-1)), after


def _mean_place(motion: Motion, q: Array, v: Array, h: float | Array) -> tuple[Array, Array]:
    after = v + h * motion.acceleration(q, v)
    mean = 0.5 * (v + after)[..., :-3]
    return motion.retract(q, h * np.concatenate((mean, after[..., -3:]), axis=-1)), after


def _old_omega(motion: Motion, q: Array, v: Array, h: float | Array) -> tuple[Array, Array]:
    after = v + h * motion.acceleration(q, v)
    mixed = np.concatenate((after[..., :-3], v[..., -3:]), axis=-1)
    return motion.retract(q, h * mixed), after


def _old_velocity(motion: Motion, q: Array, v: Array, h: float | Array) -> tuple[Array, Array]:
    after = v + h * motion.acceleration(q, v)
    mixed = np.concatenate((v[..., :-3], after[..., -3:]), axis=-1)
    return motion.retract(q, h * mixed), after


def _by_third_order(motion: Motion, q: Array, v: Array, h: float | Array) -> tuple[Array, Array]:
    """``1 - a^2/8`` and ``1/2 - a^2/48``, a the turn in rad; the second order ends any step."""
    v = v + h * motion.acceleration(q, v)
    turn = h * v[..., -3:]
    square = np.sum(turn * turn, axis=-1, keepdims=True)
    quaternion = np.concatenate((1.0 - square / 8.0, (0.5 - square / 48.0) * turn), axis=-1)
    turned = quaternion_product(q[..., -4:], quaternion)
    places = motion.retract(q, h * v)[..., :-4]
    return motion.normalize(np.concatenate((places, turned), axis=-1)), v


def _in_place(order: Sequence[int]) -> Step:
    """Each component of omega by an omega-dot of those that have moved before it."""

    def step(motion: Motion, q: Array, v: Array, h: float | Array) -> tuple[Array, Array]:
        after = v + h * motion.acceleration(q, v)
        after[..., -3:] = v[..., -3:]
        for k in order:
            rate = motion.acceleration(q, after)[..., -3:]
            after[..., -3:] += np.where(np.arange(3) == k, h * rate, 0.0)
        return motion.retract(q, h * after), after

    return step


# What states less comes first: on many bodies the velocity of translation is constant.
EULER: dict[str, Step] = {
    "the attitude moves by the omega of the step's start": _old_omega,
    "the position moves by the velocity of the step's start": _old_velocity,
    "attitude and position move by the velocities of the step's start (explicit Euler)": _explicit,
    "attitude and position move first, by the velocities of the step's start": drift_first,
    "the attitude moves by the mean of the omega before and after": _mean_omega,
    "the position moves by the mean of the velocities before and after": _mean_place,
    "attitude and position move by the mean of the velocities before and after": _mean_velocity,
    "the attitude moves by one straight step of the quaternion, normalised": straight,
    "the turn of a step is taken by the third-order series of the exponential": _by_third_order,
    **{
        "omega is changed in place, its components in the order "
        f"{', '.join('xyz'[k] for k in order)}: each with those that are new already": (
            _in_place(order)
        )
        for order in permutations(range(3))
    },
}
OF_SCHEME = {"rk4-quaternion": RUNGE_KUTTA, "semi-implicit-euler": EULER, **tableau_slips()}
# Their steps end with a quaternion that is made unit.
ON_QUATERNION = [name for name in OF_SCHEME if "quaternion" in name]
for _name in ON_QUATERNION:
    OF_SCHEME[_name] = {**OF_SCHEME[_name], **unit_slips(scheme_named(_name).step)}


def slipped(name: str) -> dict[str, Scheme]:
    """The schemes that a slip makes of a known one, by what is wrong."""
    steps = OF_SCHEME.get(name, {})
    return {text: replace(scheme_named(name), step=step) for text, step in steps.items()}
