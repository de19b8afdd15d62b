"""Right accelerations that are reported otherwise, or of states that were misread on the way in."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import partial

import numpy as np

from omegadot.diagnosis.equations.evidence import Evidence
from omegadot.diagnosis.equations.gyroscopic_terms import wrong_products
from omegadot.diagnosis.equations.operators.operands import gyroscopic, pushed
from omegadot.diagnosis.equations.operators.operands import turned as turned_by
from omegadot.diagnosis.equations.other_attitudes import other_attitudes
from omegadot.diagnosis.equations.turned_inertia import turned_inertias
from omegadot.diagnosis.models.misreadings import OF_ANY_STATE, Misreading
from omegadot.gates.bounds.scales import norm
from omegadot.reference_impl.cross_product import cross
from omegadot.reference_impl.inertia import lever, moving_inertia
from omegadot.reference_impl.kinematics import place_on_pivot
from omegadot.reference_impl.loads import applied_torque, gravity_torque
from omegadot.reference_impl.motion import forward_dynamics
from omegadot.reference_impl.rotations import rotate, rotate_inverse, rotation_between
from omegadot.reference_impl.symmetric import apply, inverse
from omegadot.reference_impl.system import Acceleration, Array, State, System


@dataclass(frozen=True)
class Reading:
    """One way to misread a state, or to report an acceleration."""

    text: str
    accelerations: Callable[[Evidence], Acceleration]


def _reported() -> Iterator[Reading]:
    def turned(e: Evidence) -> Acceleration:
        return Acceleration(rotate(e.states.orientation, e.true.angular), e.true.linear)

    def back(e: Evidence) -> Acceleration:
        return Acceleration(rotate_inverse(e.states.orientation, e.true.angular), e.true.linear)

    def negative(e: Evidence) -> Acceleration:
        return Acceleration(-e.true.angular, e.true.linear)

    def in_body(e: Evidence) -> Acceleration:
        return Acceleration(e.true.angular, rotate_inverse(e.states.orientation, e.true.linear))

    def upwards(e: Evidence) -> Acceleration:
        return Acceleration(e.true.angular, -e.true.linear)

    def of_world_omega(e: Evidence) -> Acceleration:
        w = e.states.angular_velocity
        inertia, turned = moving_inertia(e.system), rotate(e.states.orientation, w)
        more = cross(w, apply(inertia, w)) - cross(turned, apply(inertia, turned))
        return pushed(e, more)

    def torque_back(e: Evidence) -> Acceleration:
        wanted = e.system.load.torque_world
        q = e.states.orientation
        return pushed(e, rotate(q, wanted) - rotate_inverse(q, wanted))

    def torque_of_first(e: Evidence) -> Acceleration:
        wanted, q = e.system.load.torque_world, e.states.orientation
        return pushed(e, rotate_inverse(0.0 * q + q[:1], wanted) - rotate_inverse(q, wanted))

    def gravity_of_first(e: Evidence) -> Acceleration:
        q, pull = e.states.orientation, e.system.load.gravity * e.system.body.mass
        more = rotate_inverse(0.0 * q + q[:1], pull) - rotate_inverse(q, pull)
        held = e.system.load.pivot is not None
        return pushed(e, cross(lever(e.system), more) if held else 0 * more)

    def gravity_back(e: Evidence) -> Acceleration:
        """On a pivot; a free body's centre of mass falls without being turned."""
        q, pull = e.states.orientation, e.system.load.gravity * e.system.body.mass
        more = cross(lever(e.system), rotate(q, pull) - rotate_inverse(q, pull))
        return pushed(e, more if e.system.load.pivot is not None else 0 * more)

    def damped(power: int, each: bool) -> Callable[[Evidence], Acceleration]:
        """By a power of omega, of each component or of its size, instead of omega itself."""

        def there(e: Evidence) -> Acceleration:
            w, d = e.states.angular_velocity, float(e.system.load.damping)
            size = np.abs(w) if each else norm(w)[:, None]
            return pushed(e, d * (w - size ** (power - 1) * w))

        return there

    for power, named in ((2, "square"), (3, "cube")):
        yield Reading(f"the damping goes with the {named} of |omega|", damped(power, each=False))
        yield Reading(
            f"the damping goes with the {named} of each component of omega",
            damped(power, each=True),
        )

    def rescaled(weight: Callable[[System, Array], Array]) -> Callable[[Evidence], Acceleration]:
        """Without what would change the size of something that is quadratic in omega."""

        def there(e: Evidence) -> Acceleration:
            w, a = e.states.angular_velocity, e.true.angular
            due = weight(e.system, w)
            size = np.sum(due * w, axis=-1, keepdims=True)
            part = np.sum(due * a, axis=-1, keepdims=True) / np.where(size > 0.0, size, 1.0)
            return turned_by(e, a - part * w)

        return there

    kept: dict[str, Callable[[System, Array], Array]] = {
        "its size": lambda s, w: w,
        "the kinetic energy of rotation": lambda s, w: apply(moving_inertia(s), w),
        "the size of the angular momentum": lambda s, w: apply(
            moving_inertia(s), apply(moving_inertia(s), w)
        ),
    }
    for what, weight in kept.items():
        yield Reading(f"omega is rescaled so that {what} stays the same", rescaled(weight))
    yield Reading("the gyroscopic term is formed with omega in world axes", of_world_omega)
    yield Reading(
        "the torque in world axes is turned into the body by the transposed rotation", torque_back
    )
    yield Reading("gravity is turned into the body by the transposed rotation", gravity_back)
    by_first = "is turned into the body by the attitude of a batch's first state"
    yield Reading(f"the torque in world axes {by_first}", torque_of_first)
    yield Reading(f"gravity {by_first}", gravity_of_first)
    yield Reading("omega-dot looks like world axes: it matches after R^T", turned)
    yield Reading("omega-dot looks turned twice: it matches after R", back)
    yield Reading("omega-dot has the wrong sign", negative)
    yield Reading("the linear acceleration looks like body axes: it matches after R", in_body)
    yield Reading("the linear acceleration has the wrong sign", upwards)
    yield Reading(
        "the linear acceleration is zero", lambda e: Acceleration(e.true.angular, 0 * e.true.linear)
    )


