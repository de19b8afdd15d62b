"""What engines make of the inertia, where omega-dot is solved for and in the gyroscopic term."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import product
from typing import Any

import numpy as np

from omegadot.diagnosis.equations.equation_form import Form, form_of
from omegadot.diagnosis.equations.hypotheses.hypothesis import (
    Hypothesis,
    diagonal,
    given,
    moved,
    of_body,
    of_form,
    own_inertia,
)
from omegadot.diagnosis.models.tensors import DROPPED, other_tensors, product_mistakes
from omegadot.reference_impl.inertia import moving_inertia, parallel_axis
from omegadot.reference_impl.system import Array, System

# As of a tensor about the pivot that is moved there once more.
TWICE = "the inertia is moved to the pivot twice"
PARTS: dict[str, tuple[str, ...]] = {
    "in the dynamics": ("solve", "spin"),
    "where omega-dot is solved for": ("solve",),
    "in the gyroscopic term": ("spin",),
}


def spin_hypotheses() -> Iterator[Hypothesis]:
    """Each of them."""
    for text, factor in (("is missing", 0), ("has the wrong sign", -1), ("counts twice", 2)):
        yield of_form(
            f"the gyroscopic term {text}",
            "spin",
            given(factor, lambda k, f, s: {"spin": k * f.spin}),
        )
    yield of_form(
        "the gyroscopic term is formed with the inertia's diagonal alone",
        "spin",
        lambda f, s: {"spin": diagonal(f.spin)},
    )
    yield of_form(
        "in the gyroscopic term, all products of inertia have the wrong sign",
        "spin",
        lambda f, s: {"spin": 2.0 * diagonal(f.spin) - f.spin},
    )
    yield of_form(
        "the gyroscopic term is formed with the inertia about the centre of mass, "
        "not about the pivot",
        "spin",
        lambda f, s: {"spin": own_inertia(s)},
    )
    yield of_form(
        "the gyroscopic term is formed with the inertia about the body's origin",
        "spin",
        lambda f, s: {"spin": own_inertia(s) + moved(s)},
    )


def inertia_hypotheses(system: System) -> Iterator[Hypothesis]:
    """Of one system: its tensor, in the solve, in the gyroscopic term or in both."""
    own, names = own_inertia(system), other_tensors(system)
    about = _about(system)
    for name, tensor in names.items():
        text = TWICE if name.startswith("the inertia is about the pivot") else name
        if not np.linalg.eigvalsh(tensor)[0] > 0.0 or np.array_equal(tensor, own):
            continue
        if name.startswith(DROPPED):
            continue  # a limit of it is shown by several tensors: `near_inertia`
        yield of_body(
            f"in the dynamics, {text}",
            f"inertia:{text}",
            given(name, lambda t, b, s: _named(s, t)),
        )
        yield of_form(
            f"where omega-dot is solved for, {text}",
            f"inertia:{text}",
            given(name, lambda t, f, s: {"solve": np.linalg.inv(_about(s) + _tensor(s, t))}),
        )
        yield of_form(
            f"in the gyroscopic term, {text}",
            "spin",
            given(name, lambda t, f, s: {"spin": _about(s) + _tensor(s, t)}),
        )
    yield of_form(
        "where omega-dot is solved for, only the diagonal of the whole inertia is used",
        "inertia",
        lambda f, s: {"solve": np.diag(1.0 / np.diag(f.spin))},
    )
    yield of_form(
        "in the dynamics, only the diagonal of the whole inertia is used",
        "inertia",
        lambda f, s: _both(diagonal(f.spin)),
    )
    center = np.asarray(system.body.center_of_mass, dtype=float)
    if system.load.pivot is None and np.any(center):
        yield of_form(
            "the inertia about the body's origin is taken, not that about the centre of mass",
            "inertia",
            lambda f, s: _both(own_inertia(s) + _of_origin(s)) if s.load.pivot is None else {},
        )
    yield from _of_whole(system)
    if np.any(about):
        yield from _left_out()
        own_alone = "the inertia about the centre of mass is taken, not that about the pivot"
        yield of_form(
            f"where omega-dot is solved for, {own_alone}",
            "inertia",
            lambda f, s: {"solve": np.linalg.inv(own_inertia(s))},
        )
        yield of_form(
            f"in the dynamics, {own_alone}",
            "inertia",
            lambda f, s: {"solve": np.linalg.inv(own_inertia(s)), "spin": own_inertia(s)},
        )
        yield of_form(
            "the parallel-axis theorem has the lever squared on the diagonal alone",
            "inertia",
            lambda f, s: _both(own_inertia(s) + _squared(s)),
        )
        yield of_form(
            "the parallel-axis theorem adds to the diagonal alone: its products are left out",
            "inertia",
            lambda f, s: _both(own_inertia(s) + diagonal(_about(s))),
        )
        yield of_form(
            "the parallel-axis theorem has its products with the wrong sign",
            "inertia",
            lambda f, s: _both(own_inertia(s) + 2.0 * diagonal(_about(s)) - _about(s)),
        )
        yield of_form(
            "the parallel-axis theorem has the square of each axis's own component on the diagonal",
            "inertia",
            lambda f, s: _both(own_inertia(s) + _own_squares(s)),
        )
        yield of_form(
            "the parallel-axis theorem is taken with a mass of 1 kg",
            "inertia",
            lambda f, s: _both(own_inertia(s) + _about(s) / float(s.body.mass)),
        )
        yield of_form(
            "the parallel-axis theorem is applied twice",
            "inertia",
            lambda f, s: _both(2.0 * f.spin - own_inertia(s)),
        )


def _of_whole(system: System) -> Iterator[Hypothesis]:
    """Mistakes in the products of the inertia about the pivot, the body's own ones added."""
    whole = np.asarray(moving_inertia(system), dtype=float)
    for name, tensor in product_mistakes(whole):
        if not np.linalg.eigvalsh(tensor)[0] > 0.0 or np.array_equal(tensor, whole):
            continue
        for where, parts in PARTS.items():
            yield of_form(
                f"{where}, {name.replace('of inertia', 'of the whole inertia')}",
                "spin" if parts == ("spin",) else f"inertia:{name}",
                given(name, parts, lambda t, p, f, s: _in_parts(p, _whole_with(s, t))),
            )


