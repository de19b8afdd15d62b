"""Wrong equations with one number in them."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from omegadot.diagnosis.equations.equation_form import Form, form_of
from omegadot.diagnosis.equations.evidence import Evidence
from omegadot.diagnosis.equations.families.family import (
    AXES,
    NOTHING,
    Family,
    always,
    driven,
    scalar,
    scaled,
    with_body,
)
from omegadot.diagnosis.equations.families.inertias import scale_of_inertia
from omegadot.diagnosis.wording.digits import factor, number
from omegadot.reference_impl.inertia import moving_inertia
from omegadot.reference_impl.system import Array, System
from omegadot.written import written

# Of what the inertia about the pivot is made of: omega-dot is far from linear in it.
FAR = (1.0, 0.1, 10.0)
AXIS = "parallel axis"  # the name of the family of its factor


def _mass_scaled(form: Form, k: float) -> Form:
    return replace(form, torque_body=k * form.torque_body, torque_world=k * form.torque_world)


def _all_loads(form: Form, system: System, k: float) -> Form:
    loads = _mass_scaled(form, k)
    return replace(loads, weight=k * form.weight, damping=k * form.damping)


def _with_inertia(system: System, change: Callable[[Array], Array]) -> Form:
    """The equation with another inertia about the centre of mass. Raises ValueError."""
    tensor = change(np.asarray(system.body.inertia, dtype=float))
    if not np.linalg.eigvalsh(tensor)[0] > 0.0:
        raise ValueError("no inertia of a body")
    return form_of(with_body(system, inertia=tensor))


def _moment(axis: int) -> Family:
    """One of the moments on the tensor's diagonal, scaled."""
    only = np.diag(np.eye(3)[axis])
    what = f"in the dynamics, the moment of inertia {2 * AXES[axis]}"

    def form(_: Form, system: System, k: float) -> Form:
        return _with_inertia(system, lambda t: t + (k - 1.0) * only * t)

    return scalar(f"moment {AXES[axis]}", "inertia", 1.0, always, form, scaled(what))


def _torque_of(frame: str) -> Family:
    """The torque in one kind of axes, scaled."""
    name = f"torque_{frame}"
    return scalar(
        f"torque in {frame} axes",
        "torque",
        1.0,
        lambda s: bool(np.any(getattr(s.load, name))),
        lambda f, s, k: replace(f, **{name: k * getattr(f, name)}),
        scaled(f"the torque in {frame} axes"),
    )


def _with_lever(family: Family) -> Family:
    """A factor of what is there on a pivot off the centre of mass alone."""

    def starts(system: System) -> list[Array]:
        off = system.load.pivot is not None and bool(np.any(form_of(system).arm))
        return [np.array([k]) for k in FAR] if off else []

    return replace(family, starts=starts)


def _parallel_axis(form: Form, system: System, k: float) -> Form:
    own = np.asarray(system.body.inertia, dtype=float)
    spin = own + k * (np.asarray(moving_inertia(system), dtype=float) - own)
    return replace(form, spin=spin, solve=np.linalg.inv(spin))


def _lever_scaled(form: Form, system: System, k: float) -> Form:
    pivot = np.asarray(system.load.pivot, dtype=float)
    center = pivot + k * (np.asarray(system.body.center_of_mass, dtype=float) - pivot)
    return form_of(with_body(system, center_of_mass=center))


def _falls(system: System) -> bool:
    """Whether the body falls, so that gravity at its place shows."""
    return system.load.pivot is None and bool(np.any(system.load.gravity))


def _gravity_by_height() -> Family:
    """Gravity as ``1 / (1 + c z)^2``, z the height: c is the inverse of a planet's radius."""

    def guess(evidence: Evidence) -> Array | None:
        """From the height that is farthest from none, and the part of gravity that acts there."""
        if not _falls(evidence.system):
            return None
        g = np.asarray(evidence.system.load.gravity, dtype=float)
        heights = -(evidence.states.position @ g) / np.linalg.norm(g)
        farthest = int(np.argmax(np.abs(heights)))
        acting = float(evidence.found.linear[farthest] @ g / (g @ g))
        if not heights[farthest] or not acting > 0.0:
            return None
        return np.array([(acting**-0.5 - 1.0) / heights[farthest]])

    family = scalar(
        "gravity by height",
        "gravity by height",
        0.0,
        _falls,
        lambda f, s, k: replace(f, fall=f.fall + k),
        lambda s, k: (
            "gravity falls with the height z of the centre of mass above the world's origin, as "
            f"(E / (E + z))^2 with E = {number(1.0 / k)} m"
        ),
        "1/m",
    )
    return replace(family, guess=guess)


def _solve_text(_: System, k: float) -> str:
    if abs(k) < NOTHING:
        return "omega-dot is zero"
    other = f"the inertia that it is solved for with is scaled by {number(1.0 / k)}"
    return f"omega-dot is scaled by {factor(k)}, as where {other}"


def _damping_text(system: System, p: Array) -> str:
    acting, requested = float(p[0]), float(system.load.damping)
    if not requested:
        return f"a damping of {written(acting, 3)} N m s/rad acts that was not requested"
    shown, due = number(acting, requested), number(requested, acting)
    return f"the damping that acts is {shown} N m s/rad, where {due} was requested"


