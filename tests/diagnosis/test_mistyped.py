"""A formula with a product or a factor mistyped: a rotation's, or a cross product's.

What these tests catch: a slip that is recognised by what it does to one scenario alone, one that is
worded as another formula, and a cause for what is no slip of the hand.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from test_causes import causes_over
from wrong_equations import CASES, WORLD_TORQUE, case

from omegadot.reference_impl.cross_product import cross
from omegadot.reference_impl.inertia import lever, moving_inertia
from omegadot.reference_impl.loads import damping_torque, weight
from omegadot.reference_impl.rotations import normalize, rotation_matrix
from omegadot.reference_impl.symmetric import apply, inverse
from omegadot.reference_impl.system import Acceleration, Array, State, System

MORE = (
    *CASES,
    case("driven-otherwise", {"torque": {"frame": "world", "value": [0.4, 1.1, -0.3]}}, 0.8),
    case("another-top", {"gravity": [3, 1, -7], "pivot": [0.1, 0.2, 0.3]}, 1.2),
    case("driven-top", {"torque": WORLD_TORQUE, "pivot": [0.1, -0.3, 0.2], "gravity": [3, 1, -7]}),
)
Cross = Callable[[Array, Array], Array]


def engine(
    matrix: Callable[[Array], Array] = rotation_matrix,
    of_weight: Callable[[Array], Array] = rotation_matrix,
    out: Callable[[Array], Array] = rotation_matrix,
    momentum: Callable[[Array, Array], Array] = apply,
    **products: Cross,
) -> Callable[[System, State], Acceleration]:
    """Equation (8) written out, with each rotation and each cross product by itself."""

    def by(name: str) -> Cross:
        return products.get(name, products.get("every", cross))

    def found(system: System, states: State) -> Acceleration:
        w, q = states.angular_velocity, states.orientation
        r = np.asarray(lever(system)) + 0.0 * w
        inertia, held = moving_inertia(system), system.load.pivot is not None
        torque = system.load.torque_body + system.load.torque_world @ matrix(q)
        torque = torque + damping_torque(system, states)
        if held:
            torque = torque + by("weight")(r, weight(system) @ of_weight(q))
        spin = by("spin")(w, momentum(np.asarray(inertia), w))
        angular = apply(inverse(inertia), torque - spin)
        if not held:
            return Acceleration(angular, system.load.gravity + 0.0 * w)
        moved = by("dot")(angular, r) + by("outer")(w, by("inner")(w, r))
        return Acceleration(angular, (out(q) @ moved[..., None])[..., 0])

    return found


def by_vector(a: float, b: float, c: float = 1.0) -> Callable[[Array], Array]:
    """``c v + a s (u x v) + b u x (u x v)`` as matrices."""

    def matrix(q: Array) -> Array:
        s, u = q[:, :1, None], q[:, 1:]
        axes = np.broadcast_to(np.eye(3), (len(q), 3, 3))
        side = np.cross(u[:, None, :], axes)
        made = c * axes + a * s * side + b * np.cross(u[:, None, :], side)
        return np.swapaxes(made, -1, -2)

    return matrix


def with_entry(i: int, j: int, typed: Callable[..., Array]) -> Callable[[Array], Array]:
    def matrix(q: Array) -> Array:
        made = np.array(rotation_matrix(q))
        made[:, i, j] = typed(*q.T)
        return made

    return matrix


def with_component(k: int, typed: Callable[[Array, Array], Array]) -> Cross:
    def product(a: Array, b: Array) -> Array:
        made = np.array(cross(a, b))
        made[..., k] = typed(np.moveaxis(a, -1, 0), np.moveaxis(b, -1, 0))
        return made

    return product


XZ = with_entry(0, 2, lambda s, x, y, z: 2 * (x * z - s * y))
YY = with_entry(1, 1, lambda s, x, y, z: 1 - 2 * (x * x + y * y))
ZZ = with_entry(2, 2, lambda s, x, y, z: 1 - 2 * (x * x - y * y))
Z = with_component(2, lambda a, b: a[0] * b[1] - a[1] * b[1])
X = with_component(0, lambda a, b: a[1] * b[2] + a[2] * b[1])
Y = with_component(1, lambda a, b: a[2] * b[0])
INTO = "the torque in world axes is taken into body axes by v"
DUE = "where v - 2 s (u x v) + 2 u x (u x v) is right, q = (s, u): the factor of"
XZ_TEXT = "R_xz is 2 (q_x q_z - q_w q_y), where 2 (q_x q_z + q_w q_y) is right, in the matrix by "
SLIPS = {
    "b": (
        engine(by_vector(2, 1)),
        f"{INTO} - 2 s (u x v) + u x (u x v), {DUE} u x (u x v) is scaled by 0.5",
    ),
    "a": (
        engine(by_vector(1, 2)),
        f"{INTO} - s (u x v) + 2 u x (u x v), {DUE} s (u x v) is scaled by 0.5",
    ),
    "a and b": (
        engine(by_vector(1, 1)),
        f"{INTO} - s (u x v) + u x (u x v), {DUE} s (u x v) is scaled by 0.5 and the factor of "
        "u x (u x v) is scaled by 0.5",
    ),
    "of the weight": (engine(of_weight=by_vector(2, 1.5)), "the weight is taken into body axes by"),
    "of both": (
        engine(by_vector(2, 1), by_vector(2, 1)),
        "the torque in world axes and the weight are taken into body axes by",
    ),
    "out": (
        engine(out=by_vector(2, 1)),
        "the linear acceleration is taken to world axes by v + 2 s (u x v) + u x (u x v), where "
        "v + 2 s (u x v) + 2 u x (u x v) is right",
    ),
    "xz": (engine(XZ), f"{XZ_TEXT}which the torque in world axes is taken into body axes"),
    "xz of the weight": (
        engine(of_weight=XZ),
        f"{XZ_TEXT}which the weight is taken into body axes",
    ),
    "xz out": (
        engine(out=XZ),
        f"{XZ_TEXT}which the linear acceleration is taken to world axes",
    ),
    "xz everywhere": (
        engine(XZ, XZ, XZ),
        f"{XZ_TEXT}which the torque in world axes, the weight and the linear acceleration are "
        "turned",
    ),
    "yy": (
        engine(YY),
        "R_yy is 1 - 2 (q_x q_x + q_y q_y), where 1 - 2 (q_x q_x + q_z q_z) is right",
    ),
    "zz": (
        engine(of_weight=ZZ),
        "R_zz is 1 - 2 (q_x q_x - q_y q_y), where 1 - 2 (q_x q_x + q_y q_y) is right",
    ),
    "z of the weight": (
        engine(weight=Z),
        "the z component of the weight's torque r x f is r_x f_y - r_y f_y, where "
        "r_x f_y - r_y f_x is right",
    ),
    "x of the spin": (
        engine(spin=X),
        "the x component of the gyroscopic term omega x L, L = I omega, is "
        "omega_y L_z + omega_z L_y, where omega_y L_z - omega_z L_y is right",
    ),
    "y of omega-dot x r": (
        engine(dot=Y),
        "the y component of omega-dot x r in the linear acceleration is omega-dot_z r_x, where "
        "omega-dot_z r_x - omega-dot_x r_z is right",
    ),
    "z of the outer": (
        engine(outer=Z),
        "the z component of omega x c, c = omega x r, in the linear acceleration is",
    ),
    "z of the inner": (
        engine(inner=Z),
        "the z component of omega x r, the inner product of the linear acceleration, is",
    ),
    "z of every one": (
        engine(every=Z),
        "the z component of every cross product a x b is a_x b_y - a_y b_y, where "
        "a_x b_y - a_y b_x is right",
    ),
}


def with_number(i: int, j: int, axis: int) -> Callable[[Array, Array], Array]:
    """``I omega`` whose z component has I_ij with another component of omega than omega_i."""

    def momentum(inertia: Array, w: Array) -> Array:
        found = np.array(apply(inertia, w))
        found[..., 2] += inertia[i, j] * (w[..., axis] - w[..., i])
        return found

    return momentum


RIGHT = "I_xz omega_x + I_yz omega_y + I_zz omega_z is right"
SLIPS |= {
    "x of the momentum's z": (
        engine(momentum=with_number(1, 2, 0)),
        "the z component of L = I omega in the gyroscopic term omega x L is "
        f"I_xz omega_x + I_zz omega_z + I_yz omega_x, where {RIGHT}",
    ),
    "y of the momentum's z": (
        engine(momentum=with_number(0, 2, 1)),
        f"I_yz omega_y + I_zz omega_z + I_xz omega_y, where {RIGHT}",
    ),
}


@pytest.mark.parametrize("name", SLIPS)
def test_a_slip_is_named_with_its_formula(name: str) -> None:
    found, text = SLIPS[name]
    causes = causes_over(found, MORE)
    assert causes
    assert all(text in cause for cause in causes.values()), causes


def half_way(q: Array) -> Array:
    """Half of the turn."""
    return rotation_matrix(normalize(q + np.array([1.0, 0.0, 0.0, 0.0])))


NEIGHBOURS = {
    "another rotation": engine(half_way),
    "a factor that no slip has": engine(
        weight=with_component(2, lambda a, b: a[0] * b[1] - 1.23 * a[1] * b[0])
    ),
}


@pytest.mark.parametrize("name", NEIGHBOURS)
def test_what_is_no_slip_of_the_hand_is_not_named_as_one(name: str) -> None:
    causes = causes_over(NEIGHBOURS[name], MORE)
    assert causes
    assert not any("is right" in text for text in causes.values()), causes
