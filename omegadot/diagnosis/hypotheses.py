"""Wrong equations without a number in them: what engines are known to make of equation (8)."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import permutations
from typing import Any

import numpy as np

from omegadot.diagnosis.equation_form import Form, form_of
from omegadot.diagnosis.tensors import SPHERE, UNIT, other_tensors
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


def wrong_form(hypotheses: Sequence[Hypothesis], system: System) -> Form | None:
    """The equation with all of these in it; None where it has no meaning for this system."""
    try:
        for one in hypotheses:
            system = one.system(system)
        form = form_of(system)
        for one in hypotheses:
            form = one.form(form, system)
    except (ValueError, np.linalg.LinAlgError, ZeroDivisionError):
        return None
    if not all(np.all(np.isfinite(part)) for part in vars(form).values()):
        return None
    return form


def _load(text: str, part: str, change: Callable[[Load], dict[str, Any]]) -> Hypothesis:
    def other(system: System) -> System:
        return replace(system, load=replace(system.load, **change(system.load)))

    return Hypothesis(text, part, system=other)


def _body(text: str, part: str, change: Callable[[Body, System], dict[str, Any]]) -> Hypothesis:
    def other(system: System) -> System:
        body = replace(system.body, **change(system.body, system))
        return replace(system, bodies=(body,))

    return Hypothesis(text, part, system=other)


def _form(text: str, part: str, change: Callable[[Form, System], dict[str, Any]]) -> Hypothesis:
    return Hypothesis(text, part, form=lambda form, system: replace(form, **change(form, system)))


def _diagonal(matrix: Array) -> Array:
    return np.diag(np.diag(matrix))


def _single(values: Array) -> Array:
    return np.asarray(np.asarray(values, dtype=np.float32), dtype=float)


def _own(system: System) -> Array:
    return np.asarray(system.body.inertia, dtype=float)


def _moved(system: System) -> Array:
    """What the parallel-axis theorem adds for the distance from the body's origin."""
    return parallel_axis(float(system.body.mass), np.asarray(system.body.center_of_mass))


def _spin() -> Iterator[Hypothesis]:
    for text, factor in (("is missing", 0), ("has the wrong sign", -1), ("counts twice", 2)):
        yield _form(
            f"the gyroscopic term {text}", "spin", lambda f, s, k=factor: {"spin": k * f.spin}
        )
    yield _form(
        "the gyroscopic term is formed with the inertia's diagonal alone",
        "spin",
        lambda f, s: {"spin": _diagonal(f.spin)},
    )
    yield _form(
        "the gyroscopic term is formed with the inertia about the centre of mass, "
        "not about the pivot",
        "spin",
        lambda f, s: {"spin": _own(s)},
    )
    yield _form(
        "the gyroscopic term is formed with the inertia about the body's origin",
        "spin",
        lambda f, s: {"spin": _own(s) + _moved(s)},
    )


