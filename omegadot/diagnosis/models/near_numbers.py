"""Tensors of which numbers that are nearly equal, or nearly nothing, are taken to be so."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import partial
from itertools import combinations

import numpy as np

from omegadot.reference_impl.system import Array

PAIRS = ((0, 1), (1, 2), (2, 0))
WAYS: dict[str, tuple[str, Callable[[float, float], float]]] = {
    "mean": ("each is their mean", lambda a, b: 0.5 * (a + b)),
    "first": ("both are the first of the two", lambda a, b: a),
    "second": ("both are the second of the two", lambda a, b: b),
    "larger": ("both are the larger one", max),
    "smaller": ("both are the smaller one", min),
}


@dataclass(frozen=True)
class NearRule:
    """What is done to a tensor below a limit, which is relative.

    what: the numbers that are changed, as text.  done: what becomes of them, as text.  ratios: the
    limits at which the result may change, (k,).  tensor: the result at a limit.  size: what the
    limit is a part of, where it is none of these numbers.
    """

    what: str
    done: str
    ratios: Callable[[Array], Array]
    tensor: Callable[[Array, float], Array]
    size: str = ""


def _ratio(a: float, b: float) -> float:
    size = max(abs(a), abs(b))
    return abs(a - b) / size if size > 0.0 else 0.0


def _ratios(numbers: Array) -> Array:
    """Of all pairs, and of what is left when one pair has been made equal."""
    found = [_ratio(a, b) for a, b in combinations(numbers, 2)]
    for i, j in combinations(range(3), 2):
        k = 3 - i - j
        for _, way in WAYS.values():
            found.append(_ratio(way(numbers[i], numbers[j]), numbers[k]))
    return np.array(found)


def _merged(numbers: Array, limit: float, way: Callable[[float, float], float]) -> Array:
    made = np.array(numbers, dtype=float)
    for i, j in PAIRS:
        if _ratio(made[i], made[j]) < limit:
            made[i] = made[j] = way(float(made[i]), float(made[j]))
    return made


def _diagonal_rule(text: str, way: Callable[[float, float], float]) -> NearRule:
    def tensor(requested: Array, limit: float) -> Array:
        kept = np.diag(requested)
        return np.asarray(requested + np.diag(_merged(kept, limit, way) - kept))

    what = "numbers on the inertia's diagonal"
    return NearRule(what, f"taken as equal: {text}", lambda t: _ratios(np.diag(t)), tensor)


def _principal_rule(text: str, way: Callable[[float, float], float]) -> NearRule:
    def tensor(requested: Array, limit: float) -> Array:
        moments, axes = np.linalg.eigh(requested)
        more = _merged(moments, limit, way) - moments  # added: of equal moments no axes are known
        return np.asarray(requested + (axes * more) @ axes.T)

    def ratios(requested: Array) -> Array:
        return _ratios(np.linalg.eigvalsh(requested))

    return NearRule("principal moments", f"taken as equal: {text}", ratios, tensor)


def _sphere_rule() -> NearRule:
    """All three moments at once, in whatever axes."""

    def ratios(requested: Array) -> Array:
        moments = np.linalg.eigvalsh(requested)
        return np.array([_ratio(moments[0], moments[2])])

    def tensor(requested: Array, limit: float) -> Array:
        near = bool(ratios(requested)[0] < limit)
        return np.trace(requested) / 3.0 * np.eye(3) if near else requested

    done = "taken as equal: all three are a third of the trace"
    return NearRule("principal moments", done, ratios, tensor)


def _top_rule() -> NearRule:
    """As `_sphere_rule`, and two that are near where the outermost are not."""

    def ratios(requested: Array) -> Array:
        moments = np.linalg.eigvalsh(requested)
        return np.array([_ratio(moments[i], moments[j]) for i, j in PAIRS])

    def tensor(requested: Array, limit: float) -> Array:
        moments, axes = np.linalg.eigh(requested)
        near = [pair for pair in (PAIRS[2], *PAIRS[:2]) if _ratio(*moments[list(pair)]) < limit]
        if not near:
            return requested
        alike = [0, 1, 2] if near[0] == PAIRS[2] else list(near[0])
        more = np.zeros(3)
        more[alike] = np.mean(moments[alike]) - moments[alike]
        return np.asarray(requested + (axes * more) @ axes.T)

    done = "taken as equal: two are their mean, and all three where the outermost are so near"
    return NearRule("principal moments", done, ratios, tensor)


SIZES: dict[str, Callable[[Array], float]] = {
    "the largest number on its diagonal": lambda t: float(np.max(np.abs(np.diag(t)))),
    "its trace": lambda t: abs(float(np.trace(t))),
}


def _products(size: Callable[[Array], float], requested: Array) -> Array:
    """Each product over the size."""
    return np.abs(requested[np.triu_indices(3, 1)]) / size(requested)


def _without_small(size: Callable[[Array], float], requested: Array, limit: float) -> Array:
    kept = (np.abs(requested) >= limit * size(requested)) | np.eye(3, dtype=bool)
    return np.where(kept, requested, 0.0)


def _without_all(size: Callable[[Array], float], requested: Array, limit: float) -> Array:
    small = bool(np.max(_products(size, requested)) < limit)
    return np.diag(np.diag(requested)) if small else requested


def _small_rules() -> Iterator[NearRule]:
    done = {"each by itself": _without_small, "where all are so small": _without_all}
    for text, size in SIZES.items():
        for how, change in done.items():
            ways = partial(_products, size), partial(change, size)
            yield NearRule("products of inertia", f"dropped: {how}", *ways, text)


NEAR_RULES = (
    *(_diagonal_rule(*way) for way in WAYS.values()),
    *(_principal_rule(*WAYS[name]) for name in ("mean", "larger", "smaller")),
    _sphere_rule(),
)
SMALL_RULES = tuple(_small_rules())
LAST_RULES = (
    _top_rule(),
)  # which differ from these on near spheres alone: where none of them fits
