"""Causes of a model that does not read back: another body, or states in another convention."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from itertools import permutations

import numpy as np

from omegadot.diagnosis.equations.across import Across
from omegadot.diagnosis.models.misread_state import state_causes
from omegadot.diagnosis.models.tensors import (
    diagonal_in_single,
    in_single,
    other_tensors,
    products_in_single,
)
from omegadot.diagnosis.wording.digits import factor, number, vector
from omegadot.diagnosis.wording.laws import law_of
from omegadot.gates.bounds.scales import EPS, ROUNDINGS_PER_EVALUATION, eps_of
from omegadot.gates.case import Case
from omegadot.gates.states.equation import EvaluationStates
from omegadot.gates.states.model import body_rows
from omegadot.harness.drive import CaseResult
from omegadot.reference_impl.system import Array, Body, State, System
from omegadot.workers.wire import body_from
from omegadot.written import written


def model_causes(
    across: Across, case: Case, evaluation_states: EvaluationStates, result: CaseResult
) -> list[str]:
    """What the engine holds instead of the body and of the state that it was given."""
    if not result.model.ok:
        return []
    held = body_from(result.model.result["bodies"][0])
    if not all(np.all(np.isfinite(values)) for values in vars(held).values()):
        return ["the model reads back numbers that are not finite"]
    eps = eps_of(result.precision)
    failed = {row.metric for row in body_rows(case, held, eps) if row.verdict == "fail"}
    bodies = [(one.system, one.held) for one in across.scenes.values() if one.held is not None]
    parts = {"mass": _masses, "center_of_mass": _centers, "inertia": _inertias}
    found = []
    for part, named in parts.items():
        if part in failed:
            text = _part(part, named, (case.system, held), bodies)
            found += [text] if text else []
    # Of a wrong body the state follows: where it is pivoted, where its centre of mass is.
    if found or failed:
        return found
    state = State(**result.model.result["state"])
    return state_causes(across, case, evaluation_states.random[0], state, eps)


Named = Callable[[System], Iterator[tuple[str, Array]]]
Held = tuple[System, Body]


def _part(part: str, named: Named, here: Held, bodies: Sequence[Held]) -> str:
    """The first name for what is held in place of one part that holds in every scenario."""
    system, held = here

    def fits(text: str, one: Held) -> bool:
        """Where it makes no difference to a body, or matches what is held."""
        other = dict(named(one[0])).get(text)
        requested, back = (np.asarray(getattr(b, part)) for b in (one[0].body, one[1]))
        return other is None or _alike(other, back, 1.0) or _alike(other, requested, 1.0)

    requested, back = (np.asarray(getattr(b, part), dtype=float) for b in (system.body, held))
    condition = float(np.linalg.cond(requested)) if part == "inertia" else 1.0
    for text, value in named(system):
        if not _alike(value, back, condition) or _alike(value, requested, condition):
            continue
        if all(fits(text, one) for one in bodies):
            return text.strip()
    return _by_numbers(part, requested, back, bodies)


def _by_numbers(part: str, requested: Array, back: Array, bodies: Sequence[Held]) -> str:
    """One factor, an addition to the diagonal, or a limit."""
    what = part.replace("_", " ").replace("center", "centre")
    size = float(np.sum(requested * back) / np.sum(requested * requested))
    scaled = np.any(requested) and _alike(size * requested, back, 1.0)
    if part != "inertia":
        pairs = [
            (np.atleast_1d(getattr(s.body, part)), np.atleast_1d(getattr(b, part)))
            for s, b in bodies
        ]
        law = law_of(pairs, f"the {what}", "kg" if part == "mass" else "m") if pairs else ""
        if law and "scaled" not in law:
            return law
        if scaled:
            return f"the {what} is {factor(size)} times what was requested"
        shown = vector(np.atleast_1d(back), np.atleast_1d(requested))
        due = vector(np.atleast_1d(requested), np.atleast_1d(back))
        return f"the {what} reads back as {shown} m, where {due} was requested"
    if scaled:
        return f"the inertia is {factor(size)} times what was requested"
    more = back - requested
    added = float(np.trace(more)) / 3.0
    if _alike(requested + added * np.eye(3), back, 1.0):
        return f"{number(added)} kg m^2 is added to the diagonal of the inertia (an armature)"
    return _moments(requested, back)


def _moments(requested: Array, back: Array) -> str:
    """A least value of the moments or of the diagonal, or right moments about wrong axes."""
    moments, axes = np.linalg.eigh(requested)
    least = float(np.min(np.linalg.eigvalsh(back)))
    if _alike((axes * np.maximum(moments, least)) @ axes.T, back, 1.0):
        return f"every principal moment of inertia is held above {number(least)} kg m^2"
    least = float(np.min(np.diag(back)))
    held = np.maximum(np.diag(requested), least)
    if _alike(requested + np.diag(held - np.diag(requested)), back, 1.0):
        return f"the diagonal of the inertia is held above {number(least)} kg m^2"
    condition = float(np.linalg.cond(requested))
    if _alike(np.diag(moments), np.diag(np.linalg.eigvalsh(back)), condition):
        return "the inertia's moments are right, and its axes are not"
    off = float(np.linalg.norm(back - requested, 2) / np.linalg.norm(requested, 2))
    rows = "; ".join(vector(row, own) for row, own in zip(back, requested, strict=True))
    text = f"the dynamics are those of another inertia, {written(100 * off, 2)} % off"
    return f"{text}: it reads back as {rows} kg m^2"


def _alike(one: Array, other: Array, condition: float) -> bool:
    bound = ROUNDINGS_PER_EVALUATION * EPS * condition * np.linalg.norm(one)
    return bool(np.linalg.norm(one - other) <= bound)


def _masses(system: System) -> Iterator[tuple[str, Array]]:
    mass = np.asarray(system.body.mass, dtype=float)
    yield "the mass is kept in single precision", in_single(mass)
    yield "the mass is inverted: its reciprocal is held", 1.0 / mass
    yield "the mass is 1 kg, whatever was requested", np.ones(())


def _centers(system: System) -> Iterator[tuple[str, Array]]:
    center = np.asarray(system.body.center_of_mass, dtype=float)
    yield "the centre of mass is kept in single precision", in_single(center)
    yield "the centre of mass is ignored: it reads back at the body's origin", 0 * center
    yield "the centre of mass has the wrong sign: it lies on the origin's other side", -center
    for axis in range(3):
        alone, name = np.arange(3) == axis, "xyz"[axis]
        yield f"the {name} component of the centre of mass is dropped", np.where(alone, 0, center)
        flipped = np.where(alone, -center, center)
        yield f"the {name} component of the centre of mass has the wrong sign", flipped
    for order in permutations(range(3)):
        if order != (0, 1, 2):
            names = ", ".join("xyz"[k] for k in order)
            text = f"the centre of mass's components are permuted: x, y, z hold those of {names}"
            yield text, center[list(order)]
    if system.load.pivot is not None:
        pivot = np.asarray(system.load.pivot, dtype=float)
        yield "the centre of mass is given from the pivot, not from the origin", center - pivot
        yield "the centre of mass is moved by the pivot", center + pivot


def _inertias(system: System) -> Iterator[tuple[str, Array]]:
    tensor = np.asarray(system.body.inertia, dtype=float)
    yield "the inertia is kept in single precision", in_single(tensor)
    alone = "of inertia alone are kept in single precision"
    yield f"the moments {alone}", diagonal_in_single(tensor)
    yield f"the products {alone}", products_in_single(tensor)
    yield from other_tensors(system).items()
