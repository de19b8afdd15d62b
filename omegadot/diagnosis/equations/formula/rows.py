"""States of several scenarios in one row, and what an engine adds there."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from omegadot.diagnosis.equations.evidence import SLACK, Evidence
from omegadot.diagnosis.equations.formula.facts import Facts, at, facts_of, together
from omegadot.diagnosis.equations.formula.law_search import Seen
from omegadot.gates.bounds.scales import norm
from omegadot.reference_impl.rotations import rotate_inverse
from omegadot.reference_impl.system import Array

ROUNDINGS = 16.0  # of a product of a few vectors


@dataclass(frozen=True)
class Rows:
    """due: (n, 3) and bound: (n,), what is added, as accelerations in body axes.

    system: (n,), the number of each state's scenario.
    """

    facts: Facts
    due: Array
    bound: Array
    system: NDArray[np.intp]
    eps: float

    def at(self, places: NDArray[np.intp]) -> Rows:
        """These states alone."""
        parts = (self.due[places], self.bound[places], self.system[places])
        return Rows(at(self.facts, places), *parts, self.eps)

    def allowed(self, values: Array, due: Array, sizes: Array) -> Array:
        """(n,): how far vectors (n, 3) may be from what is due.

        sizes: (n,), what the parts of each multiply to. Where terms cancel in a product, its own
        rounding is more than that of the engine's answer.
        """
        length = norm(values)
        own = ROUNDINGS * self.eps * norm(due) * sizes / np.where(length > 0.0, length, np.inf)
        return SLACK * self.bound + own

    def seen(self, values: Array, due: Array, sizes: Array) -> Seen:
        """The factor of a vector at every state, (n, 3), that makes what is due."""
        size = np.sum(values * values, axis=-1)
        found = np.sum(values * due, axis=-1) / np.where(size > 0.0, size, np.nan)
        known = self.allowed(values, due, sizes) / norm(due)
        return Seen(found, known, self.system, self.facts)


def rows_of(parts: Sequence[Evidence], linear: bool) -> Rows:
    """Of the linear acceleration, or of omega-dot."""
    due, bound = list[Array](), list[Array]()
    for one in parts:
        if linear:
            rest = one.found.linear - one.true.linear
            due.append(rotate_inverse(one.states.orientation, rest))
            bound.append(one.linear_bound)
        else:
            due.append(one.found.angular - one.true.angular)
            bound.append(one.angular_bound)
    system = np.repeat(np.arange(len(parts)), [len(one) for one in bound])
    facts = together([facts_of(one) for one in parts])
    eps = max(one.eps for one in parts)
    return Rows(facts, np.concatenate(due), np.concatenate(bound), system, eps)


def across(due: Array, values: Array) -> Array:
    """The part of what is due, (n, 3), that is not along vectors (..., n, 3)."""
    size = norm(values)[..., None]
    unit = values / np.where(size > 0.0, size, 1.0)
    along = np.sum(due * unit, axis=-1, keepdims=True)
    return norm(due - along * unit)


def factors(values: Array, rows: Rows) -> float:
    """The one factor of vectors (n, 3) that fits best, each state in parts of its bound."""
    weight = np.where(np.isfinite(rows.bound) & (rows.bound > 0.0), 1.0 / rows.bound, 0.0)[:, None]
    line, rest = np.ravel(values * weight), np.ravel(rows.due * weight)
    used = np.isfinite(line) & np.isfinite(rest)
    size = float(line[used] @ line[used])
    return float(line[used] @ rest[used]) / size if size > 0.0 else 0.0
