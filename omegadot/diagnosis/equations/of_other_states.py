"""Answers that are the right ones of other states among those that are requested together.

Of n states, the i-th is answered as the j-th: by an index that wraps, runs backwards, is off by a
few or stays where it is, or by what was answered to the request before.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from omegadot.diagnosis.equations.evidence import ALONG, BEYOND_ROUNDING, FORWARD, SLACK, Evidence
from omegadot.gates.bounds.scales import norm
from omegadot.reference_impl.system import Array, State

Places = NDArray[np.intp]
Place = Callable[[Places, int], Places]  # of the answer, for each of so many states
LEAST = 3  # states that are answered wrongly
ORDERS: Mapping[str, Callable[[State], Array]] = {
    "ascending order of |omega|": lambda states: norm(states.angular_velocity),
    "descending order of |omega|": lambda states: -norm(states.angular_velocity),
}
LAST_BLOCK = 64  # the largest that is tried of blocks


def of_other_states(evidence: Mapping[str, Mapping[str, Evidence]], source: str) -> str:
    """Which state's omega-dot each state has, on all scenarios; "" where it is that of none.

    evidence: by scenario and source.
    """
    every = [one[source] for one in evidence.values() if source in one]
    wrong = [one for one in every if one.finite and len(_wrong(one))]
    if not wrong or any(not one.finite for one in every):
        return ""
    first = max(wrong, key=lambda one: len(_wrong(one)))
    if len(_wrong(first)) < LEAST:
        return ""
    count, at = len(first.sound), int(_wrong(first)[0])
    if source == ALONG and _of_request_before(evidence):
        return "states have the omega-dot of those in the same places of the request before"
    if not np.any(_same(first, at)):
        return ""
    for text, place in _mappings(first, at):
        if all(_is_of(one, place(np.arange(len(one.sound)), len(one.sound))) for one in every):
            return f"of {count} states requested together, {text}"
    for text, key in ORDERS.items():
        if all(_is_of(one, np.argsort(key(one.states), kind="stable")) for one in every):
            return f"of {count} states requested together, the answers come in {text}"
    if all(_is_of_any(one) for one in wrong):
        return "states have the omega-dot of other states that are requested together with them"
    return ""


def _wrong(evidence: Evidence) -> Places:
    """The states whose omega-dot is another, whatever their linear acceleration is."""
    off = norm(evidence.found.angular - evidence.true.angular)
    return np.flatnonzero(off > BEYOND_ROUNDING * evidence.angular_bound)


def _mappings(evidence: Evidence, at: int) -> Iterator[tuple[str, Place]]:
    """Those that the first wrong answer admits, with their numbers."""
    count = len(evidence.sound)
    yield "each has the omega-dot of the first", lambda i, n: 0 * i
    yield "each has the omega-dot of the last", lambda i, n: 0 * i + n - 1
    yield "they are answered in reverse: the first has the omega-dot of the last", _reversed
    for other in np.flatnonzero(_same(evidence, at)):
        by = int(other) - at
        if other == 0 and at > 1:
            yield f"state i, from 0, has the omega-dot of state i mod {at}", _modulo(at)
        if other == at - 1 and at > 1:
            yield f"those after the first {at} have the omega-dot of the last of these", _until(at)
        near = by if abs(by) <= count // 2 else by - count * (1 if by > 0 else -1)
        after = "after" if near > 0 else "before"
        way = f"each has the omega-dot of the state {abs(near)} {after} it"
        yield f"{way}, and the ends go round", _rolled(near)
        yield f"{way}, but for the ends", _shifted(near)
    for size in range(2, min(count, LAST_BLOCK)):
        yield f"each {size} have the omega-dot of the first of them", _first_of(size)
        yield f"each {size} have the omega-dot of the last of them", _last_of(size)
        yield f"each {size} are answered in reverse", _reversed_in(size)


def _reversed(i: Places, n: int) -> Places:
    return n - 1 - i


def _modulo(size: int) -> Place:
    return lambda i, n: i % size


def _until(size: int) -> Place:
    return lambda i, n: np.asarray(np.minimum(i, size - 1))


def _rolled(by: int) -> Place:
    return lambda i, n: (i + by) % n


def _shifted(by: int) -> Place:
    return lambda i, n: np.asarray(np.clip(i + by, 0, n - 1))


def _first_of(size: int) -> Place:
    return lambda i, n: i - i % size


def _last_of(size: int) -> Place:
    return lambda i, n: np.asarray(np.minimum(i - i % size + size - 1, n - 1))


def _reversed_in(size: int) -> Place:
    def place(i: Places, n: int) -> Places:
        first = i - i % size
        return np.asarray(first + np.minimum(size, n - first) - 1 - i % size)

    return place


def _same(evidence: Evidence, at: int) -> NDArray[np.bool_]:
    """(n,): the states whose right omega-dot is what one of them has."""
    bound = np.maximum(evidence.angular_bound, evidence.angular_bound[at])
    apart = norm(evidence.true.angular - evidence.found.angular[at])
    return np.asarray(apart <= SLACK * bound)


def _is_of(evidence: Evidence, places: Places) -> bool:
    """Whether each omega-dot is that of the state in this place."""
    return _matches(evidence, evidence.true.angular[places], evidence.angular_bound[places])


def _matches(evidence: Evidence, angular: Array, bound: Array) -> bool:
    apart = norm(evidence.found.angular - angular)
    return bool(np.all(apart <= SLACK * np.maximum(evidence.angular_bound, bound)))


def _is_of_any(evidence: Evidence) -> bool:
    """Whether each wrong omega-dot is that of another state, and they are of several."""
    of = {tuple(np.flatnonzero(_same(evidence, int(at)))) for at in _wrong(evidence)}
    return len(of) >= LEAST and () not in of


def _of_request_before(evidence: Mapping[str, Mapping[str, Evidence]]) -> bool:
    """Whether what is answered along the trajectory is what was answered to the drawn states."""
    pairs = [(e[FORWARD], e[ALONG]) for e in evidence.values() if {FORWARD, ALONG} <= e.keys()]
    return bool(pairs) and all(map(_is_before, *zip(*pairs, strict=True)))


def _is_before(before: Evidence, now: Evidence) -> bool:
    count = min(len(before.sound), len(now.sound))
    part: Sequence[Array] = (before.true.angular[:count], before.angular_bound[:count])
    return len(now.sound) <= count and _matches(now, *part)
