"""Wrong equations with three numbers: a load, a lever or a torque that was not requested."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np

from omegadot.diagnosis.equations.equation_form import Form, form_of
from omegadot.diagnosis.equations.families.family import Family
from omegadot.diagnosis.wording.digits import vector
from omegadot.diagnosis.wording.laws import SAME
from omegadot.reference_impl.inertia import moving_inertia
from omegadot.reference_impl.system import Array, System


def _load_vector(name: str, what: str, unit: str) -> Family:
    def form(right: Form, system: System, p: Array) -> Form:
        changed = form_of(replace(system, load=replace(system.load, **{name: p})))
        names = {
            "gravity": ("weight", "gravity"),
            "torque_body": ("torque_body",),
            "torque_world": ("torque_world",),
            "pivot": tuple(vars(right)),
        }[name]
        return replace(right, **{one: getattr(changed, one) for one in names})

    def text(system: System, p: Array) -> str:
        requested = np.asarray(getattr(system.load, name), dtype=float)
        if name == "pivot":
            off = vector(p - requested)
            return (
                f"the pivot lies at {vector(p, requested)} m, {off} m from where it was requested, "
                "or the centre of mass lies off by as much the other way"
            )
        shown = f"{vector(p, requested)} {unit}, where {vector(requested, p)} was requested"
        return f"{what} is {shown}"

    def right(system: System) -> Array:
        value = getattr(system.load, name)
        return np.zeros(3) if value is None else np.asarray(value, dtype=float)

    def starts(system: System) -> list[Array]:
        value = getattr(system.load, name)
        return [] if value is None or not (np.any(value) or name == "pivot") else [right(system)]

    def alike(pairs: Sequence[tuple[System, Array]]) -> str:
        """Of torques: whether they are the requested ones, taken along the principal axes."""
        for text, tensor in TENSORS.items() if name.startswith("torque") else ():
            if all(_turned(getattr(s.load, name), p, tensor(s)) for s, p in pairs):
                return f"these are the numbers of the requested one along {text}"
        return ""

    part = "torque" if name.startswith("torque") else name
    return Family(name, part, starts, form, text, right, unit, alike=alike)


# What the principal axes are of.
TENSORS: dict[str, Callable[[System], Array]] = {
    "the inertia's principal axes": lambda s: np.asarray(s.body.inertia, dtype=float),
    "the principal axes of the inertia about the pivot": lambda s: np.asarray(
        moving_inertia(s), dtype=float
    ),
}


def _turned(requested: Array, acting: Array, tensor: Array) -> bool:
    """Whether a vector is another along the principal axes, whatever their order and signs."""
    axes = np.linalg.eigh(tensor)[1]
    along, back = (np.sort(np.abs(turn @ requested)) for turn in (axes.T, axes))
    size = SAME * float(np.linalg.norm(requested))
    reached, came = np.sort(np.abs(acting)), np.sort(np.abs(axes.T @ acting))
    if np.max(np.abs(along - np.sort(np.abs(requested)))) <= size:
        return False  # the axes are the body's
    ways = (along - reached, back - reached, came - np.sort(np.abs(requested)))
    return any(float(np.max(np.abs(one))) <= size for one in ways)


def _arm(form: Form, system: System, p: Array) -> Form:
    return replace(form, arm=p)


def _lever_of(system: System) -> Array:
    return form_of(system).arm


THREE_NUMBERS: tuple[Family, ...] = (
    _load_vector("gravity", "gravity", "m/s^2"),
    _load_vector("torque_body", "the torque in body axes", "N m"),
    _load_vector("torque_world", "the torque in world axes", "N m"),
    _load_vector("pivot", "the pivot", "m"),
    Family(
        "arm",
        "gravity",
        lambda s: [_lever_of(s)] if s.load.pivot is not None and np.any(s.load.gravity) else [],
        _arm,
        lambda s, p: (
            f"the torque of gravity has the lever {vector(p, _lever_of(s))} m, where the centre of "
            f"mass lies {vector(_lever_of(s), p)} m from the pivot"
        ),
        _lever_of,
        "m",
    ),
)


def _extra(name: str, frame: str) -> Family:
    """A constant torque in axes in which none was requested."""

    def starts(system: System) -> list[Array]:
        return [] if np.any(getattr(system.load, name)) else [np.zeros(3)]

    def text(system: System, p: Array) -> str:
        return f"a torque of {vector(p)} N m in {frame} axes acts that was not requested"

    return Family(
        f"extra {name}",
        "torque",
        starts,
        lambda f, s, p: replace(f, **{name: p}),
        text,
        lambda s: np.zeros(3),
        "N m",
    )


EXTRA = (_extra("torque_body", "body"), _extra("torque_world", "world"))
