"""Wrong equations with numbers in them, fitted to an engine's accelerations."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from omegadot.diagnosis.equations.equation_form import Form, accelerations, form_of, stacked
from omegadot.diagnosis.equations.evidence import Evidence
from omegadot.diagnosis.wording.digits import factor, number, vector
from omegadot.reference_impl.inertia import moving_inertia
from omegadot.reference_impl.system import Array, System

MOST_TRIES = 8
DELTA = 1e-6
NOTHING = 1e-7  # a part that cannot be kept apart from none in the limit of vanishing steps
AXES = "xyz"


@dataclass(frozen=True)
class Family:
    """One thing that is wrong by a number or a few.

    starts: where the search begins, each (k,); none where the family does not apply.  form: the
    equation with these numbers.  text: the cause as text.  right: the numbers of the right
    equation, (k,), against which those found are held over several scenarios.
    """

    name: str
    part: str
    starts: Callable[[System], list[Array]]
    form: Callable[[Form, System, Array], Form]
    text: Callable[[System, Array], str]
    right: Callable[[System], Array]
    unit: str = ""


def fit(evidence: Evidence, family: Family, base: Form | None = None) -> Array | None:
    """The numbers with which a family is the engine's equation, by Gauss-Newton; None if none is.

    base: another equation than the right one, in which the numbers are put.
    """
    right = base or form_of(evidence.system)
    for start in family.starts(evidence.system):
        found = _from(evidence, family, right, np.asarray(start, dtype=float))
        if found is not None:
            return found
    return None


def _from(evidence: Evidence, family: Family, right: Form, p: Array) -> Array | None:
    def form(numbers: Array) -> Form:
        return family.form(right, evidence.system, numbers)

    size = float(np.max(np.abs(p)))
    if size == 0.0:
        size = float(np.trace(right.spin)) if family.unit == "kg m^2" else 1.0
    scale = np.full(len(p), DELTA * (abs(size) or 1.0))
    for _ in range(MOST_TRIES):
        try:
            here = accelerations(form(p), evidence.states)
            if evidence.fits(here):
                return p
            moved = [form(p + d * one) for d, one in zip(scale, np.eye(len(p)), strict=True)]
            there = accelerations(stacked(moved), evidence.states)
        except (ValueError, np.linalg.LinAlgError):
            return None
        rest = evidence.weighted(evidence.found, here)
        lines = [
            evidence.weighted(type(here)(there.angular[k], there.linear[k]), here) / d
            for k, d in enumerate(scale)
        ]
        matrix = np.stack(lines, axis=-1)
        if not np.any(matrix) or not np.all(np.isfinite(matrix)):
            return None
        step = np.linalg.lstsq(matrix, rest, rcond=None)[0]
        if not np.all(np.isfinite(step)):
            return None
        p = p + step
    return None


def _scalar(
    name: str,
    part: str,
    right: float,
    applies: Callable[[System], bool],
    form: Callable[[Form, System, float], Form],
    text: Callable[[System, float], str],
    unit: str = "",
) -> Family:
    """A family of one number, whose right one is the same for every system."""
    return Family(
        name,
        part,
        lambda s: [np.array([right])] if applies(s) else [],
        lambda f, s, p: form(f, s, float(p[0])),
        lambda s, p: text(s, float(p[0])),
        lambda s: np.array([right]),
        unit,
    )


def _driven(system: System) -> bool:
    return bool(np.any(system.load.torque_body) or np.any(system.load.torque_world))


def _always(_: System) -> bool:
    return True


def _scaled(what: str) -> Callable[[System, float], str]:
    def text(system: System, k: float) -> str:
        mass = float(system.body.mass)
        if abs(k) < NOTHING:
            return f"{what} is missing"
        known = {"it is divided by the mass": 1.0 / mass, "it is multiplied by the mass": mass}
        # where mass is one nothing shows it
        why = [t for t, v in known.items() if abs(mass - 1.0) > 1e-6 and abs(k / v - 1.0) < 1e-9]
        return f"{what} is scaled by {factor(k)}" + (f": {why[0]}" if why else "")

    return text


def _mass_scaled(form: Form, k: float) -> Form:
    return replace(form, torque_body=k * form.torque_body, torque_world=k * form.torque_world)


def _all_loads(form: Form, system: System, k: float) -> Form:
    loads = _mass_scaled(form, k)
    return replace(loads, weight=k * form.weight, damping=k * form.damping)


ONE_NUMBER: tuple[Family, ...] = (
    _scalar(
        "spin",
        "spin",
        1.0,
        _always,
        lambda f, s, k: replace(f, spin=k * f.spin),
        _scaled("the gyroscopic term"),
    ),
    _scalar(
        "gravity",
        "gravity",
        1.0,
        lambda s: bool(np.any(s.load.gravity)),
        lambda f, s, k: replace(f, weight=k * f.weight, gravity=k * f.gravity),
        _scaled("gravity"),
    ),
    _scalar(
        "torque",
        "torque",
        1.0,
        _driven,
        lambda f, s, k: _mass_scaled(f, k),
        _scaled("the applied torque"),
    ),
    Family(
        "damping",
        "damping",
        lambda s: [np.array([float(s.load.damping)])] if float(s.load.damping) else [],
        lambda f, s, p: replace(f, damping=float(p[0]) * np.eye(3)),
        lambda s, p: (
            f"the damping that acts is {number(float(p[0]), float(s.load.damping))} N m s/rad, "
            f"where {number(float(s.load.damping), float(p[0]))} was requested"
        ),
        lambda s: np.array([float(s.load.damping)]),
        "N m s/rad",
    ),
    _scalar(
        "loads",
        "loads",
        1.0,
        lambda s: (_driven(s) + bool(np.any(s.load.damping)) + (s.load.pivot is not None)) > 1,
        _all_loads,
        _scaled("the torque of all loads"),
    ),
    _scalar(
        "extra damping",
        "damping",
        0.0,
        lambda s: not float(s.load.damping),
        lambda f, s, d: replace(f, damping=f.damping + d * np.eye(3)),
        lambda s, d: f"a damping of {d:.3g} N m s/rad acts that was not requested",
    ),
    _scalar(
        "extra rate",
        "damping",
        0.0,
        _always,
        lambda f, s, d: replace(f, damping=f.damping + d * np.linalg.inv(f.solve)),
        lambda s, d: (
            f"omega-dot has {-d:.3g} omega in it that was not requested, whatever the inertia: a "
            "damping as a rate, not as a torque"
        ),
    ),
    _scalar(
        "extra square",
        "damping",
        0.0,
        _always,
        lambda f, s, d: replace(f, drag_square=f.drag_square + d),
        lambda s, d: f"a damping torque of -{d:.3g} |omega| omega N m acts that was not requested",
    ),
    _scalar(
        "drag",
        "drag",
        0.0,
        lambda s: s.load.pivot is None,
        lambda f, s, d: replace(f, drag=f.drag + d),
        lambda s, d: f"the linear velocity is damped: the acceleration has {-d:.3g} v in it",
    ),
    _scalar(
        "armature",
        "inertia",
        0.0,
        _always,
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
        lambda s: [] if s.load.pivot is None else [np.array([float(s.body.mass)])],
        lambda f, s, p: _of_system(_with_body(s, mass=np.asarray(p[0]))),
        lambda s, p: (
            f"the dynamics act as if the mass were {number(float(p[0]), float(s.body.mass))} kg, "
            f"where {number(float(s.body.mass), float(p[0]))} was requested"
        ),
        lambda s: np.array([float(s.body.mass)]),
        "kg",
    ),
)


def _with_body(system: System, **parts: Array) -> System:
    return replace(system, bodies=(replace(system.body, **parts),))


def _of_system(system: System) -> Form:
    return form_of(system)


def _least(name: str, held: Callable[[Array, float], Array], what: str) -> Family:
    """A least value of the moments, or of the diagonal."""

    def form(right: Form, system: System, p: Array) -> Form:
        tensor = held(np.asarray(system.body.inertia, dtype=float), float(p[0]))
        return form_of(_with_body(system, inertia=tensor))

    def starts(system: System) -> list[Array]:
        values = np.sort(np.linalg.eigvalsh(np.asarray(system.body.inertia, dtype=float)))
        middle = [values[0] + k * (values[-1] - values[0]) for k in (0.25, 0.75)]
        return [np.array([value]) for value in (*middle, 2.0 * values[-1])]

    def text(system: System, p: Array) -> str:
        return f"{what} is held above {number(float(p[0]))} kg m^2"

    return Family(name, "inertia", starts, form, text, lambda s: np.array([0.0]), "kg m^2")


def _least_moments(tensor: Array, least: float) -> Array:
    moments, axes = np.linalg.eigh(tensor)
    return np.asarray((axes * np.maximum(moments, least)) @ axes.T)


def _least_diagonal(tensor: Array, least: float) -> Array:
    kept = np.diag(tensor)
    return np.asarray(tensor + np.diag(np.maximum(kept, least) - kept))


LEAST = (
    _least("least moment", _least_moments, "every principal moment of inertia"),
    _least("least diagonal", _least_diagonal, "the diagonal of the inertia"),
)


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
                f"the pivot lies at {vector(p, requested)} m, {off} m from where it was requested"
            )
        shown = f"{vector(p, requested)} {unit}, where {vector(requested, p)} was requested"
        return f"{what} is {shown}"

    def right(system: System) -> Array:
        value = getattr(system.load, name)
        return np.zeros(3) if value is None else np.asarray(value, dtype=float)

    def starts(system: System) -> list[Array]:
        value = getattr(system.load, name)
        return [] if value is None or not (np.any(value) or name == "pivot") else [right(system)]

    part = "torque" if name.startswith("torque") else name
    return Family(name, part, starts, form, text, right, unit)


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
_I, _J = np.triu_indices(3)
_BASIS = np.zeros((6, 3, 3))
_BASIS[range(6), _I, _J] = _BASIS[range(6), _J, _I] = 1.0


def _six(tensor: Array) -> Array:
    return np.asarray(tensor, dtype=float)[_I, _J]


def _tensor(p: Array) -> Array:
    return np.tensordot(p, _BASIS, 1)


def _inertia_family(name: str, where: str, parts: tuple[str, ...]) -> Family:
    def form(right: Form, system: System, p: Array) -> Form:
        tensor = _tensor(p)
        made = {"solve": np.linalg.inv(tensor), "spin": tensor}
        return replace(right, **{one: made[one] for one in parts})

    def text(system: System, p: Array) -> str:
        requested, tensor = np.asarray(moving_inertia(system), dtype=float), _tensor(p)
        off = float(np.linalg.norm(tensor - requested, 2) / np.linalg.norm(requested, 2))
        rows = "; ".join(vector(row, own) for row, own in zip(tensor, requested, strict=True))
        about = "" if system.load.pivot is None else " about the pivot"
        return f"{where} another inertia, {100 * off:.2g} % off:{about} {rows} kg m^2"

    return Family(
        name,
        "inertia",
        lambda s: [_six(moving_inertia(s))],
        form,
        text,
        lambda s: _six(moving_inertia(s)),
        "kg m^2",
    )


SIX_NUMBERS = (
    _inertia_family("inertia", "the dynamics are those of", ("solve", "spin")),
    _inertia_family("inverse", "omega-dot is solved for with", ("solve",)),
    _inertia_family("spin inertia", "the gyroscopic term is formed with", ("spin",)),
)
LEVELS: tuple[tuple[Family, ...], ...] = (ONE_NUMBER, LEAST, THREE_NUMBERS, SIX_NUMBERS)
