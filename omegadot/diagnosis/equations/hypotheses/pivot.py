"""What engines make of a pivot, and of the lever from it."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace
from itertools import permutations
from typing import Any

import numpy as np

from omegadot.diagnosis.equations.hypotheses.hypothesis import (
    AXES,
    Hypothesis,
    given,
    of_load,
)
from omegadot.reference_impl.system import Array, Load, System


def pivot_hypotheses() -> Iterator[Hypothesis]:
    """Each of them."""

    def pivot(change: Callable[[Array], Array | None]) -> Callable[[Load], dict[str, Any]]:
        return lambda one: {"pivot": None if one.pivot is None else change(one.pivot)}

    yield of_load("the pivot is ignored: the body moves freely", "pivot", pivot(lambda p: None))
    yield of_load(
        "the body is pivoted at its origin instead of the pivot", "pivot", pivot(lambda p: 0 * p)
    )
    yield of_load("the pivot has the wrong sign", "pivot", pivot(lambda p: -p))
    for axis in range(3):
        alone = np.arange(3) == axis
        yield of_load(
            f"the {AXES[axis]} component of the pivot is dropped",
            "pivot",
            pivot(given(alone, lambda k, p: np.where(k, 0.0, p))),
        )
        yield of_load(
            f"only the {AXES[axis]} component of the pivot is used",
            "pivot",
            pivot(given(alone, lambda k, p: np.where(k, p, 0.0))),
        )
        yield of_load(
            f"the {AXES[axis]} component of the pivot has the wrong sign",
            "pivot",
            pivot(given(alone, lambda k, p: np.where(k, -p, p))),
        )
    for order in permutations(range(3)):
        if order != (0, 1, 2):
            names = ", ".join(AXES[k] for k in order)
            yield of_load(
                f"the pivot's components are permuted: x, y, z hold what belongs to {names}",
                "pivot",
                pivot(given(order, lambda k, p: p[list(k)])),
            )
    for axis in range(3):
        alone = np.arange(3) == axis
        yield _lever(
            f"only the {AXES[axis]} component of the lever from the pivot to the centre of mass "
            "is used",
            given(alone, lambda k, r: np.where(k, r, 0.0)),
        )
        yield _lever(
            f"the {AXES[axis]} component of the lever from the pivot to the centre of mass is "
            "dropped",
            given(alone, lambda k, r: np.where(k, 0.0, r)),
        )
        yield _lever(
            f"the lever from the pivot to the centre of mass is laid along {AXES[axis]}",
            given(alone, lambda k, r: np.where(k, np.linalg.norm(r), 0.0)),
        )
        yield _lever(
            f"the lever from the pivot to the centre of mass is laid along -{AXES[axis]}",
            given(alone, lambda k, r: np.where(k, -np.linalg.norm(r), 0.0)),
        )
    yield _lever("the lever from the pivot to the centre of mass loses its signs", np.abs)
    yield _lever("the lever from the pivot to the centre of mass has the wrong sign", lambda r: -r)


def _lever(text: str, change: Callable[[Array], Array]) -> Hypothesis:
    """Another lever by another centre of mass, of a pivoted body alone."""

    def other(system: System) -> System:
        body, pivot = system.body, system.load.pivot
        if pivot is None:
            return system
        center = pivot + change(body.center_of_mass - pivot)
        return replace(system, bodies=(replace(body, center_of_mass=center),))

    return Hypothesis(text, "pivot", system=other)
