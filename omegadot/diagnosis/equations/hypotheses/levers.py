"""What engines make of the lever from the pivot, each place where it is used by itself."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from itertools import permutations
from typing import Any

import numpy as np

from omegadot.diagnosis.equations.equation_form import Form
from omegadot.diagnosis.equations.hypotheses.hypothesis import (
    AXES,
    Hypothesis,
    given,
    of_form,
    own_inertia,
)
from omegadot.reference_impl.inertia import parallel_axis
from omegadot.reference_impl.system import Array, System

Change = Callable[[Array, System], Array]
USES = {
    "in the torque of gravity,": "gravity",
    "in the parallel-axis theorem,": "inertia",
    "in the linear acceleration,": "report",
}
OF_CENTER = "the centre of mass's distance from the origin is taken, not from the pivot"
MIRRORED = "the lever has the wrong sign"
# What has been named with gravity; and in the parallel-axis theorem the sign is squared.
ELSEWHERE = {("gravity", OF_CENTER), ("gravity", MIRRORED), ("inertia", MIRRORED)}


def lever_hypotheses() -> Iterator[Hypothesis]:
    """Every change of the lever in every one of its uses."""
    for where, part in USES.items():
        for text, change in _changes():
            if (part, text) not in ELSEWHERE:
                yield of_form(f"{where} {text}", part, given(part, change, _with_lever))


def _with_lever(part: str, change: Change, form: Form, system: System) -> dict[str, Any]:
    if system.load.pivot is None:
        return {}
    lever = change(form.offset, system)
    if part == "gravity":
        return {"arm": lever}
    if part == "report":
        return {"offset": lever}
    tensor = own_inertia(system) + parallel_axis(float(system.body.mass), lever)
    return {"solve": np.linalg.inv(tensor), "spin": tensor}


def _changes() -> Iterator[tuple[str, Change]]:
    yield OF_CENTER, _of_center
    yield "the pivot's distance from the origin is taken, not from the centre of mass", _of_pivot
    yield "the pivot is added to the centre of mass, not taken from it", _added
    yield MIRRORED, lambda r, s: -r
    yield "the lever loses its signs", lambda r, s: np.abs(r)
    for axis, name in enumerate(AXES):
        alone = np.arange(3) == axis
        ways: dict[str, Callable[[Array, Array], Array]] = {
            f"the {name} component of the lever is dropped": lambda k, r: np.where(k, 0.0, r),
            f"only the {name} component of the lever is used": lambda k, r: np.where(k, r, 0.0),
            f"the {name} component of the lever has the wrong sign": lambda k, r: r * (1 - 2 * k),
        }
        for text, way in ways.items():
            yield text, given(alone, way, lambda k, how, r, s: how(k, r))
    for order in permutations(range(3)):
        if order != (0, 1, 2):
            held = ", ".join(AXES[k] for k in order)
            text = f"the lever's components are permuted: x, y, z hold what belongs to {held}"
            yield text, given(list(order), lambda k, r, s: r[k])


def _of_center(_: Array, system: System) -> Array:
    return np.asarray(system.body.center_of_mass, dtype=float)


def _of_pivot(_: Array, system: System) -> Array:
    return np.asarray(system.load.pivot, dtype=float)


def _added(_: Array, system: System) -> Array:
    return _of_center(_, system) + _of_pivot(_, system)
