"""What may be changed of an equation: its terms, what goes in, and what comes out."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace

import numpy as np

from omegadot.diagnosis.equations.evidence import Evidence
from omegadot.reference_impl.cross_product import cross
from omegadot.reference_impl.inertia import lever, moving_inertia
from omegadot.reference_impl.loads import (
    applied_torque,
    damping_torque,
    gravity_torque,
    weight,
)
from omegadot.reference_impl.motion import (
    center_of_mass_acceleration,
    forward_dynamics,
)
from omegadot.reference_impl.rotations import normalize, rotate_inverse, rotation_matrix
from omegadot.reference_impl.symmetric import apply
from omegadot.reference_impl.system import Acceleration, Array, State, System


@dataclass(frozen=True)
class Operand:
    """One vector or matrix, (n, 3), (n, 4) or (n, 9), of the right equation.

    of: its values at states.  put: the accelerations with others in its place.  came: the values in
    the engine, where they follow from what was found.  constant: the same at every state of a
    scenario.  reported: it does not move the body.  rounded: tried with rounding alone.  among: and
    with those of other states.
    """

    name: str
    unit: str
    of: Callable[[Evidence], Array]
    put: Callable[[Evidence, Array], Acceleration]
    came: Callable[[Evidence], Array] | None = None
    constant: bool = False
    reported: bool = False
    rounded: bool = False
    among: bool = False


def pushed(e: Evidence, torque: Array) -> Acceleration:
    """The right accelerations with one more torque, (n, 3) N m in body axes."""
    return turned(e, e.true.angular + apply(e.solve, torque))


def turned(e: Evidence, angular: Array) -> Acceleration:
    """The accelerations with this omega-dot, which a pivoted body's centre of mass follows."""
    if e.system.load.pivot is None:
        return Acceleration(angular, e.true.linear)
    return Acceleration(angular, center_of_mass_acceleration(e.system, e.states, angular))


def gyroscopic(system: System, states: State) -> Array:
    """``-omega x I omega``, (n, 3) N m."""
    w = states.angular_velocity
    return np.asarray(-cross(w, apply(moving_inertia(system), w)))


def _of_torque(name: str, of: Callable[[System, State], Array], constant: bool = False) -> Operand:
    def values(e: Evidence) -> Array:
        return np.asarray(of(e.system, e.states) + 0.0 * e.states.angular_velocity)

    def came(e: Evidence) -> Array:
        more = apply(moving_inertia(e.system), e.found.angular - e.true.angular)
        return np.asarray(values(e) + more)

    return Operand(name, "N m", values, lambda e, v: pushed(e, v - values(e)), came, constant)


def loads(system: System, states: State) -> Array:
    """The torque of all loads, (n, 3) N m in body axes."""
    parts = (applied_torque, damping_torque, gravity_torque)
    return sum((part(system, states) for part in parts), 0.0 * states.angular_velocity)


def _world(system: System, states: State) -> Array:
    return np.asarray(rotate_inverse(states.orientation, system.load.torque_world))


def _omega(what: str, terms: tuple[Callable[[System, State], Array], ...]) -> Operand:
    """Omega on its way into some terms alone."""

    def put(e: Evidence, w: Array) -> Acceleration:
        other = replace(e.states, angular_velocity=w)
        more = [term(e.system, other) - term(e.system, e.states) for term in terms]
        return pushed(e, np.asarray(sum(more)))

    return Operand(f"omega in {what}", "rad/s", lambda e: e.states.angular_velocity, put)


def _attitude(what: str, term: Callable[[System, State], Array], unit: bool = True) -> Operand:
    """The quaternion on its way into one term alone.

    unit: it is normalised there; else what is rounded turns by a matrix that is no rotation.
    """

    def put(e: Evidence, q: Array) -> Acceleration:
        other = replace(e.states, orientation=normalize(q) if unit else q)
        return pushed(e, term(e.system, other) - term(e.system, e.states))

    name = f"the attitude in {what}{'' if unit else ', as it is,'}"
    return Operand(name, "", lambda e: e.states.orientation, put, rounded=not unit)


def _in_term(
    name: str,
    of: Callable[[System, State], Array],
    term: Callable[[System, State, Array], Array],
    unit: str = "",
    among: bool = False,
) -> Operand:
    """What goes into one torque, (n, ...), of which it may be rounded there alone."""

    def values(e: Evidence) -> Array:
        one = of(e.system, e.states)
        return np.broadcast_to(one, (len(e.sound), one.shape[-1]))

    def put(e: Evidence, v: Array) -> Acceleration:
        return pushed(e, term(e.system, e.states, v) - term(e.system, e.states, values(e)))

    return Operand(name, unit, values, put, rounded=True, among=among)


