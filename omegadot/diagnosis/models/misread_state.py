"""Causes of a state that does not read back: another convention, on its way in or out."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass, replace
from math import comb

import numpy as np

from omegadot.diagnosis.equations.across import Across
from omegadot.diagnosis.equations.known import scenarios_in_common
from omegadot.diagnosis.models.attitude_misread import attitude_misread
from omegadot.diagnosis.models.fitted_misreadings import fitted_misreadings
from omegadot.diagnosis.models.kept_place import kept_place
from omegadot.diagnosis.models.known_state import known_of_states
from omegadot.diagnosis.models.linear_map import (
    PRODUCTS,
    Product,
    fitted_map,
    is_product,
    unknown_map,
)
from omegadot.diagnosis.models.made_place import Place, made_place
from omegadot.diagnosis.models.misreadings import Misreading, losses, misreadings, settings
from omegadot.diagnosis.wording.features import SORTED_BY_KIND, Features, in_common
from omegadot.diagnosis.wording.laws import law_of
from omegadot.gates.bounds.scales import EPS
from omegadot.gates.case import Case
from omegadot.gates.states.model import state_rows
from omegadot.reference_impl.kinematics import place_on_pivot
from omegadot.reference_impl.system import Array, State, System

SIGN = "without its sign"
SET_OR_READ = "as a state is set or read back"
NEGATIVE = "the scalar part of the quaternion that is set is negative"
PLACE = ("position", "linear_velocity")
TURNS = ("orientation", "angular_velocity")
LAWS = {
    "angular_velocity": ("omega", "rad/s"),
    "linear_velocity": ("the linear velocity", "m/s"),
    "position": ("the position", "m"),
}


SCALED = re.compile(r"is scaled by (?P<number>[-+.\de]+)(?P<known> \()?")
PLAIN_DIGITS, FEWEST_SCALED = 3, 2


@dataclass(frozen=True)
class _Round:
    """A state that was set on one scenario, and what read back of it."""

    case: Case
    features: Features
    requested: State
    back: State
    eps: float

    def fails(self, back: State) -> bool:
        """Whether this is not the state that was set."""
        rows = state_rows(self.case, self.requested, back, self.eps)
        return any(row.verdict == "fail" for row in rows)


def state_causes(
    across: Across, case: Case, requested: State, back: State, eps: float
) -> list[str]:
    """What undoes, or makes, all that is read back: on every scenario, or on those of one kind."""
    scene = across.scenes[case.name]
    here = _Round(case, scene.features, requested, back, eps)
    if not here.fails(back):
        return []
    kept = kept_place(list(across.scenes.values()), case, eps)
    if kept:
        return [kept]
    every = _every(across, case, eps)
    lost = [
        text
        for text, left in losses().items()
        if not any(_differs(one, left(one.requested)) for one in every)
    ]
    if lost and SIGN in lost[0] and not any(one.back.orientation[0] < 0.0 for one in every):
        return lost[:1]
    for way in _ways(case.system):
        if not here.fails(_undone(here, way)):
            fits = [not one.fails(_undone(one, _way(one, way.statement))) for one in every]
            found = _where(way.statement, every, fits)
            if found:
                return [found]
    product = _product(here, every) or made_place([_place(one) for one in every])
    if product:
        return [product]
    lost = [text for text in lost if SIGN not in text]
    if lost:
        return lost[:1]
    law = _law(every)
    if law:
        return [law]
    for way in fitted_misreadings(back, requested, together=False):
        if not _is_chance(way, every) and not here.fails(_undone(here, way)):
            fits = [not one.fails(_undone(one, way)) for one in every]
            found = _where(way.statement, every, fits)
            if found:
                return [found]
    attitude = _attitude(every)
    if attitude:
        return [attitude]
    single = State(*(f.astype(np.float32).astype(float) for f in vars(requested).values()))
    pairs = zip(vars(single).values(), vars(back).values(), strict=True)
    if eps <= EPS and all(np.array_equal(a, b) for a, b in pairs):
        return ["the state is kept in single precision"]
    unknown = _unknown_map(across, every) if _is_omega(here) else ""
    return [unknown] if unknown else []


def _is_chance(way: Misreading, every: Sequence[_Round]) -> bool:
    """Whether it is a factor of many digits that one state alone shows: a limit makes one too."""
    scaled = SCALED.search(way.statement)
    if scaled is None or scaled["known"]:
        return False
    digits = len(scaled["number"].partition("e")[0].replace(".", "").strip("-0"))
    return digits > PLAIN_DIGITS and sum(one.fails(one.back) for one in every) < FEWEST_SCALED


def _is_omega(one: _Round) -> bool:
    """Whether omega alone is another, and of a pivoted body what follows from it."""
    return _is_alone(one, "angular_velocity")


def _place(one: _Round) -> Place:
    return Place(one.case.system, one.requested, one.back, lambda made: not _differs(one, made))


def _product(here: _Round, every: Sequence[_Round]) -> str:
    """A product of known inertias with omega, where nothing else is off."""
    if not _is_omega(here):
        return ""
    for product in PRODUCTS:
        fits = [_is_product(product, one) for one in every]
        if _is_product(product, here):
            found = _where(f"omega reads back as {product.text}", every, fits)
            if found:
                return found
    return ""


def _is_product(product: Product, one: _Round) -> bool:
    how = (one.case.system, one.requested, one.back, one.eps)
    return _is_omega(one) and is_product(product, *how)


def _unknown_map(across: Across, every: Sequence[_Round]) -> str:
    """Of the scenarios on which omega does not read back, that with the fewest loads first."""
    off = {id(one.case.system) for one in every if one.fails(one.back)}
    scenes = [scene for scene in across.scenes.values() if id(scene.system) in off]
    scenes.sort(key=lambda scene: sum(scene.features.kinds.values()))
    maps = [(s.name, fitted_map(*s.limits[0]) if s.limits else None) for s in scenes]
    return unknown_map(maps) if all(map(_is_omega, every)) else ""


def misreading_in(text: str, system: System) -> str:
    """The misreading that a cause on this system names; "" where it names none of these."""
    return next((w.statement for w in _ways(system) if text.startswith(w.statement)), "")


def would_show(misreading: str, case: Case, state: State, eps: float) -> bool:
    """Whether a misreading makes another state of this one, on this system."""
    way = next((w for w in _ways(case.system) if w.statement == misreading), None)
    if way is None:
        return False  # of a pivot, and there is none
    return any(row.verdict == "fail" for row in state_rows(case, state, way.right(state), eps))


def known_state(across: Across, case: Case, eps: float) -> str:
    """What is seen of all states that do not read back, where no cause fits; "" where all do."""
    every = _every(across, case, eps)
    rows = [state_rows(one.case, one.requested, one.back, one.eps) for one in every]
    requested, back = _attitudes(every)
    text = known_of_states(rows, requested, back)
    wrong, right = (
        [_features(one) for one in every if one.fails(one.back) is off] for off in (True, False)
    )
    where = scenarios_in_common(wrong, right, "it is so")
    return "; ".join(part for part in (text, where) if part)


def _attitudes(every: Sequence[_Round]) -> tuple[Array, Array]:
    """Those set, and those that read back, (n, 4)."""
    requested = np.array([one.requested.orientation for one in every])
    return requested, np.array([one.back.orientation for one in every])


def _every(across: Across, case: Case, eps: float) -> list[_Round]:
    return [
        _Round(replace(case, system=one.system), one.features, *one.states, eps)
        for one in across.scenes.values()
        if one.states is not None
    ]


def _attitude(every: Sequence[_Round]) -> str:
    """A rule by which all attitudes come back, or all that are wrong; the rest is that of these."""
    if not all(_is_alone(one, "orientation") for one in every):
        return ""
    wrong = [one for one in every if one.fails(one.back)]
    for shown in (every, wrong):
        text = attitude_misread(*_attitudes(shown), every[0].eps)
        if text:
            fits = [any(one is other for other in shown) for one in every]
            return _where(f"{text}, {SET_OR_READ}", every, fits)
    return ""


def _law(every: Sequence[_Round]) -> str:
    """A limit, a rounding or the like of one quantity, by which all states come back."""
    for field, (what, unit) in LAWS.items():
        pairs = [(getattr(one.requested, field), getattr(one.back, field)) for one in every]
        text = law_of(pairs, what, unit)
        if text and all(_is_alone(one, field) for one in every):
            return f"{text} as a state is set or read back"
    return ""


def _is_alone(one: _Round, field: str) -> bool:
    """Whether one quantity alone is another, and of a pivoted body what follows from it or not."""
    made = replace(one.requested, **{field: getattr(one.back, field)})
    follows = one.case.system.load.pivot is not None and field in TURNS
    others = [made, place_on_pivot(one.case.system, made)] if follows else [made]
    return any(not _differs(one, other) for other in others)


def _undone(one: _Round, way: Misreading) -> State:
    """What is meant by what reads back; on a pivot the place follows, where it did before."""
    right, system = way.right(one.back), one.case.system
    same = all(np.array_equal(getattr(right, n), getattr(one.back, n)) for n in PLACE)
    if system.load.pivot is None or not same:
        return right
    on_pivot = place_on_pivot(system, one.back)
    rows = state_rows(one.case, one.back, on_pivot, one.eps)
    follows = all(row.verdict != "fail" for row in rows)
    return place_on_pivot(system, right) if follows else right


def _ways(system: System) -> tuple[Misreading, ...]:
    return (*misreadings(system), *settings(system))


def _way(one: _Round, statement: str) -> Misreading:
    """The same way there; of a pivot it changes nothing on a free body."""
    known = (way for way in _ways(one.case.system) if way.statement == statement)
    return next(known, Misreading(statement, lambda state: state))


def _where(text: str, every: Sequence[_Round], fits: Sequence[bool]) -> str:
    """Where it undoes what is read back: everywhere, or where the others read back as they should.

    "" where it is contradicted, or nothing separates these scenarios.
    """
    against = [one for one, fit in zip(every, fits, strict=True) if not fit]
    if any(one.fails(one.back) for one in against):
        return ""
    if not against:
        return text
    shown = [o for o, fit in zip(every, fits, strict=True) if fit and o.fails(o.back)]
    if comb(len(shown) + len(against), len(shown)) < SORTED_BY_KIND:
        others = f"{len(against)} other{'s' * (len(against) > 1)}"  # so few are sorted by chance
        return f"{text}, not on {others} that would show it"
    common = in_common([_features(one) for one in shown], [_features(one) for one in against])
    return f"{text}, but only where {' or where '.join(common)}" if 0 < len(common) < 3 else ""


def _features(one: _Round) -> Features:
    """With those of the state that was set."""
    negative = bool(one.requested.orientation[0] < 0.0)
    return replace(one.features, kinds={**one.features.kinds, NEGATIVE: negative})


def _differs(one: _Round, made: State) -> bool:
    """Whether what reads back is not what is left of a state."""
    rows = state_rows(one.case, made, one.back, one.eps)
    return any(row.verdict == "fail" for row in rows)