def _gravity() -> Iterator[Hypothesis]:
    size = np.linalg.norm
    yield _load("gravity is missing", "gravity", lambda one: {"gravity": 0 * one.gravity})
    yield _load("gravity has the wrong sign", "gravity", lambda one: {"gravity": -one.gravity})
    yield _load("gravity counts twice", "gravity", lambda one: {"gravity": 2 * one.gravity})
    for axis in range(3):
        for sign in (-1.0, 1.0):
            way = f"{'-' if sign < 0 else '+'}{AXES[axis]}"
            yield _load(
                f"gravity points along {way}, whatever direction was requested",
                "gravity",
                lambda one, k=axis, s=sign: {"gravity": s * size(one.gravity) * np.eye(3)[k]},
            )
        yield _load(
            f"the {AXES[axis]} component of gravity is dropped",
            "gravity",
            lambda one, k=axis: {"gravity": np.where(np.arange(3) == k, 0.0, one.gravity)},
        )
        yield _load(
            f"the {AXES[axis]} component of gravity has the wrong sign",
            "gravity",
            lambda one, k=axis: {"gravity": np.where(np.arange(3) == k, -1.0, 1.0) * one.gravity},
        )
        yield _load(
            f"only the {AXES[axis]} component of gravity acts",
            "gravity",
            lambda one, k=axis: {"gravity": np.where(np.arange(3) == k, one.gravity, 0.0)},
        )
    for order in permutations(range(3)):
        if order != (0, 1, 2):
            names = ", ".join(AXES[k] for k in order)
            yield _load(
                f"gravity's components are permuted: x, y, z hold what belongs to {names}",
                "gravity",
                lambda one, k=order: {"gravity": one.gravity[list(k)]},
            )
    yield _form(
        "gravity is fixed to the body instead of the world",
        "gravity",
        lambda f, s: {
            "weight": 0 * f.weight,
            "weight_body": f.weight,
            "gravity": 0 * f.gravity,
            "gravity_body": f.gravity,
        },
    )
    yield _form(
        "gravity acts at the body's origin instead of the centre of mass",
        "gravity",
        lambda f, s: {"arm": f.arm - s.body.center_of_mass},
    )
    yield _form(
        "gravity turns the body about its origin, though nothing holds it there",
        "gravity",
        lambda f, s: {"arm": f.arm + s.body.center_of_mass} if s.load.pivot is None else {},
    )
    yield _form(
        "in the torque of gravity the lever from the pivot to the centre of mass has the wrong "
        "sign: the centre of mass is mirrored",
        "gravity",
        lambda f, s: {"arm": -f.arm},
    )
    yield _form("the torque of gravity is missing", "gravity", lambda f, s: {"arm": 0 * f.arm})
    yield _form("the mass is left out of the weight", "gravity", _massless)
    yield _form(
        "in the torque of gravity the lever is the centre of mass's from the origin, not from the "
        "pivot",
        "gravity",
        lambda f, s: {"arm": s.body.center_of_mass} if s.load.pivot is not None else {},
    )


def _massless(form: Form, system: System) -> dict[str, Any]:
    return {"weight": form.weight / float(system.body.mass)}


def _damping() -> Iterator[Hypothesis]:
    for text, factor in (("is missing", 0), ("has the wrong sign", -1), ("counts twice", 2)):
        yield _form(
            f"the damping {text}", "damping", lambda f, s, k=factor: {"damping": k * f.damping}
        )
    yield _form(
        "the damping acts as a rate, not as a torque: omega-dot has -d omega, whatever the inertia",
        "damping",
        lambda f, s: {"damping": np.linalg.inv(f.solve) * float(s.load.damping)},
    )
    yield _form(
        "the damping is divided by the mass instead of the inertia",
        "damping",
        lambda f, s: {
            "damping": np.linalg.inv(f.solve) * (float(s.load.damping) / float(s.body.mass))
        },
    )
    yield _form(
        "the damping torque is divided by the mass",
        "damping",
        lambda f, s: {"damping": f.damping / float(s.body.mass)},
    )
    yield _form(
        "the damping torque is multiplied by the mass",
        "damping",
        lambda f, s: {"damping": f.damping * float(s.body.mass)},
    )
    yield _form(
        "the damping torque is divided by the inertia's diagonal alone",
        "damping",
        lambda f, s: {"damping": np.linalg.inv(f.solve) @ _over_diagonal(f) @ f.damping},
    )
    yield _form(
        "the damping goes with |omega| omega instead of omega",
        "damping",
        lambda f, s: {"damping": 0 * f.damping, "drag_square": np.asarray(s.load.damping)},
    )
    for axis in range(3):
        alone = np.arange(3) == axis
        yield _form(
            f"the damping about {AXES[axis]} is missing",
            "damping",
            lambda f, s, k=alone: {"damping": np.diag(np.where(k, 0.0, np.diag(f.damping)))},
        )
        yield _form(
            f"the damping acts about {AXES[axis]} alone",
            "damping",
            lambda f, s, k=alone: {"damping": np.diag(np.where(k, np.diag(f.damping), 0.0))},
        )
    yield _form(
        "the linear velocity is damped as well: the acceleration has -d v",
        "drag",
        lambda f, s: {"drag": np.asarray(s.load.damping)},
    )
    yield _form(
        "the linear velocity is damped as well: the acceleration has -d v / m",
        "drag",
        lambda f, s: {"drag": np.asarray(s.load.damping) / float(s.body.mass)},
    )