ONE_NUMBER: tuple[Family, ...] = (
    scalar(
        "spin",
        "spin",
        1.0,
        always,
        lambda f, s, k: replace(f, spin=k * f.spin),
        scaled("the gyroscopic term"),
    ),
    scalar(
        "solve",
        "inertia",
        1.0,
        always,
        lambda f, s, k: replace(f, solve=k * f.solve),
        _solve_text,
    ),
    _moment(0),
    _moment(1),
    _moment(2),
    scalar(
        "products",
        "inertia",
        1.0,
        lambda s: bool(np.any(s.body.inertia - np.diag(np.diag(s.body.inertia)))),
        lambda f, s, k: _with_inertia(s, lambda t: k * t + (1.0 - k) * np.diag(np.diag(t))),
        scaled("in the dynamics, every product of inertia"),
    ),
    replace(
        scalar(
            "whole inertia",
            "inertia",
            1.0,
            always,
            lambda f, s, k: _with_inertia(s, lambda t: k * t),
            scaled("in the dynamics, the inertia about the centre of mass"),
        ),
        guess=scale_of_inertia,
    ),
    _with_lever(
        scalar(
            AXIS,
            "inertia",
            1.0,
            always,
            _parallel_axis,
            scaled("what the parallel-axis theorem adds to the inertia for the pivot"),
        )
    ),
    _with_lever(
        scalar(
            "lever",
            "lever",
            1.0,
            always,
            _lever_scaled,
            scaled("the lever from the pivot to the centre of mass"),
        )
    ),
    scalar(
        "gravity",
        "gravity",
        1.0,
        lambda s: bool(np.any(s.load.gravity)),
        lambda f, s, k: replace(f, weight=k * f.weight, gravity=k * f.gravity),
        scaled("gravity"),
    ),
    _gravity_by_height(),
    scalar(
        "torque",
        "torque",
        1.0,
        driven,
        lambda f, s, k: _mass_scaled(f, k),
        scaled("the applied torque"),
    ),
    _torque_of("body"),
    _torque_of("world"),
    Family(
        "damping",
        "damping",
        lambda s: [np.array([float(s.load.damping)])],
        lambda f, s, p: replace(f, damping=float(p[0]) * np.eye(3)),
        _damping_text,
        lambda s: np.array([float(s.load.damping)]),
        "N m s/rad",
    ),
    Family(
        "damping rate",
        "damping",
        lambda s: [np.array([float(s.load.damping)])] if float(s.load.damping) else [],
        lambda f, s, p: replace(f, damping=float(p[0]) * np.linalg.inv(f.solve)),
        lambda s, p: (
            f"the damping acts as a rate, not as a torque: omega-dot has {number(-float(p[0]))} "
            "omega in it, whatever the inertia"
        ),
        lambda s: np.zeros(1),
        "1/s",
    ),
    scalar(
        "loads",
        "loads",
        1.0,
        lambda s: (driven(s) + bool(np.any(s.load.damping)) + (s.load.pivot is not None)) > 1,
        _all_loads,
        scaled("the torque of all loads"),
    ),
    scalar(
        "extra rate",
        "damping",
        0.0,
        always,
        lambda f, s, d: replace(f, damping=f.damping + d * np.linalg.inv(f.solve)),
        lambda s, d: (
            f"omega-dot has {written(-d, 3)} omega in it that was not requested, whatever the "
            "inertia: a "
            "damping as a rate, not as a torque"
        ),
    ),
    scalar(
        "extra square",
        "damping",
        0.0,
        always,
        lambda f, s, d: replace(f, drag_square=f.drag_square + d),
        lambda s, d: (
            f"a damping torque of -{written(d, 3)} |omega| omega N m acts that was not requested"
        ),
    ),
    scalar(
        "drag",
        "drag",
        0.0,
        lambda s: s.load.pivot is None,
        lambda f, s, d: replace(f, drag=f.drag + d),
        lambda s, d: (
            f"the linear velocity is damped: the acceleration has {written(-d, 3)} v in it"
        ),
    ),
    scalar(
        "armature",
        "inertia",
        0.0,
        always,
        lambda f, s, a: replace(f, solve=np.linalg.inv(np.linalg.inv(f.solve) + a * np.eye(3))),
        lambda s, a: (
            f"where omega-dot is solved for, {number(a)} kg m^2 is added to the inertia's diagonal "
            "(an armature)"
        ),
        "kg m^2",
    ),
    Family(
        "mass",
        "mass",
        lambda s: [] if s.load.pivot is None else [k * np.array([float(s.body.mass)]) for k in FAR],
        lambda f, s, p: _of_system(with_body(s, mass=np.asarray(p[0]))),
        lambda s, p: (
            f"the dynamics act as if the mass were {number(float(p[0]), float(s.body.mass))} kg, "
            f"where {number(float(s.body.mass), float(p[0]))} was requested"
        ),
        lambda s: np.array([float(s.body.mass)]),
        "kg",
    ),
)


def _of_system(system: System) -> Form:
    return form_of(system)
