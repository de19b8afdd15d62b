"""Causes of a model that does not read back: another body, or states in another convention."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import permutations, product

import numpy as np

from omegadot.diagnosis.misreadings import misreadings
from omegadot.gates.case import Case
from omegadot.gates.equation import EvaluationStates
from omegadot.gates.model import body_rows, state_rows
from omegadot.gates.scales import EPS, ROUNDINGS_PER_EVALUATION, norm
from omegadot.harness.drive import CaseResult
from omegadot.reference_impl.inertia import parallel_axis
from omegadot.reference_impl.system import Array, Body, State, System
from omegadot.workers.wire import body_from


def causes(case: Case, evaluation_states: EvaluationStates, result: CaseResult) -> list[str]:
    """What the engine holds instead of the body and of the state that it was given."""
    if not result.model.ok:
        return []
    held = body_from(result.model.result["bodies"][0])
    if not all(np.all(np.isfinite(values)) for values in vars(held).values()):
        return ["the model reads back numbers that are not finite"]
    failed = {row.metric for row in body_rows(case, held) if row.verdict == "fail"}
    found = []
    if "mass" in failed:
        factor = float(held.mass) / float(case.system.body.mass)
        found.append(f"the mass is {factor:.6g} times what was requested")
    if "center_of_mass" in failed:
        found += _center(case.system.body, held)
    if "inertia" in failed:
        found += _inertia(case, held)
    # Of a wrong body the state follows: where it is pivoted, where its centre of mass is.
    return found or _state(case, evaluation_states.random[0], State(**result.model.result["state"]))


def _center(requested: Body, held: Body) -> list[str]:
    lever, bound = norm(requested.center_of_mass), ROUNDINGS_PER_EVALUATION * EPS
    if not np.any(held.center_of_mass):
        return ["the centre of mass is ignored: it reads back at the body's origin"]
    if norm(held.center_of_mass + requested.center_of_mass) <= bound * lever:
        return ["the centre of mass has the wrong sign: it lies on the origin's other side"]
    return []


def _alike(one: Array, other: Array, condition: float) -> bool:
    bound = ROUNDINGS_PER_EVALUATION * EPS * condition * np.linalg.norm(one, 2)
    return bool(np.linalg.norm(one - other, 2) <= bound)


def _inertia(case: Case, held: Body) -> list[str]:
    """The first tensor that matches within the gate's bound times the requested one's condition."""
    requested, back = np.asarray(case.system.body.inertia), np.asarray(held.inertia)
    factor = float(np.sum(requested * back) / np.sum(requested * requested))
    if _alike(factor * requested, back, 1.0):
        return [f"the inertia is {factor:.6g} times what was requested"]
    condition = float(np.linalg.cond(requested))
    for text, tensor in mistaken_inertias(case.system.body, case.system):
        if _alike(tensor, back, condition) and not _alike(tensor, requested, condition):
            return [text]
    if _alike(np.diag(np.linalg.eigvalsh(requested)), np.diag(np.linalg.eigvalsh(back)), condition):
        return ["the inertia's moments are right, and its axes are not"]
    return []


def _state(case: Case, requested: State, back: State) -> list[str]:
    def failures(state: State) -> set[str]:
        return {r.channel for r in state_rows(case, requested, state) if r.verdict == "fail"}

    failed = failures(back)
    if not failed:
        return []
    for one in misreadings(case.system):
        if not failures(one.right(back)):
            return [one.statement]
    single = State(*(f.astype(np.float32).astype(float) for f in vars(requested).values()))
    pairs = zip(vars(single).values(), vars(back).values(), strict=True)
    if all(np.array_equal(a, b) for a, b in pairs):
        return ["the state is kept in single precision"]
    return []


def mistaken_inertias(body: Body, system: System) -> Iterator[tuple[str, Array]]:
    """What it would be, and the tensor; the plainest first."""
    tensor = np.asarray(body.inertia, dtype=float)
    diagonal = np.diag(np.diag(tensor))
    moments, axes = np.linalg.eigh(tensor)
    yield "only the diagonal of the inertia is used", diagonal
    yield "the products of inertia have the wrong sign", 2 * diagonal - tensor
    about = "instead of the centre of mass"
    shifted = tensor + parallel_axis(body.mass, body.center_of_mass)
    yield f"the inertia is about the body's origin {about}", shifted
    if system.load.pivot is not None:
        lever = body.center_of_mass - system.load.pivot
        yield f"the inertia is about the pivot {about}", tensor + parallel_axis(body.mass, lever)
    yield "the inertia is inverted: its reciprocal is used", np.linalg.inv(tensor)
    for order in permutations(range(3)):
        if order != (0, 1, 2):
            names = ", ".join("xyz"[k] for k in order)
            text = f"the inertia's axes are permuted: x, y, z hold what belongs to {names}"
            yield text, tensor[np.ix_(order, order)]
    for order in permutations(range(3)):
        text = "the principal moments stand on the diagonal: the rotation of their axes is dropped"
        yield text, np.diag(moments[list(order)])
    # R^T D R for R D R^T, whatever order and signs the axes are kept in
    for order, signs in product(permutations(range(3)), product((1.0, -1.0), repeat=3)):
        turn = axes[:, order] * np.array(signs)
        text = "the rotation of the inertia's principal axes looks transposed"
        yield text, turn.T @ np.diag(moments[list(order)]) @ turn