def _over_diagonal(form: Form) -> Array:
    return np.diag(1.0 / np.diag(np.linalg.inv(form.solve)))


def _applied(one: Load, change: Callable[[Array], Array]) -> dict[str, Any]:
    return {"torque_body": change(one.torque_body), "torque_world": change(one.torque_world)}


def _torque() -> Iterator[Hypothesis]:
    for text, factor in (("is missing", 0), ("has the wrong sign", -1), ("counts twice", 2)):
        yield _load(
            f"the applied torque {text}",
            "torque",
            lambda one, k=factor: _applied(one, lambda t: k * t),
        )
    yield _load(
        "the applied torque is taken in the wrong frame",
        "torque",
        lambda one: {"torque_body": one.torque_world, "torque_world": one.torque_body},
    )
    yield _load(
        "the torque in world axes is taken for one in body axes",
        "torque",
        lambda one: {
            "torque_body": one.torque_body + one.torque_world,
            "torque_world": 0 * one.torque_world,
        },
    )
    yield _load(
        "the torque in body axes is taken for one in world axes",
        "torque",
        lambda one: {
            "torque_world": one.torque_body + one.torque_world,
            "torque_body": 0 * one.torque_body,
        },
    )
    for frame in ("body", "world"):
        yield _load(
            f"the torque in {frame} axes is missing",
            "torque",
            lambda one, k=f"torque_{frame}": {k: 0 * getattr(one, k)},
        )
    for axis in range(3):
        for what, factor in (("has the wrong sign", -1.0), ("is missing", 0.0)):
            signs = np.where(np.arange(3) == axis, factor, 1.0)
            yield _load(
                f"the {AXES[axis]} component of the applied torque {what}",
                "torque",
                lambda one, k=signs: _applied(one, lambda t: k * t),
            )
    for order in permutations(range(3)):
        if order != (0, 1, 2):
            names = ", ".join(AXES[k] for k in order)
            yield _load(
                f"the applied torque's components are permuted: x, y, z hold those of {names}",
                "torque",
                lambda one, k=order: _applied(one, lambda t: t[list(k)]),
            )
    for what, power in (("divided", -1), ("multiplied", 1)):
        yield _form(
            f"all loads have a wrong torque: it is {what} by the mass",
            "loads",
            lambda f, s, k=power: _loads_scaled(f, float(s.body.mass) ** k),
        )
    through: dict[str, Callable[[Form, System], Array]] = {
        "is not divided by the inertia": lambda f, s: np.eye(3),
        "is divided by the inertia's diagonal alone": lambda f, s: _over_diagonal(f),
        "is divided by the mass": lambda f, s: f.solve / float(s.body.mass),
        "is multiplied by the mass": lambda f, s: f.solve * float(s.body.mass),
        "meets the inertia about the body's origin": lambda f, s: np.linalg.inv(
            _own(s) + _moved(s)
        ),
        "meets the inertia about the centre of mass": lambda f, s: np.linalg.inv(_own(s)),
    }
    for text, matrix in through.items():

        def change(form: Form, system: System, made: Any = matrix) -> dict[str, Any]:
            ratio = np.linalg.inv(form.solve) @ made(form, system)
            return {"torque_body": ratio @ form.torque_body, "turned": ratio}

        yield _form(f"the applied torque {text}", "torque", change)
    for text, sign in (("", 1.0), ("", -1.0)):
        yield _form(
            "the applied torque turns the body about its origin, so that it moves the centre of "
            "mass" + text,
            "report",
            lambda f, s, k=sign: (
                {"couple_offset": k * s.body.center_of_mass} if s.load.pivot is None else {}
            ),
        )


def _loads_scaled(form: Form, k: float) -> dict[str, Any]:
    parts = ("torque_body", "torque_world", "weight", "damping")
    return {name: k * getattr(form, name) for name in parts}


