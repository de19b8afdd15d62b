"""What engines make of an applied torque."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace
from itertools import permutations, product
from typing import Any

import numpy as np

from omegadot.diagnosis.equations.equation_form import Form, form_of
from omegadot.diagnosis.equations.hypotheses.hypothesis import (
    AXES,
    Hypothesis,
    applied,
    diagonal,
    given,
    moved,
    of_form,
    of_load,
    over_diagonal,
    own_inertia,
)
from omegadot.diagnosis.models.principal_axes import SIGNS, near_the_bodys
from omegadot.reference_impl.inertia import moving_inertia
from omegadot.reference_impl.system import Array, Load, System


def loads_hypotheses(system: System) -> Iterator[Hypothesis]:
    """Of a system on which several loads act: that none does. Of one load it is that one."""
    load, form = system.load, form_of(system)
    weight = bool(np.any(form.weight)) and load.pivot is not None
    applied = bool(np.any(load.torque_body) or np.any(load.torque_world))
    if applied + weight + bool(np.any(load.damping)) > 1:
        yield of_form(
            "the torque of all loads is missing", "loads", lambda f, s: _loads_scaled(f, 0.0)
        )


def torque_hypotheses() -> Iterator[Hypothesis]:
    """Each of them."""
    for text, factor in (("is missing", 0), ("has the wrong sign", -1), ("counts twice", 2)):
        yield of_load(
            f"the applied torque {text}",
            "torque",
            given(factor, lambda k, one: applied(one, lambda t: k * t)),
        )
    yield of_load(
        "the applied torque is taken in the wrong frame",
        "torque",
        lambda one: {"torque_body": one.torque_world, "torque_world": one.torque_body},
    )
    yield of_load(
        "the torque in world axes is taken for one in body axes",
        "torque",
        lambda one: {
            "torque_body": one.torque_body + one.torque_world,
            "torque_world": 0 * one.torque_world,
        },
    )
    yield of_load(
        "the torque in body axes is taken for one in world axes",
        "torque",
        lambda one: {
            "torque_world": one.torque_body + one.torque_world,
            "torque_body": 0 * one.torque_body,
        },
    )
    for of, tensor in (("inertia", own_inertia), ("the inertia about the pivot", moving_inertia)):
        for handed, nearest, back in product(SIGNS, (False, True), (False, True)):
            yield Hypothesis(
                f"the torque in body axes is taken along the principal axes of {of}",
                "torque",
                system=given(tensor, handed, nearest, back, _along_principal_axes),
            )
    for frame in ("body", "world"):
        yield of_load(
            f"the torque in {frame} axes is missing",
            "torque",
            given(f"torque_{frame}", lambda k, one: {k: 0 * getattr(one, k)}),
        )
    for axis in range(3):
        for what, sign in (("has the wrong sign", -1.0), ("is missing", 0.0)):
            signs = np.where(np.arange(3) == axis, sign, 1.0)
            yield of_load(
                f"the {AXES[axis]} component of the applied torque {what}",
                "torque",
                given(signs, lambda k, one: applied(one, lambda t: k * t)),
            )
        for frame, other in (("body", "world"), ("world", "body")):
            component, names = f"the {AXES[axis]} component", (f"torque_{frame}", f"torque_{other}")
            yield of_load(
                f"{component} of the torque in {frame} axes acts in {other} axes",
                "torque",
                given(axis, *names, _component_moved),
            )
            for what, times in (("has the wrong sign", -1.0), ("is missing", 0.0)):
                yield of_load(
                    f"{component} of the torque in {frame} axes {what}",
                    "torque",
                    given(axis, names[0], times, _component_scaled),
                )
    for order in permutations(range(3)):
        if order != (0, 1, 2):
            shown = ", ".join(AXES[k] for k in order)
            yield of_load(
                f"the applied torque's components are permuted: x, y, z hold those of {shown}",
                "torque",
                given(order, lambda k, one: applied(one, lambda t: t[list(k)])),
            )
    for what, power in (("divided", -1), ("multiplied", 1)):
        yield of_form(
            f"all loads have a wrong torque: it is {what} by the mass",
            "loads",
            given(power, lambda k, f, s: _loads_scaled(f, float(s.body.mass) ** k)),
        )
    through: dict[str, Callable[[Form, System], Array]] = {
        "is not divided by the inertia": lambda f, s: np.eye(3),
        "is divided by the inertia's diagonal alone": lambda f, s: over_diagonal(f),
        "is divided by the mass": lambda f, s: f.solve / float(s.body.mass),
        "is multiplied by the mass": lambda f, s: f.solve * float(s.body.mass),
        "meets the inertia about the body's origin": lambda f, s: np.linalg.inv(
            own_inertia(s) + moved(s)
        ),
        "meets the inertia about the centre of mass": lambda f, s: np.linalg.inv(own_inertia(s)),
    }
    for text, matrix in through.items():

        def change(form: Form, system: System, made: Any = matrix) -> dict[str, Any]:
            ratio = np.linalg.inv(form.solve) @ made(form, system)
            return {"torque_body": ratio @ form.torque_body, "turned": ratio}

        yield of_form(f"the applied torque {text}", "torque", change)
        for frame, changed in (("body", "torque_body"), ("world", "turned")):
            yield of_form(
                f"the torque in {frame} axes {text}",
                "torque",
                given(change, changed, lambda c, k, f, s: {k: c(f, s)[k]}),
            )
    for sign in (1.0, -1.0):
        yield of_form(
            "the applied torque turns the body about its origin, so that it moves the centre of "
            "mass",
            "report",
            given(sign, lambda k, f, s: _moves_center(s, k)),
        )
    yield of_form(
        "the applied torque acts about the body's origin, which stays: it meets the inertia about "
        "the origin, and moves the centre of mass",
        "torque",
        lambda f, s: _about_origin(f, s) | _moves_center(s, 1.0),
    )


def _component_moved(axis: int, of: str, to: str, load: Load) -> dict[str, Array]:
    """One component of a torque is taken as that along the same axis of the other frame."""
    alone = np.where(np.arange(3) == axis, getattr(load, of), 0.0)
    return {of: getattr(load, of) - alone, to: getattr(load, to) + alone}


def _component_scaled(axis: int, of: str, times: float, load: Load) -> dict[str, Array]:
    return {of: np.where(np.arange(3) == axis, times * getattr(load, of), getattr(load, of))}


def _moves_center(system: System, sign: float) -> dict[str, Any]:
    pivoted = system.load.pivot is not None
    return {} if pivoted else {"couple_offset": sign * system.body.center_of_mass}


def _about_origin(form: Form, system: System) -> dict[str, Any]:
    if system.load.pivot is not None:
        return {}
    ratio = np.linalg.inv(form.solve) @ np.linalg.inv(own_inertia(system) + moved(system))
    return {"torque_body": ratio @ form.torque_body, "turned": ratio}


def _loads_scaled(form: Form, k: float) -> dict[str, Any]:
    parts = ("torque_body", "torque_world", "weight", "damping")
    return {name: k * getattr(form, name) for name in parts}


def _along_principal_axes(
    of: Callable[[System], Array],
    signs: Callable[[Array], Array],
    nearest: bool,
    back: bool,
    system: System,
) -> System:
    """By ascending moments, or each axis the nearest to one of the body's."""
    tensor = np.asarray(of(system), dtype=float)
    if nearest and not np.any(tensor - diagonal(tensor)):
        return system  # these are the body's axes
    axes = np.linalg.eigh(tensor)[1]
    axes = signs(axes[:, near_the_bodys(axes)] if nearest else axes)
    turned = (axes.T if back else axes) @ system.load.torque_body
    return replace(system, load=replace(system.load, torque_body=turned))