def _left_out() -> Iterator[Hypothesis]:
    """What the parallel-axis theorem adds, but for one axis."""
    for (where, parts), axis in product(PARTS.items(), range(3)):
        own = f"the moment of inertia {2 * 'xyz'[axis]}"
        names = ", ".join(n for n in ("xx", "xy", "xz", "yy", "yz", "zz") if "xyz"[axis] in n)
        for what, alone in ((own, True), (f"the numbers {names} of the inertia", False)):
            yield of_form(
                f"{where}, the parallel-axis theorem adds nothing to {what}",
                "spin" if parts == ("spin",) else "inertia",
                given(axis, alone, parts, _without_axis),
            )


def _without_axis(
    axis: int, alone: bool, parts: Sequence[str], form: Form, system: System
) -> dict[str, Any]:
    about, here = _about(system), np.arange(3) == axis
    left = here[:, None] & here if alone else here[:, None] | here
    return _in_parts(parts, own_inertia(system) + np.where(left, 0.0, about))


def _in_parts(parts: Sequence[str], tensor: Array) -> dict[str, Any]:
    return {name: one for name, one in _both(tensor).items() if name in parts}


def _whole_with(system: System, text: str) -> Array:
    """The inertia that moves, with this mistake in its products."""
    whole = np.asarray(moving_inertia(system), dtype=float)
    return dict(product_mistakes(whole))[text]


def _tensor(system: System, text: str) -> Array:
    return other_tensors(system).get(text, own_inertia(system))


def _named(system: System, text: str) -> dict[str, Any]:
    tensor = _tensor(system, text)
    if not np.linalg.eigvalsh(tensor)[0] > 0.0:
        raise ValueError(text)
    return {"inertia": tensor}


def _about(system: System) -> Array:
    return np.asarray(moving_inertia(system), dtype=float) - own_inertia(system)


def _of_origin(system: System) -> Array:
    center = np.asarray(system.body.center_of_mass, dtype=float)
    return np.asarray(parallel_axis(float(system.body.mass), center), dtype=float)


def _squared(system: System) -> Array:
    r = form_of(system).offset
    return float(system.body.mass) * float(r @ r) * np.eye(3)


def _own_squares(system: System) -> Array:
    about = _about(system)
    own = 0.5 * np.trace(about) - np.diag(about)  # m r_k^2
    return np.asarray(about - diagonal(about) + np.diag(own))


def _both(tensor: Array) -> dict[str, Any]:
    return {"solve": np.linalg.inv(tensor), "spin": tensor}