def _pivot() -> Iterator[Hypothesis]:
    def pivot(change: Callable[[Array], Array | None]) -> Callable[[Load], dict[str, Any]]:
        return lambda one: {"pivot": None if one.pivot is None else change(one.pivot)}

    yield _load("the pivot is ignored: the body moves freely", "pivot", pivot(lambda p: None))
    yield _load(
        "the body is pivoted at its origin instead of the pivot", "pivot", pivot(lambda p: 0 * p)
    )
    yield _load("the pivot has the wrong sign", "pivot", pivot(lambda p: -p))
    for axis in range(3):
        alone = np.arange(3) == axis
        yield _load(
            f"the {AXES[axis]} component of the pivot is dropped",
            "pivot",
            pivot(lambda p, k=alone: np.where(k, 0.0, p)),
        )
        yield _load(
            f"only the {AXES[axis]} component of the pivot is used",
            "pivot",
            pivot(lambda p, k=alone: np.where(k, p, 0.0)),
        )
        yield _load(
            f"the {AXES[axis]} component of the pivot has the wrong sign",
            "pivot",
            pivot(lambda p, k=alone: np.where(k, -p, p)),
        )
    for order in permutations(range(3)):
        if order != (0, 1, 2):
            names = ", ".join(AXES[k] for k in order)
            yield _load(
                f"the pivot's components are permuted: x, y, z hold what belongs to {names}",
                "pivot",
                pivot(lambda p, k=order: p[list(k)]),
            )
    for axis in range(3):
        alone = np.arange(3) == axis
        yield _lever(
            f"only the {AXES[axis]} component of the lever from the pivot to the centre of mass "
            "is used",
            lambda r, k=alone: np.where(k, r, 0.0),
        )
        yield _lever(
            f"the {AXES[axis]} component of the lever from the pivot to the centre of mass is "
            "dropped",
            lambda r, k=alone: np.where(k, 0.0, r),
        )
        yield _lever(
            f"the lever from the pivot to the centre of mass is laid along {AXES[axis]}",
            lambda r, k=alone: np.where(k, np.linalg.norm(r), 0.0),
        )
        yield _lever(
            f"the lever from the pivot to the centre of mass is laid along -{AXES[axis]}",
            lambda r, k=alone: np.where(k, -np.linalg.norm(r), 0.0),
        )
    yield _lever("the lever from the pivot to the centre of mass loses its signs", np.abs)
    yield _lever("the lever from the pivot to the centre of mass has the wrong sign", lambda r: -r)


def _lever(text: str, change: Callable[[Array], Array]) -> Hypothesis:
    """Another lever by another centre of mass, of a pivoted body alone."""

    def other(system: System) -> System:
        body, pivot = system.body, system.load.pivot
        if pivot is None:
            return system
        center = pivot + change(body.center_of_mass - pivot)
        return replace(system, bodies=(replace(body, center_of_mass=center),))

    return Hypothesis(text, "pivot", system=other)


def _center() -> Iterator[Hypothesis]:
    yield _body(
        "the centre of mass is ignored",
        "center",
        lambda body, s: {"center_of_mass": 0 * body.center_of_mass},
    )
    yield _body(
        "the centre of mass has the wrong sign",
        "center",
        lambda body, s: {"center_of_mass": -body.center_of_mass},
    )


def _report() -> Iterator[Hypothesis]:
    yield _form(
        "the linear acceleration looks like that of the body's origin",
        "report",
        lambda f, s: {"offset": f.offset - s.body.center_of_mass},
    )
    yield _form(
        "the linear acceleration is the spatial one: omega x v is left out of it",
        "report",
        lambda f, s: {"spatial": np.asarray(-1.0)},
    )
    yield _form(
        "the linear acceleration counts omega x v twice",
        "report",
        lambda f, s: {"spatial": np.asarray(1.0)},
    )


