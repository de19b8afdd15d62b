"""A vector turned between world and body by a formula of the quaternion that is mistyped."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np

from omegadot.diagnosis.equations.evidence import Evidence
from omegadot.diagnosis.equations.mistyped.few import Few
from omegadot.diagnosis.equations.mistyped.kinds import ANGULAR, LINEAR, Kind
from omegadot.diagnosis.equations.mistyped.matrices import entry_text, products_of
from omegadot.diagnosis.equations.mistyped.vector_forms import form_text, vector_form
from omegadot.diagnosis.equations.operators.operands import pushed
from omegadot.diagnosis.equations.readings import Reading
from omegadot.diagnosis.wording.digits import listed
from omegadot.reference_impl.cross_product import cross
from omegadot.reference_impl.inertia import lever
from omegadot.reference_impl.loads import weight
from omegadot.reference_impl.rotations import rotate_inverse
from omegadot.reference_impl.symmetric import apply
from omegadot.reference_impl.system import Acceleration, Array

TORQUE, WEIGHT, MOVED = "torque", "weight", "moved"
USES = {
    TORQUE: "the torque in world axes",
    WEIGHT: "the weight",
    MOVED: "the linear acceleration",
}
# Of which the numbers are found, then what else may be turned by the same.
PLACES = {(TORQUE,): (), (WEIGHT,): (), (TORQUE, WEIGHT): (), (MOVED,): ()}
Matrices = Callable[[Array], Array]  # of quaternions (n, 4): what is added, (..., n, 3, 3)


@dataclass(frozen=True)
class _Turned:
    """What is added to ``world_R_body`` of quaternions (n, 4)."""

    more: Matrices

    def made(self, e: Evidence, uses: tuple[str, ...]) -> Acceleration:
        """The accelerations where these vectors are turned by it."""
        more = self.more(e.states.orientation)
        found = pushed(e, _torque(e, more, uses))
        if e.system.load.pivot is None or MOVED not in uses:
            return found
        own = rotate_inverse(e.states.orientation, found.linear)
        return Acceleration(found.angular, found.linear + (more @ own[..., None])[..., 0])


def _torque(e: Evidence, more: Array, uses: tuple[str, ...]) -> Array:
    """(..., n, 3) N m in body axes, of what is added to the matrix."""
    torque = 0.0 * more[..., 0, :]
    if TORQUE in uses:
        torque = torque + e.system.load.torque_world @ more
    if WEIGHT in uses and e.system.load.pivot is not None:
        torque = torque + cross(np.asarray(lever(e.system)), weight(e.system) @ more)
    return np.asarray(torque)


def _lines(matrices: Matrices, uses: tuple[str, ...]) -> Callable[[Evidence], Array]:
    def angular(e: Evidence) -> Array:
        more = matrices(e.states.orientation)
        return apply(e.solve, _torque(e, more, uses))

    def linear(e: Evidence) -> Array:
        q, more = e.states.orientation, matrices(e.states.orientation)
        held = 0.0 if e.system.load.pivot is None else 1.0
        own = rotate_inverse(q, held * e.true.linear)
        return rotate_inverse(q, (more @ own[..., None])[..., 0])

    return linear if uses == (MOVED,) else angular


def kinds() -> Iterator[Kind]:
    """The vector formula, then every entry of the matrix, of each vector that is turned."""
    for uses in PLACES:
        of = LINEAR if uses == (MOVED,) else ANGULAR
        readings = _readings(uses, vector_form, _form_text)
        yield Kind(of, _lines(vector_form, uses), readings, any_factors=True)
        for i in range(3):
            for j in range(3):
                matrices = products_of(i, j)

                def text(uses: tuple[str, ...], more: Few, i: int = i, j: int = j) -> str:
                    return f"{entry_text(i, j, more)}, in the matrix by which {_what(uses)}"

                yield Kind(of, _lines(matrices, uses), _readings(uses, matrices, text))


def _readings(
    uses: tuple[str, ...], matrices: Matrices, text: Callable[[tuple[str, ...], Few], str]
) -> Callable[[Few], Iterator[Reading]]:
    def readings(more: Few) -> Iterator[Reading]:
        factors = np.array([c for _, c in more])
        terms = [k for k, _ in more]
        turned = _Turned(lambda q: np.tensordot(factors, matrices(q)[terms], 1))
        for places in (uses,) if uses == (MOVED,) else (uses, (*uses, MOVED)):
            said = text(places, more)
            if said:
                yield Reading(said, lambda e, p=places: turned.made(e, p))  # type: ignore[misc]

    return readings


def _form_text(uses: tuple[str, ...], more: Few) -> str:
    return form_text(_what(uses), more, into_body=MOVED not in uses)


def _what(uses: tuple[str, ...]) -> str:
    verb = "are" if len(uses) > 1 else "is"
    ways = "" if MOVED in uses and len(uses) > 1 else _way(uses)
    return f"{listed([USES[use] for use in uses])} {verb} {ways or 'turned'}"


def _way(uses: tuple[str, ...]) -> str:
    return "taken to world axes" if MOVED in uses else "taken into body axes"
