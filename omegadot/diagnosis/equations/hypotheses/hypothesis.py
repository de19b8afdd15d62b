"""One thing that is wrong in an equation, and how it is written."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import Any

import numpy as np

from omegadot.diagnosis.equations.equation_form import Form, changed, form_of
from omegadot.diagnosis.models.tensors import SPHERE, UNIT
from omegadot.reference_impl.inertia import parallel_axis
from omegadot.reference_impl.system import Array, Body, Load, System

AXES = "xyz"
UNLIKELY = (SPHERE, UNIT)


@dataclass(frozen=True)
class Hypothesis:
    """One thing that is wrong.

    part: what it is about; two hypotheses are combined only where these differ.  system: the body
    and loads that the engine takes instead, where it is that.  form: what it makes of the equation.
    unlikely: two others together are as likely.
    """

    text: str
    part: str
    system: Callable[[System], System] = lambda system: system
    form: Callable[[Form, System], Form] = lambda form, system: form

    @property
    def unlikely(self) -> bool:
        """Whether two others together are as likely as this one."""
        return any(what in self.text for what in UNLIKELY)


def wrong_form(
    hypotheses: Sequence[Hypothesis], system: System, right: Form | None = None
) -> Form | None:
    """The equation with all of these in it; None where it has no meaning for this system.

    right: the right equation of the system, where it is known already.
    """
    right = right or form_of(system)
    other = system
    try:
        with np.errstate(all="ignore"):  # two at once may divide by what one has made zero
            for one in hypotheses:
                other = one.system(other)
            form = right if other is system else form_of(other)
            for one in hypotheses:
                form = one.form(form, other)
    except (ValueError, np.linalg.LinAlgError, ZeroDivisionError):
        return None
    pairs = zip(vars(form).values(), vars(right).values(), strict=True)
    if not all(one is own or np.isfinite(one).all() for one, own in pairs):
        return None
    return form


def given(*values: Any) -> Callable[..., Any]:
    """A function, the last of these, with its first arguments given."""
    return partial(values[-1], *values[:-1])


def of_load(text: str, part: str, change: Callable[[Load], dict[str, Any]]) -> Hypothesis:
    """Another load: what changes of it."""

    def other(system: System) -> System:
        return replace(system, load=replace(system.load, **change(system.load)))

    return Hypothesis(text, part, system=other)


def of_body(text: str, part: str, change: Callable[[Body, System], dict[str, Any]]) -> Hypothesis:
    """Another body: what changes of it."""

    def other(system: System) -> System:
        body = replace(system.body, **change(system.body, system))
        return replace(system, bodies=(body,))

    return Hypothesis(text, part, system=other)


def of_form(text: str, part: str, change: Callable[[Form, System], dict[str, Any]]) -> Hypothesis:
    """Another equation: which of its parts are others."""
    return Hypothesis(text, part, form=lambda form, system: changed(form, **change(form, system)))


def diagonal(matrix: Array) -> Array:
    """The diagonal alone, (3, 3)."""
    return np.diag(np.diag(matrix))


def own_inertia(system: System) -> Array:
    """The requested inertia about the centre of mass, (3, 3)."""
    return np.asarray(system.body.inertia, dtype=float)


def moved(system: System) -> Array:
    """What the parallel-axis theorem adds for the distance from the body's origin."""
    return parallel_axis(float(system.body.mass), np.asarray(system.body.center_of_mass))


def over_diagonal(form: Form) -> Array:
    """The inverse of the inertia's diagonal, (3, 3)."""
    return np.diag(1.0 / np.diag(np.linalg.inv(form.solve)))


def applied(one: Load, change: Callable[[Array], Array]) -> dict[str, Any]:
    """Both torques changed."""
    return {"torque_body": change(one.torque_body), "torque_world": change(one.torque_world)}
