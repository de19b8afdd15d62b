"""Whether double precision can hold a motion: the squares of its sizes, and the angle turned.

A length is the root of a sum of squares, so that a size s needs ``s^2`` among the normal numbers,
with the digits of an eps below it: ``(tiny / eps)^1/2 <= s <= max^1/2``. Sizes are kept a factor
of ``2^16`` within, because equations are evaluated at faster states too. Zero is exact.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from omegadot.reference_impl.inertia import lever, moving_inertia
from omegadot.reference_impl.system import Array, State, System
from omegadot.written import written

EPS = float(np.finfo(float).eps)
_MARGIN = 2.0**16
LEAST = float(np.sqrt(np.finfo(float).tiny / EPS)) * _MARGIN
MOST = float(np.sqrt(np.finfo(float).max)) / _MARGIN


class UnrepresentableError(ArithmeticError):
    """Double precision cannot hold the motion; the message is a clause that states why."""


def check_representable(system: System, initial: State, duration: float) -> None:
    """Raise UnrepresentableError where doubles cannot hold the terms of a motion from its start.

    Besides the range: of a lever L to the pivot the moment about it vanishes beside a rounding of
    ``m L^2`` where ``eps m L^2`` exceeds it. Leading axes are none.
    """
    with np.errstate(all="ignore"):
        for name, size, unit in _sizes(system, initial):
            _check_size(name, size, unit)
        own = float(np.linalg.eigvalsh(np.asarray(system.body.inertia, float))[0])
        moved = float(system.body.mass) * float(_length(lever(system))) ** 2
        if EPS * moved >= own:
            raise UnrepresentableError(
                f"about the pivot the mass has a moment of inertia of {written(moved, 2)} kg m^2, "
                f"and beside it double precision does not hold the body's own, {written(own, 2)}"
            )
        _check_turn(float(_length(initial.angular_velocity)), duration)


def check_solved(state: State, omega_dot: Array, times: Array) -> None:
    """Raise UnrepresentableError where a motion left what doubles hold on its way.

    state, omega_dot: (n,), at times (n,) s.
    """
    values = (*vars(state).values(), omega_dot)
    if not all(np.all(np.isfinite(value)) for value in values):
        raise UnrepresentableError("the motion leaves the range of numbers")
    with np.errstate(all="ignore"):
        fastest = float(np.max(_length(state.angular_velocity)))
        _check_size("omega-dot", float(np.max(_length(omega_dot))), "rad/s^2")
        _check_turn(fastest, float(np.max(np.abs(times))))


def _length(vectors: Array) -> Array:
    """By hypot, which has no square to lose."""
    return np.asarray(np.hypot.reduce(np.asarray(vectors, float), axis=-1))


def _sizes(system: System, initial: State) -> Iterator[tuple[str, float, str]]:
    """What lengths and products are taken of, with its name and unit."""
    body, load = system.body, system.load
    moments = np.linalg.eigvalsh(np.asarray(moving_inertia(system), float))
    mass, rate = float(body.mass), float(_length(initial.angular_velocity))
    arm, gravity = float(_length(lever(system))), float(_length(load.gravity))
    speed, place = (float(_length(v)) for v in (initial.linear_velocity, initial.position))
    yield "the angular velocity", rate, "rad/s"
    yield "the lever to the pivot", arm, "m"
    yield "the centre of mass", float(_length(body.center_of_mass)), "m"
    yield "gravity", gravity, "m/s^2"
    if load.pivot is None:
        yield "the linear velocity", speed, "m/s"
        yield "the position", place, "m"
        yield "the weight", mass * gravity, "N"
        yield "the linear momentum", mass * speed, "kg m/s"
        yield "the angular momentum about the world's origin", mass * speed * place, "kg m^2/s"
    yield "the angular momentum", float(moments[-1]) * rate, "kg m^2/s"
    torque = float(moments[-1]) * rate**2 + float(load.damping) * rate + mass * arm * gravity
    torque += float(_length(load.torque_body)) + float(_length(load.torque_world))
    yield "the torque", torque, "N m"
    least = float(moments[0])
    yield "omega-dot", torque / least if least > 0.0 else 0.0, "rad/s^2"


def _check_size(name: str, size: float, unit: str) -> None:
    if size == 0.0 or LEAST <= size <= MOST:
        return
    raise UnrepresentableError(
        f"{name} is {written(size, 2)} {unit}, and double precision does not hold its square"
    )


def _check_turn(rate: float, duration: float) -> None:
    """An eps of the rate is an eps of the angle, which is then a radian or more."""
    angle = rate * duration
    if EPS * angle >= 1.0:
        raise UnrepresentableError(
            f"the body turns by {written(angle, 2)} rad, and double precision holds "
            "no digit of where it then points"
        )