def _precision() -> Iterator[Hypothesis]:
    single = "is kept in single precision"
    yield _body(f"the mass {single}", "precision", lambda body, s: {"mass": _single(body.mass)})
    yield _body(
        f"the inertia {single}", "precision", lambda body, s: {"inertia": _single(body.inertia)}
    )
    yield _body(
        f"the centre of mass {single}",
        "precision",
        lambda body, s: {"center_of_mass": _single(body.center_of_mass)},
    )
    yield _body(
        "mass, centre of mass and inertia are kept in single precision",
        "precision",
        lambda body, s: {name: _single(value) for name, value in vars(body).items()},
    )
    for name in ("gravity", "damping", "pivot"):
        yield _load(
            f"the {name} {single}".replace("the gravity", "gravity"),
            "precision",
            lambda one, k=name: {k: None if getattr(one, k) is None else _single(getattr(one, k))},
        )
    yield _load(f"the applied torque {single}", "precision", lambda one: _applied(one, _single))


def _inertia(system: System) -> Iterator[Hypothesis]:
    """Of one system: its tensor, in the solve, in the gyroscopic term or in both."""
    own, names = _own(system), other_tensors(system)
    about = form_of(system).spin - own
    for text, tensor in names.items():
        if not np.linalg.eigvalsh(tensor)[0] > 0.0 or np.array_equal(tensor, own):
            continue
        yield _body(
            f"in the dynamics, {text}", f"inertia:{text}", lambda b, s, t=text: _named(s, t)
        )
        yield _form(
            f"where omega-dot is solved for, {text}",
            f"inertia:{text}",
            lambda f, s, t=text: {"solve": np.linalg.inv(_about(s) + _tensor(s, t))},
        )
        yield _form(
            f"in the gyroscopic term, {text}",
            f"inertia:{text}",
            lambda f, s, t=text: {"spin": _about(s) + _tensor(s, t)},
        )
    if np.any(about):
        own_alone = "the inertia about the centre of mass is taken, not that about the pivot"
        yield _form(
            f"where omega-dot is solved for, {own_alone}",
            "inertia",
            lambda f, s: {"solve": np.linalg.inv(_own(s))},
        )
        yield _form(
            f"in the dynamics, {own_alone}",
            "inertia",
            lambda f, s: {"solve": np.linalg.inv(_own(s)), "spin": _own(s)},
        )
        yield _form(
            "the parallel-axis theorem has the lever squared on the diagonal alone",
            "inertia",
            lambda f, s: _both(_own(s) + _squared(s)),
        )
        yield _form(
            "the parallel-axis theorem is applied twice",
            "inertia",
            lambda f, s: _both(2.0 * f.spin - _own(s)),
        )
        yield _form(
            "where omega-dot is solved for, only the diagonal of the inertia about the pivot is "
            "used",
            "inertia",
            lambda f, s: {"solve": np.diag(1.0 / np.diag(f.spin))},
        )
        yield _form(
            "in the dynamics, only the diagonal of the inertia about the pivot is used",
            "inertia",
            lambda f, s: _both(_diagonal(f.spin)),
        )


def _tensor(system: System, text: str) -> Array:
    return other_tensors(system).get(text, _own(system))


def _named(system: System, text: str) -> dict[str, Any]:
    tensor = _tensor(system, text)
    if not np.linalg.eigvalsh(tensor)[0] > 0.0:
        raise ValueError(text)
    return {"inertia": tensor}


def _about(system: System) -> Array:
    return form_of(system).spin - _own(system)


def _squared(system: System) -> Array:
    r = form_of(system).offset
    return float(system.body.mass) * float(r @ r) * np.eye(3)


def _both(tensor: Array) -> dict[str, Any]:
    return {"solve": np.linalg.inv(tensor), "spin": tensor}


FIXED: tuple[Hypothesis, ...] = (
    *_spin(),
    *_gravity(),
    *_damping(),
    *_torque(),
    *_pivot(),
    *_center(),
    *_report(),
    *_precision(),
)


def hypotheses(system: System) -> list[Hypothesis]:
    """All of them, for one system; most make no difference to it."""
    return [*FIXED, *_inertia(system)]
