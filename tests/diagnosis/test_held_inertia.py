"""An inertia that reads back with a part of its numbers in single precision."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from wrong_equations import TENSOR, case

from omegadot.diagnosis.equations.across import Across
from omegadot.diagnosis.equations.wrong_equation import scene_of
from omegadot.diagnosis.models.wrong_model import model_causes
from omegadot.gates.states.equation import EvaluationStates, random_acceleration, random_states
from omegadot.harness.drive import CaseResult
from omegadot.reference_impl.system import Array
from omegadot.workers.harness_end.process import Answer

CASES = tuple(
    case(f"size-{k}", {}, 1.0, (s * np.array(TENSOR)).tolist())
    for k, s in enumerate((0.013, 0.37, 5.9))
)


def single(values: Array) -> Array:
    return np.asarray(values.astype(np.float32), dtype=float)


def products(tensor: Array) -> Array:
    kept = np.diag(np.diag(tensor))
    return np.asarray(kept + single(tensor - kept))


def moments(tensor: Array) -> Array:
    kept = np.diag(np.diag(tensor))
    return np.asarray(single(kept) + tensor - kept)


def one_product(tensor: Array) -> Array:
    made = tensor.copy()
    made[0, 1] = made[1, 0] = single(tensor[0, 1])
    return made


def named(change: Callable[[Array], Array]) -> set[str]:
    across, rows = Across(), []
    for one in CASES:
        x = random_states(one, 4, [1])
        body = replace(one.system.body, inertia=change(np.asarray(one.system.body.inertia)))
        model = {"bodies": [vars(body)], "state": vars(x[0])}
        states = EvaluationStates(x, x, random_acceleration(one.system, x, [2]))
        result = CaseResult(model=Answer("ok", result=model))
        across.add(scene_of(one, states, result))
        rows.append((one, states, result))
    return {text for row in rows for text in model_causes(across, *row)}


@pytest.mark.parametrize(
    ("change", "what"),
    [
        (products, "the products of inertia alone are"),
        (moments, "the moments of inertia alone are"),
        (single, "the inertia is"),
    ],
)
def test_the_part_that_is_rounded_is_named(change: Callable[[Array], Array], what: str) -> None:
    """Caught: six numbers to compare by eye."""
    assert named(change) == {f"{what} kept in single precision"}


def test_a_single_product_that_is_rounded_is_none_of_these() -> None:
    assert not any("single precision" in text for text in named(one_product))
