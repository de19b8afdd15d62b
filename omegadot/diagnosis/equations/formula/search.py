"""The search: which vector is along what an engine adds, and how its size goes, over a run."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from omegadot.diagnosis.equations.evidence import INVERSE, SLACK, Evidence
from omegadot.diagnosis.equations.formula.facts import product, rates_of, terms_of
from omegadot.diagnosis.equations.formula.formula import Formula, Kind, Where
from omegadot.diagnosis.equations.formula.law_search import laws
from omegadot.diagnosis.equations.formula.rows import Rows, across, rows_of
from omegadot.diagnosis.equations.formula.tensors import OtherInertia, other_inertias, with_law
from omegadot.diagnosis.equations.formula.vectors import blocks
from omegadot.gates.bounds.scales import norm
from omegadot.reference_impl.system import Array

AnyFormula = Formula | OtherInertia
SCREENED = 1e-9  # relative: what cancels in a product may leave so much of its rounding
VISIBLE, SEEN = 30.0, 0.1  # bounds; part of the states
SCENARIOS, STATES, FEW = 8, 6, 4  # of which vectors are tried; states of the first of these
IN_LAWS = 24  # states of each scenario
MOST_TRIED = 24  # vectors whose size is looked at


@dataclass(frozen=True)
class Found:
    """found: the plainest first.  along: what all that is added is along, whatever its size."""

    found: Sequence[AnyFormula] = ()
    along: str = ""
    hopeless: bool = False  # it is seen, and nothing is along it


def formulas(
    failing: Sequence[Evidence], others: Sequence[Evidence] = (), linear: bool = False
) -> Found:
    """Those that may be the engine's equation, the plainest first; each has yet to be held.

    failing: of the scenarios on which it is wrong.  others: of the same systems with one size
    changed.
    """
    every = [one for one in failing if _shows(one, linear)]
    if not every:
        return Found()
    with np.errstate(all="ignore"):
        chosen = _spread(every, linear)
        rows = rows_of([e.at(p) for e, p in chosen], linear)
        few = np.unique(rows.system, return_index=True)[1]
        few = np.unique([*few[:FEW], *np.linspace(0, len(rows.bound) - 1, FEW).astype(int)])
        held = {e.system.load.pivot is not None for e in every}
        where: Where = "any" if len(held) > 1 else "pivoted" if held == {True} else "free"
        near = sorted(_along(rows, few, linear, where), key=lambda one: one.cost)
        more = [e for e in others if _shows(e, linear)]
        seen = _visible([*every, *more], linear)
        found: list[AnyFormula] = [x for v in near[:MOST_TRIED] for x in _with_law(v, seen)]
        if not linear and every[0].source != INVERSE:
            found += [x for one in other_inertias(rows) for x in with_law(one, seen)]
    nothing = not found and not near
    along = next((one.direction for one in near if not one.instead), "")
    return Found(sorted(found, key=lambda one: one.cost), along, nothing)


def _shows(evidence: Evidence, linear: bool) -> bool:
    """Whether it is seen at more than a few states, where rounding itself may be small."""
    if not evidence.finite:
        return False
    if linear and evidence.system.load.pivot is not None and np.any(_off(evidence, False) > 1.0):
        return False  # it follows from a wrong omega-dot
    return bool(np.mean(_off(evidence, linear) > VISIBLE) > SEEN)


def _off(evidence: Evidence, linear: bool) -> Array:
    """What an engine is off by at every state, in bounds."""
    kind = "linear" if linear else "angular"
    rest = norm(getattr(evidence.found, kind) - getattr(evidence.true, kind))
    bound = evidence.linear_bound if linear else evidence.angular_bound
    return np.where(np.isfinite(bound), rest / bound, 0.0)


def _spread(every: Sequence[Evidence], linear: bool) -> list[tuple[Evidence, NDArray[np.intp]]]:
    """A few scenarios, free and pivoted, where it shows best, and states of each."""
    size = [float(np.median(_off(one, linear))) for one in every]
    order = sorted(range(len(every)), key=lambda k: -size[k])
    held = [k for k in order if every[k].system.load.pivot is not None]
    free = [k for k in order if k not in held]
    half = SCENARIOS // 2
    kept = [*held[: max(half, SCENARIOS - len(free))], *free[: max(half, SCENARIOS - len(held))]]
    found = []
    for k in kept[:SCENARIOS]:
        off = _off(every[k], linear)
        seen = np.flatnonzero(off > VISIBLE)
        step = max(1, len(seen) // STATES)
        found.append((every[k], seen[::step][:STATES]))
    return found


def _targets(rows: Rows, linear: bool, where: Where) -> dict[str, Array]:
    """What a vector must be along: what is added, or what stands in place of a right term."""
    facts, found = rows.facts, {"": rows.due}
    if linear:
        terms = rates_of(facts, where == "pivoted") if where != "any" else {}
    else:
        inverse = facts.matrices["I^-1"]
        terms = {name: product(inverse, term) for name, term in terms_of(facts).items()}
    for name, term in terms.items():
        if np.any(term):
            found[name] = rows.due + term
    return found


def _along(rows: Rows, few: NDArray[np.intp], linear: bool, where: Where) -> Iterator[Formula]:
    """The vectors that are along a target at all of these states."""
    kinds: tuple[Kind, ...] = ("linear",) if linear else ("torque", "rate")
    first, targets = rows.at(few), _targets(rows, linear, where)
    inverse = first.facts.matrices["I^-1"]
    for values, named in blocks(rows.facts, few):
        for kind in kinds:
            lanes = product(inverse, values) if kind == "torque" else values
            size = norm(lanes)
            unit = lanes / np.where(size > 0.0, size, 1.0)[..., None]
            for instead, due in targets.items():
                allowed = SLACK * first.bound + SCREENED * norm(due[few])
                left = norm(due[few] - np.sum(due[few] * unit, -1, keepdims=True) * unit)
                for k in np.flatnonzero(np.all(left <= allowed, axis=-1)):
                    one = Formula(kind, named(int(k)), instead=instead, where=where)
                    if _holds(one, rows, due) and not _is_scaled(one, rows):
                        yield one


def _holds(one: Formula, rows: Rows, due: Array) -> bool:
    values = one.accelerations(rows.facts)
    return bool(np.all(across(due, values) <= rows.allowed(values, due, one.sizes(rows.facts))))


def _is_scaled(one: Formula, rows: Rows) -> bool:
    """Whether what stands in place of a torque is along it, and so along what is added as well."""
    if not one.instead:
        return False
    values, term = one.accelerations(rows.facts), one.replaced(rows.facts)
    return bool(np.all(across(term, values) <= SLACK * rows.bound))


def _visible(every: Sequence[Evidence], linear: bool) -> Rows:
    """The states that show it, of every scenario."""
    parts = []
    for evidence in every:
        seen = np.flatnonzero(_off(evidence, linear) > VISIBLE)
        if len(seen):
            parts.append(evidence.at(seen[:: max(1, len(seen) // IN_LAWS)]))
    return rows_of(parts, linear)


def _with_law(one: Formula, rows: Rows) -> Iterator[Formula]:
    """The same with its size: as one law over all scenarios."""
    due = rows.due + one.replaced(rows.facts)
    for law in laws(rows.seen(one.accelerations(rows.facts), due, one.sizes(rows.facts))):
        yield replace(one, law=law)
