"""Which one or two of many terms make a difference, by factors that a slip of the hand has."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from omegadot.diagnosis.equations.evidence import SLACK
from omegadot.reference_impl.system import Array

Few = tuple[tuple[int, float], ...]  # numbers of terms, each with its factor

HALVES, MOST = 2.0, 4.0  # a factor is so many halves at most, as of a product that is typed wrong
NEAR = 1e-3  # a fitted factor is that number; all states decide afterwards, within their bounds
EXACT = 1e-6  # a factor that may be any number, and is that one
LEFT = 1e-8  # of the square of the difference, what is left where a fit is worth being tried
PARALLEL = 1e-9  # of the determinant: two terms that are one here


def few_of(lines: Array, rest: Array) -> list[Few]:
    """One of the terms (k, n) that is the difference (n,), else two; in bounds, by least squares.

    All that come near are given: here two may be one.
    """
    gram, along, whole = lines @ lines.T, lines @ rest, float(rest @ rest)
    allowed = max(LEFT * whole, SLACK**2 * len(rest))
    sizes = np.diag(gram)
    used = np.flatnonzero(sizes > 0.0)
    if not whole > allowed:
        return []
    single = along[used] / sizes[used]
    near = whole - single * along[used] <= allowed
    found = [_plain([k], [p]) for k, p in zip(used[near], single[near], strict=True)]
    return _known(found) or _known(_pairs(gram, along, whole, allowed, used))


def _pairs(
    gram: Array, along: Array, whole: float, allowed: float, used: NDArray[np.intp]
) -> list[Few]:
    first, second = (used[k] for k in np.triu_indices(len(used), 1))
    a, b, c = gram[first, first], gram[second, second], gram[first, second]
    det = a * b - c * c
    apart = det > PARALLEL * a * b
    first, second, det = first[apart], second[apart], det[apart]
    a, b, c = a[apart], b[apart], c[apart]
    p = (b * along[first] - c * along[second]) / det
    q = (a * along[second] - c * along[first]) / det
    near = whole - p * along[first] - q * along[second] <= allowed
    every = zip(first[near], second[near], p[near], q[near], strict=True)
    return [_plain([i, j], [x, y]) for i, j, x, y in every]


def _plain(terms: Sequence[int], factors: Sequence[float]) -> Few:
    """With the halves that are meant; nothing where one is no such number."""
    meant = [round(HALVES * p) / HALVES for p in factors]
    pairs = zip(factors, meant, strict=True)
    if not all(0.0 < abs(m) <= MOST and abs(p - m) <= NEAR for p, m in pairs):
        return ()
    return tuple((int(k), m) for k, m in zip(terms, meant, strict=True))


def _known(found: Sequence[Few]) -> list[Few]:
    return [one for one in found if one]


def factors_of(lines: Array, rest: Array) -> list[Few]:
    """All of the terms at once, by any factors; those that are no number of halves as they are."""
    allowed = max(LEFT * float(rest @ rest), SLACK**2 * len(rest))
    sizes = np.sqrt(np.sum(lines * lines, axis=-1))
    if not float(rest @ rest) > allowed or not np.all(sizes > 0.0):
        return []
    scaled, *_ = np.linalg.lstsq((lines / sizes[:, None]).T, rest, rcond=None)
    left = rest - (scaled / sizes) @ lines
    if not float(left @ left) <= allowed:
        return []
    pairs = [(k, p, round(HALVES * p) / HALVES) for k, p in enumerate(scaled / sizes)]
    return [tuple((k, m if abs(p - m) <= EXACT else float(p)) for k, p, m in pairs)]