def _turned_by_series() -> Iterator[Reading]:
    """Loads in world axes by ``1 + [t]`` or ``1 + [t] + [t]^2 / 2``, t the turn of at most pi."""

    def turned(order: int, t: Array, load: Array) -> Array:
        once = cross(load + 0.0 * t, t)
        return np.asarray(load + once + (0.5 * cross(once, t) if order > 1 else 0.0))

    def made(order: int, e: Evidence) -> Acceleration:
        q, load = e.states.orientation, e.system.load
        t, pull = rotation_between(np.eye(1, 4), q), e.system.body.mass * load.gravity
        off, pulled = (
            turned(order, t, one) - rotate_inverse(q, one) for one in (load.torque_world, pull)
        )
        arm = lever(e.system) if load.pivot is not None else np.zeros(3)
        return pushed(e, off + cross(arm, pulled))

    for order, named in ((1, "first"), (2, "second")):
        text = f"loads in world axes are turned into the body by a series of the {named} order"
        yield Reading(text, partial(made, order))


def _not_solved() -> Iterator[Reading]:
    """A torque that is taken as a rate, or divided by the inertia twice."""
    terms: dict[str, Callable[[System, State], Array]] = {
        "the gyroscopic term": gyroscopic,
        "the applied torque": applied_torque,
        "the torque of gravity": gravity_torque,
    }

    def made(term: Callable[[System, State], Array], twice: bool, e: Evidence) -> Acceleration:
        inertia = moving_inertia(e.system)
        torque = term(e.system, e.states) + 0.0 * e.states.angular_velocity
        other = apply(inverse(inertia) if twice else np.asarray(inertia), torque)
        return pushed(e, other - torque)

    for what, term in terms.items():
        yield Reading(f"{what} is not divided by the inertia", partial(made, term, False))
        yield Reading(f"{what} is divided by the inertia twice", partial(made, term, True))


def _mixed() -> Iterator[Reading]:
    """The answers to several states in another order."""

    def transposed(e: Evidence) -> Acceleration:
        return Acceleration(e.true.angular.T.reshape(-1, 3), e.true.linear)

    def both(e: Evidence) -> Acceleration:
        return Acceleration(transposed(e).angular, e.true.linear.T.reshape(-1, 3))

    def reversed_(e: Evidence) -> Acceleration:
        return Acceleration(e.true.angular[::-1], e.true.linear[::-1])

    mixed = "of several states come out as a 3 x n array that is read as n x 3"
    yield Reading(f"the omega-dot {mixed}", transposed)
    yield Reading(f"omega-dot and the linear acceleration {mixed}", both)
    yield Reading("the answers to several states come in the opposite order", reversed_)


def _misread(one: Misreading) -> Iterator[Reading]:
    def there(e: Evidence) -> Acceleration:
        return forward_dynamics(e.system, place_on_pivot(e.system, one.right(e.states)))

    def turned(e: Evidence) -> Acceleration:
        found = there(e)
        return Acceleration(rotate(e.states.orientation, found.angular), found.linear)

    yield Reading(f"on the way in, {one.statement}", there)
    yield Reading(f"on the way in, {one.statement}, and omega-dot comes out in world axes", turned)


READINGS = (
    *_reported(),
    *_turned_by_series(),
    *_not_solved(),
    *_mixed(),
    *(Reading(text, made) for text, made in turned_inertias()),
    *(Reading(text, made) for text, made in wrong_products()),
    *(Reading(text, made) for text, made in other_attitudes()),
    *(reading for one in OF_ANY_STATE for reading in _misread(one)),
)
