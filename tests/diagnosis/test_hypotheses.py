"""Every wrong equation that is listed is one by itself: it acts, and no other of the list is it."""

from __future__ import annotations

from itertools import combinations

import numpy as np

from omegadot.diagnosis.equations.equation_form import Form, form_of
from omegadot.diagnosis.equations.hypotheses import FIXED, wrong_form
from omegadot.diagnosis.models.tensors import mistaken_inertias
from omegadot.harness.random_cases import random_case
from omegadot.reference_impl.system import Array

SYSTEMS = [random_case(1, index).system for index in range(32)]


def numbers(form: Form | None, size: int) -> Array:
    """All numbers of an equation in one row; nan where it has no meaning."""
    if form is None:
        return np.full(size, np.nan)
    return np.concatenate([np.ravel(part) for part in vars(form).values()])


def test_each_listed_equation_acts_and_is_no_other() -> None:
    """Caught: a sign that is squared, and one mistake that two files list."""
    known = list({one.text: one for one in FIXED}.values())
    acts, pairs = set[str](), set(combinations(range(len(known)), 2))
    for system in SYSTEMS:
        right = numbers(form_of(system), 0)
        rows = np.array([numbers(wrong_form([one], system), len(right)) for one in known])
        near = 1e-12 * np.maximum(np.abs(right), 1e-3)
        same = np.all(np.abs(rows - right) <= near, axis=1) | np.isnan(rows[:, 0])
        acts |= {one.text for one, none in zip(known, same, strict=True) if not none}
        alike = [np.all((np.abs(rows - row) <= near), axis=1) for row in rows]
        pairs = {(i, j) for i, j in pairs if alike[i][j] or (same[i] and same[j])}
    assert {one.text for one in known} == acts
    assert not [(known[i].text, known[j].text) for i, j in pairs]


def test_each_mistaken_inertia_is_another() -> None:
    """Caught: the axes of -R beside those of R, which make one tensor."""
    system = next(s for s in SYSTEMS if s.load.pivot is not None and full(s.body.inertia))
    found = [tensor for _, tensor in mistaken_inertias(system.body, system)]
    for one, other in combinations(found, 2):
        assert not np.allclose(one, other, rtol=1e-12, atol=0.0)


def full(tensor: Array) -> bool:
    return bool(np.all(tensor)) and len(np.unique(np.linalg.eigvalsh(tensor))) == 3
