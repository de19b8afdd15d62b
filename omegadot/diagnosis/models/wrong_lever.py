"""Causes of a pivoted body that is placed by another lever than the one from pivot to centre."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence

import numpy as np

from omegadot.diagnosis.equations.across import Across
from omegadot.diagnosis.equations.hypotheses import hypotheses
from omegadot.diagnosis.equations.hypotheses.hypothesis import Hypothesis
from omegadot.diagnosis.wording.digits import factor, vector
from omegadot.diagnosis.wording.laws import law_of
from omegadot.gates.case import Case
from omegadot.gates.states.equation import EvaluationStates
from omegadot.harness.drive import CaseResult
from omegadot.reference_impl.cross_product import cross
from omegadot.reference_impl.inertia import lever as lever_of
from omegadot.reference_impl.rotations import attitude_angle, rotate, rotate_inverse
from omegadot.reference_impl.system import Array, State, System

CLOSE = 1e-9  # relative: numbers of a state that are the same
LEVER = "the lever from the pivot to the centre of mass"
FROM_CENTER = (
    f"{LEVER} is the pivot's coordinates with the other sign: either the pivot is taken as given "
    "from the centre of mass, or the centre of mass as the origin"
)


def lever_causes(
    across: Across,
    case: Case,
    evaluation_states: EvaluationStates,
    result: CaseResult,
    *,
    numbers: bool = True,
) -> list[str]:
    """A pivoted body that is placed by another lever; its attitude and omega are right.

    numbers: whether a lever of no known kind is stated as well, by its numbers.
    """
    if not result.model.ok or case.system.load.pivot is None:
        return []
    state = State(**result.model.result["state"])
    held = _held_lever(case.system, evaluation_states.random[0], state)
    if held is None:
        return []
    systems, levers = list[System](), list[Array]()
    for one in across.scenes.values():
        if one.states is not None and one.system.load.pivot is not None:
            other = _held_lever(one.system, *one.states)
            systems.append(one.system)
            levers.append(_due(one.system) if other is None else other)
    found = law_of_levers(systems, levers) if systems else ""
    found = found or _known_lever(case.system, held, systems, levers)
    return [found] if found else [_numbers(case.system, held)] * numbers


def _due(system: System) -> Array:
    return np.asarray(lever_of(system), dtype=float)


def law_of_levers(systems: Sequence[System], levers: Sequence[Array]) -> str:
    """Of the levers, or of the centres of mass where the pivots are right; "" without any."""
    due = [_due(one) for one in systems]
    pivots = [np.asarray(one.load.pivot, dtype=float) for one in systems]
    if all(_same(held, -pivot) for pivot, held in zip(pivots, levers, strict=True)):
        return FROM_CENTER
    text = law_of([*zip(due, levers, strict=True)], LEVER, "m")
    centers = [np.asarray(one.body.center_of_mass, dtype=float) for one in systems]
    moved = [c + lever - d for c, lever, d in zip(centers, levers, due, strict=True)]
    return text or law_of([*zip(centers, moved, strict=True)], "the centre of mass", "m")


def _held_lever(system: System, requested: State, back: State) -> Array | None:
    """The lever in body axes, m, by which a body is placed; None where it is the right one.

    None as well where something else is wrong.
    """
    due = _due(system)
    q, w = requested.orientation, requested.angular_velocity
    held = rotate_inverse(back.orientation, back.position)
    size = float(np.linalg.norm(held)) + float(np.linalg.norm(due))
    moved = rotate(q, cross(w, held))
    same = attitude_angle(back.orientation, q) <= CLOSE
    same &= np.linalg.norm(back.angular_velocity - w) <= CLOSE * np.linalg.norm(w)
    apart = np.linalg.norm(back.linear_velocity - moved)
    if not np.isfinite(apart) or not same or apart > CLOSE * size * np.linalg.norm(w):
        return None
    return held if np.linalg.norm(held - due) > CLOSE * size else None


def _known_lever(
    system: System, held: Array, systems: Sequence[System], levers: Sequence[Array]
) -> str:
    """A lever of a known kind, with how many other scenarios have it not though they would."""
    for text, made in _known(system, held):
        others = [
            _same(lever, _due(one))
            for one, lever in zip(systems, levers, strict=True)
            if not _same(made(one), lever)
        ]
        if not all(others):  # another lever is wrong by something else
            continue
        many = f"{len(others)} other{'s' * (len(others) > 1)}"
        return f"{text}, not on {many} that would show it" if others else text
    return ""


def _known(system: System, held: Array) -> Iterator[tuple[str, Callable[[System], Array]]]:
    """Each that makes this lever, and what it makes of any system."""
    for one in sorted(hypotheses(system), key=lambda one: one.part != "precision"):
        if one.part in ("precision", "pivot", "center"):

            def made(other: System, one: Hypothesis = one) -> Array:
                changed = one.system(other)
                return _due(changed if changed.load.pivot is not None else other)

            if one.system(system).load.pivot is not None and _same(made(system), held):
                yield one.text, made
    due = _due(system)
    k = float(held @ due) / float(due @ due) if np.any(due) else 0.0
    if _same(held, 0.0 * due, due):
        yield f"{LEVER} is taken for zero", lambda other: 0.0 * _due(other)
    elif _same(held, k * due, due):
        yield f"{LEVER} is scaled by {factor(k)}", lambda other: k * _due(other)


def _same(one: Array, other: Array, beside: Array | None = None) -> bool:
    """Whether two levers are one. beside: a lever of which they may be a small part."""
    size = float(np.linalg.norm(one)) + float(np.linalg.norm(other if beside is None else beside))
    return bool(np.linalg.norm(one - other) <= CLOSE * size)


def _numbers(system: System, held: Array) -> str:
    due = _due(system)
    shown = f"{vector(held, due)} m from the pivot, where {vector(due, held)} m was requested"
    return f"the centre of mass is placed {shown}: either of them is another"
