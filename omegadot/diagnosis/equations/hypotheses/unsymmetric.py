"""A tensor of inertia that is no longer symmetric: a triangle, or a single number, is wrong."""

from __future__ import annotations

from collections.abc import Callable, Iterator

import numpy as np

from omegadot.diagnosis.equations.hypotheses.hypothesis import (
    Hypothesis,
    given,
    of_form,
    own_inertia,
)
from omegadot.reference_impl.inertia import moving_inertia
from omegadot.reference_impl.system import Array, System

Change = Callable[[Array], Array]


def _entry(i: int, j: int, factor: float, tensor: Array) -> Array:
    other = tensor.copy()
    other[i, j] *= factor
    return other


def _changes() -> Iterator[tuple[str, Change]]:
    yield "the lower triangle of the inertia is zero", np.triu
    yield "the upper triangle of the inertia is zero", np.tril
    for i in range(3):
        for j in range(3):
            if i != j:
                name = f"the number {'xyz'[i]}{'xyz'[j]} of the inertia alone"
                yield f"{name} is zero", given(i, j, 0.0, _entry)
                yield f"{name} has the wrong sign", given(i, j, -1.0, _entry)


CHANGES = tuple(_changes())
OF_WHOLE = "of what stays, "


def of_whole(text: str) -> str:
    """A text about the inertia as one of what stays, which without a lever is the same."""
    found = next((change for change, _ in CHANGES if change in text), None)
    return text.replace(found, OF_WHOLE + found) if found and OF_WHOLE not in text else text


def unsymmetric_hypotheses(system: System) -> Iterator[Hypothesis]:
    """Of the inertia about the centre of mass, and of that about the pivot."""
    own = own_inertia(system)
    about = np.asarray(moving_inertia(system), dtype=float) - own
    products = bool(np.any(own - np.diag(np.diag(own))))
    for text, change in CHANGES:
        if np.any(about):
            whole = OF_WHOLE + text
            yield from _in_places(whole, given(change, _whole))
        if products:
            yield from _in_places(text, given(change, _own))


def _in_places(text: str, tensor: Callable[[System], Array]) -> Iterator[Hypothesis]:
    def solve(system: System) -> Array:
        return np.asarray(np.linalg.inv(tensor(system)))

    yield of_form(
        f"in the dynamics, {text}",
        "inertia",
        lambda f, s: {"solve": solve(s), "spin": tensor(s)},
    )
    yield of_form(
        f"where omega-dot is solved for, {text}", "inertia", lambda f, s: {"solve": solve(s)}
    )
    yield of_form(f"in the gyroscopic term, {text}", "spin", lambda f, s: {"spin": tensor(s)})


def _whole(change: Change, system: System) -> Array:
    return np.asarray(change(np.asarray(moving_inertia(system), dtype=float)))


def _own(change: Change, system: System) -> Array:
    own = own_inertia(system)
    return np.asarray(moving_inertia(system) - own + change(own))
