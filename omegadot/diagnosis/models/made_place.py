"""A position or a velocity that reads back as another product of the same vectors.

Of a pivoted body the place follows from attitude and omega: x = R r, v = R omega x R r, with r from
the pivot to the centre of mass (equation (3)). Of a free body it is the one set, and what an engine
that keeps another point adds to it: R c, and R omega x R c. Each vector may have been turned once
too often or not at all, be another lever, or have the other sign.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import partial
from itertools import product
from typing import Any

import numpy as np

from omegadot.reference_impl.cross_product import cross
from omegadot.reference_impl.inertia import lever
from omegadot.reference_impl.kinematics import place_on_pivot
from omegadot.reference_impl.rotations import conjugate, rotate, rotate_inverse
from omegadot.reference_impl.system import Array, State, System

TRANSPOSED = (
    "the rotation looks transposed in the place of a pivoted body: position and linear velocity "
    "are by R^T"
)
ALIKE = 1e-12  # relative
MOST = 2  # forms that agree on all states and are all stated
TURNS: dict[str, Callable[[Array, Array], Array]] = {
    "": lambda q, v: v,
    "R ": rotate,
    "R^T ": rotate_inverse,
}
LEVERS: dict[str, tuple[str, Callable[[System], Any]]] = {
    "r": ("the lever from the pivot to the centre of mass", lever),
    "c": ("the centre of mass from the body's origin", lambda s: s.body.center_of_mass),
    "p": ("the pivot from the body's origin", lambda s: s.load.pivot),
}
FIELDS = {"position": "the position", "linear_velocity": "the linear velocity"}
SYMBOLS = {"position": "x", "linear_velocity": "v"}
Lever = Callable[[System], Any]
Made = Callable[[System, State], Array]
DUE = {"position": "R r", "linear_velocity": "(R omega) x (R r)"}


@dataclass(frozen=True)
class Place:
    """One state that was set on one system, and what read back of it.

    same: whether a state is what read back, to the bounds of the model gate.
    """

    system: System
    requested: State
    back: State
    same: Callable[[State], bool]

    @property
    def pivoted(self) -> bool:
        """Whether the place follows from attitude and omega."""
        return self.system.load.pivot is not None

    def has(self, field: str, values: Array) -> bool:
        """Whether one quantity reads back with these values."""
        return self.same(replace(self.back, **{field: values}))


@dataclass(frozen=True)
class _Form:
    """How one quantity is made of bodies that are pivoted, or of free ones; text states it."""

    text: str
    pivoted: bool
    make: Made


def made_place(places: Sequence[Place]) -> str:
    """The formulas by which all positions and velocities read back; "" where none does.

    Attitudes and omegas must read back right: what is made of others is another cause.
    """
    for one in places:
        kept = {name: getattr(one.requested, name) for name in FIELDS}
        if not one.same(replace(one.requested, **{n: getattr(one.back, n) for n in kept})):
            return ""
    if any(one.pivoted for one in places) and all(map(_is_transposed, places)):
        return TRANSPOSED
    texts = []
    for field, what in FIELDS.items():
        wrong = [one for one in places if not one.has(field, getattr(one.requested, field))]
        if wrong:
            found = _formulas(field, wrong, places)
            if not 0 < len(found) <= MOST:
                return ""
            texts.append(f"{what} {' or '.join(found)}")
    return " and ".join(texts)


def _is_transposed(place: Place) -> bool:
    """Whether a pivoted body's place is by the transposed rotation; a free one's reads back."""
    turned = replace(place.requested, orientation=conjugate(place.requested.orientation))
    made = place_on_pivot(place.system, turned)
    return place.same(replace(made, orientation=place.requested.orientation))


def _formulas(field: str, wrong: Sequence[Place], places: Sequence[Place]) -> list[str]:
    """All that fit every state: those of the bodies that are wrong, which must be of one kind."""
    kinds = {one.pivoted for one in wrong}
    if len(kinds) > 1:
        return []
    alike = [one for one in places if one.pivoted in kinds]
    forms = [form for form in _FORMS[field] if form.pivoted in kinds]
    fits = list[_Form]()
    for form in forms:
        # what is wrong rules out most of them
        if all(one.has(field, form.make(one.system, one.requested)) for one in (*wrong, *alike)):
            same = (all(map(partial(_alike, form, kept), wrong)) for kept in fits)
            fits += [] if any(same) else [form]
    return [form.text for form in fits]


def _alike(one: _Form, other: _Form, place: Place) -> bool:
    """Whether two formulas are one, as of a lever where the centre of mass is the origin."""
    a, b = (form.make(place.system, place.requested) for form in (one, other))
    return bool(np.allclose(a, b, rtol=ALIKE, atol=0.0))


def _turned(turn: str, q: Array, vector: Array) -> Array:
    return TURNS[turn](q, np.broadcast_to(np.asarray(vector, dtype=float), (*q.shape[:-1], 3)))


def _lever_forms(names: str) -> Iterator[tuple[str, str, Made]]:
    """Each lever in body axes, in the world, and turned back: its name, what it is, its values."""
    for name, turn in product(names, TURNS):
        what, of = LEVERS[name]

        def made(system: System, s: State, turn: str = turn, of: Lever = of) -> Array:
            return _turned(turn, s.orientation, of(system))

        yield f"{turn}{name}", f"{name} is {what}", made


def _product_forms(names: str) -> Iterator[tuple[str, str, Made]]:
    """The product of omega and a lever, each turned in its way."""
    for (second, what, b), turn in product(_lever_forms(names), TURNS):

        def made(system: System, s: State, turn: str = turn, b: Made = b) -> Array:
            return cross(_turned(turn, s.orientation, s.angular_velocity), b(system, s))

        first = f"({turn}omega)" if turn else "omega"
        yield f"{first} x {f'({second})' if ' ' in second else second}", what, made


def _forms(field: str) -> Iterator[_Form]:
    """All of one quantity: of a pivoted body in place of what is due, of a free one added to it."""
    forms = _lever_forms if field == "position" else _product_forms
    due, symbol = DUE[field], SYMBOLS[field]
    for (name, what, make), sign in product(forms("rcp"), (1.0, -1.0)):
        if (name, sign) != (due, 1.0):
            shown = name if sign > 0.0 else f"-{name}"
            text = f"of a pivoted body reads back as {shown}, where {due} is due ({what})"

            def instead(system: System, s: State, make: Made = make, sign: float = sign) -> Array:
                return sign * make(system, s)

            yield _Form(text, True, instead)
    for (name, what, make), sign in product(forms("c"), (1.0, -1.0)):
        shown = f"{symbol} {'+' if sign > 0.0 else '-'} {name}"
        text = f"of a free body reads back as {shown}, where {symbol} was set ({what})"

        def added(system: System, s: State, make: Made = make, sign: float = sign) -> Array:
            set_values: Array = getattr(s, field)
            return set_values + sign * make(system, s)

        yield _Form(text, False, added)


_FORMS = {field: tuple(_forms(field)) for field in FIELDS}
