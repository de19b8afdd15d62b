"""Runge-Kutta methods with one coefficient's sign or place wrong, from their tableaus."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from itertools import combinations

from omegadot.diagnosis.stepping.explicit_schemes import TABLEAUS, by_exponential
from omegadot.diagnosis.stepping.on_quaternion import Rows, on_quaternion
from omegadot.reference_impl.schemes.scheme import Step

ORDINALS = ("first", "second", "third", "fourth")
SLIPPED = ("Kutta's 3/8 method", "Heun's method", "the explicit midpoint method")
OTHER_PLACES = {  # of the second stage of the methods of two, as parts of the step
    "Heun's method": (0.5, "its second stage is taken at half the step"),
    "the explicit midpoint method": (1.0, "its second stage is taken at the whole step"),
}
Tableau = tuple[Rows, Sequence[float]]


def wrong_signs(rows: Rows) -> Iterator[tuple[str, Rows]]:
    """Each coefficient of a stage with the other sign."""
    for stage, row in enumerate(rows):
        for slope, a in enumerate(row):
            if a:
                text = f"the {ORDINALS[slope]} slope has the wrong sign in its "
                yield f"{text}{ORDINALS[stage]} stage", _with_row(rows, stage, {slope: -a})


def _swapped(rows: Rows) -> Iterator[tuple[str, Rows]]:
    """Two coefficients of a stage in each other's place."""
    for stage, row in enumerate(rows):
        for i, j in combinations(range(len(row)), 2):
            if row[i] != row[j]:
                text = f"the coefficients of its {ORDINALS[i]} and {ORDINALS[j]} slopes are swapped"
                changed = {i: row[j], j: row[i]}
                yield f"{text} in its {ORDINALS[stage]} stage", _with_row(rows, stage, changed)


def _with_row(rows: Rows, stage: int, changed: Mapping[int, float]) -> Rows:
    row = tuple(changed.get(slope, a) for slope, a in enumerate(rows[stage]))
    return (*rows[:stage], row, *rows[stage + 1 :])


def _weights(weights: Sequence[float]) -> Iterator[tuple[str, Sequence[float]]]:
    """Two weights in each other's place, and all of them equal."""
    for i, j in combinations(range(len(weights)), 2):
        if weights[i] and weights[j] and weights[i] != weights[j]:
            other = list(weights)
            other[i], other[j] = weights[j], weights[i]
            yield f"the weights of its {ORDINALS[i]} and {ORDINALS[j]} slopes are swapped", other
    if len(weights) > 2:
        yield "its slopes have equal weights", [1.0 / len(weights)] * len(weights)


def _tableaus(name: str) -> Iterator[tuple[str, Tableau]]:
    _, rows, weights = TABLEAUS[name]
    for text, other in (*wrong_signs(rows), *_swapped(rows)):
        yield text, (other, weights)
    for text, own in _weights(weights):
        yield text, (rows, own)
    if name in OTHER_PLACES:
        place, text = OTHER_PLACES[name]
        yield text, (((), (place,)), weights)


def tableau_slips() -> dict[str, dict[str, Step]]:
    """By scheme, on the quaternion and, of second order, with the exponential."""
    found = dict[str, dict[str, Step]]()
    ways: dict[str, Callable[[Rows, Sequence[float]], Step]] = {
        "on the quaternion": on_quaternion,
        "with the exponential": by_exponential,
    }
    for name in SLIPPED:
        for way, made in ways.items():
            if TABLEAUS[name][0] < 3 or made is on_quaternion:
                steps = {text: made(*tableau) for text, tableau in _tableaus(name)}
                found[f"{name} {way}"] = steps
    return found
