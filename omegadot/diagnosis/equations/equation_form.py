"""The equations of one body with every part of them apart, so that each can be another.

A wrong engine's equation is one of these forms with a few parts changed, which is evaluated next to
others at the same states: the parts take a leading axis, the lane of a hypothesis.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

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
    drag: Array
    spatial: Array
    offset: Array
    couple_offset: Array


def form_of(system: System) -> Form:
    """The right equation of a system."""
    load, inertia = system.load, np.asarray(moving_inertia(system), dtype=float)
    pivoted, none = load.pivot is not None, np.zeros(3)
    arm = np.asarray(lever(system), dtype=float)
    return Form(
        solve=np.asarray(inverse(inertia), dtype=float),
        spin=inertia,
        damping=float(load.damping) * np.eye(3),
        drag_square=np.zeros(()),
        torque_body=np.asarray(load.torque_body, dtype=float),
        torque_world=np.asarray(load.torque_world, dtype=float),
        turned=np.eye(3),
        weight=np.asarray(weight(system), dtype=float),
        weight_body=none,
        arm=arm if pivoted else none,
        gravity=none if pivoted else np.asarray(load.gravity, dtype=float),
        gravity_body=none,
        drag=np.zeros(()),
        spatial=np.zeros(()),
        offset=arm if pivoted else none,
        couple_offset=none,
    )


def stacked(forms: Sequence[Form]) -> Form:
    """Many forms in lanes, (lanes, 1, ...): the states come in the second axis."""
    parts = zip(*(vars(form).values() for form in forms), strict=True)
    return Form(*(np.stack(part)[:, None] for part in parts))


def accelerations(form: Form, states: State) -> Acceleration:
    """What a form gives at states (n,): (n, 3), and (lanes, n, 3) of stacked forms."""
    w, v = states.angular_velocity, states.linear_velocity
    turn = rotation_matrix(states.orientation)

    def into_body(vector: Array) -> Array:
        return (vector[..., None, :] @ turn)[..., 0, :]

    rate = np.sqrt(np.sum(w * w, axis=-1, keepdims=True))
    applied = form.torque_body + apply(form.turned, into_body(form.torque_world))
    moment = cross(form.arm, into_body(form.weight) + form.weight_body)
    braked = apply(form.damping, w) + form.drag_square[..., None] * rate * w
    angular = apply(form.solve, applied + moment - braked - cross(w, apply(form.spin, w)))
    lever = form.gravity_body + cross(angular, form.offset) + cross(w, cross(w, form.offset))
    lever = lever + cross(apply(form.solve, applied), form.couple_offset)
    # R (R^T v) stands for v itself: the spatial term is ω × v with ω in the world
    lever = lever + form.spatial[..., None] * cross(w, into_body(v))
    return Acceleration(angular, form.gravity - form.drag[..., None] * v + apply(turn, lever))


def same_form(one: Form, other: Form) -> bool:
    """Whether two hypotheses come to one equation on a system."""
    pairs = zip(vars(one).values(), vars(other).values(), strict=True)
    return all(
        np.allclose(a, b, rtol=1e-12, atol=1e-14 * float(np.max(np.abs(a)))) for a, b in pairs
    )
