"""What engines make of a body's numbers, and of what they report."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from itertools import permutations

import numpy as np

from omegadot.diagnosis.equations.equation_form import Form
from omegadot.diagnosis.equations.hypotheses.hypothesis import (
    AXES,
    Hypothesis,
    applied,
    given,
    of_body,
    of_form,
    of_load,
)
from omegadot.diagnosis.models.tensors import diagonal_in_single, in_single, products_in_single
from omegadot.reference_impl.system import Array


def center_hypotheses() -> Iterator[Hypothesis]:
    """Each of them."""
    yield of_body(
        "the centre of mass is ignored",
        "center",
        lambda body, s: {"center_of_mass": 0 * body.center_of_mass},
    )
    yield of_body(
        "the centre of mass has the wrong sign",
        "center",
        lambda body, s: {"center_of_mass": -body.center_of_mass},
    )
    for text, change in _of_components():
        what = given(change, lambda how, body, s: {"center_of_mass": how(body.center_of_mass)})
        yield of_body(text, "center", what)


def _of_components() -> Iterator[tuple[str, Callable[[Array], Array]]]:
    """What becomes of single components of the centre of mass."""
    for axis, name in enumerate(AXES):
        alone = np.arange(3) == axis
        start = f"the {name} component of the centre of mass"
        yield f"{start} is dropped", given(alone, lambda k, c: np.where(k, 0.0, c))
        yield f"{start} has the wrong sign", given(alone, lambda k, c: np.where(k, -c, c))
    for order in permutations(range(3)):
        if order != (0, 1, 2):
            held = ", ".join(AXES[k] for k in order)
            text = f"the centre of mass's components are permuted: x, y, z hold those of {held}"
            yield text, given(list(order), lambda k, c: c[k])


def report_hypotheses() -> Iterator[Hypothesis]:
    """Each of them."""
    yield of_form(
        "the linear acceleration looks like that of the body's origin",
        "report",
        lambda f, s: {"offset": f.offset - s.body.center_of_mass},
    )
    yield of_form(
        "the linear acceleration is the spatial one: omega x v is left out of it",
        "report",
        lambda f, s: {"spatial": np.asarray(-1.0)},
    )
    yield of_form(
        "the linear acceleration counts omega x v twice",
        "report",
        lambda f, s: {"spatial": np.asarray(1.0)},
    )


def precision_hypotheses() -> Iterator[Hypothesis]:
    """Each of them."""
    kept = "is kept in single precision"
    yield of_body(f"the mass {kept}", "precision", lambda body, s: {"mass": in_single(body.mass)})
    yield of_body(
        f"the inertia {kept}", "precision", lambda body, s: {"inertia": in_single(body.inertia)}
    )
    for what, rounded in (("moments", diagonal_in_single), ("products", products_in_single)):
        yield of_body(
            f"the {what} of inertia alone are kept in single precision",
            "precision",
            given(rounded, lambda how, body, s: {"inertia": how(body.inertia)}),
        )
    yield of_body(
        f"the centre of mass {kept}",
        "precision",
        lambda body, s: {"center_of_mass": in_single(body.center_of_mass)},
    )
    yield of_body(
        "mass, centre of mass and inertia are kept in single precision",
        "precision",
        lambda body, s: {name: in_single(value) for name, value in vars(body).items()},
    )
    for what, name in (("inverse of the inertia", "solve"), ("gyroscopic term's inertia", "spin")):
        yield of_form(
            f"the {what} {kept}",
            "precision",
            given(name, lambda k, f, s: {k: in_single(getattr(f, k))}),
        )
    yield of_form(
        f"the inertia about the pivot {kept}",
        "precision",
        lambda f, s: _about_pivot(f),
    )
    for name in ("gravity", "damping", "pivot"):
        yield of_load(
            f"the {name} {kept}".replace("the gravity", "gravity"),
            "precision",
            given(
                name,
                lambda k, one: {k: None if getattr(one, k) is None else in_single(getattr(one, k))},
            ),
        )
    yield of_load(f"the applied torque {kept}", "precision", lambda one: applied(one, in_single))
    yield of_load(
        "all loads are kept in single precision",
        "precision",
        lambda one: {k: None if v is None else in_single(v) for k, v in vars(one).items()},
    )


def _about_pivot(form: Form) -> dict[str, Array]:
    """The whole inertia rounded, in the solve and in the gyroscopic term."""
    whole = in_single(form.spin)
    return {"solve": np.linalg.inv(whole), "spin": whole}
