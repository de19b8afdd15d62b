"""Causes of a pivoted body that is placed by another lever than the one from pivot to centre."""

from __future__ import annotations

import numpy as np

from omegadot.diagnosis.equations.across import Across
from omegadot.diagnosis.equations.hypotheses import hypotheses
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
    pairs = list[tuple[Array, Array]]()
    for one in across.scenes.values():
        if one.states is not None and one.system.load.pivot is not None:
            other = _held_lever(one.system, *one.states)
            due = np.asarray(lever_of(one.system), dtype=float)
            pairs.append((due, due if other is None else other))
    law = law_of(pairs, "the lever from the pivot to the centre of mass", "m") if pairs else ""
    found = law or _known_lever(case.system, held)
    return [found] if found else [_numbers(case.system, held)] * numbers


def _held_lever(system: System, requested: State, back: State) -> Array | None:
    """The lever in body axes, m, by which a body is placed; None where it is the right one.

    None as well where something else is wrong.
    """
    due = np.asarray(lever_of(system), dtype=float)
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


def _known_lever(system: System, held: Array) -> str:
    due = np.asarray(lever_of(system), dtype=float)
    size = float(np.linalg.norm(held)) + float(np.linalg.norm(due))
    for one in sorted(hypotheses(system), key=lambda one: one.part != "precision"):
        if one.part in ("precision", "pivot", "center"):
            other = one.system(system)
            placed = other.load.pivot is not None
            if placed and np.linalg.norm(held - lever_of(other)) <= CLOSE * size:
                return one.text
    k = float(held @ due) / float(due @ due) if np.any(due) else 0.0
    if np.linalg.norm(held) <= CLOSE * size:
        return "the lever from the pivot to the centre of mass is taken for zero"
    if np.linalg.norm(held - k * due) <= CLOSE * size:
        return f"the lever from the pivot to the centre of mass is scaled by {factor(k)}"
    return ""


def _numbers(system: System, held: Array) -> str:
    due = np.asarray(lever_of(system), dtype=float)
    shown = f"{vector(held, due)} m from the pivot, where {vector(due, held)} m was requested"
    return f"the centre of mass is placed {shown}: either of them is another"