def _by_matrix(vector: Array, matrix: Array) -> Array:
    """``R^T v`` of matrices (..., 9)."""
    return np.asarray(vector @ matrix.reshape(*matrix.shape[:-1], 3, 3))


def _entries(_: System, states: State) -> Array:
    return rotation_matrix(states.orientation).reshape(-1, 9)


def _arm(system: System) -> Array:
    return np.zeros(3) if system.load.pivot is None else np.asarray(lever(system), dtype=float)


def _down(system: System, states: State) -> Array:
    return rotate_inverse(states.orientation, weight(system))


def _weighed(system: System, _: State, matrix: Array) -> Array:
    return cross(_arm(system), _by_matrix(weight(system), matrix))


def _twisted(system: System, _: State, matrix: Array) -> Array:
    return _by_matrix(np.asarray(system.load.torque_world), matrix)


IN_TERMS = (
    _in_term("the rotation matrix in the torque of gravity", _entries, _weighed),
    _in_term("the rotation matrix in the torque in world axes", _entries, _twisted),
    _in_term(
        "the rotation matrix in all loads",
        _entries,
        lambda s, x, m: _weighed(s, x, m) + _twisted(s, x, m),
    ),
    _in_term(
        "the lever in the torque of gravity",
        lambda s, x: _arm(s),
        lambda s, x, v: cross(v, _down(s, x)),
        "m",
    ),
    _in_term(
        "the weight in the torque of gravity",
        lambda s, x: weight(s),
        lambda s, x, v: cross(_arm(s), rotate_inverse(x.orientation, v)),
        "N",
    ),
    _in_term("the weight, taken to body axes,", _down, lambda s, x, v: cross(_arm(s), v), "N"),
    _in_term(
        "I omega in the gyroscopic term",
        lambda s, x: apply(moving_inertia(s), x.angular_velocity),
        lambda s, x, v: -cross(x.angular_velocity, v),
        "kg m^2/s",
        among=True,
    ),
)


def _whole_omega(e: Evidence, w: Array) -> Acceleration:
    return forward_dynamics(e.system, replace(e.states, angular_velocity=w))


def _whole_attitude(e: Evidence, q: Array) -> Acceleration:
    return forward_dynamics(e.system, replace(e.states, orientation=normalize(q)))


OPERANDS = (
    _of_torque("the gyroscopic term", gyroscopic),
    _of_torque("the torque in body axes", lambda s, x: s.load.torque_body, constant=True),
    _of_torque("the torque in world axes, taken to body axes,", _world),
    _of_torque("the damping torque", damping_torque),
    _of_torque("the torque of gravity", gravity_torque),
    _of_torque("the torque of all loads", loads),
    _of_torque("the whole torque", lambda s, x: loads(s, x) + gyroscopic(s, x)),
    _omega("the gyroscopic term", (gyroscopic,)),
    _omega("the damping", (damping_torque,)),
    _attitude("the torque of gravity", gravity_torque),
    _attitude("the torque in world axes", _world),
    _attitude("all loads", loads),
    _attitude("the torque of gravity", gravity_torque, unit=False),
    _attitude("the torque in world axes", _world, unit=False),
    _attitude("all loads", loads, unit=False),
    Operand("the attitude on its way in", "", lambda e: e.states.orientation, _whole_attitude),
    Operand("omega on its way in", "rad/s", lambda e: e.states.angular_velocity, _whole_omega),
    Operand(
        "omega-dot",
        "rad/s^2",
        lambda e: e.true.angular,
        turned,
        lambda e: e.found.angular,
    ),
    Operand(
        "the omega-dot that is reported",
        "rad/s^2",
        lambda e: e.true.angular,
        lambda e, v: replace(e.true, angular=v),
        lambda e: e.found.angular,
        reported=True,
    ),
    Operand(
        "the linear acceleration",
        "m/s^2",
        lambda e: e.true.linear,
        lambda e, v: replace(e.true, linear=v),
        lambda e: e.found.linear,
    ),
    *IN_TERMS,
)


def acting(evidence: Evidence) -> Iterator[Operand]:
    """Those that are not nothing here, and no two that are the same."""
    seen = list[Array]()
    for one in OPERANDS:
        values = one.of(evidence)
        torque = one.unit == "N m"
        if not np.any(values) or (torque and any(np.array_equal(values, x) for x in seen)):
            continue
        if one in IN_TERMS:
            with_none = one.put(evidence, 0.0 * values).angular
            if not np.array_equal(with_none, evidence.true.angular):
                yield one
            continue
        if one.unit == "" and np.array_equal(
            one.put(evidence, 0.0 * values + [0.5, 0.5, -0.5, 0.5]).angular, evidence.true.angular
        ):
            continue  # the term does not act
        if one.name == "omega in the damping" and not np.any(evidence.system.load.damping):
            continue
        seen += [values] if torque else []
        yield one
