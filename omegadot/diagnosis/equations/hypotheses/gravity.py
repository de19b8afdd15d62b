"""What engines make of gravity."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import permutations
from typing import Any

import numpy as np

from omegadot.diagnosis.equations.equation_form import Form
from omegadot.diagnosis.equations.hypotheses.hypothesis import (
    AXES,
    Hypothesis,
    given,
    of_form,
    of_load,
)
from omegadot.reference_impl.system import Array, System


def gravity_hypotheses() -> Iterator[Hypothesis]:
    """Each of them."""
    size = np.linalg.norm
    yield of_load("gravity is missing", "gravity", lambda one: {"gravity": 0 * one.gravity})
    yield of_load("gravity has the wrong sign", "gravity", lambda one: {"gravity": -one.gravity})
    yield of_load("gravity counts twice", "gravity", lambda one: {"gravity": 2 * one.gravity})
    for axis in range(3):
        for sign in (-1.0, 1.0):
            way = f"{'-' if sign < 0 else '+'}{AXES[axis]}"
            yield of_load(
                f"gravity points along {way}, whatever direction was requested",
                "gravity",
                given(
                    axis, sign, lambda k, s, one: {"gravity": s * size(one.gravity) * np.eye(3)[k]}
                ),
            )
        yield of_load(
            f"the {AXES[axis]} component of gravity is dropped",
            "gravity",
            given(axis, lambda k, one: {"gravity": np.where(np.arange(3) == k, 0.0, one.gravity)}),
        )
        yield of_load(
            f"the {AXES[axis]} component of gravity has the wrong sign",
            "gravity",
            given(
                axis,
                lambda k, one: {"gravity": np.where(np.arange(3) == k, -1.0, 1.0) * one.gravity},
            ),
        )
        yield of_load(
            f"only the {AXES[axis]} component of gravity acts",
            "gravity",
            given(axis, lambda k, one: {"gravity": np.where(np.arange(3) == k, one.gravity, 0.0)}),
        )
    yield of_load(
        "gravity acts along the axis of its largest component, with its whole magnitude",
        "gravity",
        lambda one: {"gravity": size(one.gravity) * np.sign(_largest(one.gravity))},
    )
    yield of_load(
        "only the largest component of gravity acts",
        "gravity",
        lambda one: {"gravity": _largest(one.gravity)},
    )
    for order in permutations(range(3)):
        if order != (0, 1, 2):
            names = ", ".join(AXES[k] for k in order)
            yield of_load(
                f"gravity's components are permuted: x, y, z hold what belongs to {names}",
                "gravity",
                given(order, lambda k, one: {"gravity": one.gravity[list(k)]}),
            )
    yield of_form(
        "gravity is fixed to the body instead of the world",
        "gravity",
        lambda f, s: {
            "weight": 0 * f.weight,
            "weight_body": f.weight,
            "gravity": 0 * f.gravity,
            "gravity_body": f.gravity,
        },
    )
    yield of_form(
        "gravity acts at the body's origin instead of the centre of mass",
        "gravity",
        lambda f, s: {"arm": f.arm - s.body.center_of_mass},
    )
    yield of_form(
        "gravity turns the body about its origin, though nothing holds it there",
        "gravity",
        lambda f, s: {"arm": f.arm + s.body.center_of_mass} if s.load.pivot is None else {},
    )
    yield of_form(
        "in the torque of gravity the lever from the pivot to the centre of mass has the wrong "
        "sign: the centre of mass is mirrored",
        "gravity",
        lambda f, s: {"arm": -f.arm},
    )
    yield of_form("the torque of gravity is missing", "gravity", lambda f, s: {"arm": 0 * f.arm})
    yield of_form("the mass is left out of the weight", "gravity", _massless)
    yield of_form(
        "in the torque of gravity the lever is the centre of mass's from the origin, not from the "
        "pivot",
        "gravity",
        lambda f, s: {"arm": s.body.center_of_mass} if s.load.pivot is not None else {},
    )


def _largest(vector: Array) -> Array:
    """The vector's component of the largest size alone."""
    return np.where(np.arange(3) == np.argmax(np.abs(vector)), vector, 0.0)


def _massless(form: Form, system: System) -> dict[str, Any]:
    return {"weight": form.weight / float(system.body.mass)}
