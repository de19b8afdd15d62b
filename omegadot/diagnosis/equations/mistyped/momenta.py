"""The angular momentum ``L = I omega`` of the gyroscopic term with one component mistyped."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from itertools import combinations_with_replacement, product

import numpy as np

from omegadot.diagnosis.equations.evidence import Evidence
from omegadot.diagnosis.equations.mistyped.few import Few
from omegadot.diagnosis.equations.mistyped.kinds import ANGULAR, Kind
from omegadot.diagnosis.equations.mistyped.products import sum_text
from omegadot.diagnosis.equations.operators.operands import pushed
from omegadot.diagnosis.equations.readings import Reading
from omegadot.reference_impl.cross_product import cross
from omegadot.reference_impl.inertia import moving_inertia
from omegadot.reference_impl.symmetric import apply
from omegadot.reference_impl.system import Acceleration, Array

AXES = "xyz"
# The terms I_ij omega_l that may be added: each number of the inertia with each component.
TERMS = [(*ij, axis) for ij, axis in product(combinations_with_replacement(range(3), 2), range(3))]


@dataclass(frozen=True)
class _Typed:
    """``L_k + sum of c I_ij omega_l``. more: the number of the term in TERMS, and c."""

    k: int
    more: Few

    def made(self, e: Evidence) -> Acceleration:
        """The accelerations by an equation that has it."""
        added = sum(c * _terms(e)[place] for place, c in self.more)
        return pushed(e, _gyroscopic(e, self.k, np.asarray(added)))

    @property
    def text(self) -> str:
        """As it is typed, and as it is right."""
        right = {TERMS.index((*sorted((self.k, axis)), axis)): 1.0 for axis in range(3)}  # type: ignore[arg-type]
        typed = dict(right)
        for place, c in self.more:
            typed[place] = typed.get(place, 0.0) + c
        made, due = (sum_text({_name(p): c for p, c in of.items()}) for of in (typed, right))
        what = f"the {AXES[self.k]} component of L = I omega in the gyroscopic term omega x L"
        return f"{what} is {made}, where {due} is right"


def _name(place: int) -> str:
    i, j, axis = TERMS[place]
    return f"I_{AXES[i]}{AXES[j]} omega_{AXES[axis]}"


def _terms(e: Evidence) -> Array:
    """(18, n): of TERMS, with the inertia about what stays."""
    inertia, w = np.asarray(moving_inertia(e.system)), e.states.angular_velocity
    return np.stack([inertia[i, j] * w[:, axis] for i, j, axis in TERMS])


def _gyroscopic(e: Evidence, k: int, momentum: Array) -> Array:
    """The torque (..., n, 3) of a component (..., n) of the momentum."""
    return -cross(e.states.angular_velocity, momentum[..., None] * np.eye(3)[k])


def kinds() -> Iterator[Kind]:
    """Every component."""
    for k in range(3):
        yield Kind(ANGULAR, _lines(k), _readings(k))


def _lines(k: int) -> Callable[[Evidence], Array]:
    """What each of the terms adds to omega-dot, (18, n, 3)."""
    return lambda e: np.asarray(apply(e.solve, _gyroscopic(e, k, _terms(e))))


def _readings(k: int) -> Callable[[Few], Iterator[Reading]]:
    def readings(more: Few) -> Iterator[Reading]:
        typed = _Typed(k, more)
        yield Reading(typed.text, typed.made)

    return readings
