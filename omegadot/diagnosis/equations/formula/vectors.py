"""Products of known vectors and matrices, and all of them side by side at the states of a run."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from omegadot.diagnosis.equations.formula.facts import MATRICES, VECTORS, Facts, Unit, at, product
from omegadot.gates.bounds.scales import norm
from omegadot.reference_impl.cross_product import cross
from omegadot.reference_impl.system import Array
from omegadot.written import written

INVERSE = {("I", "I^-1"), ("I^-1", "I"), ("R", "R^T"), ("R^T", "R")}
SAME = 1e-12  # relative: what is the same on all of a run


@dataclass(frozen=True)
class Vector:
    """One vector as a formula: its text, unit, how many parts it has, and its values."""

    text: str
    unit: Unit
    cost: float
    of: Callable[[Facts], Array]
    size: Callable[[Facts], Array]  # (n,): what its parts multiply to, of which it is rounded

    @property
    def inner(self) -> str:
        """As part of a longer formula."""
        return f"({self.text})" if " x " in self.text or " o " in self.text else self.text


Block = tuple[Array, Callable[[int], Vector]]  # values (k, n, 3), and what each of them is


def _added(one: Unit, other: Unit) -> Unit:
    return (one[0] + other[0], one[1] + other[1], one[2] + other[2])


def known(name: str) -> Vector:
    """One of the known vectors. Axes are less likely."""
    cost = 1.5 if name.startswith(("e_", "E_")) or name in ("omega-dot", "a") else 1.0
    size = lambda f: norm(f.vectors[name])  # noqa: E731
    return Vector(name, VECTORS[name][0], cost, lambda f: f.vectors[name], size)


def times(name: str, one: Vector) -> Vector:
    """A matrix times a vector."""
    unit = _added(MATRICES[name][0], one.unit)
    text = f"{name} {one.text if _matrix_of(one.text) else one.inner}"

    def size(facts: Facts) -> Array:
        return np.asarray(
            np.sqrt(np.sum(facts.matrices[name] ** 2, axis=(-1, -2))) * one.size(facts)
        )

    return Vector(text, unit, one.cost + 0.8, lambda f: product(f.matrices[name], one.of(f)), size)


def crossed(one: Vector, other: Vector) -> Vector:
    """The cross product."""
    unit, text = _added(one.unit, other.unit), f"{one.inner} x {other.inner}"
    return Vector(
        text,
        unit,
        one.cost + other.cost + 0.2,
        lambda f: cross(one.of(f), other.of(f)),
        lambda f: one.size(f) * other.size(f),
    )


def each(one: Vector, other: Vector) -> Vector:
    """Component by component; of a vector with itself each keeps its sign."""
    unit = _added(one.unit, other.unit)
    text = f"{one.inner} o {other.inner}"
    return Vector(
        text,
        unit,
        one.cost + other.cost + 0.7,
        lambda f: one.of(f) * other.of(f),
        lambda f: one.size(f) * other.size(f),
    )


def powers(one: Vector, power: float) -> Vector:
    """A power of each component, with its sign."""
    unit = tuple(power * k for k in one.unit)
    text = f"|{one.text}_i|^{written(power - 1)} {one.text}_i" if power else f"sign({one.text}_i)"
    text = text.replace("^1 ", " ")

    def values(facts: Facts) -> Array:
        v = one.of(facts)
        return np.asarray(np.sign(v) * np.abs(v) ** power)

    unit3 = (unit[0], unit[1], unit[2])
    return Vector(text, unit3, one.cost + 0.9, values, lambda f: one.size(f) ** power)


def _distinct(vectors: list[Vector], facts: Facts) -> tuple[list[Vector], Array]:
    """Without those that vanish somewhere, and those that are along another at every state."""
    kept, units, rows = list[Vector](), list[Array](), list[Array]()
    for one in vectors:
        values = one.of(facts)
        sizes = np.sqrt(np.sum(values * values, axis=-1))
        if not np.all(np.isfinite(values)) or not np.all(sizes > 0.0):
            continue
        unit = values / sizes[:, None]
        if any(np.all(np.abs(np.sum(unit * x, axis=-1)) > 1.0 - SAME) for x in units):
            continue
        kept.append(one)
        units.append(unit)
        rows.append(values)
    return kept, np.stack(rows) if rows else np.zeros((0, *facts.vectors["omega"].shape))


def blocks(facts: Facts, few: NDArray[np.intp]) -> Iterator[Block]:
    """All vectors that formulas are made of, at a few of the states, in blocks."""
    plain, values = _distinct([known(name) for name in VECTORS], facts)
    matrices = _matrices(facts)
    made = [times(name, one) for name in matrices for one in plain]
    more, rows = _distinct([*plain, *made], facts)
    values, rows, facts = values[:, few], rows[:, few], at(facts, few)
    yield rows, lambda k: more[k]
    short = [k for k, one in enumerate(plain) if one.cost == 1.0]
    signed = [powers(plain[k], power) for k in short for power in (2.0, 0.0, 3.0, 0.5)]
    if signed:
        yield np.stack([one.of(facts) for one in signed]), lambda k: signed[k]
    i, j = np.triu_indices(len(more), 1)
    by = np.array([_matrix_of(one.text) for one in more])
    apart = (by[i] != by[j]) | (by[i] == "")  # of two by one matrix it is that of the plain ones
    i, j = i[apart], j[apart]
    yield cross(rows[i], rows[j]), lambda k: crossed(more[i[k]], more[j[k]])
    deep = _twice(more, matrices)
    if deep:
        moved = np.stack([one.of(facts) for one in deep])
        yield moved, lambda k: deep[k]
        first, second = (np.ravel(x) for x in np.indices((len(short), len(deep))))
        places = np.array(short)[first]
        yield (
            cross(values[places], moved[second]),
            lambda k: crossed(plain[places[k]], deep[second[k]]),
        )
    a, b = np.triu_indices(len(plain), 1)
    inner = cross(values[a], values[b])
    outer, pairs = (np.ravel(x) for x in np.indices((len(more), len(a))))

    def double(k: int) -> Vector:
        return crossed(more[outer[k]], crossed(plain[a[pairs[k]]], plain[b[pairs[k]]]))

    yield cross(rows[outer], inner[pairs]), double
    for name in matrices:
        moved = product(facts.matrices[name], inner)
        yield moved, lambda k, n=name: times(n, crossed(plain[a[k]], plain[b[k]]))  # type: ignore[misc]
    c, d = np.triu_indices(len(plain))
    yield values[c] * values[d], lambda k: each(plain[c[k]], plain[d[k]])


def _twice(more: list[Vector], matrices: list[str]) -> list[Vector]:
    """Two matrices, one after the other, on a vector that is likely."""
    once = [one for one in more if _matrix_of(one.text) and one.cost < 2.0]
    return [
        times(name, one)
        for name in matrices
        for one in once
        if (name, _matrix_of(one.text)) not in INVERSE
    ]


def _matrix_of(text: str) -> str:
    first, _, rest = text.partition(" ")
    return first if rest and first in MATRICES else ""


def _matrices(facts: Facts) -> list[str]:
    """Without those that are zero or that are another."""
    kept = list[str]()
    for name in MATRICES:
        one = facts.matrices[name]
        if np.any(one) and not any(np.array_equal(one, facts.matrices[k]) for k in kept):
            kept.append(name)
    return kept
