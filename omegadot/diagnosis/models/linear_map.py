"""An omega that reads back as a matrix times the one that is set: a product of known inertias.

An engine that keeps omega as a momentum makes it by one inertia, and may turn it back by another:
``M^-1 I omega`` reads back. What is set and read back is one state on each scenario, which holds a
known product against all of them. Of an unknown one the first steps of no length, from many states,
show that it is linear, and what it is.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from omegadot.diagnosis.wording.digits import vector
from omegadot.gates.bounds.scales import ROUNDINGS_PER_EVALUATION, norm
from omegadot.reference_impl.inertia import moving_inertia, parallel_axis
from omegadot.reference_impl.system import Array, State, System

Inertias = dict[str, Array]
MEANT = {
    "I": "the inertia about the centre of mass",
    "M": "that about the pivot",
    "O": "that about the body's origin",
    "D": "the diagonal of I",
}
LEAST = 5  # states, of which three would fit any matrix
FITTED = 1e-8  # relative: what steps of no length know omega by, and a fit must leave
WELL = 1e-3  # of the largest omega: what the states that are set must span, in every direction


@dataclass(frozen=True)
class Product:
    """text: of omega.  matrix: (3, 3), of a system, with how much it makes of a rounding."""

    text: str
    matrix: Callable[[System], tuple[Array, float]]


def _inertias(system: System) -> Inertias:
    body = system.body
    own = np.asarray(body.inertia, dtype=float)
    return {
        "I": own,
        "M": np.asarray(moving_inertia(system), dtype=float),
        "O": own + parallel_axis(body.mass, body.center_of_mass),
        "D": np.diag(np.diag(own)),
    }


def _product(left: str, right: str, inverse_first: bool) -> Product:
    def matrix(system: System) -> tuple[Array, float]:
        known = _inertias(system)
        one, other = known[left], known[right]
        back = np.linalg.inv(one if inverse_first else other)
        condition = float(np.linalg.cond(one if inverse_first else other))
        return (back @ other if inverse_first else one @ back), condition

    meant = ", ".join(
        f"{name}: {MEANT[name]}" for name in sorted((left, right), key=[*MEANT].index)
    )
    text = f"{left}^-1 {right}" if inverse_first else f"{left} {right}^-1"
    return Product(f"{text} omega ({meant})", matrix)


def _products() -> Iterator[Product]:
    names = ("M", "I", "O", "D")
    for first in (True, False):
        for pair in (("M", "I"), ("I", "M"), ("O", "I"), ("I", "O"), ("D", "I"), ("I", "D")):
            yield _product(*pair, first)
        for one in names:
            for other in names:
                if one != other and "I" not in (one, other):
                    yield _product(one, other, first)


PRODUCTS = tuple(_products())


def is_product(one: Product, system: System, meant: State, back: State, eps: float) -> bool:
    """Whether the omega that is read back is this product with the one that was set."""
    matrix, condition = one.matrix(system)
    made = matrix @ meant.angular_velocity
    off = norm(back.angular_velocity - made)
    return bool(off <= ROUNDINGS_PER_EVALUATION * eps * condition * norm(made))


def fitted_map(states: State, limit: State) -> Array | None:
    """(3, 3): what steps of no length make of every omega; None where no matrix does, or 1."""
    was, now = states.angular_velocity, limit.angular_velocity
    if len(was) < LEAST or not np.all(np.isfinite(now)):
        return None
    sizes = np.linalg.svd(was, compute_uv=False)
    if not sizes[-1] > WELL * sizes[0]:
        return None
    matrix = np.linalg.lstsq(was, now, rcond=None)[0].T
    left = norm(now - was @ matrix.T)
    fits = np.all(left <= FITTED * (norm(now) + norm(was)))
    other = np.any(np.abs(matrix - np.eye(3)) > FITTED / WELL)
    return matrix if fits and other else None


def unknown_map(seen: Sequence[tuple[str, Array | None]]) -> str:
    """Of a matrix that is none of the known; "" unless omega is linear on all these scenarios.

    seen: the scenario's name and its matrix, of the plainest first.
    """
    if not seen or any(matrix is None for _, matrix in seen):
        return ""
    name, matrix = seen[0]
    assert matrix is not None
    rows = "; ".join(vector(np.round(row, 7)) for row in matrix)
    return f"omega reads back as a matrix times the one that is set: on {name} as {rows}"
