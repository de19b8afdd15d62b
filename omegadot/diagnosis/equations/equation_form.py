"""The equations of one body with every part of them apart, so that each can be another.

A wrong engine's equation is one of these forms with a few parts changed, which is evaluated next to
others at the same states: the parts take a leading axis, the lane of a hypothesis.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from omegadot.reference_impl.arithmetic.precision import extended_type
from omegadot.reference_impl.cross_product import cross
from omegadot.reference_impl.inertia import lever, moving_inertia
from omegadot.reference_impl.loads import weight
from omegadot.reference_impl.rotations import rotation_matrix
from omegadot.reference_impl.symmetric import apply, inverse
from omegadot.reference_impl.system import Acceleration, Array, State, System


@dataclass(frozen=True)
class Form:
    """``ω̇ = A (τ_b + B R^T τ_w + r × (R^T f + f_b) - D ω - Q |ω| ω - ω × S ω)``, body axes.

    solve A: (..., 3, 3), the inverse of the inertia.  spin S: the inertia of the gyroscopic term.
    damping D: (..., 3, 3) N m s/rad.  drag_square Q: (...) N m s^2.  torque_body and torque_world:
    (..., 3) N m, with turned B (..., 3, 3).  weight f: (..., 3) N, world; weight_body f_b: body
    axes; arm r (..., 3) m.
    Of the centre of mass
    ``a = g - k v + s ω × v + R (g_b + ω̇ × l + ω × (ω × l) + A τ_applied × e)``, with gravity g and
    gravity_body g_b (..., 3), drag k and spatial s (...), offset l and couple_offset e (..., 3) m.
    With fall c (...) 1/m, gravity is ``g / (1 + c z)^2``, z the height of the centre of mass above
    the world's origin, against g.
    """

    solve: Array
    spin: Array
    damping: Array
    drag_square: Array
    torque_body: Array
    torque_world: Array
    turned: Array
    weight: Array
    weight_body: Array
    arm: Array
    gravity: Array
    gravity_body: Array
    fall: Array
    drag: Array
    spatial: Array
    offset: Array
    couple_offset: Array


def _constant(values: Array) -> Array:
    values.flags.writeable = False
    return values


# One array each: lanes that share a part are known by it.
_NONE, _NOTHING, _UNTURNED = (_constant(one) for one in (np.zeros(3), np.zeros(()), np.eye(3)))


@lru_cache(maxsize=1024)
def _solving(inertia: bytes, _: str) -> Array:
    """The inverse of an inertia, which most hypotheses on a system leave as it is."""
    return _constant(np.asarray(inverse(np.frombuffer(inertia).reshape(3, 3)), dtype=float))


def form_of(system: System) -> Form:
    """The right equation of a system. Raises ValueError for an inertia that has no inverse."""
    load, inertia = system.load, np.asarray(moving_inertia(system), dtype=float)
    pivoted = load.pivot is not None
    arm = np.asarray(lever(system), dtype=float) if pivoted else _NONE
    return Form(
        solve=_solving(inertia.tobytes(), extended_type()),
        spin=inertia,
        damping=float(load.damping) * _UNTURNED,
        drag_square=_NOTHING,
        torque_body=np.asarray(load.torque_body, dtype=float),
        torque_world=np.asarray(load.torque_world, dtype=float),
        turned=_UNTURNED,
        weight=np.asarray(weight(system), dtype=float),
        weight_body=_NONE,
        arm=arm,
        gravity=_NONE if pivoted else np.asarray(load.gravity, dtype=float),
        gravity_body=_NONE,
        fall=_NOTHING,
        drag=_NOTHING,
        spatial=_NOTHING,
        offset=arm,
        couple_offset=_NONE,
    )


def stacked(forms: Sequence[Form]) -> Form:
    """Many forms in lanes, (lanes, 1, ...): the states come in the second axis.

    A part that all share has one lane, except for the first, which shows how many there are.
    """
    first, *parts = zip(*(vars(form).values() for form in forms), strict=True)
    return Form(np.stack(first)[:, None], *map(_in_lanes, parts))


def _in_lanes(part: Sequence[Array]) -> Array:
    if all(one is part[0] for one in part):
        return part[0][None, None]
    return np.stack(part)[:, None]


def accelerations(form: Form, states: State) -> Acceleration:
    """What a form gives at states (n,): (n, 3), and (lanes, n, 3) of stacked forms.

    Terms that are zero in every lane are left out: most of them are, and each takes its time.
    """
    w, v = states.angular_velocity, states.linear_velocity
    turn = rotation_matrix(states.orientation)

    def into_body(vector: Array) -> Array:
        return (vector[..., None, :] @ turn)[..., 0, :]

    applied = form.torque_body
    if form.torque_world.any():
        applied = applied + apply(form.turned, into_body(form.torque_world))
    moment = applied
    if form.arm.any():
        moment = moment + cross(form.arm, into_body(form.weight) + form.weight_body)
    braked = apply(form.damping, w)
    if form.drag_square.any():
        rate = np.sqrt(np.sum(w * w, axis=-1, keepdims=True))
        braked = braked + form.drag_square[..., None] * rate * w
    angular = apply(form.solve, moment - braked - cross(w, apply(form.spin, w)))
    lever = form.gravity_body
    if form.offset.any():
        lever = lever + cross(angular, form.offset) + cross(w, cross(w, form.offset))
    if form.couple_offset.any():
        lever = lever + cross(apply(form.solve, applied), form.couple_offset)
    if form.spatial.any():
        # R (R^T v) stands for v itself: the spatial term is ω × v with ω in the world
        lever = lever + form.spatial[..., None] * cross(w, into_body(v))
    linear = form.gravity - form.drag[..., None] * v
    if form.fall.any():
        linear = linear + form.gravity * _less_with_height(form, states.position)[..., None]
    if lever is not form.gravity_body or lever.any():
        linear = linear + apply(turn, lever)
    if linear.shape != angular.shape:
        linear = np.broadcast_to(linear, angular.shape)
    return Acceleration(angular, linear)


def _less_with_height(form: Form, place: Array) -> Array:
    """How much of gravity is added at a place (n, 3): (n,), and (lanes, n) of stacked forms."""
    size = np.sqrt(np.sum(form.gravity * form.gravity, axis=-1))
    height = -np.sum(place * form.gravity, axis=-1) / np.where(size > 0.0, size, 1.0)
    return np.asarray((1.0 + form.fall * height) ** -2.0 - 1.0)


def changed(form: Form, **parts: Array) -> Form:
    """A form with other parts: as ``replace`` makes it, in a third of the time."""
    return Form(**{**vars(form), **parts})


def same_form(one: Form, other: Form) -> bool:
    """Whether two hypotheses come to one equation on a system."""
    pairs = zip(vars(one).values(), vars(other).values(), strict=True)
    return all(a is b or _same(a, b) for a, b in pairs)


def _same(a: Array, b: Array) -> bool:
    """As ``np.allclose`` has it, of finite numbers, in a fifth of its time."""
    allowed = 1e-14 * np.abs(a).max() + 1e-12 * np.abs(b)
    return bool((np.abs(a - b) <= allowed).all())
