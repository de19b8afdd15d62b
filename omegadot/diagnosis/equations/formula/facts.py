"""What a formula may be made of: the known vectors, matrices and sizes at the states of a run."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from omegadot.diagnosis.equations.evidence import Evidence
from omegadot.gates.bounds.scales import norm
from omegadot.reference_impl.cross_product import cross
from omegadot.reference_impl.inertia import lever, moving_inertia
from omegadot.reference_impl.rotations import rotate_inverse, rotation_matrix
from omegadot.reference_impl.system import Array

Unit = tuple[float, float, float]  # exponents of kg, m and s
TORQUE, RATE, LENGTH, NONE = (1.0, 2.0, -2.0), (0.0, 0.0, -2.0), (0.0, 1.0, 0.0), (0.0, 0.0, 0.0)
INERTIA, SPEED, ACCELERATION = (1.0, 2.0, 0.0), (0.0, 1.0, -1.0), (0.0, 1.0, -2.0)

# The plainest first: of two that are the same on a run the first is used.
VECTORS: dict[str, tuple[Unit, str]] = {
    "omega": ((0.0, 0.0, -1.0), ""),
    "g": (ACCELERATION, "gravity in body axes"),
    "r": (LENGTH, "the lever from the pivot to the centre of mass"),
    "tau_b": (TORQUE, "the torque in body axes"),
    "tau_w": (TORQUE, "the torque in world axes, taken to body axes"),
    "tau": (TORQUE, "the applied torque"),
    "v": (SPEED, "the velocity in body axes"),
    "c": (LENGTH, "the centre of mass from the origin"),
    "p": (LENGTH, "the pivot from the origin"),
    "s": (LENGTH, "the position in body axes"),
    "omega-dot": (RATE, ""),
    "a": (ACCELERATION, "the acceleration in body axes"),
    "e_x": (NONE, "the body's x axis"),
    "e_y": (NONE, "the body's y axis"),
    "e_z": (NONE, "the body's z axis"),
    "E_x": (NONE, "the world's x axis"),
    "E_y": (NONE, "the world's y axis"),
    "E_z": (NONE, "the world's z axis"),
}
MOMENTUM = "I omega"  # which is a matrix times a vector, and a size of it
MATRICES: dict[str, tuple[Unit, str]] = {
    "I": (INERTIA, "the inertia"),
    "I_c": (INERTIA, "the inertia about the centre of mass"),
    "I^-1": ((-1.0, -2.0, 0.0), "the inverse of the inertia"),
    "D": (INERTIA, "the inertia's diagonal"),
    "P": (INERTIA, "the inertia without its diagonal"),
    "D_c": (INERTIA, "the diagonal of the inertia about the centre of mass"),
    "P_c": (INERTIA, "the products of the inertia about the centre of mass"),
    "R": (NONE, "the turn from body to world axes"),
    "R^T": (NONE, "the turn from world to body axes"),
}
SIZES: dict[str, tuple[Unit, str]] = {  # of a system
    "m": ((1.0, 0.0, 0.0), "the mass"),
    "d": ((1.0, 2.0, -1.0), "the damping"),
    "|g|": (ACCELERATION, ""),
    "|r|": (LENGTH, ""),
    "|c|": (LENGTH, ""),
    "|p|": (LENGTH, ""),
    "|tau_b|": (TORQUE, ""),
    "|tau_w|": (TORQUE, ""),
    "tr I": (INERTIA, ""),
    "tr I_c": (INERTIA, ""),
    "m|g||r|": (TORQUE, ""),
    "ln(1+d)": (NONE, "the damping in SI units"),  # what is made of a damping a second
    "ln(1/(1-d))": (NONE, "the damping in SI units"),
    "(1-exp(-d))": (NONE, "the damping in SI units"),
}


@dataclass(frozen=True)
class Facts:
    """At states (n,), of one system or of several: vectors (n, 3) in body axes, matrices, sizes."""

    vectors: dict[str, Array]
    matrices: dict[str, Array]
    sizes: dict[str, Array]


def facts_of(evidence: Evidence) -> Facts:
    """Those of one system. What it does not have is zero."""
    system, states, load = evidence.system, evidence.states, evidence.system.load
    w, q, center = states.angular_velocity, states.orientation, system.body.center_of_mass
    held = load.pivot is not None
    turn, none = rotation_matrix(q), 0.0 * w
    inertia = np.asarray(moving_inertia(system), dtype=float)
    own = np.asarray(system.body.inertia, dtype=float)
    arm = np.asarray(lever(system), dtype=float) if held else np.zeros(3)
    world = rotate_inverse(q, load.torque_world + none)
    vectors = {
        "omega": w,
        "g": rotate_inverse(q, load.gravity + none),
        "r": arm + none,
        "tau_b": load.torque_body + none,
        "tau_w": world,
        "tau": load.torque_body + world,
        "v": rotate_inverse(q, states.linear_velocity),
        "c": center + none,
        "p": (load.pivot if load.pivot is not None else np.zeros(3)) + none,
        "s": rotate_inverse(q, states.position),
        "omega-dot": evidence.true.angular,
        "a": rotate_inverse(q, evidence.true.linear),
        MOMENTUM: product(inertia, w),
    }
    vectors |= {f"e_{k}": none + axis for k, axis in zip("xyz", np.eye(3), strict=True)}
    vectors |= {f"E_{k}": turn[:, j] + none for j, k in enumerate("xyz")}
    parts = (inertia, own, np.linalg.inv(inertia), *_parts(inertia), *_parts(own))
    many = [np.broadcast_to(one, (len(w), 3, 3)) for one in parts]
    matrices = dict(zip(MATRICES, [*many, turn, np.swapaxes(turn, -1, -2)], strict=True))
    mass, damping = float(system.body.mass), float(load.damping)
    lengths = [float(norm(np.asarray(x))) for x in (load.gravity, arm, center)]
    lengths += [float(norm(vectors["p"])[0])] if len(w) else [0.0]
    lengths += [float(norm(x)) for x in (load.torque_body, load.torque_world)]
    traces = float(np.trace(inertia)), float(np.trace(own))
    left = -np.log1p(-damping) if damping < 1.0 else np.nan
    decays = float(np.log1p(damping)), float(left), -float(np.expm1(-damping))
    numbers = (mass, damping, *lengths, *traces, mass * lengths[0] * lengths[1], *decays)
    sizes = {name: np.full(len(w), x) for name, x in zip(SIZES, numbers, strict=True)}
    return Facts(vectors, matrices, sizes)


def _parts(inertia: Array) -> tuple[Array, Array]:
    diagonal = np.diag(np.diag(inertia))
    return diagonal, inertia - diagonal


DAMPING, WEIGHT = "the damping torque -d omega", "the torque of gravity"


def terms_of(facts: Facts) -> dict[str, Array]:
    """The torques of the right equation, (n, 3), which another may stand in place of."""
    own, w = facts.vectors, facts.vectors["omega"]
    weight = facts.sizes["m"][:, None] * cross(own["r"], own["g"])
    return {
        "the gyroscopic term -omega x I omega": -cross(w, own[MOMENTUM]),
        DAMPING: -facts.sizes["d"][:, None] * w,
        "the torque in body axes": own["tau_b"],
        "the torque in world axes": own["tau_w"],
        WEIGHT: weight,
    }


def rates_of(facts: Facts, pivoted: bool) -> dict[str, Array]:
    """The terms of the right linear acceleration, (n, 3) in body axes."""
    own = facts.vectors
    if not pivoted:
        return {"gravity": own["g"]}
    return {
        "omega-dot x r": cross(own["omega-dot"], own["r"]),
        "omega x (omega x r)": cross(own["omega"], cross(own["omega"], own["r"])),
        "(omega-dot x r + omega x (omega x r))": own["a"],
    }


def product(matrices: Array, vectors: Array) -> Array:
    """``M v`` over leading axes."""
    return np.asarray((matrices @ vectors[..., None])[..., 0])


def together(several: Sequence[Facts]) -> Facts:
    """The states of several systems in one row."""

    def joined(part: str) -> dict[str, Array]:
        parts = [getattr(one, part) for one in several]
        return {name: np.concatenate([one[name] for one in parts]) for name in parts[0]}

    return Facts(joined("vectors"), joined("matrices"), joined("sizes"))


def at(facts: Facts, places: NDArray[np.intp]) -> Facts:
    """The facts at these states alone."""
    parts = ({k: v[places] for k, v in part.items()} for part in vars(facts).values())
    return Facts(*parts)
