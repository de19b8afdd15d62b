"""A solve that is no inverse of the inertia: ``omega-dot = B (torque - omega x I omega)``."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from omegadot.diagnosis.equations.equation_form import form_of
from omegadot.diagnosis.equations.evidence import INVERSE, INVERTED, SLACK, Evidence
from omegadot.diagnosis.wording.digits import listed
from omegadot.diagnosis.wording.products import where_products
from omegadot.reference_impl.cross_product import cross
from omegadot.reference_impl.inertia import moving_inertia
from omegadot.reference_impl.loads import torque
from omegadot.reference_impl.symmetric import apply
from omegadot.reference_impl.system import Array

LEAST = 2  # scenarios that show all nine numbers
ROWS = 9  # states, of three rows each: three times as many as there are numbers
ALIKE = 1e-6  # relative to the matrix: as well as its numbers have to be known
FEW = 4  # entries that differ, of which the others are said to be right

Entries = NDArray[np.bool_]  # (3, 3), those that differ


@dataclass(frozen=True)
class _Solve:
    """One scenario: torques (n, 3) N m that are solved for; weight: (n, 1), of each omega-dot."""

    evidence: Evidence
    torques: Array
    weight: Array
    inertia: Array

    @cached_property
    def fitted(self) -> tuple[Array, Array]:
        """B that fits best, and (3,) how far each of its columns is known."""
        lines, due = (self.weight * x for x in (self.torques, self.evidence.found.angular))
        found = np.linalg.lstsq(lines, due, rcond=None)[0].T
        size = np.linalg.svd(lines, compute_uv=False)
        if not size[-1] > 0.0:
            return found, np.full(3, np.inf)
        return found, SLACK * np.sqrt(np.diag(np.linalg.pinv(lines.T @ lines)))

    @property
    def matrix(self) -> Array | None:
        """The inverse of B; None where the torques do not show all of it."""
        found, known = self.fitted
        if not np.all(np.isfinite(known)) or abs(np.linalg.det(found)) == 0.0:
            return None
        own = np.linalg.inv(found)
        off = np.abs(own) @ np.outer(np.ones(3), known) @ np.abs(own)
        return own if np.max(off) <= ALIKE * np.linalg.norm(own) else None

    def holds(self, solve: Array) -> bool:
        """Whether a matrix in place of the inverse of the inertia makes the engine's answers."""
        form = replace(form_of(self.evidence.system), solve=solve)
        return bool(np.all(np.isfinite(solve))) and self.evidence.is_of(form)

    def holds_by(self, entries: Entries, symmetric: bool, inverse: bool) -> bool:
        """Whether other numbers in these entries do, of the inertia or of its inverse."""
        vectors, right = self.evidence.found.angular, self.inertia
        if inverse:
            right, vectors = np.linalg.inv(right), self.torques
        places = [
            p for p in zip(*np.nonzero(entries), strict=True) if not symmetric or p[0] <= p[1]
        ]
        bases = np.zeros((len(places), 3, 3))
        for base, (i, j) in zip(bases, places, strict=True):
            base[i, j] = 1.0
            if symmetric:
                base[j, i] = 1.0
        due = (self.evidence.found.angular if inverse else self.torques) - apply(right, vectors)
        lines = np.stack([np.ravel(self.weight * apply(one, vectors)) for one in bases], axis=-1)
        more = np.linalg.lstsq(lines, np.ravel(self.weight * due), rcond=None)[0]
        made = right + np.tensordot(more, bases, 1)
        if inverse:
            return self.holds(made)
        return bool(np.linalg.det(made)) and self.holds(np.linalg.inv(made))


def solve_matrix(every: Sequence[Evidence]) -> str:
    """What explains all that is wrong on all scenarios of one source; "" where nothing does."""
    used = [e for e in every if e.finite and e.source not in (INVERSE, INVERTED)]
    wrong = [_solve(e) for e in used if e.clear]
    solves = [one for one in wrong if one is not None]
    if len(solves) < max(LEAST, len(wrong)) or not all(one.holds(one.fitted[0]) for one in solves):
        return ""
    known = [(one.inertia, own) for one in solves if (own := one.matrix) is not None]
    if len(known) < LEAST or all(_is_scaled(*pair) for pair in known):
        return ""
    symmetric = all(_alike(own, own.T, own) for _, own in known)
    text = "omega-dot is solved for with a matrix that is not the inertia"
    kept = "symmetric" if symmetric else "not symmetric"
    right = [e.system for e in used if np.all(e.sound)]
    where = where_products([one.evidence.system for one in solves], right)
    for inverse in (False, True):
        pairs = [tuple(map(np.linalg.inv, pair)) if inverse else pair for pair in known]
        entries = np.any([~_near(due, own) for due, own in pairs], axis=0)
        few = 0 < np.count_nonzero(entries) <= FEW
        if few and all(one.holds_by(entries, symmetric, inverse) for one in solves):
            of = "its inverse differs from the inertia's" if inverse else "differs"
            return f"{text}: it is {kept}, and {of} in {_named(entries, symmetric)} alone{where}"
    return f"{text}: it is {kept}{where}"


def _solve(evidence: Evidence) -> _Solve | None:
    system, states = evidence.system, evidence.states
    inertia, w = np.asarray(moving_inertia(system), dtype=float), states.angular_velocity
    bound = evidence.angular_bound
    weight = np.where(np.isfinite(bound) & (bound > 0.0), 1.0 / bound, 0.0)[:, None]
    if np.count_nonzero(weight) < ROWS:
        return None
    torques = torque(system, states) - cross(w, apply(inertia, w))
    return _Solve(evidence, torques, weight, inertia)


def _alike(one: Array, other: Array, size: Array) -> bool:
    return bool(np.all(np.abs(one - other) <= ALIKE * np.linalg.norm(size)))


def _near(due: Array, own: Array) -> Entries:
    return np.asarray(np.abs(own - due) <= ALIKE * np.linalg.norm(due))


def _is_scaled(due: Array, own: Array) -> bool:
    """Whether a factor of omega-dot does the same."""
    return _alike(own, float(np.sum(own * due) / np.sum(due * due)) * due, own)


def _named(entries: Entries, symmetric: bool) -> str:
    places = zip(*np.nonzero(entries), strict=True)
    return listed([f"{'xyz'[i]}{'xyz'[j]}" for i, j in places if not symmetric or i <= j])
